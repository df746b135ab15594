//! How uneven the edges of a picture are: renderers that count a few places in each pixel are off by another amount in every window.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::window::{beside, sample};
use super::{Ring, Step, profile};
use crate::partition::Partition;
use crate::tuning;

/// Standard deviation of the positions along slanted edges, pixels; 0 if too few tell.
///
/// *Why*: fourth differences of five positions in a row show neither slopes nor bends, and their median no corners.
pub(super) fn unevenness(partition: &Partition, rings: &[Vec<Ring>]) -> f64 {
    let mut off: Vec<f64> = Vec::new();
    for ring in rings.iter().flatten() {
        // The rings of both sides of a boundary tell the same.
        let position = |step: &Step| {
            let sample = (step.inner < step.other).then(|| sample(partition, step))??;
            Some(sample.point.dot(sample.axis))
        };
        let positions: Vec<Option<f64>> = ring.steps.iter().map(position).collect();
        off.extend(
            (0..positions.len())
                .filter_map(|k| five(ring, &positions, k))
                .filter(|&at| !(partition.has_exact_edges() && is_corner(at)))
                .map(|at| profile::fourth_difference(at).abs()),
        );
    }
    if off.len() < tuning::UNEVEN_LEAST {
        return 0.0;
    }
    let middle = off.len() / 2;
    let (_, median, _) = off.select_nth_unstable_by(middle, f64::total_cmp);
    // The median of a normal distribution's absolute values, and the root of the sum of the squares of 1, -4, 6, -4, 1.
    *median / 0.6745 / 70.0_f64.sqrt()
}

/// Positions in five windows side by side from step `first` on, along their axis; none if the boundary is not slanted or not straight there.
fn five(ring: &Ring, positions: &[Option<f64>], first: usize) -> Option<[f64; 5]> {
    let mut at = [positions[first]?; 5];
    let mut k = first;
    for value in &mut at[1..] {
        k = beside(ring, k, true)?;
        *value = positions[k]?;
    }
    let slope = 0.1 * (at[3] - at[1] + 2.0 * (at[4] - at[0]));
    let mean = at.iter().sum::<f64>() / 5.0;
    let is_straight = (0..5).all(|k| (at[k] - mean - slope * (k as f64 - 2.0)).abs() < tuning::UNEVEN_BENT);
    let is_slanted = (tuning::UNEVEN_SLOPES[0]..tuning::UNEVEN_SLOPES[1]).contains(&slope.abs());
    (is_straight && is_slanted).then_some(at)
}

/// Whether positions are on whole pixels, with one step between them: no line that is off, but two things, or sides of one, a pixel from one another.
fn is_corner(at: [f64; 5]) -> bool {
    at.iter().all(|at| at.fract() == 0.0) && at.windows(2).filter(|pair| pair[0] != pair[1]).count() == 1
}
