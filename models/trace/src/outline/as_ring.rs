//! Outlines of any kind as rings of lines, arcs and cubics.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::Similarity;
use dvp_core::shape::{PathRing, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::OutlineShape;

impl OutlineShape {
    /// The outline as a closed ring; ellipses as four cubics, within 3e-4 of their radii.
    #[must_use]
    pub fn ring(&self) -> PathRing<f64> {
        match *self {
            Self::Path(ref ring) => ring.clone(),
            Self::Circle { center, radius } => {
                let across = Vec2::new(radius, 0.0);
                let points = vec![(center - across).to_array(), (center + across).to_array()];
                PathRing { points, segments: vec![Segment::Arc { bulge: 1.0 }; 2] }
            }
            Self::Ellipse { center, radii, angle } => ellipse(center, radii, Vec2::from_angle(angle)),
            Self::Rectangle { center, size, corner_radius, angle } => {
                rectangle(center, size, corner_radius, Vec2::from_angle(angle))
            }
            Self::RegularPolygon { center, sides, radius, angle } => {
                let corner = |k: usize| Vec2::from_angle(angle + core::f64::consts::TAU * k as f64 / sides as f64);
                PathRing::polygon((0..sides).map(|k| (center + corner(k) * radius).to_array()).collect())
            }
            Self::Star { center, points, radii, angle } => {
                let corner = |k: usize| {
                    let direction = Vec2::from_angle(angle + core::f64::consts::PI * k as f64 / points as f64);
                    (center + direction * radii[k % 2]).to_array()
                };
                PathRing::polygon((0..2 * points).map(corner).collect())
            }
        }
    }
}

impl OutlineShape {
    /// The same elsewhere, turned or reflected, and in another size.
    #[must_use]
    pub(crate) fn moved(&self, map: &Similarity<f64>) -> Self {
        let (scale, turn) = (map.scale(), map.angle());
        let turned = |angle: f64| if map.reflected { turn - angle } else { turn + angle };
        match *self {
            Self::Path(ref ring) => Self::Path(moved(ring, map)),
            Self::Circle { center, radius } => Self::Circle { center: map.point(center), radius: radius * scale },
            Self::Ellipse { center, radii, angle } => Self::Ellipse {
                center: map.point(center),
                radii: radii.map(|radius| radius * scale),
                angle: turned(angle),
            },
            Self::Rectangle { center, size, corner_radius, angle } => Self::Rectangle {
                center: map.point(center),
                size: size.map(|side| side * scale),
                corner_radius: corner_radius * scale,
                angle: turned(angle),
            },
            Self::RegularPolygon { center, sides, radius, angle } => {
                Self::RegularPolygon { center: map.point(center), sides, radius: radius * scale, angle: turned(angle) }
            }
            Self::Star { center, points, radii, angle } => Self::Star {
                center: map.point(center),
                points,
                radii: radii.map(|radius| radius * scale),
                angle: turned(angle),
            },
        }
    }

    /// The numbers of a circle (middle, radius) or of a rectangle with round corners (middle, width, height, corner radius), in pixels; its angle is
    /// as it is. None of other kinds.
    #[must_use]
    pub(crate) fn numbers(&self) -> Option<Vec<f64>> {
        match *self {
            Self::Circle { center, radius } => Some(vec![center.x, center.y, radius]),
            Self::Rectangle { center, size, corner_radius, .. } if corner_radius > 0.0 => {
                Some(vec![center.x, center.y, size[0], size[1], corner_radius])
            }
            _ => None,
        }
    }

    /// The same kind with other numbers; none if they make no such.
    #[must_use]
    pub(crate) fn with_numbers(&self, numbers: &[f64]) -> Option<Self> {
        let center = Vec2::new(*numbers.first()?, *numbers.get(1)?);
        match (self, numbers.get(2..)?) {
            (Self::Circle { .. }, &[radius]) if radius > 0.0 => Some(Self::Circle { center, radius }),
            (&Self::Rectangle { angle, .. }, &[width, height, corner_radius])
                if corner_radius > 0.0 && 2.0 * corner_radius < width.min(height) =>
            {
                Some(Self::Rectangle { center, size: [width, height], corner_radius, angle })
            }
            _ => None,
        }
    }
}

fn ellipse(center: Vec2<f64>, radii: [f64; 2], turn: Vec2<f64>) -> PathRing<f64> {
    // Length of the handles of a quarter of the unit circle.
    let handle = 4.0 / 3.0 * (core::f64::consts::SQRT_2 - 1.0);
    let place = |x: f64, y: f64| (center + Vec2::new(x * radii[0], y * radii[1]).turned(turn)).to_array();
    let corners = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let mut ring = PathRing::default();
    for k in 0..4 {
        let ([x, y], [to_x, to_y]) = (corners[k], corners[(k + 1) % 4]);
        ring.points.push(place(x, y));
        let controls = [place(x - handle * y, y + handle * x), place(to_x + handle * to_y, to_y - handle * to_x)];
        ring.segments.push(Segment::Cubic { controls });
    }
    ring
}

fn rectangle(center: Vec2<f64>, size: [f64; 2], corner_radius: f64, turn: Vec2<f64>) -> PathRing<f64> {
    let [half_x, half_y] = size.map(|side| 0.5 * side.abs());
    let radius = corner_radius.clamp(0.0, half_x.min(half_y));
    let place = |x: f64, y: f64| (center + Vec2::new(x, y).turned(turn)).to_array();
    let signs = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    if radius <= 0.0 {
        return PathRing::polygon(signs.iter().map(|&[x, y]| place(x * half_x, y * half_y)).collect());
    }
    let mut ring = PathRing::default();
    let quarter = (core::f64::consts::PI / 8.0).tan();
    for (k, &[x, y]) in signs.iter().enumerate() {
        let ends: Vec<[f64; 2]> = if k % 2 == 0 {
            vec![place(x * half_x, y * (half_y - radius)), place(x * (half_x - radius), y * half_y)]
        } else {
            vec![place(x * (half_x - radius), y * half_y), place(x * half_x, y * (half_y - radius))]
        };
        ring.points.extend(ends);
        ring.segments.extend([Segment::Arc { bulge: quarter }, Segment::Line]);
    }
    ring
}

/// A ring elsewhere, turned or reflected, and in another size.
#[must_use]
pub(crate) fn moved(ring: &PathRing<f64>, map: &Similarity<f64>) -> PathRing<f64> {
    let place = |point: [f64; 2]| map.point(Vec2::from(point)).to_array();
    let segment = |segment: &Segment<f64>| match *segment {
        Segment::Cubic { controls } => Segment::Cubic { controls: controls.map(place) },
        Segment::SmoothCubic { handle, control } => {
            Segment::SmoothCubic { handle: handle * map.scale(), control: place(control) }
        }
        Segment::Arc { bulge } if map.reflected => Segment::Arc { bulge: -bulge },
        other => other,
    };
    PathRing {
        points: ring.points.iter().map(|&point| place(point)).collect(),
        segments: ring.segments.iter().map(segment).collect(),
    }
}
