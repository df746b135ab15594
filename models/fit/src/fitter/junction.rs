//! Which of two touching objects is in front by how their outlines meet.
//!
//! Where one object hides another, the outline of the one in front runs on, and that of the one behind ends at it: a T. So
//! the outline that turns less where the shared stretch begins and ends is that of the one in front.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::contour::{perimeter, resample};

use super::run::Run;
use crate::free::sight::Sight;

/// Distance (px) between points of a contour that are looked at.
const STEP_PX: f64 = 1.5;
/// Points on either side of a junction that tell its directions; those nearer than the first are blurred by it.
const NEAR: usize = 2;
const FAR: usize = 6;
/// Difference of the turnings (radians, of both ends together) that tells.
const CLEARLY: f64 = 0.5;

impl<T: Real> Run<'_, T> {
    /// The object in front at an open border, as its ends have it; none if they do not tell.
    pub(super) fn front_by_junctions(&mut self, border: usize) -> Option<u32> {
        let [a, b] = self.scratch.segmentation.borders().get(border)?.objects;
        let turns_a = self.turning_at_ends(border, a)?;
        let turns_b = self.turning_at_ends(border, b)?;
        let clearly = T::of(CLEARLY);
        if turns_a + clearly < turns_b { Some(a) } else { (turns_b + clearly < turns_a).then_some(b) }
    }

    /// How much (radians) the outline of an object turns at the ends of a border if it is in front there; none if the two
    /// ends are not found. The border is open afterwards.
    fn turning_at_ends(&mut self, border: usize, object: u32) -> Option<T> {
        let (size, kind) = (self.image.size(), self.kind);
        self.scratch.segmentation.gather_object(object, size, &kind);
        let at = object as usize;
        let own: Vec<([u32; 2], T)> = self.scratch.segmentation.segments()[at].rim.clone();
        self.scratch.segmentation.set_front(border, Some(object));
        self.scratch.segmentation.gather_object(object, size, &kind);
        let contour = self.contour_of(at);
        self.scratch.segmentation.set_front(border, None);
        let contour = contour?;
        let count = (perimeter(&contour) / T::of(STEP_PX)).to_count();
        if count < 4 * FAR {
            return None;
        }
        let points = resample(&contour, count);
        let sight = Sight::new(&own, object, &self.scratch.segmentation, size);
        let shared: Vec<bool> = points.iter().map(|&point| !sight.shows(point)).collect();
        let ends = (0..count).filter(|&i| shared[i] != shared[(i + 1) % count]);
        let direction = |from: usize, to: usize| {
            let (p, q) = (points[from % count], points[to % count]);
            [q[0] - p[0], q[1] - p[1]]
        };
        let (mut turning, mut found) = (T::zero(), 0);
        for i in ends {
            let (u, v) = (direction(i + count - FAR, i + count - NEAR), direction(i + NEAR, i + FAR));
            turning += (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).abs();
            found += 1;
        }
        (found == 2).then_some(turning)
    }
}
