//! What windows across a circle or an ellipse are off by, so that its numbers are not.
//!
//! A window tells the mean of the outline along it. The boundary makes the position in its middle of that, from the windows beside it
//! ([`straightened`]), and is as good as those rise and fall like a parabola of fourth degree: not around the tip of a slender ellipse. Of an
//! outline that is known to a thousandth of a pixel the means of all windows are known, and what is made of them.

use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::figure::{Figure, MOST_NUMBERS};
use crate::sample::{Sample, straightened};

/// Windows to either side that the position in one is made of.
const REACH: usize = 2;
/// Places and weights in a window, from -1/2 to 1/2, that give means of polynomials of fifth degree (Gauss and Legendre).
const PLACES: [(f64, f64); 3] = [(-0.387_298_334_6, 5.0 / 18.0), (0.0, 4.0 / 9.0), (0.387_298_334_6, 5.0 / 18.0)];

/// The samples with what is off in them taken away, if the outline is about this figure; without those whose windows, or windows beside, the
/// outline does not cross from one side to the other. None if these are more than half.
pub(super) fn unbent(figure: Figure, numbers: &[f64; MOST_NUMBERS], samples: &[Sample]) -> Option<Vec<Sample>> {
    let [x, y, a, b, angle, _] = *numbers;
    let (radii, angle) = match figure {
        Figure::Circle => ([a, a], 0.0),
        Figure::Ellipse => ([a, b], angle),
        _ => return Some(samples.to_vec()),
    };
    let round = Round { center: Vec2::new(x, y), radii, turn: Vec2::from_angle(-angle) };
    let unbent = samples.iter().filter_map(|sample| {
        let off = round.off(sample)?;
        Some(Sample { point: sample.point - sample.axis * off, ..*sample })
    });
    let unbent: Vec<Sample> = unbent.collect();
    (2 * unbent.len() >= samples.len()).then_some(unbent)
}

/// An ellipse.
struct Round {
    center: Vec2<f64>,
    radii: [f64; 2],
    /// From the picture to its own axes.
    turn: Vec2<f64>,
}

impl Round {
    /// What is made of the windows around a sample, less the position in its middle.
    fn off(&self, sample: &Sample) -> Option<f64> {
        let mean = |window: f64| -> Option<f64> {
            PLACES.iter().map(|(place, weight)| Some(weight * self.position(sample, window + place)?)).sum()
        };
        let here = mean(0.0)?;
        let mut beside = [0.0; 2 * REACH];
        for (value, window) in beside.iter_mut().zip([-2.0, -1.0, 1.0, 2.0]) {
            *value = mean(window)? - here;
        }
        let [first, before, behind, last] = beside;
        Some(here + straightened([before, behind], Some([first, last]))? - self.position(sample, 0.0)?)
    }

    /// Where the line along the axis of a sample, moved across by some pixels, meets the side of the ellipse that the sample is on, from the sample.
    fn position(&self, sample: &Sample, across: f64) -> Option<f64> {
        // In a plane in which it is the unit circle.
        let own = |vector: Vec2<f64>| {
            let vector = vector.turned(self.turn);
            Vec2::new(vector.x / self.radii[0], vector.y / self.radii[1])
        };
        let (axis, side) = (own(sample.axis), own(sample.point - self.center));
        let from = side + own(sample.axis.perp()) * across;
        let (steepness, middle) = (axis.length_squared(), axis.dot(from));
        let square = middle * middle - steepness * (from.length_squared() - 1.0);
        let reach = (square > 0.0).then(|| square.sqrt())?;
        Some((reach.copysign(axis.dot(side)) - middle) / steepness)
    }
}
