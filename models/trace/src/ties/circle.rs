//! Circles of arcs.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Piece, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::figure::circle_of_arc;
use super::numbers::{Kind, SIGMA, arc_sigma};
use super::places::{LIMIT, Places};

/// A circle at places of the drawing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub(super) center: Vec2<f64>,
    pub(super) radius: f64,
    pub(super) bits: f64,
}

/// Puts a ring of arcs of one circle at places of the drawing; false if a ring is none.
pub(super) fn tie(ring: &mut PathRing<f64>, pieces: &[Piece<f64>], places: &Places<'_>) -> bool {
    let circles: Option<Vec<_>> = pieces.iter().map(circle_of_arc).collect();
    let Some(circles) = circles.filter(|_| ring.is_closed()) else { return false };
    let (center, radius) = circles[0];
    if circles.iter().any(|circle| (circle.0 - center).length() + (circle.1 - radius).abs() > SIGMA) {
        return false;
    }
    let moved = Vec2::new(places.cheapest(Kind::X, center.x, LIMIT), places.cheapest(Kind::Y, center.y, LIMIT));
    let scale = places.cheapest(Kind::Length, radius, LIMIT) / radius;
    // Where on the circle its arcs meet is free: above, below or beside the center.
    let quarter = core::f64::consts::FRAC_PI_2;
    let angles = || ring.points.iter().map(|&point| (Vec2::from(point) - center).angle());
    let first = angles().next().unwrap_or_default();
    let turn = (first / quarter).round() * quarter - first;
    let turns: Vec<f64> = angles()
        .map(|angle| {
            let upright = ((angle + turn) / quarter).round() * quarter;
            if (upright - angle - turn).abs() * radius < LIMIT { upright - angle } else { turn }
        })
        .collect();
    let placed: Vec<f64> = angles().zip(&turns).map(|(angle, turn)| angle + turn).collect();
    for (k, segment) in ring.segments.iter_mut().enumerate() {
        if let Segment::Arc { bulge } = segment {
            let sweep = (placed[(k + 1) % placed.len()] - placed[k]) * bulge.signum();
            let turns = (sweep / core::f64::consts::TAU).floor();
            *bulge = (0.25 * (sweep - turns * core::f64::consts::TAU)).tan() * bulge.signum();
        }
    }
    for (point, angle) in ring.points.iter_mut().zip(placed) {
        *point = (moved + Vec2::from_angle(angle) * (radius * scale)).to_array();
    }
    true
}

/// The circle of an arc at places of the drawing, if the arc is long enough to tell where they are.
pub(super) fn of_arc(piece: &Piece<f64>, places: &Places<'_>) -> Option<Circle> {
    let Piece::Arc { bulge, .. } = *piece else { return None };
    let (center, radius) = circle_of_arc(piece)?;
    let reach = 2.0 * arc_sigma(bulge);
    let [xs, ys, radii] = [(Kind::X, center.x), (Kind::Y, center.y), (Kind::Length, radius)]
        .map(|(kind, value)| places.near(kind, value, reach));
    let mut best: Option<Circle> = None;
    for (x, y, length) in
        xs.iter().skip(1).flat_map(|x| ys.iter().skip(1).flat_map(|y| radii.iter().skip(1).map(|r| (*x, *y, *r))))
    {
        let circle =
            Circle { center: Vec2::new(x.value, y.value), radius: length.value, bits: x.bits + y.bits + length.bits };
        let misses =
            [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| ((piece.point(t) - circle.center).length() - circle.radius).abs());
        if misses.iter().all(|&miss| miss <= LIMIT) && best.is_none_or(|best| circle.bits < best.bits) {
            best = Some(circle);
        }
    }
    best
}
