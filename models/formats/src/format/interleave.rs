//! Images to the bytes that encoders of pictures take.

use dvp_core::image::RgbaImage;
use dvp_core::{ImageView, Real, simd};

use super::{BitDepth, to_byte, to_step};

/// Red, green, blue of every pixel, row by row; values are clamped to [0, 1] and rounded to the nearest of 256 or 65536 steps. Sixteen bits
/// are two bytes in the order of the machine.
#[must_use]
#[inline(never)]
pub fn interleaved_bytes<T: Real>(image: ImageView<'_, T>, bits: BitDepth) -> Vec<u8> {
    match bits {
        BitDepth::Eight => interleaved(image, 255.0, |step| [step.to_le_bytes()[0]]),
        BitDepth::Sixteen => interleaved(image, 65535.0, native),
    }
}

/// Red, green, blue, alpha of every pixel, row by row, colors not multiplied by alpha; otherwise as [`interleaved_bytes`].
#[must_use]
#[inline(never)]
pub fn interleaved_rgba_bytes<T: Real>(image: &RgbaImage<T>, bits: BitDepth) -> Vec<u8> {
    let straight = image.to_straight();
    match bits {
        BitDepth::Eight => straight.iter().map(|&value| to_byte(value)).collect(),
        BitDepth::Sixteen => straight.iter().flat_map(|&value| native(to_step(value, 65535.0))).collect(),
    }
}

/// The bytes of a step of 16 bits, in the order of the machine.
fn native(step: i32) -> [u8; 2] {
    let [low, high, ..] = step.to_le_bytes();
    u16::from_le_bytes([low, high]).to_ne_bytes()
}

/// r, g, b, r, g, b, ..., the `N` bytes of the nearest of the steps 0 to `most`.
fn interleaved<T: Real, const N: usize>(image: ImageView<'_, T>, most: f64, bytes: impl Fn(i32) -> [u8; N]) -> Vec<u8> {
    let mut out = vec![[0; N]; 3 * image.size().pixels()];
    simd::dispatch(Interleave { image, most, bytes, out: out.as_chunks_mut().0 });
    out.into_flattened()
}

/// Pixels that are worked on together: their steps stay in the processor's nearest memory.
const BLOCK: usize = 256;

/// The kernel that puts the steps of the channels beside each other.
struct Interleave<'a, T, F, const N: usize> {
    image: ImageView<'a, T>,
    most: f64,
    bytes: F,
    out: &'a mut [[[u8; N]; 3]],
}

impl<T: Real, F: Fn(i32) -> [u8; N], const N: usize> simd::Kernel for Interleave<'_, T, F, N> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let mut steps = [[0; BLOCK]; 3];
        let [red, green, blue] = [0, 1, 2].map(|channel| self.image.channel(channel).chunks(BLOCK));
        for (((out, red), green), blue) in self.out.chunks_mut(BLOCK).zip(red).zip(green).zip(blue) {
            for (steps, values) in steps.iter_mut().zip([red, green, blue]) {
                for (own, &value) in steps.iter_mut().zip(values) {
                    *own = to_step(value, self.most);
                }
            }
            let [red, green, blue] = &steps;
            for ((([r, g, b], &red), &green), &blue) in out.iter_mut().zip(red).zip(green).zip(blue) {
                (*r, *g, *b) = ((self.bytes)(red), (self.bytes)(green), (self.bytes)(blue));
            }
        }
    }
}
