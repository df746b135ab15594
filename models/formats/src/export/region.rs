//! What an object encloses as simple polygons with holes: what other programs take.

use dvp_core::contour::{contains, perimeter, signed_area};
use dvp_core::geometry::{Bounds, Vec2};
use dvp_core::shape::{Boundary, FillRule, Moments, Outline, ShapeError};
use dvp_core::sort;

/// Rings that enclose less are left out, px^2: nobody sees them, and rounded to decimals they would be no rings.
const LEAST_AREA: f64 = 1e-4;

/// What an object encloses, px.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Region {
    /// Polygons that do not overlap.
    pub polygons: Vec<Polygon>,
}

/// A polygon with holes; its rings do not cross, and each is closed by the edge from its last vertex to its first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon {
    /// The ring around it, turning from +x to +y.
    pub outer: Vec<[f64; 2]>,
    /// The rings around its holes, turning the other way.
    pub holes: Vec<Vec<[f64; 2]>>,
}

impl Region {
    /// What rings enclose under the even-odd rule, however they cross or turn.
    ///
    /// # Errors
    /// [`ShapeError`] if a vertex is not finite or the size overflows.
    pub fn new(outline: &Outline<f64>) -> Result<Self, ShapeError> {
        let simple = outline.resolved(FillRule::EvenOdd)?;
        let rings = simple.rings().iter().map(|ring| (signed_area(ring), ring));
        let (mut outer, holes): (Vec<_>, Vec<_>) =
            rings.filter(|(area, _)| area.abs() >= LEAST_AREA).partition(|(area, _)| *area > 0.0);
        // Small ones first, so that the first one around a hole is the one that it is a hole of.
        sort::ascending(&mut outer, |&(area, _)| area);
        let mut polygons: Vec<Polygon> =
            outer.into_iter().map(|(_, ring)| Polygon { outer: ring.to_vec(), holes: Vec::new() }).collect();
        for (_, hole) in holes {
            let inside = |polygon: &&mut Polygon| point_in(hole).is_some_and(|point| contains(&polygon.outer, point));
            if let Some(polygon) = polygons.iter_mut().find(inside) {
                polygon.holes.push(hole.to_vec());
            }
        }
        polygons.reverse();
        Ok(Self { polygons })
    }

    /// All rings.
    pub fn rings(&self) -> impl Iterator<Item = &[[f64; 2]]> + Clone {
        self.polygons.iter().flat_map(Polygon::rings)
    }

    /// Whether there is a hole.
    #[must_use]
    pub fn has_holes(&self) -> bool {
        self.polygons.iter().any(|polygon| !polygon.holes.is_empty())
    }

    /// Area, centroid and second moments; none if nothing is enclosed.
    ///
    /// # Errors
    /// [`ShapeError::TooLarge`] if the size overflows.
    pub fn moments(&self) -> Result<Option<Moments<f64>>, ShapeError> {
        let mut boundary = Boundary::default();
        for ring in self.rings() {
            boundary.push_polygon(&ring.iter().map(|&vertex| Vec2::from(vertex)).collect::<Vec<_>>());
        }
        Ok(Some(boundary.moments()?).filter(|moments| moments.area > 0.0))
    }

    /// The length of all rings, px.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        self.rings().map(perimeter).sum()
    }

    /// How the length of all rings changes, px, when everything is made longer along a direction and narrower across it, per logarithm of the factor.
    #[must_use]
    pub fn perimeter_along(&self, angle: f64) -> f64 {
        let along = Vec2::from_angle(angle);
        let edges = |ring: &[[f64; 2]]| -> f64 {
            let next = ring.iter().cycle().skip(1);
            let chords = ring.iter().zip(next).map(|(&from, &to)| Vec2::from(to) - Vec2::from(from));
            let by = |chord: Vec2<f64>| chord.dot(along).powi(2) - chord.cross(along).powi(2);
            chords.filter(|chord| chord.length() > 0.0).map(|chord| by(chord) / chord.length()).sum()
        };
        self.rings().map(edges).sum()
    }

    /// The smallest upright box around it; none if nothing is enclosed.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds<f64>> {
        Bounds::of(self.polygons.iter().flat_map(|polygon| &polygon.outer).map(|&vertex| Vec2::from(vertex)))
    }

    /// The ring around the largest polygon; none if nothing is enclosed.
    #[must_use]
    pub fn largest_ring(&self) -> Option<&[[f64; 2]]> {
        self.polygons.first().map(|polygon| polygon.outer.as_slice())
    }
}

impl Polygon {
    /// The outer ring, then the holes.
    pub fn rings(&self) -> impl Iterator<Item = &[[f64; 2]]> + Clone {
        core::iter::once(&self.outer).chain(&self.holes).map(Vec::as_slice)
    }
}

/// A point inside of a ring, just beside the middle of its longest edge.
fn point_in(ring: &[[f64; 2]]) -> Option<[f64; 2]> {
    let ends = ring.iter().skip(1).chain(ring.first());
    let length = |p: &[f64; 2], q: &[f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]);
    let (p, q) = ring.iter().zip(ends).max_by(|a, b| length(a.0, a.1).total_cmp(&length(b.0, b.1)))?;
    // To the side of the inside: to that where +x turns to +y for rings of positive area.
    let side = 1e-6 * signed_area(ring).signum();
    Some([0.5 * (p[0] + q[0]) - side * (q[1] - p[1]), 0.5 * (p[1] + q[1]) + side * (q[0] - p[0])])
}
