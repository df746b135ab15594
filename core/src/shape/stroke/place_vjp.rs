//! The way back of [`Source::place`].

use super::leg::{At, Leg};
use super::place::{Source, Turn, arc_sweep, bulge, center_factor, factor, share};
use super::walk::Side;
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{CubicVertex, CutArc, End, Piece, PieceGrad, conjugate, stand_out, stand_out_slope};
use crate::shape::resolve::line_crossing_vjp;

impl<T: Real> Source<T> {
    /// Adds the gradient of `grad` x vertex to those of the legs' pieces and of the vertices before; returns that with respect to
    /// half the width.
    pub(super) fn place_vjp(
        &self,
        legs: &[Leg<T>],
        half: T,
        places: &[Vec2<T>],
        grad: Vec2<T>,
        earlier: &mut [Vec2<T>],
        grad_legs: &mut [PieceGrad<T>],
    ) -> T {
        match *self {
            Self::Offset { at, across, along } => offset_vjp(legs, at, [across, along], half, grad, grad_legs),
            Self::Round { from, side, turn, step, count } => {
                round_vjp(legs, (from, side, turn), (step, count), half, grad, grad_legs)
            }
            Self::Tip { before, after, side } => tip_vjp(legs, [before, after], side, half, grad, grad_legs),
            Self::BesideArc { leg, side, step, count } => {
                beside_arc_vjp(legs, (leg, side), (step, count), half, grad, grad_legs)
            }
            Self::Center { leg } => {
                let (piece, bulge) = (legs[leg].piece, bulge(&legs[leg]));
                let grad_chord = grad.turned(conjugate(center_factor(bulge)));
                let grad_piece = &mut grad_legs[leg];
                grad_piece.points[0] += grad - grad_chord;
                grad_piece.points[1] += grad_chord;
                let slope = -(T::one() + (bulge * bulge).recip()) * T::of(0.25);
                grad_piece.bulge += grad.dot((piece.to() - piece.from()).perp()) * slope;
                T::zero()
            }
            Self::BesideCubic { leg, vertex } => match legs[leg].piece {
                Piece::Cubic(points) => {
                    let at = CubicVertex { distance: vertex.distance * half, ..vertex };
                    at.place_vjp(&points, grad, &mut grad_legs[leg].points) * vertex.distance
                }
                _ => T::zero(),
            },
            Self::Crossing(edges) => {
                let grads = line_crossing_vjp(edges.map(|edge| edge.map(|vertex| places[vertex])), grad);
                for (&vertex, grad) in edges.as_flattened().iter().zip(grads) {
                    earlier[vertex] += grad;
                }
                T::zero()
            }
        }
    }
}

/// Adds the gradients of the point and the direction at a place.
fn frame_vjp<T: Real>(legs: &[Leg<T>], at: At<T>, point: Vec2<T>, direction: Vec2<T>, grad_legs: &mut [PieceGrad<T>]) {
    let (leg, grad_piece) = (&legs[at.leg()], &mut grad_legs[at.leg()]);
    match (at, leg.piece) {
        (At::Inside(_, t), Piece::Cubic(points)) => {
            // A vertex on the cubic itself has its place, one at a distance of 1 its normal too.
            let on = |distance| CubicVertex { t, distance, push: T::zero() };
            on(T::zero()).place_vjp(&points, point, &mut grad_piece.points);
            // direction = -perp(normal), and normal = (vertex at distance 1) - (vertex at distance 0).
            on(T::one()).place_vjp(&points, direction.perp(), &mut grad_piece.points);
            on(T::zero()).place_vjp(&points, -direction.perp(), &mut grad_piece.points);
        }
        (At::Inside(..), _) => {}
        (At::End(_, end), piece) => {
            let last = if matches!(piece, Piece::Cubic(_)) { 3 } else { 1 };
            grad_piece.points[if end == End::Start { 0 } else { last }] += point;
            piece.direction_vjp(end, direction, grad_piece);
        }
    }
}

