//! Regions of the plane, and what they have in common or not: polygons that neither cross nor overlap.
//!
//! Rings of a region turn so that their windings add up to 1 inside and 0 outside. What two regions have in common is where the
//! windings of both, less those of their union, do not cancel.

use alloc::rc::Rc;

use dvp_core::geometry::{Bounds, Vec2};
use dvp_core::shape::{
    AnyShape, Efd, FillRule, Flattening, Outline, OutlineBasis, Polygon, REFERENCE_VERTICES, Shape as _, ShapeError,
};
use dvp_core::{Pose, contour};

/// Rings with less area than this, squared pixels, are left out: what rounding leaves where edges coincide.
const LEAST_AREA_PX: f64 = 1e-6;

/// A shape, and where it stands in scene units.
pub(crate) type Placed = (AnyShape<f64>, Pose<f64>);

/// A part of the plane, scene units.
#[derive(Clone, Debug, Default)]
pub(crate) struct Region {
    outline: Outline<f64>,
}

impl Region {
    /// What a shape covers; `tolerance` for its curves, scene units.
    pub(crate) fn of((shape, pose): &Placed, tolerance: f64) -> Result<Self, ShapeError> {
        let mut outline = Outline::default();
        let basis = OutlineBasis::new(REFERENCE_VERTICES, shape.efd().map_or(1, Efd::harmonic_count))?;
        shape.flatten(&Flattening::new(&basis, tolerance), &mut outline)?;
        pose.transform(&mut outline.vertices);
        Ok(Self { outline: outline.rings().resolved(FillRule::EvenOdd)? })
    }

    pub(crate) fn union(&self, other: &Self) -> Result<Self, ShapeError> {
        sum(&[(self, false), (other, false)])
    }

    pub(crate) fn intersection(&self, other: &Self) -> Result<Self, ShapeError> {
        sum(&[(self, false), (other, false), (&self.union(other)?, true)])
    }

    pub(crate) fn difference(&self, other: &Self) -> Result<Self, ShapeError> {
        sum(&[(&self.union(other)?, false), (other, true)])
    }

    /// The polygon of the rings with more area than `least`, scene units squared; none if there are none.
    pub(crate) fn to_placed(&self, least: f64) -> Result<Option<Placed>, ShapeError> {
        let rings = self.outline.rings().iter().map(<[[f64; 2]]>::to_vec);
        let rings: Vec<_> = rings.filter(|ring| contour::signed_area(ring).abs() > least).collect();
        if rings.is_empty() {
            return Ok(None);
        }
        Ok(Some((AnyShape::from(Polygon::new(rings)?), Pose::identity())))
    }

    /// The smallest upright box around it; none if it is empty.
    pub(crate) fn bounds(&self) -> Option<Bounds<f64>> {
        Bounds::of(self.outline.vertices.iter().copied().map(Vec2::from))
    }

    /// Whether the whole box is inside, its border included.
    fn contains(&self, bounds: Bounds<f64>) -> bool {
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

/// A shape inside of a region, with whether it was cut; none if nothing is left. `px` scene units per pixel.
pub(crate) fn cut(
    placed: Placed,
    region: &Rc<Region>,
    tolerance: f64,
    px: f64,
) -> Result<Option<(Placed, bool)>, ShapeError> {
    let own = Region::of(&placed, tolerance)?;
    let Some(bounds) = own.bounds() else { return Ok(None) };
    if region.contains(bounds) {
        return Ok(Some((placed, false)));
    }
    Ok(own.intersection(region)?.to_placed(LEAST_AREA_PX * px * px)?.map(|placed| (placed, true)))
}
