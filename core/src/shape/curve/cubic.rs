//! Cubics: where they are cut into edges, and the vertices of their polygons and of those of their parallels.

use alloc::vec::Vec;

use super::MOST_EDGES;
use crate::geometry::{LineSegment, Vec2};
use crate::real::Real;

/// Halvings until a cubic has [`MOST_EDGES`] edges.
const DEEPEST: u32 = MOST_EDGES.ilog2();

/// Most that the direction turns along an edge of a parallel, radians, whatever the tolerance.
const WIDEST_TURN: f64 = 1.0;

/// Appends the parameters at which a cubic is cut, rising, 0 and 1 left out and at least one: middles of halves, quarters
/// and so on, so that they do not move with the control points.
///
/// The polygon strays at most `tolerance` from the cubic, and those of its parallels at distances up to `distance` from
/// them. A part strays that far from its chord, and the vertices stand outside by at most as much; by a third more if there is
/// but one of them.
pub(crate) fn cut<T: Real>(points: [Vec2<T>; 4], tolerance: T, distance: T, parameters: &mut Vec<T>) {
    let is_flat = |part: &[Vec2<T>; 4], depth: u32| {
        let tolerance = if depth == 1 { tolerance * T::of(0.75) } else { tolerance };
        is_flat(part, tolerance, distance)
    };
    halve(points, [T::zero(), T::one()], 1, &is_flat, parameters);
}

fn halve<T: Real>(
    points: [Vec2<T>; 4],
    [start, end]: [T; 2],
    depth: u32,
    is_flat: &dyn Fn(&[Vec2<T>; 4], u32) -> bool,
    parameters: &mut Vec<T>,
) {
    let half = T::of(0.5);
    let middle = (start + end) * half;
    let [p, q, r, s] = points;
    let [pq, qr, rs] = [p.lerp(q, half), q.lerp(r, half), r.lerp(s, half)];
    let [pqr, qrs] = [pq.lerp(qr, half), qr.lerp(rs, half)];
    let center = pqr.lerp(qrs, half);
    let (before, after) = ([p, pq, pqr, center], [center, qrs, rs, s]);
    if depth < DEEPEST && !is_flat(&before, depth) {
        halve(before, [start, middle], depth + 1, is_flat, parameters);
    }
    parameters.push(middle);
    if depth < DEEPEST && !is_flat(&after, depth) {
        halve(after, [middle, end], depth + 1, is_flat, parameters);
    }
}

fn is_flat<T: Real>(points: &[Vec2<T>; 4], tolerance: T, distance: T) -> bool {
    let [from, first, second, to] = *points;
    // With both control points at one distance from the chord, the curve reaches three quarters of it.
    let chord = LineSegment::new(from, to);
    let near = |point| chord.nearest(point).distance() * T::of(0.75) <= tolerance;
    if !(near(first) && near(second)) {
        return false;
    }
    if distance <= T::zero() {
        return true;
    }
    let length = (first - from).length() + (second - first).length() + (to - second).length();
    !is_turn_too_wide(turning(points), length, distance, tolerance)
}

/// Whether an edge that turns by `turn` radians over `length` is too long for the parallels of a curve up to `distance`.
///
/// An arc has the height length x turn / 8.
pub(crate) fn is_turn_too_wide<T: Real>(turn: T, length: T, distance: T, tolerance: T) -> bool {
    turn > T::of(WIDEST_TURN) || turn * (length + distance * turn) > T::of(8.0) * tolerance
}

/// The tangents of the angles at the control points, added up: at least the angle by which the direction turns.
/// Infinite where it turns by a quarter or more at once.
pub(crate) fn turning<T: Real>(points: &[Vec2<T>; 4]) -> T {
    let legs = [points[1] - points[0], points[2] - points[1], points[3] - points[2]];
    let mut turn = T::zero();
    let mut before: Option<Vec2<T>> = None;
    for leg in legs.into_iter().filter(|leg| leg.length_squared() > T::zero()) {
        if let Some(before) = before {
            let dot = before.dot(leg);
            turn += if dot > T::zero() { before.cross(leg).abs() / dot } else { T::infinity() };
        }
        before = Some(leg);
    }
    turn
}

/// What the four points of a cubic are multiplied by to give its point, first and second derivative at `t`.
pub(super) fn weights<T: Real>(t: T) -> [[T; 4]; 3] {
    let (two, three, six) = (T::of(2.0), T::of(3.0), T::of(6.0));
    let s = T::one() - t;
    [
        [s * s * s, three * t * s * s, three * t * t * s, t * t * t],
        [-three * s * s, three * s * (s - two * t), three * t * (two * s - t), three * t * t],
        [six * s, six * (t - two * s), six * (s - two * t), six * t],
    ]
}

