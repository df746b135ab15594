//! Which way round each ring is walked, so that the winding number is 1 inside of the object and 0 outside.
//!
//! Coverage is worked out from the mean winding number of a pixel, which is exact where the pixel holds two neighboring
//! winding numbers at most. Rings are drawn in any direction: walked as drawn, an outer ring and a hole of the same
//! direction have the winding numbers 0, 1 and 2, and a pixel that holds both borders would hold all three. A ring is
//! therefore walked in one direction if an even number of others is around it, and in the other direction if an odd one is.

use alloc::vec::Vec;

use crate::contour::signed_area;
use crate::real::Real;
use crate::render::even_odd::{Probe, Probes};
use crate::shape::Rings;

/// The directions of the rings of an object, and memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Orientation<T> {
    /// Per ring, whether it is walked against the order of its vertices.
    reversed: Vec<bool>,
    /// Per ring, the area inside of it.
    areas: Vec<T>,
    /// A point inside of each ring, with the ring's index.
    probes: Probes<T, usize>,
    /// Where a row meets a ring.
    meets: Vec<T>,
}

impl<T: Real> Orientation<T> {
    /// Finds the directions. For rings that do not cross each other the winding number is then 0 or 1 everywhere, even
    /// where rings touch, share edges or coincide.
    ///
    /// Of two rings only the larger one can be around the other, and it is if it is around any point inside of that.
    pub(super) fn find(&mut self, rings: Rings<'_, T>) {
        let Self { reversed, areas, probes, meets } = self;
        reversed.clear();
        areas.clear();
        for ring in rings.iter() {
            let area = signed_area(ring);
            // Down the right side is +1 to the right of it: rings that turn from +x to +y are walked backward.
            reversed.push(area > T::zero());
            areas.push(area.abs());
        }
        if areas.len() < 2 {
            return;
        }
        let points = rings.iter().enumerate().filter_map(|(k, ring)| Some(Probe::new(point_inside(ring, meets)?, k)));
        probes.fill(points);
        for (k, ring) in rings.iter().enumerate() {
            // Of rings as large as each other the first is taken for the larger one.
            let smaller = |&other: &usize| areas[other] < areas[k] || (areas[other] <= areas[k] && k < other);
            probes.cross(ring, smaller);
        }
        for probe in probes.iter() {
            reversed[probe.owner] ^= probe.inside;
        }
    }

    /// Per ring, whether it is walked against the order of its vertices.
    #[inline(always)]
    pub(super) fn reversed(&self) -> impl Iterator<Item = bool> {
        self.reversed.iter().copied()
    }

    /// The edges of the rings as indices of two vertices, in the directions that were found.
    #[inline(always)]
    pub(super) fn edges(&self, rings: Rings<'_, T>) -> impl Iterator<Item = (usize, usize)> {
        rings.ranges().zip(self.reversed()).flat_map(|(ring, reversed)| {
            let (start, end) = (ring.start, ring.end);
            ring.map(move |k| {
                let next = if k + 1 == end { start } else { k + 1 };
                if reversed { (next, k) } else { (k, next) }
            })
        })
    }
}

/// A point inside of a ring under the even-odd rule, away from its border: the middle of the widest part of the row at half
/// height. None if the ring has no height.
fn point_inside<T: Real>(ring: &[[T; 2]], meets: &mut Vec<T>) -> Option<[T; 2]> {
    let (&last, half) = (ring.last()?, T::of(0.5));
    let (top, bottom) = ring.iter().fold((last[1], last[1]), |(low, high), v| (low.min(v[1]), high.max(v[1])));
    let y = half * (top + bottom);
    meets.clear();
    let mut a = last;
    for &b in ring {
        if (a[1] <= y) != (b[1] <= y) {
            meets.push(a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
        }
        a = b;
    }
    meets.sort_unstable_by(|a, b| a.as_f64().total_cmp(&b.as_f64()));
    let widest =
        meets.as_chunks::<2>().0.iter().max_by(|a, b| (a[1] - a[0]).as_f64().total_cmp(&(b[1] - b[0]).as_f64()));
    widest.map(|&[left, right]| [half * (left + right), y])
}
