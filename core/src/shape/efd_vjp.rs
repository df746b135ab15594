//! The way back of [`OutlineBasis::outline`]: gradients of vertices to gradients of descriptors.

use super::ShapeError;
use super::efd::{LANES, OutlineBasis};
use crate::real::Real;

/// Blocks folded at a time: 128 vertices, which is 2 KiB of stack in f32.
const BLOCKS: usize = 8;

/// One block of folded gradients: sums of mirrored vertices (x, y), then differences (x, y).
type Folded<T> = [[T; LANES]; 4];

impl<T: Real> OutlineBasis<T> {
    /// Adds to `grad_rows` the gradient of sum(grad_vertices x outline) with respect to the descriptors.
    ///
    /// The outline is linear in the descriptors, so that they are not needed. *Dimensions*: K vertices, at most N rows.
    /// Allocates nothing.
    ///
    /// # Errors
    /// As [`Self::outline`].
    pub fn outline_vjp(&self, grad_vertices: &[[T; 2]], grad_rows: &mut [[T; 4]]) -> Result<(), ShapeError> {
        self.check(grad_rows.len(), grad_vertices.len())?;
        self.pull_back(0, grad_vertices, grad_rows);
        Ok(())
    }

    /// As [`Self::outline_vjp`] for the harmonics from `skip + 1` on, lengths checked by the caller.
    pub(crate) fn pull_back(&self, skip: usize, grad_vertices: &[[T; 2]], grad_rows: &mut [[T; 4]]) {
        let mut folded = [[[T::zero(); LANES]; 4]; BLOCKS];
        for (group, tables) in self.table.chunks(self.harmonic_count() * BLOCKS).enumerate() {
            let blocks = tables.len() / self.harmonic_count();
            for (block, slot) in folded[..blocks].iter_mut().enumerate() {
                *slot = self.fold((group * BLOCKS + block) * LANES, grad_vertices);
            }
            for (n, row) in grad_rows.iter_mut().enumerate() {
                let mut sums = [[T::zero(); LANES]; 4];
                let harmonics = tables.iter().skip(skip + n).step_by(self.harmonic_count());
                for ([cos, sin], [x_even, y_even, x_odd, y_odd]) in harmonics.zip(&folded[..blocks]) {
                    for lane in 0..LANES {
                        sums[0][lane] += x_even[lane] * cos[lane];
                        sums[1][lane] += x_odd[lane] * sin[lane];
                        sums[2][lane] += y_even[lane] * cos[lane];
                        sums[3][lane] += y_odd[lane] * sin[lane];
                    }
                }
                for (value, lanes) in row.iter_mut().zip(sums) {
                    *value += sum_lanes(lanes);
                }
            }
        }
    }

    /// Sums and differences of the gradients at the vertices `first..` and at their mirrors.
    #[inline]
    #[expect(clippy::needless_range_loop, reason = "the lane runs through four arrays at once")]
    fn fold(&self, first: usize, grad_vertices: &[[T; 2]]) -> Folded<T> {
        let half = self.vertex_count().div_ceil(2);
        let last = self.vertex_count() - 1;
        let mut folded = [[T::zero(); LANES]; 4];
        for lane in 0..LANES.min(half - first) {
            let here = first + lane;
            let [x, y] = grad_vertices[here];
            let [mirror_x, mirror_y] = if here == last - here { [T::zero(); 2] } else { grad_vertices[last - here] };
            folded[0][lane] = x + mirror_x;
            folded[1][lane] = y + mirror_y;
            folded[2][lane] = x - mirror_x;
            folded[3][lane] = y - mirror_y;
        }
        folded
    }
}

/// The sum, by halving: four independent additions, then two, then one.
#[inline(always)]
fn sum_lanes<T: Real>(lanes: [T; LANES]) -> T {
    let [a, b, c, d, e, f, g, h] = lanes;
    ((a + e) + (b + f)) + ((c + g) + (d + h))
}
