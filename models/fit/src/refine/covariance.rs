//! Covariance of poses from the normal equations of the joint refinement, colors integrated out.
//!
//! Where the pixels near outlines are missed by more than noise explains, they tell so much less: the mean squared residual
//! there stands for the variance of the noise if it is above it.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

use crate::cholesky::{factor, packed, solve};
use crate::covariance::{PRIOR_VARIANCE, with_stretch};
use crate::joint::{JointScratch, PER_OBJECT};
use crate::segment::PIXEL_NOISE;

/// Per object, row-major 5 x 5 in (x, y in scene units, log scale, rotation, log stretch); empty if the equations are singular.
/// Expects the equations of `objects` objects in `joint`, with their cost, and leaves it without them.
pub(super) fn covariances<T: Real>(joint: &mut JointScratch<T>, cost: T, objects: usize, unit_px: T) -> Vec<[T; 25]> {
    let n = objects * PER_OBJECT + 3;
    // Noise as unit: entries of the inverse are far below the rounding of f32 otherwise.
    let noise = T::of(PIXEL_NOISE * PIXEL_NOISE).max(cost / T::of_usize(3 * joint.near.max(1)));
    let units = [unit_px, unit_px, T::one(), T::one()];
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
            with_stretch(block)
        })
        .collect()
}
