//! What of a boundary lies between corners inward.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::LineSegment;
use dvp_core::shape::Piece;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::outline::{Outline, OutlineShape};
use crate::sample::{RingSamples, Sample};
use crate::stroke::piece::{direction, pieces};

/// Sine of the turn of a corner: cells that are a little uneven turn inward by half as much over as many windows.
pub(super) const LEAST_TURN: f64 = 0.3;
/// Windows so near to a corner outward (pixels) hold it: they tell of both sides.
const CORNER: f64 = 1.0;

/// Sine of the turn of a corner outward, and turn (radians) inward along half of a piece, that no outline drawn through round things has: one that is drawn
/// through noise may turn by half as much.
const UNLIKE_TURN: f64 = 0.8;
/// Least length (pixels) of the pieces that say so: what is seen between two things that nearly touch is half as long.
const UNLIKE_LENGTH: f64 = 8.0;
/// Windows so far from a corner (pixels) show that its sides are seen.
const SEEN: f64 = 4.0;

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

    /// Whether outlines with clear edges may be those of round things that overlap. Such turn outward along a thing, and inward where two meet: what is seen
    /// to have a corner outward, or to turn inward along a piece, need not be shared out among round things, which takes long.
    #[inline(never)]
    pub(super) fn may_be_round(&self, outlines: &[Outline]) -> bool {
        let is_seen =
            |at: Vec2<f64>| self.samples.iter().flatten().any(|sample| (sample.point - at).length() < 0.5 * SEEN);
        let turn = |[before, after]: [Vec2<f64>; 2]| before.cross(after).atan2(before.dot(after));
        let is_long = |piece: &Piece<f64>| (piece.to() - piece.from()).length() > UNLIKE_LENGTH;
        let is_hollow = |piece: &Piece<f64>| {
            let [first, middle, last] = [0.0, 0.5, 1.0].map(|t| direction(piece, t));
            let turns = [[first, middle], [middle, last]].map(turn);
            turns[0].min(turns[1]) < -UNLIKE_TURN && is_long(piece) && is_seen(piece.point(0.5))
        };
        let is_corner = |(before, after): (&Piece<f64>, &Piece<f64>)| {
            let (at, sides) = (after.from(), [direction(before, 1.0), direction(after, 0.0)]);
            let are_seen = || is_seen(at - sides[0] * SEEN) && is_seen(at + sides[1] * SEEN);
            sides[0].cross(sides[1]) > UNLIKE_TURN && is_long(before) && is_long(after) && are_seen()
        };
        let is_unlike = |outline: &Outline| {
            let OutlineShape::Path(ring) = &outline.shape else { return false };
            let pieces = pieces(ring);
            let before = pieces.iter().cycle().skip(pieces.len().saturating_sub(1));
            pieces.iter().any(is_hollow) || before.zip(&pieces).any(is_corner)
        };
        !outlines.iter().any(is_unlike)
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
