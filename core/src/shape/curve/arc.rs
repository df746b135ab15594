//! Circular arcs between fixed ends, as polygons of the same area.
//!
//! The formulas know the chord and the sweep, not the center, so that they hold down to a straight line. Points are chord
//! vectors times complex factors: with sweep w and share s, the point of the arc is
//! from + chord x sin(s w / 2) / sin(w / 2) x e^(-i (1 - s) w / 2), since the chord of a part of the arc is
//! 2 radius sin(half its sweep) long and points half its sweep away from the tangent at the start.

use core::f64::consts::FRAC_PI_4;

use super::MOST_EDGES;
use crate::geometry::Vec2;
use crate::real::Real;

/// The squared angle per edge x radius / tolerance: vertices stand outside by a twelfth of the squared angle, and 11
/// leaves room for the terms of higher order.
const EDGE: f64 = 11.0;

/// Most angle of an edge, whatever the tolerance: formulas and pictures stay sane.
const WIDEST_EDGE: f64 = FRAC_PI_4;

/// The edges of a whole circle of `radius`: a multiple of 4, so that it keeps its center and axes.
pub(super) fn circle_edges<T: Real>(radius: T, tolerance: T) -> usize {
    let count = T::of(core::f64::consts::TAU) * (radius / (T::of(EDGE) * tolerance)).sqrt();
    count.to_count().saturating_add(1).clamp(8, MOST_EDGES).next_multiple_of(4)
}

/// How far outside of a whole circle of radius 1 its vertices stand, plus 1: sqrt(angle / sin angle), `angle` that
/// of an edge.
pub(super) fn circle_radius<T: Real>(angle: T) -> T {
    (T::one() + angle * angle * excess(angle)).sqrt()
}

/// The edges of an arc of `chord` length, at least 2: one vertex at least is needed to keep the area, and to feel the
/// bulge of a straight line.
pub(crate) fn edges<T: Real>(chord: T, bulge: T, tolerance: T) -> usize {
    let sweep = sweep(bulge);
    // radius x sweep, without the radius, which is infinite at bulge 0: the radius is chord / (2 sin(sweep / 2)).
    let length = chord / sinc(sweep * T::of(0.5));
    edges_of_length(length.abs(), sweep.abs(), tolerance).max(2)
}

/// The edges of an arc of `length` that turns by `sweep`, at least 1.
pub(crate) fn edges_of_length<T: Real>(length: T, sweep: T, tolerance: T) -> usize {
    let bent = length * sweep;
    // n (n - 1) times the tolerance is at least bent / 11: next to a fixed end vertices stand further out.
    let half = T::of(0.5);
    let count = half + (half * half + bent / (T::of(EDGE) * tolerance)).sqrt();
    let widest = sweep / T::of(WIDEST_EDGE);
    count.max(widest).to_count().saturating_add(1).clamp(1, MOST_EDGES)
}

/// The angle of an arc, radians.
pub(crate) fn sweep<T: Real>(bulge: T) -> T {
    T::of(4.0) * bulge.atan()
}

/// An arc cut into edges of equal angle.
pub(crate) struct CutArc<T> {
    pub(super) sweep: T,
    pub(super) edges: T,
    /// sinc(sweep / 2).
    pub(super) sinc: T,
    /// How far outside vertices stand, per radius and 2 sin(sweep / 2): in units of the chord.
    pub(super) push: T,
}

impl<T: Real> CutArc<T> {
    pub(crate) fn new(sweep: T, edges: usize) -> Self {
        let n = T::of_usize(edges);
        let sinc = sinc(sweep * T::of(0.5));
        let angle = sweep / n;
        let excess = excess(angle);
        let push = excess * sweep / (n * spread(n, angle * angle * excess) * sinc);
        Self { sweep, edges: n, sinc, push }
    }

    /// What the chord is multiplied by to come from the start of the arc to vertex `k`, 0 < k < edges.
    pub(crate) fn factor(&self, k: usize) -> Vec2<T> {
        let share = T::of_usize(k) / self.edges;
        let half = self.sweep * T::of(0.5);
        let ratio = share * sinc(share * half) / self.sinc;
        let on_arc = Vec2::from_angle((share - T::one()) * half) * ratio;
        on_arc + outward(self.sweep * (share - T::of(0.5))) * self.push
    }
}

