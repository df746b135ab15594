//! Lines thinner than two pixels: no pixel is theirs alone, so that windows across them tell of both sides at once.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{Cap, Join, Stroke};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::draw::MITER_LIMIT;
use super::piece::{direction, halve_turns, move_tip, nearest, pieces, tip};
use crate::outline::{OpenFit, fit_closed, fit_open};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};

/// What one window across a thin line tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinSample {
    /// The middle of the line, pixels.
    pub point: Vec2<f64>,
    /// The axis along which it was read: (1, 0) for a piece of a row, (0, 1) for one of a column.
    pub axis: Vec2<f64>,
    /// Standard deviation of the position along the axis, pixels.
    pub sigma: f64,
    /// How wide the line is along the axis: the sum of its coverage over the window, pixels.
    pub width: f64,
}

/// What is known of one thin line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ThinChain {
    /// Windows across it, in order.
    pub samples: Vec<ThinSample>,
    /// How much further it goes than the first and the last window, pixels.
    pub ends: [f64; 2],
    /// Whether it comes back to where it starts.
    pub is_closed: bool,
}

/// The stroke along a chain of at least three samples, and the bits by which it misses them: its center line through them, its width their
/// mean across the line.
#[must_use]
pub fn fit_thin(chain: &ThinChain, ruler: &Ruler) -> Option<(Stroke<f64>, f64)> {
    let thin = &chain.samples[..];
    if thin.len() < 3 {
        return None;
    }
    let mut samples: Vec<_> = thin.iter().map(|thin| Sample::new(thin.point, thin.axis, thin.sigma)).collect();
    let (mut ring, misfit) = if chain.is_closed {
        let area: f64 =
            (0..samples.len()).map(|k| samples[k].point.cross(samples[(k + 1) % samples.len()].point)).sum();
        if area < 0.0 {
            samples.reverse();
        }
        let outline = fit_closed(&RingSamples { runs: alloc::vec![samples.clone()], closed: true }, ruler)?;
        (outline.shape.ring(), outline.misfit)
    } else {
        let OpenFit { mut path, misfit, .. } = fit_open(&samples, ruler)?;
        halve_turns(&mut path);
        (path, misfit)
    };
    let line = pieces(&ring);
    let (mut sum, mut weights) = (0.0, 0.0);
    for sample in thin {
        let distance = |&(piece, t): &(&_, f64)| (dvp_core::shape::Piece::point(piece, t) - sample.point).length();
        let feet = line.iter().map(|piece| (piece, nearest(piece, sample.point)));
        let (piece, t) = feet.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        // A window along an axis sees a slanted line wider than it is.
        let cosine = direction(piece, t).perp().dot(sample.axis).abs();
        let weight = (sample.sigma * cosine.max(0.5)).powi(-2);
        sum += weight * sample.width * cosine;
        weights += weight;
    }
    // Windows are a pixel wide, and their samples in the middle.
    for at_finish in [false, true].into_iter().filter(|_| !chain.is_closed) {
        let [from, out] = tip(&ring, at_finish)?;
        let end = if at_finish { samples.last()? } else { samples.first()? };
        let reach = (0.5 + chain.ends[usize::from(at_finish)]) / out.cross(end.axis).abs().max(0.5);
        move_tip(&mut ring, at_finish, from + out * reach);
    }
    let join = Join::Miter { limit: MITER_LIMIT };
    Some((Stroke::new(alloc::vec![ring], sum / weights, Cap::Butt, join).ok()?, misfit))
}