fn offset_vjp<T: Real>(
    legs: &[Leg<T>],
    at: At<T>,
    amounts: [Side; 2],
    half: T,
    grad: Vec2<T>,
    grad_legs: &mut [PieceGrad<T>],
) -> T {
    let frame = legs[at.leg()].frame(at);
    let [across, along] = amounts.map(factor::<T>);
    frame_vjp(legs, at, grad, (grad * along - grad.perp() * across) * half, grad_legs);
    grad.dot(frame.normal() * across + frame.direction * along)
}

fn round_vjp<T: Real>(
    legs: &[Leg<T>],
    (from, side, turn): (At<T>, Side, Turn<T>),
    (step, count): (usize, usize),
    half: T,
    grad: Vec2<T>,
    grad_legs: &mut [PieceGrad<T>],
) -> T {
    let frame = legs[from.leg()].frame(from);
    let angle = turn.angle(legs, frame.direction);
    let (share, side) = (share::<T>(step, count), factor::<T>(side));
    let rotation = Vec2::from_angle(angle * share);
    let spoke = frame.normal().turned(rotation);
    let out = T::one() + stand_out(angle, count);
    let grad_radius = grad.dot(spoke) * side;
    let grad_normal = grad.turned(conjugate(rotation)) * (half * out * side);
    let mut grad_direction = -grad_normal.perp();
    if let Turn::To(to) = turn {
        let grad_angle =
            half * (grad_radius * stand_out_slope(angle, count) + grad.dot(spoke.perp()) * out * side * share);
        // angle = atan2(from x to, from . to), of two vectors of length 1.
        let (before, after) = (frame.direction, legs[to.leg()].frame(to).direction);
        let (cross, dot) = (before.cross(after), before.dot(after));
        frame_vjp(legs, to, Vec2::default(), (before.perp() * dot - before * cross) * grad_angle, grad_legs);
        grad_direction += (-after.perp() * dot - after * cross) * grad_angle;
    }
    frame_vjp(legs, from, grad, grad_direction, grad_legs);
    grad_radius * out
}

fn tip_vjp<T: Real>(
    legs: &[Leg<T>],
    places: [At<T>; 2],
    side: Side,
    half: T,
    grad: Vec2<T>,
    grad_legs: &mut [PieceGrad<T>],
) -> T {
    let [before, after] = places.map(|at| legs[at.leg()].frame(at));
    let divisor = T::one() + before.direction.dot(after.direction);
    let reach = factor::<T>(side) / divisor;
    let grad_reach = grad.dot(before.normal() + after.normal());
    let grad_divisor = -grad_reach * half * reach / divisor;
    let grad_normal = -grad.perp() * (half * reach);
    frame_vjp(legs, places[0], grad, grad_normal + after.direction * grad_divisor, grad_legs);
    frame_vjp(legs, places[1], Vec2::default(), grad_normal + before.direction * grad_divisor, grad_legs);
    grad_reach * reach
}

fn beside_arc_vjp<T: Real>(
    legs: &[Leg<T>],
    (leg, side): (usize, Side),
    (step, count): (usize, usize),
    half: T,
    grad: Vec2<T>,
    grad_legs: &mut [PieceGrad<T>],
) -> T {
    let arc = CutArc::new(arc_sweep(&legs[leg]), count);
    let side = factor::<T>(side);
    let ends = [End::Start, End::Finish].map(|end| At::End(leg, end));
    let frames = ends.map(|at| legs[leg].frame(at));
    let chord = frames[1].point - frames[0].point + (frames[1].normal() - frames[0].normal()) * (half * side);
    let bulge = bulge(&legs[leg]);
    let slope = arc.factor_slope(step, &arc.slopes());
    grad_legs[leg].bulge += grad.dot(chord.turned(slope)) * T::of(4.0) / (T::one() + bulge * bulge);
    let grad_chord = grad.turned(conjugate(arc.factor(step)));
    let mut grad_half = T::zero();
    for ((at, frame), grad) in ends.into_iter().zip(frames).zip([grad - grad_chord, grad_chord]) {
        frame_vjp(legs, at, grad, -grad.perp() * (half * side), grad_legs);
        grad_half += grad.dot(frame.normal()) * side;
    }
    grad_half
}
