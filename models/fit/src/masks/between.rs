//! The outline in the middle of the room that the cracks of a mask leave.
//!
//! The outline crosses the row or column of a crack somewhere between the two pixel centers beside it, anywhere as likely. So
//! nothing is said by how far the middle of a crack is missed until it is missed by half a pixel, and then everything. The outline
//! that is farthest from all these bounds is known much better than the one of least squares: to 1 / n from n cracks, not 1 / sqrt n.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::shape::REFERENCE_VERTICES;

use crate::free::basis::Basis;
use crate::free::foot::{EdgeLanes, foot};
use crate::free::outline_fit::{FreeOutline, OutlineScratch, OutlineSettings, Target, refine};
use crate::segment::EdgeSample;

/// The edge between a pixel of the mask and one that is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crack<T> {
    /// Its middle, px.
    pub(super) middle: [T; 2],
    /// Whether it is a piece of a row's border, so that the pixels beside it stand one above the other.
    pub(super) lies_in_row: bool,
}

/// Powers of the distance over its bound that are made least, one after the other: high ones are nearly the greatest distance.
const POWERS: [u8; 12] = [4, 4, 4, 8, 8, 8, 16, 16, 16, 16, 16, 16];
/// Where an outline runs nearly along the line between two centers the bound would be 0; it is at least this, px.
const LEAST_BOUND: f64 = 0.03;
/// Room that the bounds leave beside their middle counts at least as this share of them.
const LEAST_SHARE: f64 = 0.1;

/// Moves `outline` to the middle of its bounds; returns by how much (px) it exceeds them where it does so most, at most 0 if it
/// keeps them all.
pub(super) fn settle<T: Real>(
    outline: &mut FreeOutline<T>,
    cracks: &[Crack<T>],
    basis: &Basis<T>,
    scratch: &mut OutlineScratch<T>,
) -> T {
    // Damping keeps what the cracks do not tell; there is no noise to hold anything against.
    let settings =
        OutlineSettings { width_px: T::of(1e3), pixel_noise: T::one(), smoothness: T::of(1e-6), max_steps: 2 };
    let mut samples: Vec<EdgeSample<T>> = Vec::with_capacity(cracks.len());
    for power in POWERS {
        let power = T::of(power.into());
        samples.clear();
        measure(outline, cracks, basis, |crack, distance, bound| {
            // A step of Gauss and Newton on the power: weights that grow with the distance, and a shorter way to go.
            let share = (distance.abs() / bound).max(T::of(LEAST_SHARE));
            let weight = share.powf((power - T::of(2.0)) * T::of(0.5)) / bound;
            let distance = distance * (T::one() - T::of(2.0) / power);
            samples.push(EdgeSample { point: crack.middle, distance, weight });
        });
        let target = Target { samples: &samples, basis, vertex_count: REFERENCE_VERTICES, settings };
        refine(outline, &target, scratch);
    }
    let mut excess = T::neg_infinity();
    measure(outline, cracks, basis, |_, distance, bound| excess = excess.max(distance.abs() - bound));
    excess
}

/// The signed distance (px) of the outline from the middle of every crack, and the greatest one that leaves the centers beside it
/// on their sides.
fn measure<T: Real>(
    outline: &FreeOutline<T>,
    cracks: &[Crack<T>],
    basis: &Basis<T>,
    mut tell: impl FnMut(&Crack<T>, T, T),
) {
    let mut vertices = Vec::new();
    outline.write_vertices(basis, REFERENCE_VERTICES, &mut vertices);
    let mut lanes = EdgeLanes::default();
    lanes.set(&vertices);
    for crack in cracks {
        let foot = foot(&vertices, &lanes, crack.middle);
        let across = foot.direction[usize::from(crack.lies_in_row)].abs();
        tell(crack, foot.distance, (T::of(0.5) * across).max(T::of(LEAST_BOUND)));
    }
}
