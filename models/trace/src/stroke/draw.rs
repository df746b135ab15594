//! What a pen of some width covers along lines: how far a point of the boundary is outside of it.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{Cap, PathRing, Piece};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::piece::{direction, nearest, pieces};

/// A center line and how it ends.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) ring: PathRing<f64>,
    /// Round or butt.
    pub(super) cap: Cap,
    /// Whether its start and its end are hidden by other lines: nothing is measured to them then.
    pub(super) is_covered: [bool; 2],
    pub(super) pieces: Vec<Piece<f64>>,
    /// A disk around each piece.
    disks: Vec<(Vec2<f64>, f64)>,
}

/// Lines that one pen draws.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) lines: Vec<Line>,
    pub(super) half_width: f64,
    /// Whether the outer sides of corners go on until they meet; else corners are round.
    pub(super) is_mitered: bool,
}

/// Which part of the outline of a line is near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Foot {
    /// The place on a piece to which it is parallel.
    Body { piece: usize, t: f64 },
    /// The tangent at an end of a piece, beyond that end.
    Tangent { piece: usize, t: f64 },
    /// The straight end.
    Face { at_finish: bool },
}

/// Least turn at which a corner is one, sine.
const LEAST_CORNER: f64 = 0.02;

/// Longest tip of a corner per width that SVG draws unless said otherwise.
pub(super) const MITER_LIMIT: f64 = 4.0;

impl Line {
    /// None if the numbers make no line.
    pub(super) fn new(ring: PathRing<f64>, cap: Cap) -> Option<Self> {
        let pieces = pieces(&ring);
        let disks = pieces.iter().map(disk).collect();
        (!pieces.is_empty() && pieces.len() == ring.segments.len()).then_some(Self { ring, cap, is_covered: [false; 2], pieces, disks })
    }

    /// The same line with another center line of as many pieces.
    pub(super) fn with_ring(&self, ring: PathRing<f64>) -> Option<Self> {
        Some(Self { is_covered: self.is_covered, ..Self::new(ring, self.cap)? })
    }

    /// How far a point is outside of the line's strip, and which part of the outline that is measured to; none if that is
    /// more than `limit`.
    fn gap(&self, point: Vec2<f64>, half: f64, is_mitered: bool, limit: f64) -> Option<(f64, Foot)> {
        let mut least = limit + half;
        let mut body = None;
        for (piece, (shape, &(center, radius))) in self.pieces.iter().zip(&self.disks).enumerate() {
            if (point - center).length() - radius >= least {
                continue;
            }
            let t = nearest(shape, point);
            let is_covered = !self.ring.is_closed()
                && (t <= 0.0 && piece == 0 && self.is_covered[0]
                    || t >= 1.0 && piece + 1 == self.pieces.len() && self.is_covered[1]);
            if is_covered {
                continue;
            }
            let distance = (point - shape.point(t)).length();
            if distance < least {
                (least, body) = (distance, Some((piece, t)));
            }
        }
        let (piece, t) = body?;
        let mut feet = [Some(Foot::Body { piece, t }), None];
        let is_end = t <= 0.0 || t >= 1.0;
        let (count, at_finish) = (self.pieces.len(), t > 0.5);
        let neighbor = if at_finish { piece + 1 } else { piece.wrapping_sub(1) };
        let neighbor = if self.ring.is_closed() { (neighbor.wrapping_add(count)) % count } else { neighbor };
        if neighbor >= count {
            // Beside a straight end the nearest point is not always the end itself.
            if self.cap == Cap::Butt && !self.is_covered[usize::from(at_finish)] {
                feet[1] = Some(Foot::Face { at_finish });
                if is_end {
                    feet[0] = Some(Foot::Tangent { piece, t });
                }
            }
        } else if is_end && is_mitered {
            let other = 1.0 - t;
            let [own, next] = [(piece, t), (neighbor, other)].map(|(piece, t)| direction(&self.pieces[piece], t));
            let half_turn = (0.5 * (1.0 + own.dot(next))).max(0.0).sqrt();
            if own.cross(next).abs() > LEAST_CORNER && half_turn * MITER_LIMIT > 1.0 {
                feet = [Some(Foot::Tangent { piece, t }), Some(Foot::Tangent { piece: neighbor, t: other })];
            }
        }
        let gaps = feet.into_iter().flatten().map(|foot| (gap(&self.pieces, foot, point, half), foot));
        gaps.max_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// How far a point is beyond one part of an outline.
pub(super) fn gap(pieces: &[Piece<f64>], foot: Foot, point: Vec2<f64>, half: f64) -> f64 {
    match foot {
        Foot::Body { piece, t } => pieces.get(piece).map_or(0.0, |piece| (point - piece.point(t)).length() - half),
        Foot::Tangent { piece, t } => pieces
            .get(piece)
            .map_or(0.0, |piece| (point - piece.point(t)).cross(direction(piece, t)).abs() - half),
        Foot::Face { at_finish } => {
            let (piece, t, sign) = if at_finish { (pieces.last(), 1.0, 1.0) } else { (pieces.first(), 0.0, -1.0) };
            piece.map_or(0.0, |piece| (point - piece.point(t)).dot(direction(piece, t)) * sign)
        }
    }
}

impl Drawing {
    /// How far a point is outside of everything that is drawn, the line that is nearest and the part of its outline.
    pub(super) fn gap(&self, point: Vec2<f64>) -> Option<(f64, usize, Foot)> {
        let mut least: Option<(f64, usize, Foot)> = None;
        for (i, line) in self.lines.iter().enumerate() {
            let limit = least.map_or(f64::INFINITY, |least| least.0);
            if let Some((gap, foot)) = line.gap(point, self.half_width, self.is_mitered, limit) {
                if gap < limit {
                    least = Some((gap, i, foot));
                }
            }
        }
        least
    }

    /// The distance from a point to the nearest center line; `skipped` is a line and a piece of it that do not count.
    pub(super) fn distance(&self, point: Vec2<f64>, skipped: (usize, usize)) -> f64 {
        let all = self.lines.iter().enumerate().flat_map(|(i, line)| line.pieces.iter().enumerate().map(move |(k, piece)| ((i, k), piece)));
        let others = all.filter(|&(place, _)| place != skipped);
        others.map(|(_, piece)| (point - piece.point(nearest(piece, point))).length()).fold(f64::INFINITY, f64::min)
    }
}

/// A disk that holds a piece.
fn disk(piece: &Piece<f64>) -> (Vec2<f64>, f64) {
    const PLACES: u8 = 8;
    let center = piece.point(0.5);
    let reach = (0..=PLACES).map(|k| (piece.point(f64::from(k) / f64::from(PLACES)) - center).length());
    (center, reach.fold(0.0, f64::max) * 1.1)
}
