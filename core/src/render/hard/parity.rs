//! Which pixel centers lie inside of rings.

use alloc::vec::Vec;

use crate::real::Real;
use crate::render::tile::{ChunkState, LANES, Lanes, Tile, grow};
use crate::shape::Rings;
use crate::simd::Kernel;

/// Memory of the forward pass.
#[derive(Clone, Debug, Default)]
pub struct HardRecord {
    /// Per chunk, bit by bit, the pixels before which a row enters or leaves the object.
    crossings: Vec<u16>,
}

const _: () = assert!(LANES == u16::BITS as usize, "a chunk is one word of bits");

/// Covers one object.
///
/// Each edge marks in each row that it spans the first pixel center at or right of it; a pixel is inside if the number
/// of marks up to it is odd.
pub(super) struct Cover<'a, T> {
    pub(super) rings_px: Rings<'a, T>,
    pub(super) tile: &'a mut Tile<T>,
    pub(super) record: &'a mut HardRecord,
}

impl<T: Real> Kernel for Cover<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { rings_px, tile, record } = self;
        let window = tile.window();
        let chunks = window.chunks;
        let count = chunks * window.rows;
        grow(&mut record.crossings, count, tile.reserved());
        let crossings = &mut record.crossings[..count];
        crossings.fill(0);
        let (left, width) = (T::of_usize(window.left()), window.width());
        let (top, end) = (T::of_usize(window.top), T::of_usize(window.top + window.rows));
        for ring in rings_px.iter() {
            let Some(&last) = ring.last() else { continue };
            let mut a = last;
            for &b in ring {
                let (upper, lower) = if a[1] <= b[1] { (a, b) } else { (b, a) };
                a = b;
                // Rows y with upper <= y < lower.
                let first = upper[1].max(top).min(end).ceil();
                let end = lower[1].max(top).min(end).ceil();
                let slope = (lower[0] - upper[0]) / (lower[1] - upper[1]);
                let mut y = first;
                while y < end {
                    let column = (upper[0] + (y - upper[1]) * slope - left).ceil().to_count();
                    if column < width {
                        let row = y.to_count() - window.top;
                        crossings[row * chunks + column / LANES] ^= 1 << (column % LANES);
                    }
                    y += T::one();
                }
            }
        }
        let rows = crossings.chunks_exact(chunks).zip(tile.states.chunks_exact_mut(chunks));
        for ((crossings, states), coverage) in rows.zip(tile.coverage.chunks_exact_mut(chunks)) {
            let mut inside = false;
            for ((&crossings, state), coverage) in crossings.iter().zip(states).zip(coverage) {
                // Bit k becomes the parity of bits 0 to k.
                let mut bits = crossings;
                bits ^= bits << 1;
                bits ^= bits << 2;
                bits ^= bits << 4;
                bits ^= bits << 8;
                if inside {
                    bits = !bits;
                }
                inside = bits >> (LANES - 1) == 1;
                *state = match bits {
                    0 => ChunkState::Empty,
                    u16::MAX => ChunkState::Full,
                    _ => {
                        *coverage = expand(bits);
                        ChunkState::Mixed
                    }
                };
            }
        }
    }
}

/// 1 where a bit is set, else 0.
#[inline(always)]
fn expand<T: Real>(bits: u16) -> Lanes<T> {
    core::array::from_fn(|lane| if bits >> lane & 1 == 1 { T::one() } else { T::zero() })
}
