//! Every kind of shape in another precision.

use super::{Circle, Ellipse, Path, PathRing, Polygon, Prototype, Rectangle, RegularPolygon, Segment, Star};
use crate::real::Real;

fn number<T: Real, U: Real>(value: T) -> U {
    U::of(value.as_f64())
}

fn point<T: Real, U: Real>(point: [T; 2]) -> [U; 2] {
    point.map(number)
}

impl<T: Real> Circle<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Circle<U> {
        Circle { radius: number(self.radius) }
    }
}

impl<T: Real> Ellipse<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Ellipse<U> {
        Ellipse { radii: point(self.radii) }
    }
}

impl<T: Real> Rectangle<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Rectangle<U> {
        Rectangle { size: point(self.size), corner_radius: number(self.corner_radius) }
    }
}

impl<T: Real> RegularPolygon<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> RegularPolygon<U> {
        RegularPolygon { sides: self.sides, radius: number(self.radius) }
    }
}

impl<T: Real> Star<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Star<U> {
        Star { points: self.points, radius: number(self.radius), inner_radius: number(self.inner_radius) }
    }
}

impl<T: Real> Polygon<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Polygon<U> {
        Polygon { rings: self.rings.iter().map(|ring| ring.iter().copied().map(point).collect()).collect() }
    }
}

impl<T: Real> Path<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Path<U> {
        Path { rings: self.rings.iter().map(PathRing::cast).collect(), fill: self.fill }
    }
}

impl<T: Real> PathRing<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> PathRing<U> {
        let segments = self.segments.iter().map(|segment| match *segment {
            Segment::Line => Segment::Line,
            Segment::Arc { bulge } => Segment::Arc { bulge: number(bulge) },
            Segment::SmoothArc => Segment::SmoothArc,
            Segment::Cubic { controls } => Segment::Cubic { controls: controls.map(point) },
            Segment::SmoothCubic { handle, control } => {
                Segment::SmoothCubic { handle: number(handle), control: point(control) }
            }
        });
        PathRing { points: self.points.iter().copied().map(point).collect(), segments: segments.collect() }
    }
}

impl<T: Real> Prototype<T> {
    /// The same in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Prototype<U> {
        Prototype { index: self.index, efd: self.efd.cast() }
    }
}
