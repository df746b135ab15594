//! Regions of the plane, and what they have in common or not: polygons that neither cross nor overlap.
//!
//! Rings of a region turn so that their windings add up to 1 inside and 0 outside. What two regions have in common is where the
//! windings of both, less those of their union, do not cancel.

use alloc::vec::Vec;

use super::Pose;
use crate::contour;
use crate::geometry::{Bounds, Vec2};
use crate::shape::{
    AnyShape, Efd, FillRule, Flattening, Outline, OutlineBasis, Polygon, REFERENCE_VERTICES, Shape as _, ShapeError,
};

/// A shape, and where it stands in scene units.
pub type Placed = (AnyShape<f64>, Pose<f64>);

/// A part of the plane, scene units; the default is empty.
///
/// # Examples
/// ```
/// use dvp_core::Pose;
/// use dvp_core::scene::Region;
/// use dvp_core::shape::Rectangle;
/// let square = |x: f64| {
///     let shape = Rectangle { size: [2.0, 2.0], corner_radius: 0.0 }.into();
///     Region::of(&(shape, Pose { translation: [x, 0.0], ..Pose::identity() }), 1e-3)
/// };
/// // Two squares of side 2, one apart: they share half of each.
/// let shared = square(0.0)?.intersection(&square(1.0)?)?;
/// let bounds = shared.bounds().map(|bounds| (bounds.min.to_array(), bounds.max.to_array()));
/// assert_eq!(bounds, Some(([0.0, -1.0], [1.0, 1.0])));
/// # Ok::<(), dvp_core::shape::ShapeError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Region {
    outline: Outline<f64>,
}

impl Region {
    /// What a shape covers, as polygons at most `tolerance` from its curves, scene units.
    ///
    /// # Errors
    /// [`ShapeError`] if the numbers of the shape describe none, [`ShapeError::TooLarge`] if the size overflows.
    pub fn of((shape, pose): &Placed, tolerance: f64) -> Result<Self, ShapeError> {
        let mut outline = Outline::default();
        let basis = OutlineBasis::new(REFERENCE_VERTICES, shape.efd().map_or(1, Efd::harmonic_count))?;
        shape.flatten(&Flattening::new(&basis, tolerance), &mut outline)?;
        pose.transform(&mut outline.vertices);
        Ok(Self { outline: outline.rings().resolved(FillRule::EvenOdd)? })
    }

    /// What is in this one, in the other, or in both.
    ///
    /// # Errors
    /// [`ShapeError::NotFinite`], [`ShapeError::TooLarge`] if the size overflows.
    pub fn union(&self, other: &Self) -> Result<Self, ShapeError> {
        sum(&[(self, false), (other, false)])
    }

    /// What is in both.
    ///
    /// # Errors
    /// [`ShapeError::NotFinite`], [`ShapeError::TooLarge`] if the size overflows.
    pub fn intersection(&self, other: &Self) -> Result<Self, ShapeError> {
        sum(&[(self, false), (other, false), (&self.union(other)?, true)])
    }

    /// What is in this one and not in the other.
    ///
    /// # Errors
    /// [`ShapeError::NotFinite`], [`ShapeError::TooLarge`] if the size overflows.
    pub fn difference(&self, other: &Self) -> Result<Self, ShapeError> {
        sum(&[(&self.union(other)?, false), (other, true)])
    }

    /// The polygon of the rings with more area than `least`, scene units squared; none if there are none.
    ///
    /// # Errors
    /// [`ShapeError`] if the rings are no polygon.
    pub fn to_placed(&self, least: f64) -> Result<Option<Placed>, ShapeError> {
        let rings = self.outline.rings().iter().map(<[[f64; 2]]>::to_vec);
        let rings: Vec<_> = rings.filter(|ring| contour::signed_area(ring).abs() > least).collect();
        if rings.is_empty() {
            return Ok(None);
        }
        Ok(Some((AnyShape::from(Polygon::new(rings)?), Pose::identity())))
    }

    /// The smallest upright box around it, scene units; none if it is empty.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds<f64>> {
        Bounds::of(self.outline.vertices.iter().copied().map(Vec2::from))
    }

    /// Whether the whole box is inside, its border included.
    #[must_use]
    pub fn contains(&self, bounds: Bounds<f64>) -> bool {
        let rings = self.outline.rings();
        let center = bounds.center().to_array();
        let is_inside = rings.iter().filter(|ring| contour::contains(ring, center)).count() % 2 == 1;
        let mut edges = rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().skip(1).chain(ring.first())));
        is_inside && !edges.any(|(&a, &b)| enters(a, b, bounds))
    }
}

/// Whether an edge has points inside of a box.
fn enters(a: [f64; 2], b: [f64; 2], bounds: Bounds<f64>) -> bool {
    let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
    let (mut start, mut end) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let (from, step) = (a[axis], b[axis] - a[axis]);
        if step == 0.0 {
            if from <= min[axis] || from >= max[axis] {
                return false;
            }
        } else {
            let [first, second] = [min[axis], max[axis]].map(|side| (side - from) / step);
            start = start.max(first.min(second));
            end = end.min(first.max(second));
        }
    }
    start < end
}

/// Where windings do not cancel, those of some regions reversed.
fn sum(parts: &[(&Region, bool)]) -> Result<Region, ShapeError> {
    let mut all = Outline::default();
    for (part, is_reversed) in parts {
        for ring in part.outline.rings().iter().filter(|ring| !ring.is_empty()) {
            if *is_reversed {
                all.push_ring(ring.iter().rev().copied());
            } else {
                all.push_ring(ring.iter().copied());
            }
        }
    }
    Ok(Region { outline: all.rings().resolved(FillRule::NonZero)? })
}
