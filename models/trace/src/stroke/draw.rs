//! What a pen of some width covers along lines: how far a point of the boundary is outside of it.

use alloc::vec::Vec;

use dvp_core::shape::{Cap, PathRing, Piece};
use dvp_core::{Vec2, sort};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::piece::{direction, nearest, pieces};
use crate::outline::OutlineShape;

/// A center line and how it ends.
#[derive(Clone, Debug)]
pub(super) struct Line {
    pub(super) ring: PathRing<f64>,
    /// Round or butt.
    pub(super) cap: Cap,
    /// Whether its start and its end are hidden by other lines: nothing is measured to them then.
    pub(super) is_covered: [bool; 2],
    pub(super) pieces: Vec<Piece<f64>>,
    /// The whole outline that the ring is, if it is one of few numbers.
    pub(super) figure: Option<OutlineShape>,
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

impl Foot {
    /// Whether another one is on the same straight or smooth stretch of the outline, as far as its number tells.
    pub(super) fn is_beside(self, other: Self) -> bool {
        match (self, other) {
            (Self::Body { piece, t }, Self::Body { piece: other, t: at }) => {
                let part = |t: f64| (t <= 0.0, t >= 1.0);
                piece == other && part(t) == part(at)
            }
            (Self::Tangent { piece, .. }, Self::Tangent { piece: other, .. }) => piece == other,
            (Self::Face { at_finish }, Self::Face { at_finish: other }) => at_finish == other,
            _ => false,
        }
    }
}

/// The outline as a point sees it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    /// How far the point is outside.
    pub(super) gap: f64,
    /// The part of the outline that this is measured to.
    pub(super) foot: Foot,
    /// How far the point is outside of what the outline goes on with at the nearest corner.
    next: f64,
}

/// Half the width of a window and a little, pixels.
const WINDOW: f64 = 0.6;

/// Least turn at which a corner is one, sine.
const LEAST_CORNER: f64 = 0.1;

/// Longest tip of a corner per width that SVG draws unless said otherwise.
pub(super) const MITER_LIMIT: f64 = 4.0;

impl Line {
    /// None if the numbers make no line.
    pub(super) fn new(ring: PathRing<f64>, cap: Cap) -> Option<Self> {
        let pieces = pieces(&ring);
        let disks = pieces.iter().map(disk).collect();
        (!pieces.is_empty() && pieces.len() == ring.segments.len()).then_some(Self {
            ring,
            cap,
            is_covered: [false; 2],
            pieces,
            figure: None,
            disks,
        })
    }

    /// The same line, whose center line is a whole outline.
    pub(super) fn with_figure(self, figure: Option<OutlineShape>) -> Self {
        Self { figure, ..self }
    }

    /// The same line with another center line of as many pieces.
    pub(super) fn with_ring(&self, ring: PathRing<f64>) -> Option<Self> {
        Some(Self { is_covered: self.is_covered, ..Self::new(ring, self.cap)? })
    }

    /// Where the outline of the line's strip is nearest to a point; none if that is more than `limit` away.
    fn reading(&self, point: Vec2<f64>, half: f64, is_mitered: bool, limit: f64) -> Option<Reading> {
        // The middle of every disk is on its piece: none that is further away than that and a window says anything.
        let counts = |piece: usize| {
            let is_end = [piece == 0, piece + 1 == self.pieces.len()];
            self.ring.is_closed() || (0..2).all(|end| !(is_end[end] && self.is_covered[end]))
        };
        let middles = self.disks.iter().map(|&(center, _)| (point - center).length());
        let nearest_middle = middles.enumerate().filter(|&(piece, _)| counts(piece)).map(|(_, distance)| distance);
        let far = nearest_middle.fold(f64::INFINITY, f64::min) + 2.0 * WINDOW;
        let reach = far.min(limit + half);
        let near = self.pieces.iter().zip(&self.disks).enumerate().filter_map(|(piece, (shape, &(center, radius)))| {
            let is_near = (point - center).length() - radius < reach;
            let t = if is_near { nearest(shape, point) } else { return None };
            let is_covered = !self.ring.is_closed()
                && (t <= 0.0 && piece == 0 && self.is_covered[0]
                    || t >= 1.0 && piece + 1 == self.pieces.len() && self.is_covered[1]);
            (!is_covered).then(|| ((point - shape.point(t)).length(), piece, t))
        });
        let mut near: Vec<_> = near.filter(|near| near.0 < limit + half).collect();
        sort::ascending(&mut near, |near| near.0);
        let &(distance, piece, t) = near.first()?;
        let body = Reading { gap: distance - half, foot: Foot::Body { piece, t }, next: f64::INFINITY };
        let other = |foot: Foot, reading: Reading| reading.against(gap(&self.pieces, foot, point, half), foot);
        let (is_end, at_finish) = (t <= 0.0 || t >= 1.0, t > 0.5);
        let Some(neighbor) = self.neighbor(piece, at_finish) else {
            // Beside a straight end the nearest point is not always the end itself.
            return Some(match self.cap {
                Cap::Butt if !self.is_covered[usize::from(at_finish)] => {
                    let side = if is_end { Foot::Tangent { piece, t } } else { body.foot };
                    other(
                        Foot::Face { at_finish },
                        Reading { gap: gap(&self.pieces, side, point, half), foot: side, ..body },
                    )
                }
                _ => body,
            });
        };
        let opposite = if at_finish { 0.0 } else { 1.0 };
        if is_end && is_mitered && self.is_corner([(piece, t), (neighbor, opposite)]) {
            let side = Foot::Tangent { piece, t };
            let side = Reading { gap: gap(&self.pieces, side, point, half), foot: side, ..body };
            return Some(other(Foot::Tangent { piece: neighbor, t: opposite }, side));
        }
        // At the inner side of a corner two pieces are near; at smooth joins and around the outer side it is one and the same place.
        let next = near.iter().skip(1).find(|&&(_, other, at)| {
            let joins = [false, true].into_iter().filter(|&finish| self.neighbor(piece, finish) == Some(other));
            let ends = joins.map(|finish| (f64::from(u8::from(finish)), f64::from(u8::from(!finish))));
            let mut ends = ends
                .filter(|&(own, end)| (at - end).abs() < f64::EPSILON || !self.is_corner([(piece, own), (other, end)]));
            ends.next().is_none()
        });
        Some(Reading { next: next.map_or(f64::INFINITY, |next| next.0 - half), ..body })
    }

