//! What of a boundary lies between corners inward.

use alloc::vec::Vec;

use dvp_core::Vec2;

use crate::outline::{Outline, OutlineShape};
use crate::sample::{RingSamples, Sample};
use crate::stroke::piece::{direction, pieces};

/// Sine of the turn of a corner: cells that are a little uneven turn inward by half as much over as many windows.
const LEAST_TURN: f64 = 0.3;
/// Windows so near to a corner outward (pixels) hold it: they tell of both sides.
const CORNER: f64 = 1.0;
/// Windows to either side that tell which way a boundary goes.
const REACH: usize = 3;

/// Stretches of a boundary.
pub(super) struct Stretches {
    pub(super) samples: Vec<Vec<Sample>>,
    /// Where they were cut.
    pub(super) cuts: Vec<Vec2<f64>>,
    /// Windows nearer to a cut (pixels) are left out.
    spoiled: f64,
}

impl Stretches {
    /// What of a boundary lies between the corners inward of the outlines that were drawn through it.
    pub(super) fn new(rings: Vec<RingSamples>, outlines: &[Outline], spoiled: f64) -> Self {
        let Corners { inward: cuts, outward } = Corners::of(outlines);
        let is_corner = |sample: &Sample| outward.iter().any(|&corner| (sample.point - corner).length() < CORNER);
        let is_cut = |sample: &Sample| cuts.iter().any(|&cut| (sample.point - cut).length() < spoiled);
        let mut samples = Vec::new();
        for RingSamples { mut runs, closed } in rings {
            for run in &mut runs {
                run.retain(|sample| !is_corner(sample));
                if closed {
                    let first = run.iter().position(is_cut);
                    run.rotate_left(first.unwrap_or(0));
                }
                samples.extend(run.split(is_cut).map(<[Sample]>::to_vec));
            }
        }
        Self { samples, cuts, spoiled }
    }

    /// Cuts a stretch where it turns inward most; whether it turns inward anywhere.
    pub(super) fn cut(&mut self, stretch: &[Sample]) -> bool {
        let at = |k: usize| stretch[k].point;
        let turn = |k: usize| {
            let [before, after] = [at(k) - at(k - REACH), at(k + REACH) - at(k)];
            before.cross(after) / (before.length() * after.length()).max(1e-9)
        };
        let inner = REACH..stretch.len().saturating_sub(REACH);
        let most = inner.map(|k| (turn(k), at(k))).min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, cut)) = most.filter(|most| most.0 < -LEAST_TURN) else { return false };
        let is_cut = |sample: &Sample| (sample.point - cut).length() < self.spoiled;
        self.samples.extend(stretch.split(is_cut).map(<[Sample]>::to_vec));
        self.cuts.push(cut);
        true
    }
}

/// The corners of outlines.
#[derive(Default)]
struct Corners {
    inward: Vec<Vec2<f64>>,
    outward: Vec<Vec2<f64>>,
}

impl Corners {
    fn of(outlines: &[Outline]) -> Self {
        let mut corners = Self::default();
        for outline in outlines {
            let OutlineShape::Path(ring) = &outline.shape else { continue };
            let pieces = pieces(ring);
            let before = pieces.iter().cycle().skip(pieces.len().saturating_sub(1));
            for (before, after) in before.zip(&pieces) {
                let turn = direction(before, 1.0).cross(direction(after, 0.0));
                if turn < -LEAST_TURN {
                    corners.inward.push(after.from());
                } else if turn > LEAST_TURN {
                    corners.outward.push(after.from());
                }
            }
        }
        corners
    }
}
