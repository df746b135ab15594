//! Numbers of a drawing that the picture pins down, with the doubt of each.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Piece};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::figure::{Sides, circle_of_arc};
use crate::layers::{Form, Layers};
use crate::outline::OutlineShape;
use crate::stroke::piece::{direction, pieces};
use crate::tuning;

/// What a number says; only numbers of one kind can be equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// How far to the right.
    X,
    /// How far down.
    Y,
    /// A radius or a width.
    Length,
}

/// Coordinates along the two axes.
pub(super) const AXES: [Kind; 2] = [Kind::X, Kind::Y];

/// A number and its standard deviation, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Number {
    pub(super) value: f64,
    pub(super) sigma: f64,
}

/// Standard deviation of the position of an edge, pixels.
pub(super) const SIGMA: f64 = tuning::STROKE_OFFSET;
/// Numbers that are less certain than this many edges say nothing about grids.
const MOST_DOUBT: f64 = 2.5;

/// The numbers of layers by kind.
pub(super) fn of(layers: &Layers) -> [Vec<Number>; 3] {
    let mut numbers = Numbers::default();
    for layer in &layers.layers {
        match &layer.form {
            Form::Stroked(stroke) => {
                numbers.push(Kind::Length, stroke.width, SIGMA);
                stroke.rings.iter().for_each(|ring| numbers.ring(ring));
            }
            Form::Filled(outlines) => outlines.iter().for_each(|outline| numbers.shape(&outline.shape)),
        }
    }
    numbers.0
}

#[derive(Default)]
struct Numbers([Vec<Number>; 3]);

impl Numbers {
    fn push(&mut self, kind: Kind, value: f64, sigma: f64) {
        if value.is_finite() && sigma <= MOST_DOUBT * SIGMA {
            self.0[kind as usize].push(Number { value, sigma });
        }
    }

    fn point(&mut self, point: Vec2<f64>, sigmas: [f64; 2]) {
        self.push(Kind::X, point.x, sigmas[0]);
        self.push(Kind::Y, point.y, sigmas[1]);
    }

    fn shape(&mut self, shape: &OutlineShape) {
        match *shape {
            OutlineShape::Path(ref ring) => self.ring(ring),
            OutlineShape::Circle { center, radius } => {
                self.point(center, [SIGMA; 2]);
                self.push(Kind::Length, radius, SIGMA);
            }
            OutlineShape::Rectangle { center, size, corner_radius, angle } => match Sides::of(center, size, angle) {
                Some(Sides { low, high }) => {
                    self.point(low, [SIGMA; 2]);
                    self.point(high, [SIGMA; 2]);
                    if corner_radius > 0.0 {
                        self.push(Kind::Length, corner_radius, corner_sigma());
                    }
                }
                None => self.point(center, [SIGMA; 2]),
            },
            OutlineShape::Ellipse { center, .. }
            | OutlineShape::RegularPolygon { center, .. }
            | OutlineShape::Star { center, .. } => self.point(center, [SIGMA; 2]),
        }
    }

    fn ring(&mut self, ring: &PathRing<f64>) {
        let pieces = pieces(ring);
        if pieces.len() != ring.segments.len() {
            return;
        }
        for (k, &point) in ring.points.iter().enumerate() {
            self.point(Vec2::from(point), doubt(&pieces, k, ring.is_closed()));
        }
        for piece in &pieces {
            let Piece::Arc { bulge, .. } = *piece else { continue };
            let Some((center, radius)) = circle_of_arc(piece) else { continue };
            let sigma = arc_sigma(bulge);
            self.push(Kind::Length, radius, sigma);
            // The center of less than about half a circle says what its ends say.
            if sigma < 1.2 * SIGMA {
                self.point(center, [sigma; 2]);
            }
        }
    }
}

/// Standard deviation of the radius of corners of 90 degrees.
pub(super) fn corner_sigma() -> f64 {
    arc_sigma((core::f64::consts::PI / 8.0).tan())
}

/// Standard deviation of the radius of an arc: its middle moves by 1 - cos(sweep / 2) of what the radius grows by.
pub(super) fn arc_sigma(bulge: f64) -> f64 {
    SIGMA / (1.0 - (2.0 * bulge.atan()).cos()).max(1e-9)
}

/// Standard deviations of x and y of a point where pieces meet: each piece says where the point is across it, the end of a line
/// where it is along it, too.
fn doubt(pieces: &[Piece<f64>], k: usize, closed: bool) -> [f64; 2] {
    let before = if closed { Some((k + pieces.len() - 1) % pieces.len()) } else { k.checked_sub(1) };
    let before = before.and_then(|k| pieces.get(k)).map(|piece| direction(piece, 1.0));
    let after = pieces.get(k).map(|piece| direction(piece, 0.0));
    // What is known about x, about both together and about y.
    let [mut xx, mut xy, mut yy] = [1e-6, 0.0, 1e-6];
    let mut know = |x: f64, y: f64| {
        xx += x * x;
        xy += x * y;
        yy += y * y;
    };
    for along in [before, after].into_iter().flatten() {
        know(-along.y, along.x);
    }
    if let (Some(along), None) | (None, Some(along)) = (before, after) {
        know(along.x, along.y);
    }
    let determinant = xx * yy - xy * xy;
    [yy, xx].map(|other| SIGMA * (other / determinant).sqrt().max(1.0))
}
