//! Outlines: the closed polygons that renderers paint, ring by ring, and how curves become polygons.

use alloc::vec::Vec;
use core::ops::Range;

use super::{FillRule, OutlineBasis, ShapeError};
use crate::real::Real;

/// How far a polygon may stray from the curve it stands for unless said otherwise, scene units: 0.008 px at 128 px.
pub const OUTLINE_TOLERANCE: f64 = 1.0 / 16_384.0;

/// How curves become polygons.
#[derive(Clone, Copy, Debug)]
pub struct Flattening<'a, T> {
    /// The table for descriptors: they are sampled at its parameters, whatever the tolerance.
    pub basis: &'a OutlineBasis<T>,
    /// Most that the polygon of any other curve strays from it, in the units of the shape.
    pub tolerance: T,
}

impl<'a, T: Real> Flattening<'a, T> {
    /// Polygons within `tolerance` (scene units) of their curves.
    #[must_use]
    pub fn new(basis: &'a OutlineBasis<T>, tolerance: T) -> Self {
        Self { basis, tolerance }
    }

    /// The same for a shape that is drawn `scale` times as large.
    #[must_use]
    pub fn magnified(&self, scale: T) -> Self {
        Self { basis: self.basis, tolerance: self.tolerance / scale.abs().max(T::min_positive_value()) }
    }
}

impl<'a, T: Real> From<&'a OutlineBasis<T>> for Flattening<'a, T> {
    /// Polygons within 1/16384 scene units of their curves: 0.008 px at 128 pixels.
    fn from(basis: &'a OutlineBasis<T>) -> Self {
        Self::new(basis, T::of(OUTLINE_TOLERANCE))
    }
}

/// Closed polygons, ring after ring: what a shape encloses under the even-odd rule. Each ring is closed by the edge from
/// its last vertex to its first.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline<T> {
    /// The vertices of all rings.
    pub vertices: Vec<[T; 2]>,
    /// Where each ring but the first starts, rising; empty for one ring.
    pub breaks: Vec<usize>,
}

impl<T: Real> Outline<T> {
    /// Removes everything, keeps the memory.
    pub fn clear(&mut self) {
        self.vertices.clear();
        self.breaks.clear();
    }

    /// Appends a ring.
    pub fn push_ring(&mut self, ring: impl IntoIterator<Item = [T; 2]>) {
        self.start_ring();
        self.vertices.extend(ring);
    }

    /// What is appended to the vertices from here on belongs to another ring.
    pub fn start_ring(&mut self) {
        let first = self.vertices.len();
        if first > 0 && self.breaks.last() != Some(&first) {
            self.breaks.push(first);
        }
    }

    /// The rings.
    #[must_use]
    pub fn rings(&self) -> Rings<'_, T> {
        Rings { vertices: &self.vertices, breaks: &self.breaks, first: 0 }
    }

    /// Rings that enclose, under the even-odd rule, what these fill by `rule`, but neither cross nor overlap: outer ones turn
    /// from +x to +y, holes the other way.
    ///
    /// # Errors
    /// [`ShapeError::NotFinite`], [`ShapeError::TooLarge`] if the size overflows.
    pub fn resolved(&self, rule: FillRule) -> Result<Self, ShapeError> {
        self.rings().resolved(rule)
    }
}

/// Borrowed rings, in the layout of [`Outline`].
#[derive(Clone, Copy, Debug)]
pub struct Rings<'a, T> {
    /// The vertices of all rings.
    pub vertices: &'a [[T; 2]],
    /// Where each ring but the first starts, rising.
    pub breaks: &'a [usize],
    /// The number that `breaks` give to the first vertex: 0, or where these rings start in a longer list.
    pub first: usize,
}

impl<'a, T> Rings<'a, T> {
    /// One ring.
    #[must_use]
    pub fn one(vertices: &'a [[T; 2]]) -> Self {
        Self { vertices, breaks: &[], first: 0 }
    }

    /// The indices into `vertices` of each ring, in order.
    #[inline(always)]
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> + Clone + use<'a, T> {
        let (breaks, first, len) = (self.breaks, self.first, self.vertices.len());
        let start = move |ring: usize| if ring == 0 { 0 } else { breaks[ring - 1].saturating_sub(first).min(len) };
        let end = move |ring: usize| breaks.get(ring).map_or(len, |&end| end.saturating_sub(first).min(len));
        (0..=breaks.len()).map(move |ring| start(ring)..end(ring))
    }

    /// The rings, each as its vertices; none of them where breaks fall or pass the end.
    pub fn iter(&self) -> impl Iterator<Item = &'a [[T; 2]]> + Clone + use<'a, T> {
        let vertices = self.vertices;
        self.ranges().map(move |range| vertices.get(range).unwrap_or_default())
    }
}
