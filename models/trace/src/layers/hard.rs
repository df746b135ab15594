//! Pictures whose edges are hard: an outline is right if it passes between the centers of the pixels on both sides, wherever.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use alloc::vec::Vec;

use dvp_core::Vec2;

use super::raster;
use crate::outline::{Outline, fit_closed};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};

/// Rounds of a fit: on look-alikes of Multi-dSprites one leaves an error of .00151, four .00117, six .00113, and each takes as long.
const ROUNDS: usize = 4;
/// Half the way from the center of a pixel to that of the next.
const HALF: f64 = 0.5;
/// Miss (pixels) from which on a sample counts more in the next round: the standard deviation of what lies anywhere between two centers.
const USUAL: f64 = 0.29;
/// By how much the weight of a sample, as a deviation, may change in a round: with steps twice as large the kinds of pieces change, too.
const CHANGE: [f64; 2] = [0.85, 1.4];
/// Longest miss that is told from others, pixels.
const FAR: f64 = 4.0;

/// The outline through samples in the middle between pixels that gets fewest of these pixels wrong, for its numbers; what it gets wrong is its
/// misfit.
///
/// *Why*: least squares take the middle for the likeliest place, and are off by more than half a pixel here and there where another outline of as
/// many numbers is nowhere. Samples that are missed most count more, again and again (Lawson's way to the least greatest miss).
pub(super) fn fit(ring: &RingSamples, ruler: &Ruler) -> Option<Outline> {
    let mut weighted = ring.clone();
    let mut best: Option<Outline> = None;
    for _ in 0..ROUNDS {
        let Some(mut outline) = fit_closed(&weighted, ruler) else { break };
        let misses: Vec<f64> = match raster::polygon(&outline) {
            Some(polygon) => ring.runs.iter().flatten().map(|sample| miss(sample, &polygon)).collect(),
            None => break,
        };
        let wrong = misses.iter().filter(|&&miss| miss > HALF).count();
        // Which sample it is, and on which side.
        outline.misfit = wrong as f64 * (1.0 + (misses.len() as f64).log2());
        let cost = |outline: &Outline| outline.bits + outline.misfit;
        if best.as_ref().is_none_or(|best| cost(&outline) < cost(best)) {
            best = Some(outline);
        }
        if wrong == 0 {
            break;
        }
        for (sample, miss) in weighted.runs.iter_mut().flatten().zip(misses) {
            sample.sigma /= (miss / USUAL).clamp(CHANGE[0], CHANGE[1]);
        }
    }
    best
}

/// How far from a sample along its axis a polygon passes, pixels.
fn miss(sample: &Sample, polygon: &[[f64; 2]]) -> f64 {
    let local = |point: [f64; 2]| {
        let offset = Vec2::from(point) - sample.point;
        (offset.dot(sample.axis.perp()), offset.dot(sample.axis))
    };
    let mut nearest = f64::INFINITY;
    let mut last = local(polygon[polygon.len() - 1]);
    for &point in polygon {
        let here = local(point);
        if (last.0 <= 0.0) != (here.0 <= 0.0) {
            let at = last.1 - last.0 / (here.0 - last.0) * (here.1 - last.1);
            nearest = nearest.min(at.abs());
        }
        last = here;
    }
    nearest.min(FAR)
}
