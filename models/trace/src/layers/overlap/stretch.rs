//! What of a boundary lies between corners inward.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::LineSegment;
use dvp_core::shape::Piece;

use crate::outline::{Outline, OutlineShape};
use crate::sample::{RingSamples, Sample};
use crate::stroke::piece::{direction, pieces};

/// Sine of the turn of a corner: cells that are a little uneven turn inward by half as much over as many windows.
pub(super) const LEAST_TURN: f64 = 0.3;
/// Windows so near to a corner outward (pixels) hold it: they tell of both sides.
const CORNER: f64 = 1.0;

/// Stretches of a boundary.
pub(super) struct Stretches {
    pub(super) samples: Vec<Vec<Sample>>,
    /// Where they were cut.
    pub(super) cuts: Vec<Vec2<f64>>,
    /// The corners outward of the outlines, and their straight sides.
    pub(super) corners: Vec<Corner>,
    pub(super) sides: Vec<LineSegment<f64>>,
    /// Windows nearer to a cut (pixels) are left out.
    spoiled: f64,
}

impl Stretches {
    /// What of a boundary lies between the corners inward of the outlines that were drawn through it.
    pub(super) fn new(rings: Vec<RingSamples>, outlines: &[Outline], spoiled: f64) -> Self {
        let Corners { inward: cuts, outward, sides } = Corners::of(outlines);
        let is_corner = |sample: &Sample| outward.iter().any(|corner| (sample.point - corner.at).length() < CORNER);
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
        Self { samples, cuts, corners: outward, sides, spoiled }
    }

    /// What is left of a stretch that is cut.
    pub(super) fn halves(&self, stretch: &[Sample], cut: Vec2<f64>) -> Vec<Vec<Sample>> {
        stretch.split(|sample| (sample.point - cut).length() < self.spoiled).map(<[Sample]>::to_vec).collect()
    }
}

/// A corner of an outline.
pub(super) struct Corner {
    pub(super) at: Vec2<f64>,
    /// Unit vectors along the outline, before the corner and after it.
    pub(super) sides: [Vec2<f64>; 2],
}

/// The corners of outlines.
#[derive(Default)]
struct Corners {
    inward: Vec<Vec2<f64>>,
    outward: Vec<Corner>,
    sides: Vec<LineSegment<f64>>,
}

impl Corners {
    fn of(outlines: &[Outline]) -> Self {
        let mut corners = Self::default();
        for outline in outlines {
            let OutlineShape::Path(ring) = &outline.shape else { continue };
            let pieces = pieces(ring);
            corners.sides.extend(pieces.iter().filter_map(|piece| match *piece {
                Piece::Line { from, to } => Some(LineSegment::new(from, to)),
                _ => None,
            }));
            let before = pieces.iter().cycle().skip(pieces.len().saturating_sub(1));
            for (before, after) in before.zip(&pieces) {
                let (at, sides) = (after.from(), [direction(before, 1.0), direction(after, 0.0)]);
                let turn = sides[0].cross(sides[1]);
                if turn < -LEAST_TURN {
                    corners.inward.push(at);
                } else if turn > LEAST_TURN {
                    corners.outward.push(Corner { at, sides });
                }
            }
        }
        corners
    }
}