/// The direction away from the center where the tangent has turned by `angle` from the chord, the chord along +x:
/// -i e^(i angle).
pub(super) fn outward<T: Real>(angle: T) -> Vec2<T> {
    let (sin, cos) = angle.sin_cos();
    Vec2::new(sin, -cos)
}

/// The denominator of the share e of the radius by which the inner vertices stand outside.
///
/// The n - 2 inner triangles to the center have the area q^2 sin(angle) / 2, q = 1 + e, the two at the ends q sin(angle) / 2, and
/// together the sector's, n angle / 2. With g = angle / sin(angle) - 1 that is (n - 2) e^2 + 2 (n - 1) e = n g,
/// and e = n g / (n - 1 + sqrt((n - 1)^2 + n (n - 2) g)): no digits are lost at small angles.
pub(super) fn spread<T: Real>(n: T, g: T) -> T {
    n - T::one() + root(n, g)
}

/// The share of the radius by which the inner vertices of an arc of `edges` stand outside. *Derivative*:
/// [`stand_out_slope`](super::arc_vjp::stand_out_slope).
pub(crate) fn stand_out<T: Real>(sweep: T, edges: usize) -> T {
    let n = T::of_usize(edges);
    let angle = sweep / n;
    let g = angle * angle * excess(angle);
    n * g / spread(n, g)
}

/// sqrt((n - 1)^2 + n (n - 2) g).
pub(super) fn root<T: Real>(n: T, g: T) -> T {
    let one = T::one();
    ((n - one) * (n - one) + n * (n - one - one) * g).sqrt()
}

/// Below this argument functions that lose digits near 0 are taken from their series.
const SMALL: f64 = 0.25;

/// (angle / sin(angle) - 1) / angle^2.
pub(super) fn excess<T: Real>(angle: T) -> T {
    let square = angle * angle;
    if angle.abs() < T::of(SMALL) {
        polynomial(&EXCESS, square)
    } else {
        let sin = angle.sin();
        (angle - sin) / (sin * square)
    }
}

/// The derivative of [`excess`].
pub(super) fn excess_slope<T: Real>(angle: T) -> T {
    let square = angle * angle;
    if angle.abs() < T::of(SMALL) {
        let slopes: [f64; 5] = core::array::from_fn(|k| 2.0 * f64::of_usize(k + 1) * EXCESS[k + 1]);
        angle * polynomial(&slopes, square)
    } else {
        let (sin, cos) = angle.sin_cos();
        ((sin - angle * cos) / (sin * sin) - T::of(2.0) * angle * excess(angle)) / square
    }
}

/// Coefficients of (x / sin x - 1) / x^2 in x^2.
const EXCESS: [f64; 6] =
    [1.0 / 6.0, 7.0 / 360.0, 31.0 / 15_120.0, 127.0 / 604_800.0, 73.0 / 3_421_440.0, 1_414_477.0 / 653_837_184_000.0];

/// sin(x) / x.
pub(crate) fn sinc<T: Real>(x: T) -> T {
    if x.abs() < T::of(SMALL) {
        polynomial(&[1.0, -1.0 / 6.0, 1.0 / 120.0, -1.0 / 5_040.0, 1.0 / 362_880.0, -1.0 / 39_916_800.0], x * x)
    } else {
        x.sin() / x
    }
}

/// The derivative of [`sinc`]: (cos(x) - sinc(x)) / x.
pub(super) fn sinc_slope<T: Real>(x: T) -> T {
    if x.abs() < T::of(SMALL) {
        let slopes = [-1.0 / 3.0, 1.0 / 30.0, -1.0 / 840.0, 1.0 / 45_360.0, -1.0 / 3_991_680.0];
        x * polynomial(&slopes, x * x)
    } else {
        (x.cos() - x.sin() / x) / x
    }
}

/// The sum of coefficient k x `variable`^k.
fn polynomial<T: Real>(coefficients: &[f64], variable: T) -> T {
    coefficients.iter().rev().fold(T::zero(), |sum, &coefficient| sum * variable + T::of(coefficient))
}
