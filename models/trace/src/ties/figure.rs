//! Whole figures: circles, ellipses, rectangles, regular polygons and stars.

use dvp_core::Vec2;
use dvp_core::shape::Piece;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::numbers::{Kind, SIGMA, corner_sigma};
use super::places::{LIMIT, Places};
use crate::outline::OutlineShape;

/// An upright rectangle by its sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sides {
    /// Left and top.
    pub(super) low: Vec2<f64>,
    /// Right and bottom.
    pub(super) high: Vec2<f64>,
}

impl Sides {
    /// None if the corners of the upright one are further off than can be overlooked.
    pub(super) fn of(center: Vec2<f64>, size: [f64; 2], angle: f64) -> Option<Self> {
        let quarters = (angle / core::f64::consts::FRAC_PI_2).round();
        let turn = angle - quarters * core::f64::consts::FRAC_PI_2;
        let [width, height] = if quarters % 2.0 == 0.0 { size } else { [size[1], size[0]] };
        let half = Vec2::new(width, height) * 0.5;
        (half.length() * turn.abs() <= SIGMA).then_some(Self { low: center - half, high: center + half })
    }
}

/// Center and radius of the circle of an arc; none if it is straight.
pub(super) fn circle_of_arc(piece: &Piece<f64>) -> Option<(Vec2<f64>, f64)> {
    let Piece::Arc { from, to, bulge } = *piece else { return None };
    if bulge.abs() < 1e-6 {
        return None;
    }
    let chord = to - from;
    let center = from + (chord + chord.perp() * ((1.0 - bulge * bulge) / (2.0 * bulge))) * 0.5;
    Some((center, chord.length() * (1.0 + bulge * bulge) / (4.0 * bulge.abs())))
}

/// A figure with its numbers at places of the drawing.
pub(super) fn tie(shape: &mut OutlineShape, places: &Places<'_>) {
    let point = |point: Vec2<f64>| {
        Vec2::new(places.cheapest(Kind::X, point.x, LIMIT), places.cheapest(Kind::Y, point.y, LIMIT))
    };
    let length = |value: f64| places.cheapest(Kind::Length, value, LIMIT);
    match shape {
        OutlineShape::Path(_) => (),
        OutlineShape::Circle { center, radius } => {
            *center = point(*center);
            *radius = length(*radius);
        }
        OutlineShape::Ellipse { center, radii, .. } => {
            *center = point(*center);
            *radii = radii.map(length);
            if radii[0] == radii[1] {
                *shape = OutlineShape::Circle { center: *center, radius: radii[0] };
            }
        }
        OutlineShape::Rectangle { center, size, corner_radius, angle } => {
            let Some(Sides { low, high }) = Sides::of(*center, *size, *angle) else {
                *center = point(*center);
                return;
            };
            let (low, high) = (point(low), point(high));
            *center = (low + high) * 0.5;
            *size = (high - low).to_array();
            *angle = 0.0;
            if *corner_radius > 0.0 {
                // Round ends stay round.
                let most = 0.5 * size[0].min(size[1]);
                let limit = LIMIT * corner_sigma() / SIGMA;
                *corner_radius = if (*corner_radius - most).abs() <= limit {
                    most
                } else {
                    places.cheapest(Kind::Length, *corner_radius, limit).min(most)
                };
            }
        }
        OutlineShape::RegularPolygon { center, .. } | OutlineShape::Star { center, .. } => *center = point(*center),
    }
}
