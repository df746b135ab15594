//! Whole outlines of few numbers: how far points are from them.

use core::f64::consts::PI;

use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Most numbers of a figure.
pub(super) const MOST_NUMBERS: usize = 6;

/// A kind of whole outline; its numbers are kept apart, in the order given here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Figure {
    /// Center, radius.
    Circle,
    /// Center, two radii, angle.
    Ellipse,
    /// Center, width, height, corner radius, angle.
    Rectangle,
    /// Center, radius, angle.
    Polygon { sides: usize },
    /// Center, radius of the points, radius of the corners between, angle.
    Star { points: usize },
}

impl Figure {
    /// Signed distance of a point, positive outside, to first order, and the direction in which it rises.
    pub(super) fn distance(self, numbers: &[f64; MOST_NUMBERS], point: Vec2<f64>) -> (f64, Vec2<f64>) {
        let [x, y, a, b, c, d] = *numbers;
        let offset = point - Vec2::new(x, y);
        match self {
            Self::Circle => {
                let length = offset.length_squared().sqrt();
                (length - a, offset / length)
            }
            Self::Ellipse => {
                let turn = Vec2::from_angle(c);
                let q = offset.turned(conjugate(turn));
                let height = Vec2::new(q.x / a, q.y / b).length_squared().sqrt();
                let slope = Vec2::new(q.x / (a * a), q.y / (b * b)) / height;
                let steepness = slope.length_squared().sqrt();
                ((height - 1.0) / steepness, (slope / steepness).turned(turn))
            }
            Self::Rectangle => {
                let turn = Vec2::from_angle(d);
                let q = offset.turned(conjugate(turn));
                let beyond = Vec2::new(q.x.abs() - (0.5 * a - c), q.y.abs() - (0.5 * b - c));
                let (distance, normal) = if beyond.x > 0.0 && beyond.y > 0.0 {
                    let length = beyond.length_squared().sqrt();
                    (length - c, beyond / length)
                } else if beyond.x > beyond.y {
                    (beyond.x - c, Vec2::new(1.0, 0.0))
                } else {
                    (beyond.y - c, Vec2::new(0.0, 1.0))
                };
                (distance, Vec2::new(normal.x * q.x.signum(), normal.y * q.y.signum()).turned(turn))
            }
            Self::Polygon { sides } => spokes(sides, [a, a * (PI / as_f64(sides)).cos()], b, offset),
            Self::Star { points } => spokes(points, [a, b], c, offset),
        }
    }

    /// How many numbers it has.
    pub(super) fn number_count(self) -> usize {
        match self {
            Self::Circle => 3,
            Self::Polygon { .. } => 4,
            Self::Ellipse | Self::Star { .. } => 5,
            Self::Rectangle => 6,
        }
    }

    /// Which number is the angle, if one is.
    pub(super) fn angle(self) -> Option<usize> {
        match self {
            Self::Circle => None,
            _ => Some(self.number_count() - 1),
        }
    }

    /// Its sharp corners.
    pub(super) fn corners(self, numbers: &[f64; MOST_NUMBERS]) -> Vec<Vec2<f64>> {
        let [x, y, a, b, c, d] = *numbers;
        let center = Vec2::new(x, y);
        match self {
            Self::Rectangle if c < 0.5 => {
                let turn = Vec2::from_angle(d);
                let signs = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
                signs.map(|[u, v]| center + Vec2::new(0.5 * a * u, 0.5 * b * v).turned(turn)).into()
            }
            Self::Polygon { sides } => {
                (0..sides).map(|k| center + Vec2::from_angle(b + 2.0 * PI * as_f64(k) / as_f64(sides)) * a).collect()
            }
            Self::Star { points } => (0..2 * points)
                .map(|k| {
                    center + Vec2::from_angle(c + PI * as_f64(k) / as_f64(points)) * if k % 2 == 0 { a } else { b }
                })
                .collect(),
            Self::Circle | Self::Ellipse | Self::Rectangle => Vec::new(),
        }
    }
}

/// Distance from a star: folded on half of one of its points it is one straight line.
fn spokes(points: usize, radii: [f64; 2], angle: f64, offset: Vec2<f64>) -> (f64, Vec2<f64>) {
    let sector = 2.0 * PI / as_f64(points);
    let bearing = offset.angle() - angle;
    let spoke = (bearing / sector).round() * sector;
    let side = (bearing - spoke).signum();
    let local = offset.turned(Vec2::from_angle(-spoke - angle));
    let folded = Vec2::new(local.x, local.y * side);
    let tip = Vec2::new(radii[0], 0.0);
    let edge = Vec2::from_angle(0.5 * sector) * radii[1] - tip;
    let normal = -edge.perp() / edge.length();
    ((folded - tip).dot(normal), Vec2::new(normal.x, normal.y * side).turned(Vec2::from_angle(spoke + angle)))
}

/// The turn back.
fn conjugate(turn: Vec2<f64>) -> Vec2<f64> {
    Vec2::new(turn.x, -turn.y)
}

#[expect(clippy::cast_precision_loss, reason = "numbers of corners are small")]
pub(super) fn as_f64(count: usize) -> f64 {
    count as f64
}