/// The sum of the points, each times its weight.
fn mix<T: Real>(points: &[Vec2<T>; 4], weights: [T; 4]) -> Vec2<T> {
    points[0] * weights[0] + points[1] * weights[1] + points[2] * weights[2] + points[3] * weights[3]
}

/// Point, first and second derivative at `t`.
pub(crate) fn derivatives<T: Real>(points: &[Vec2<T>; 4], t: T) -> [Vec2<T>; 3] {
    weights(t).map(|weights| mix(points, weights))
}

/// The share of the second derivative by which a vertex at `t` stands outside, given the steps of the parameter before and after
/// it, and whether a fixed end is next: such an end leaves its part of the area to its neighbor. Of the cubic and of its parallels
/// up to `distance`.
///
/// An edge over a step h lacks the area h^3 |p' x p''| / 12; half of it is each end's, and a vertex that moves out by d
/// adds d |p'| (h + h') / 2. Where edges curve evenly that is two thirds of what they stray. It is 0 next to a cusp, where it
/// is more than three quarters of the tolerance, and where the curve turns both ways or by a quarter along an edge: what is
/// outside at the vertex may be inside of such an edge.
pub(crate) fn push<T: Real>(
    points: &[Vec2<T>; 4],
    t: T,
    [before, after]: [T; 2],
    fixed: [bool; 2],
    [tolerance, distance]: [T; 2],
) -> T {
    let area = |step: T, fixed: bool| step * step * step * if fixed { T::of(2.0) } else { T::one() };
    let push = (area(before, fixed[0]) + area(after, fixed[1])) / (T::of(12.0) * (before + after));
    let [_, first, second] = derivatives(points, t);
    let speed = first.length();
    let turning = (first.cross(second) / (speed * speed)).abs();
    let out = push * (speed + distance * turning) * turning;
    let is_even = || bends_one_way(points, [first, second], -before) && bends_one_way(points, [first, second], after);
    if out <= tolerance * T::of(0.75) && is_even() { push } else { T::zero() }
}

/// Whether a cubic turns to one side only, and by less than a quarter, from the parameter with the given first and second
/// derivative to that parameter plus `step`.
fn bends_one_way<T: Real>(points: &[Vec2<T>; 4], [first, second]: [Vec2<T>; 2], step: T) -> bool {
    let half = T::of(0.5);
    let third = (points[3] - points[0] + (points[1] - points[2]) * T::of(3.0)) * T::of(6.0);
    let onward = first + (second + third * (step * half)) * step;
    // p' x p'' is a parabola: the second and the third of its Bezier coefficients have the sign of the first.
    let bend = first.cross(second);
    let middle = bend + first.cross(third) * (step * half);
    let end = middle + (first.cross(third) + second.cross(third) * step) * (step * half);
    onward.dot(first) > T::zero() && middle * bend >= T::zero() && end * bend >= T::zero()
}

/// The vertices at all parameters of [`cut`].
pub(super) fn vertices<'a, T: Real>(
    points: &'a [Vec2<T>; 4],
    parameters: &'a [T],
    tolerance: T,
) -> impl Iterator<Item = CubicVertex<T>> + 'a {
    let zero = T::zero();
    let last = parameters.len().saturating_sub(1);
    parameters.iter().enumerate().map(move |(i, &t)| {
        let before = if i == 0 { zero } else { parameters[i - 1] };
        let after = if i == last { T::one() } else { parameters[i + 1] };
        let push = push(points, t, [t - before, after - t], [i == 0, i == last], [tolerance, zero]);
        CubicVertex { t, distance: zero, push }
    })
}

/// A vertex of the polygon of a parallel of a cubic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CubicVertex<T> {
    /// The parameter.
    pub(crate) t: T,
    /// Distance of the parallel, toward the normal: the direction of travel turned from +x to +y by a quarter. 0 for the
    /// cubic itself.
    pub(crate) distance: T,
    /// From [`push`].
    pub(crate) push: T,
}

impl<T: Real> CubicVertex<T> {
    /// Where the vertex stands.
    ///
    /// A parallel at distance d has the speed |p'| - d w, w = (p' x p'') / |p'|^2 the speed at which the direction turns, so that
    /// its vertices stand outside by push x (|p'| - d w) w. Where p' is zero there is no normal: the point itself.
    pub(crate) fn place(&self, points: &[Vec2<T>; 4]) -> Vec2<T> {
        let [point, first, second] = derivatives(points, self.t);
        match first.normalized() {
            Some(direction) => point + direction.perp() * self.along_normal(first, second),
            None => point,
        }
    }

    fn along_normal(&self, first: Vec2<T>, second: Vec2<T>) -> T {
        let speed = first.length();
        let turning = first.cross(second) / (speed * speed);
        self.distance - self.push * (speed - self.distance * turning) * turning
    }
}
