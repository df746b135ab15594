//! Images to PNG, with 8 or 16 bits per channel, and to pixels of 8 bits.

use dvp_core::dims::SizeError;
use dvp_core::image::RgbaImage;
use dvp_core::{Image, ImageSize, ImageView, Real, simd};
use image::codecs::png::PngEncoder;
use image::error::{LimitError, LimitErrorKind, ParameterError, ParameterErrorKind};
use image::{ExtendedColorType, ImageEncoder, ImageError, RgbImage};

use super::{BitDepth, FormatError, to_byte, to_step};

/// The bytes of an RGB PNG; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// As [`to_rgb8`].
pub fn encode_png<T: Real>(image: ImageView<'_, T>, bits: BitDepth) -> Result<Vec<u8>, FormatError> {
    let (bytes, color) = match bits {
        BitDepth::Eight => (bytes(image), ExtendedColorType::Rgb8),
        BitDepth::Sixteen => (interleaved(image, 65535.0, native), ExtendedColorType::Rgb16),
    };
    png(&bytes, image.size(), color)
}

/// The bytes of an RGBA PNG with straight colors; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// As [`to_rgb8`].
pub fn encode_png_rgba<T: Real>(image: &RgbaImage<T>, bits: BitDepth) -> Result<Vec<u8>, FormatError> {
    let straight = image.to_straight();
    let (bytes, color): (Vec<u8>, _) = match bits {
        BitDepth::Eight => (straight.iter().map(|&value| to_byte(value)).collect(), ExtendedColorType::Rgba8),
        BitDepth::Sixteen => {
            (straight.iter().flat_map(|&value| native(to_step(value, 65535.0))).collect(), ExtendedColorType::Rgba16)
        }
    };
    png(&bytes, image.size(), color)
}

/// The bytes of a gray PNG of 8 bits: one value per pixel, row by row.
///
/// # Errors
/// [`FormatError::Encode`] if there are not as many values as pixels, or if a side is above 2^32.
pub fn encode_gray8(pixels: &[u8], size: ImageSize) -> Result<Vec<u8>, FormatError> {
    png(pixels, size, ExtendedColorType::L8)
}

/// The bytes of a gray PNG of 16 bits: one value per pixel, row by row.
///
/// # Errors
/// As [`encode_gray8`].
pub fn encode_gray16(pixels: &[u16], size: ImageSize) -> Result<Vec<u8>, FormatError> {
    let bytes: Vec<u8> = pixels.iter().flat_map(|pixel| pixel.to_ne_bytes()).collect();
    png(&bytes, size, ExtendedColorType::L16)
}

fn png(bytes: &[u8], size: ImageSize, color: ExtendedColorType) -> Result<Vec<u8>, FormatError> {
    let [width, height] = sides(size)?;
    // The encoder panics at any other length.
    if Some(bytes.len()) != size.pixels().checked_mul(usize::from(color.bits_per_pixel() / 8)) {
        let source = ImageError::Parameter(ParameterError::from_kind(ParameterErrorKind::DimensionMismatch));
        return Err(FormatError::Encode { source: source.into() });
    }
    let mut png = Vec::new();
    let written = PngEncoder::new(&mut png).write_image(bytes, width, height, color);
    written.map_err(|source| FormatError::Encode { source: source.into() })?;
    Ok(png)
}

/// The bytes of a step of 16 bits, in the order of the machine.
fn native(step: i32) -> [u8; 2] {
    let [low, high, ..] = step.to_le_bytes();
    u16::from_le_bytes([low, high]).to_ne_bytes()
}

/// A picture of 8 bits; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// [`FormatError::Encode`] if a side is above 2^32.
pub fn to_rgb8<T: Real>(image: ImageView<'_, T>) -> Result<RgbImage, FormatError> {
    let [width, height] = sides(image.size())?;
    RgbImage::from_raw(width, height, bytes(image)).ok_or_else(too_large)
}

/// The values of a picture of 8 bits, [0, 1].
///
/// # Errors
/// [`SizeError`] if it has no pixel.
pub fn from_rgb8<T: Real>(picture: &RgbImage) -> Result<Image<T>, SizeError> {
    let size = ImageSize::new(picture.width() as usize, picture.height() as usize)?;
    let mut image = Image::zeros(size);
    let bytes = picture.as_raw().iter().enumerate();
    bytes.for_each(|(i, &byte)| image.data_mut()[i % 3 * size.pixels() + i / 3] = T::of(f64::from(byte) / 255.0));
    Ok(image)
}

/// r, g, b, r, g, b, ... in steps of 1/255.
fn bytes<T: Real>(image: ImageView<'_, T>) -> Vec<u8> {
    interleaved(image, 255.0, |step| [step.to_le_bytes()[0]])
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

fn sides(size: ImageSize) -> Result<[u32; 2], FormatError> {
    let side = |pixels: usize| u32::try_from(pixels).map_err(|_| too_large());
    Ok([side(size.width())?, side(size.height())?])
}

fn too_large() -> FormatError {
    let source = ImageError::Limits(LimitError::from_kind(LimitErrorKind::DimensionError));
    FormatError::Encode { source: source.into() }
}