    /// The piece before or after another one.
    fn neighbor(&self, piece: usize, at_finish: bool) -> Option<usize> {
        let (count, is_closed) = (self.pieces.len(), self.ring.is_closed());
        match (at_finish, piece) {
            (true, _) if piece + 1 < count => Some(piece + 1),
            (true, _) => is_closed.then_some(0),
            (false, 0) => is_closed.then(|| count - 1),
            (false, _) => Some(piece - 1),
        }
    }

    /// Whether two pieces meet in a corner whose tip is drawn if it is mitered; of each, its number and the end there.
    fn is_corner(&self, ends: [(usize, f64); 2]) -> bool {
        let [own, next] = ends.map(|(piece, t)| direction(&self.pieces[piece], t));
        let half_turn = (0.5 * (1.0 + own.dot(next))).max(0.0).sqrt();
        own.cross(next).abs() > LEAST_CORNER && half_turn * MITER_LIMIT > 1.0
    }
}

impl Reading {
    /// Of two parts that a convex corner lies between the one that the point is further outside of.
    fn against(self, gap: f64, foot: Foot) -> Self {
        if gap > self.gap { Self { gap, foot, next: self.gap } } else { Self { next: gap, ..self } }
    }

    /// Whether a corner of the outline is so near that a window there shows both of its sides.
    pub(super) fn is_spoiled(&self) -> bool {
        (self.next - self.gap).abs() < WINDOW && self.gap.abs() < WINDOW
    }
}

/// How far a point is beyond one part of an outline.
pub(super) fn gap(pieces: &[Piece<f64>], foot: Foot, point: Vec2<f64>, half: f64) -> f64 {
    match foot {
        Foot::Body { piece, t } => pieces.get(piece).map_or(0.0, |piece| (point - piece.point(t)).length() - half),
        Foot::Tangent { piece, t } => {
            pieces.get(piece).map_or(0.0, |piece| (point - piece.point(t)).cross(direction(piece, t)).abs() - half)
        }
        Foot::Face { at_finish } => {
            let (piece, t, sign) = if at_finish { (pieces.last(), 1.0, 1.0) } else { (pieces.first(), 0.0, -1.0) };
            piece.map_or(0.0, |piece| (point - piece.point(t)).dot(direction(piece, t)) * sign)
        }
    }
}

impl Drawing {
    /// The same with all that is drawn of its ends to be measured.
    pub(super) fn uncovered(&self) -> Self {
        let lines = self.lines.iter().map(|line| Line { is_covered: [false; 2], ..line.clone() }).collect();
        Self { lines, ..*self }
    }

    /// Where the outline of everything that is drawn is nearest to a point, and on which line.
    pub(super) fn reading(&self, point: Vec2<f64>) -> Option<(usize, Reading)> {
        let mut least: Option<(usize, Reading)> = None;
        for (i, line) in self.lines.iter().enumerate() {
            let limit = least.map_or(f64::INFINITY, |least| least.1.gap + WINDOW);
            let Some(reading) = line.reading(point, self.half_width, self.is_mitered, limit) else { continue };
            least = Some(match least {
                Some((_, old)) if reading.gap < old.gap => (i, Reading { next: reading.next.min(old.gap), ..reading }),
                Some((line, old)) => (line, Reading { next: old.next.min(reading.gap), ..old }),
                None => (i, reading),
            });
        }
        least
    }

    /// The distance from a point to the nearest center line; `skipped` is a line and a piece of it that do not count.
    pub(super) fn distance(&self, point: Vec2<f64>, skipped: (usize, usize)) -> f64 {
        let all = self
            .lines
            .iter()
            .enumerate()
            .flat_map(|(i, line)| line.pieces.iter().enumerate().map(move |(k, piece)| ((i, k), piece)));
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
