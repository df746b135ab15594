//! Backward: how coverage follows the corners of the winning triangle.

use super::distance::TriangleRecord;
use super::profile::SquaredProfile;
use crate::real::Real;
use crate::render::tile::{ChunkState, LANES, Tile};
use crate::simd::Kernel;

/// Adds to `grad_px` the gradient of sum(grad x coverage) over the pixels of a tile.
///
/// Each pixel pulls at the two ends of the nearest edge of its triangle. With q = a + u (b - a) the nearest point and
/// e = x - q, the derivative of |e|^2 is -2 (1 - u) e by a and -2 u e by b (u itself needs none, it minimizes); inside
/// the triangle the sign is turned. Nothing flows to the other edges, the other triangles, or the choice of triangulation.
pub(super) struct CoverVjp<'a, T> {
    pub(super) profile: SquaredProfile<T>,
    pub(super) tile: &'a Tile<T>,
    pub(super) record: &'a TriangleRecord<T>,
    pub(super) grad_px: &'a mut [[T; 2]],
}

impl<T: Real> Kernel for CoverVjp<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { profile, tile, record, grad_px } = self;
        let window = tile.window();
        for chunk in 0..window.chunks * window.rows {
            if tile.states[chunk] != ChunkState::Mixed {
                continue;
            }
            let distance = &record.distance[chunk];
            let slopes = distance.map(|d2| profile.slope(d2));
            let y = T::of_usize(chunk / window.chunks);
            let left = chunk % window.chunks * LANES;
            for lane in 0..LANES {
                let pull = tile.grad[chunk][lane] * slopes[lane];
                if pull != T::zero() {
                    let point = [T::of_usize(left + lane), y];
                    pull_ends(record, record.winner[chunk][lane], point, distance[lane], pull, grad_px);
                }
            }
        }
    }
}

/// Adds the gradient `pull` of the signed squared distance `d2` of one pixel to the ends of the nearest edge.
#[inline(always)]
fn pull_ends<T: Real>(record: &TriangleRecord<T>, winner: u32, point: [T; 2], d2: T, pull: T, grad_px: &mut [[T; 2]]) {
    let code = winner as usize;
    let face = record.faces[code / 3];
    let (from, to) = (face[code % 3], face[(code + 1) % 3]);
    let (a, b) = (record.vertices[from], record.vertices[to]);
    let along = [b[0] - a[0], b[1] - a[1]];
    let away = [point[0] - a[0], point[1] - a[1]];
    let square = along[0] * along[0] + along[1] * along[1];
    let u = if square > T::min_positive_value() {
        ((away[0] * along[0] + away[1] * along[1]) / square).max(T::zero()).min(T::one())
    } else {
        T::zero()
    };
    let doubled = if d2 < T::zero() { T::of(2.0) } else { T::of(-2.0) };
    for axis in 0..2 {
        let step = doubled * pull * (away[axis] - u * along[axis]);
        grad_px[from][axis] += step * (T::one() - u);
        grad_px[to][axis] += step * u;
    }
}
