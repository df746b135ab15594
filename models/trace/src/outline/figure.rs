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

/// A figure of given numbers, ready to be held against many points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    figure: Figure,
    numbers: [f64; MOST_NUMBERS],
    /// The turn from its own axes to the picture's.
    turn: Vec2<f64>,
    spoke: Spoke,
}

/// Half of one point of a star, about its middle axis: one straight line.
#[derive(Clone, Copy, Debug, Default)]
struct Spoke {
    /// Angle from one to the next.
    sector: f64,
    tip: Vec2<f64>,
    /// Away from the star.
    normal: Vec2<f64>,
}

impl Placed {
    /// Signed distance of a point, positive outside, to first order, and the direction in which it rises.
    pub(super) fn distance(&self, point: Vec2<f64>) -> (f64, Vec2<f64>) {
        let [x, y, a, b, c, _] = self.numbers;
        let offset = point - Vec2::new(x, y);
        if self.figure == Figure::Circle {
            let length = offset.length_squared().sqrt();
            return (length - a, offset / length);
        }
        let q = offset.turned(conjugate(self.turn));
        let (distance, normal) = match self.figure {
            Figure::Circle | Figure::Ellipse => {
                let height = Vec2::new(q.x / a, q.y / b).length_squared().sqrt();
                let slope = Vec2::new(q.x / (a * a), q.y / (b * b)) / height;
                let steepness = slope.length_squared().sqrt();
                ((height - 1.0) / steepness, slope / steepness)
            }
            Figure::Rectangle => {
                let beyond = Vec2::new(q.x.abs() - (0.5 * a - c), q.y.abs() - (0.5 * b - c));
                let (distance, normal) = if beyond.x > 0.0 && beyond.y > 0.0 {
                    let length = beyond.length_squared().sqrt();
                    (length - c, beyond / length)
                } else if beyond.x > beyond.y {
                    (beyond.x - c, Vec2::new(1.0, 0.0))
                } else {
                    (beyond.y - c, Vec2::new(0.0, 1.0))
                };
                (distance, Vec2::new(normal.x * q.x.signum(), normal.y * q.y.signum()))
            }
            Figure::Polygon { .. } | Figure::Star { .. } => self.spoke.distance(q),
        };
        (distance, normal.turned(self.turn))
    }
}

impl Spoke {
    fn new(points: usize, radii: [f64; 2]) -> Self {
        let sector = 2.0 * PI / as_f64(points);
        let tip = Vec2::new(radii[0], 0.0);
        let edge = Vec2::from_angle(0.5 * sector) * radii[1] - tip;
        Self { sector, tip, normal: -edge.perp() / edge.length() }
    }

    /// Distance of a point from the star, and the direction in which it rises: the point folded on half of the star's point it is nearest to.
    fn distance(&self, at: Vec2<f64>) -> (f64, Vec2<f64>) {
        let bearing = at.angle();
        let spoke = (bearing / self.sector).round() * self.sector;
        let side = (bearing - spoke).signum();
        let turn = Vec2::from_angle(spoke);
        let local = at.turned(conjugate(turn));
        let folded = Vec2::new(local.x, local.y * side);
        ((folded - self.tip).dot(self.normal), Vec2::new(self.normal.x, self.normal.y * side).turned(turn))
    }
}

impl Figure {
    /// The figure of these numbers.
    pub(super) fn placed(self, numbers: &[f64; MOST_NUMBERS]) -> Placed {
        let turn = self.angle().map_or(Vec2::new(1.0, 0.0), |k| Vec2::from_angle(numbers[k]));
        let [_, _, a, b, ..] = *numbers;
        let spoke = match self {
            Self::Polygon { sides } => Spoke::new(sides, [a, a * (PI / as_f64(sides)).cos()]),
            Self::Star { points } => Spoke::new(points, [a, b]),
            Self::Circle | Self::Ellipse | Self::Rectangle => Spoke::default(),
        };
        Placed { figure: self, numbers: *numbers, turn, spoke }
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

/// The turn back.
fn conjugate(turn: Vec2<f64>) -> Vec2<f64> {
    Vec2::new(turn.x, -turn.y)
}

#[expect(clippy::cast_precision_loss, reason = "numbers of corners are small")]
pub(super) fn as_f64(count: usize) -> f64 {
    count as f64
}
