//! Pieces of center lines: their nearest points, their ends.

use alloc::vec::Vec;

use dvp_core::geometry::LineSegment;
use dvp_core::shape::{Path, PathRing, Piece, Segment};
use dvp_core::{Shape as _, Vec2};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::outline::MOST_BULGE;

/// The exact pieces of a line, those of open ones without the straight way back; none if its numbers make no sense.
pub(crate) fn pieces(ring: &PathRing<f64>) -> Vec<Piece<f64>> {
    let path = Path { rings: alloc::vec![ring.clone()], ..Path::default() };
    let mut pieces = path.boundary().map(|boundary| boundary.pieces).unwrap_or_default();
    pieces.truncate(ring.segments.len());
    pieces
}

/// Parameter of the point of a piece nearest to `point`.
pub(crate) fn nearest(piece: &Piece<f64>, point: Vec2<f64>) -> f64 {
    match *piece {
        Piece::Line { from, to } => LineSegment::new(from, to).nearest(point).share,
        Piece::Arc { from, to, bulge } if bulge.abs() < FLAT => LineSegment::new(from, to).nearest(point).share,
        Piece::Arc { from, to, bulge } => {
            let chord = to - from;
            let center = from + (chord + chord.perp() * ((1.0 - bulge * bulge) / (2.0 * bulge))) * 0.5;
            let (first, arm) = (from - center, point - center);
            let turn = first.cross(arm).atan2(first.dot(arm)) * bulge.signum();
            let sweep = 4.0 * bulge.atan().abs();
            let turn = if turn < 0.0 { turn + core::f64::consts::TAU } else { turn };
            if turn <= sweep {
                turn / sweep
            } else {
                f64::from(u8::from((point - to).length_squared() < (point - from).length_squared()))
            }
        }
        Piece::Cubic(_) | Piece::Ellipse { .. } => {
            let offset = |t: f64| piece.point(t) - point;
            let starts = (0..=STARTS).map(|k| f64::from(k) / f64::from(STARTS));
            let mut t = starts
                .min_by(|&a, &b| offset(a).length_squared().total_cmp(&offset(b).length_squared()))
                .unwrap_or_default();
            for _ in 0..STEPS {
                let velocity = piece.velocity(t);
                let step = offset(t).dot(velocity) / velocity.length_squared().max(1e-12);
                t = (t - step).clamp(0.0, 1.0);
                if step.abs() < 1e-7 {
                    break;
                }
            }
            t
        }
    }
}

/// Arcs of less bulge are straight for all that can be seen.
const FLAT: f64 = 1e-7;

/// Parts of a cubic, at one of whose ends the search begins, and its steps: the nearest point of a curve that bends less than the
/// point is away is found to a thousandth of a part.
const STARTS: u8 = 12;
const STEPS: usize = 8;

/// The direction in which a piece leaves (at 0) and arrives (at 1).
pub(crate) fn direction(piece: &Piece<f64>, t: f64) -> Vec2<f64> {
    let inside = if t > 0.5 { t - 1e-3 } else { t + 1e-3 };
    piece.velocity(t).normalized().or_else(|| piece.velocity(inside).normalized()).unwrap_or_default()
}

/// Cuts arcs of nearly a whole turn in the middle: where one ends beside its start, only the tiny distance between both would tell its radius.
pub(super) fn halve_turns(ring: &mut PathRing<f64>) {
    for (k, piece) in pieces(ring).iter().enumerate().rev() {
        if let Piece::Arc { bulge, .. } = *piece
            && bulge.abs() > MOST_BULGE
        {
            let half = Segment::Arc { bulge: (0.5 * bulge.atan()).tan() };
            ring.points.insert(k + 1, piece.point(0.5).to_array());
            ring.segments.splice(k..=k, [half, half]);
        }
    }
}

/// Where an open line ends (`at_finish`) or starts, and which way it points there, out of the line.
pub(super) fn tip(ring: &PathRing<f64>, at_finish: bool) -> Option<[Vec2<f64>; 2]> {
    let pieces = pieces(ring);
    if at_finish {
        pieces.last().map(|piece| [piece.to(), direction(piece, 1.0)])
    } else {
        pieces.first().map(|piece| [piece.from(), -direction(piece, 0.0)])
    }
}

/// Moves an end of an open line: arcs keep their direction at the other end, cubics the one at this end.
pub(super) fn move_tip(ring: &mut PathRing<f64>, at_finish: bool, to: Vec2<f64>) {
    let pieces = pieces(ring);
    let ends = if at_finish {
        (ring.points.last_mut(), ring.segments.last_mut())
    } else {
        (ring.points.first_mut(), ring.segments.first_mut())
    };
    let piece = if at_finish { pieces.last() } else { pieces.first() };
    let (Some(point), Some(segment), Some(piece)) = (ends.0, ends.1, piece) else { return };
    let shift = to - Vec2::from(*point);
    *point = to.to_array();
    let moved = |control: [f64; 2]| (Vec2::from(control) + shift).to_array();
    match segment {
        Segment::Line | Segment::SmoothArc => {}
        Segment::Arc { bulge } => {
            // tan(sweep / 4), half the sweep the angle between the tangent and the chord.
            let (fixed, tangent) =
                if at_finish { (piece.from(), direction(piece, 0.0)) } else { (piece.to(), -direction(piece, 1.0)) };
            let chord = to - fixed;
            let angle = tangent.cross(chord).atan2(tangent.dot(chord));
            *bulge = if at_finish { (0.5 * angle).tan() } else { -(0.5 * angle).tan() };
        }
        Segment::Cubic { controls } if at_finish => controls[1] = moved(controls[1]),
        Segment::Cubic { controls } => controls[0] = moved(controls[0]),
        Segment::SmoothCubic { control, .. } if at_finish => *control = moved(*control),
        Segment::SmoothCubic { .. } => {}
    }
}
