//! Where the vertices of a stroke's rings are.

use super::leg::{At, Leg};
use super::walk::Side;
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{CubicVertex, CutArc, End, Piece, stand_out, sweep};
use crate::shape::resolve::line_crossing;

/// What a vertex is. *Derivative*: [`Source::place_vjp`].
#[derive(Clone, Copy, Debug)]
pub(super) enum Source<T> {
    /// So many half widths to the side of the normal, and so many ahead.
    Offset { at: At<T>, across: Side, along: Side },
    /// On the circle around `from` on which the side turns.
    Round { from: At<T>, side: Side, turn: Turn<T>, step: usize, count: usize },
    /// Where the lines beside two pieces that meet in a corner meet.
    Tip { before: At<T>, after: At<T>, side: Side },
    /// Beside an arc cut into `count` edges.
    BesideArc { leg: usize, side: Side, step: usize, count: usize },
    /// The center of an arc.
    Center { leg: usize },
    /// Beside a cubic; the distance of the vertex is in half widths.
    BesideCubic { leg: usize, vertex: CubicVertex<T> },
    /// Where the line through two earlier vertices crosses that through two others.
    Crossing([[usize; 2]; 2]),
}

/// How far a side turns.
#[derive(Clone, Copy, Debug)]
pub(super) enum Turn<T> {
    /// Half around, from +x to +y.
    Half,
    /// To the direction at another place, the shorter way.
    To(At<T>),
}

/// The factor of a side.
pub(super) fn factor<T: Real>(side: Side) -> T {
    T::of(f64::from(side))
}

/// What the chord of an arc is multiplied by to come from its start to its center: (1 + i cot(sweep / 2)) / 2, and
/// cot(sweep / 2) = (1 / bulge - bulge) / 2.
pub(super) fn center_factor<T: Real>(bulge: T) -> Vec2<T> {
    Vec2::new(T::of(0.5), T::of(0.25) * (bulge.recip() - bulge))
}

impl<T: Real> Source<T> {
    /// Where the vertex is; `half` the width, `places` those of the earlier vertices.
    pub(super) fn place(&self, legs: &[Leg<T>], half: T, places: &[Vec2<T>]) -> Vec2<T> {
        let frame = |at: At<T>| legs[at.leg()].frame(at);
        match *self {
            Self::Offset { at, across, along } => {
                let frame = frame(at);
                frame.point + (frame.normal() * factor(across) + frame.direction * factor(along)) * half
            }
            Self::Round { from, side, turn, step, count } => {
                let frame = frame(from);
                let angle = turn.angle(legs, frame.direction);
                let radius = half * (T::one() + stand_out(angle, count)) * factor(side);
                frame.point + frame.normal().turned(Vec2::from_angle(angle * share(step, count))) * radius
            }
            Self::Tip { before, after, side } => {
                let (before, after) = (frame(before), frame(after));
                let divisor = T::one() + before.direction.dot(after.direction);
                before.point + (before.normal() + after.normal()) * (half * factor(side) / divisor)
            }
            Self::BesideArc { leg, side, step, count } => {
                let [from, to] = [End::Start, End::Finish].map(|end| {
                    let frame = frame(At::End(leg, end));
                    frame.point + frame.normal() * (half * factor(side))
                });
                from + (to - from).turned(CutArc::new(arc_sweep(&legs[leg]), count).factor(step))
            }
            Self::Center { leg } => {
                let piece = legs[leg].piece;
                piece.from() + (piece.to() - piece.from()).turned(center_factor(bulge(&legs[leg])))
            }
            Self::BesideCubic { leg, vertex } => match legs[leg].piece {
                Piece::Cubic(points) => CubicVertex { distance: vertex.distance * half, ..vertex }.place(&points),
                piece => piece.from(),
            },
            Self::Crossing(edges) => line_crossing(edges.map(|edge| edge.map(|vertex| places[vertex]))),
        }
    }
}

impl<T: Real> Turn<T> {
    /// The angle, radians, from a direction.
    pub(super) fn angle(self, legs: &[Leg<T>], from: Vec2<T>) -> T {
        match self {
            Self::Half => T::of(core::f64::consts::PI),
            Self::To(at) => {
                let to = legs[at.leg()].frame(at).direction;
                from.cross(to).atan2(from.dot(to))
            }
        }
    }
}

pub(super) fn share<T: Real>(step: usize, count: usize) -> T {
    T::of_usize(step) / T::of_usize(count)
}

/// The bulge of a leg that is an arc.
pub(super) fn bulge<T: Real>(leg: &Leg<T>) -> T {
    if let Piece::Arc { bulge, .. } = leg.piece { bulge } else { T::zero() }
}

pub(super) fn arc_sweep<T: Real>(leg: &Leg<T>) -> T {
    sweep(bulge(leg))
}
