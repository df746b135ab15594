//! Covariance of poses from the normal equations of the joint refinement, colors integrated out.
//!
//! What the pixels near outlines are missed by beyond the noise is taken for displacements of outlines, as in
//! [`covariance`](mod@crate::covariance): of the whole of one and of each of its parts, which no count of pixels averages away. The parts
//! are those of a disk here: which pixel belongs to which part is not kept.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

use crate::cholesky::{factor, packed, solve};
use crate::covariance::{ARCS, PRIOR_VARIANCE, with_stretch};
use crate::joint::{JointScratch, PER_OBJECT};
use crate::tuning::SYSTEMATIC_PX;

/// Per object, row-major 5 x 5 in (x, y in scene units, log scale, rotation, log stretch); empty if the equations are singular.
/// Expects the equations of `objects` objects in `joint`, and leaves it without them. `pixel_noise` is the standard
/// deviation of a channel.
pub(super) fn covariances<T: Real>(
    joint: &mut JointScratch<T>,
    objects: usize,
    unit_px: T,
    pixel_noise: T,
) -> Vec<[T; 25]> {
    let n = objects * PER_OBJECT + 3;
    // Noise as unit: entries of the inverse are far below the rounding of f32 otherwise.
    let noise = pixel_noise * pixel_noise;
    let units = [unit_px, unit_px, T::one(), T::one()];
    // Per object, the sums of squared slopes: of a displacement by a pixel, a growth, and a turn.
    let slopes: Vec<[T; 3]> = (0..objects)
        .map(|object| {
            let of = |i: usize| joint.hessian[packed(object * PER_OBJECT + i, object * PER_OBJECT + i)];
            [of(0) + of(1), of(2), of(3)]
        })
        .collect();
    let excess = (joint.near_cost - noise * T::of_usize(3 * joint.near)).max(T::zero());
    let all: T = slopes.iter().map(|slopes| slopes[0]).sum();
    let systematic = if all > T::zero() { excess / all } else { T::zero() } + T::of(SYSTEMATIC_PX * SYSTEMATIC_PX);
    for i in 0..n {
        // A color in [0, 1] has a variance of 1 at most.
        let variance = if i < objects * PER_OBJECT && i % PER_OBJECT < 4 {
            let unit = units[i % PER_OBJECT];
            T::of(PRIOR_VARIANCE[i % PER_OBJECT]) * unit * unit
        } else {
            T::one()
        };
        joint.hessian[packed(i, i)] += noise / variance;
    }
    if !factor(&mut joint.hessian, n) {
        return Vec::new();
    }
    let mut column = vec![T::zero(); n];
    (0..objects)
        .map(|object| {
            let first = object * PER_OBJECT;
            let mut block = [T::zero(); 16];
            for i in 0..4 {
                column.fill(T::zero());
                column[first + i] = noise;
                solve(&joint.hessian, n, &mut column);
                for j in 0..4 {
                    block[4 * j + i] = column[first + j] / (units[i] * units[j]);
                }
            }
            let [shift, growth, turn] = slopes[object];
            let part = systematic / T::of_usize(ARCS);
            let per = |squared: T| if squared > T::zero() { shift / squared } else { T::zero() };
            let alike = [part + part, part + part, (part + systematic) * per(growth), part * per(turn)];
            for (i, alike) in alike.into_iter().enumerate() {
                // Nothing is known less well than before looking.
                let widened = block[5 * i] + alike / (units[i] * units[i]);
                block[5 * i] = widened.min(T::of(PRIOR_VARIANCE[i]));
            }
            with_stretch(block)
        })
        .collect()
}
