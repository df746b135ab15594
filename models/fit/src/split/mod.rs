//! One segment that is really several objects of one color: their outlines, each as far as it shows.
//!
//! In: the samples of a segment that no single prototype explains. Out: sets of posed prototypes whose union has its
//! outline at the sampled distances. Inside a union the distance to each part is at least the one sampled: an object may lie
//! behind the outline, where another one explains the sample, but must not stand out. `partial` finds poses that
//! explain a part of the samples, `cover` sets of them that explain all, `assign` refines a set with each sample given to the
//! outline nearest to it. Without prototypes `waist` tells which outlines are worth a look; `simple_shapes` are tried, and
//! `twins` finds two objects of one unknown shape by the `motion` from one to the other and the `symmetry` of what shows.

mod assign;
mod cover;
pub(crate) mod motion;
pub(crate) mod overlap;
mod pair;
mod partial;
pub(crate) mod simple_shapes;
mod symmetry;
#[cfg(test)]
mod tests;
pub(crate) mod twins;
pub(crate) mod waist;

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::sort;

use simple_shapes::SimpleShapes;

use crate::free::outline_fit::FreeOutline;
use crate::pose::gauss_newton::PosePx;
use crate::pose::search::Prototype;
use crate::segment::Segment;
use crate::tuning::{CROSSING_PX, EXPLAINED_PX, THIRD_PART};

/// Sets of poses that are handed back.
const MOST_SETS: usize = 3;

/// A prototype at a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Part<T> {
    pub(crate) prototype: usize,
    pub(crate) pose: PosePx<T>,
}

/// Objects that together explain a segment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PartSet<T> {
    pub(crate) parts: Vec<Part<T>>,
    /// Robust mean squared distance error (px^2).
    pub(crate) cost: T,
}

/// Objects of one color, each a shape (px) and the motion that places it, that together explain an outline.
#[derive(Clone, Debug)]
pub(crate) struct Explanation<T> {
    pub(crate) members: Vec<(FreeOutline<T>, PosePx<T>)>,
    /// Bits of their shapes, shared ones once.
    pub(crate) shape_bits: f64,
    /// Robust mean squared distance error (px^2).
    pub(crate) cost: T,
}

impl<T: Real> PartSet<T> {
    /// The set as it is, of simple shapes.
    pub(crate) fn of_simple_shapes(&self, shapes: &SimpleShapes<T>) -> Explanation<T> {
        let member = |part: &Part<T>| {
            let rows = shapes.rows[part.prototype].clone();
            (FreeOutline { center: [T::zero(); 2], rows }, part.pose)
        };
        Explanation {
            members: self.parts.iter().map(member).collect(),
            shape_bits: shapes.bits() * f64::of_usize(self.parts.len()),
            cost: self.cost,
        }
    }
}

/// Sets of two or three posed prototypes whose union could be `segment`, best first.
///
/// None where no set explains clearly more samples than one prototype does.
pub(crate) fn split<T: Real>(segment: &Segment<T>, prototypes: &[Prototype<T>]) -> Vec<PartSet<T>> {
    let candidates = partial::search(segment, prototypes);
    let mut sets: Vec<PartSet<T>> = cover::sets(&candidates, segment.samples.len())
        .into_iter()
        .map(|parts| assign::refine(parts, &segment.samples, prototypes))
        .collect();
    // A third part must make much of a difference.
    let price = |set: &PartSet<T>| if set.parts.len() > 2 { set.cost * T::of(THIRD_PART) } else { set.cost };
    sort::ascending(&mut sets, |set| price(set).as_f64());
    sets.truncate(MOST_SETS);
    sets
}
