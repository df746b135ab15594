//! Which predicted object stands for which true one, for a batch of scenes.

use alloc::vec::Vec;

use super::{LossError, ScenePairs};
use crate::matching::{CostMatrix, Hungarian, MatchingCost};
use crate::real::Real;
use crate::scene::Object;
use crate::shape::{REFERENCE_SYMMETRY_HARMONICS, REFERENCE_SYMMETRY_THRESHOLD};
/// A true object and the predicted one that stands for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match<T> {
    /// Index of the pair of scenes.
    pub pair: usize,
    /// Index of the true object in its scene.
    pub truth: usize,
    /// Index of the predicted object in its scene.
    pub prediction: usize,
    /// Angle of the true object minus that of the predicted one.
    pub(super) turn: T,
    /// Symmetry order of the true shape.
    pub(super) order: usize,
}

/// How often a symmetry order occurs among the true objects of all scenes with `objects` objects.
#[derive(Clone, Copy, Debug)]
pub(super) struct OrderCount {
    pub(super) objects: usize,
    pub(super) order: usize,
    pub(super) count: usize,
}

/// Memory of [`SceneLoss`](super::SceneLoss), and the matches it found last.
#[derive(Clone, Debug, Default)]
pub struct SceneLossScratch<T> {
    matches: Vec<Match<T>>,
    /// The matches of pair i are `matches[starts[i]..starts[i + 1]]`.
    starts: Vec<usize>,
    pub(super) orders: Vec<OrderCount>,
    costs: Vec<T>,
    solver: Hungarian<T>,
    /// Difference of two descriptors, or the gradient of the difference.
    pub(super) rows: Vec<[T; 4]>,
    /// The outline of that difference, or its gradient.
    pub(super) vertices: Vec<[T; 2]>,
}

impl<T: Real> SceneLossScratch<T> {
    /// The matches of the last call, pair by pair, in the order of the true objects.
    #[must_use]
    pub fn matches(&self) -> &[Match<T>] {
        &self.matches
    }

    /// The matches of one pair.
    pub(super) fn of_pair(&self, pair: usize) -> core::ops::Range<usize> {
        self.starts[pair]..self.starts[pair + 1]
    }

    /// Matches every pair.
    pub(super) fn match_all(&mut self, cost: &MatchingCost<T>, pairs: ScenePairs<'_, T>) -> Result<(), LossError> {
        self.matches.clear();
        self.orders.clear();
        self.starts.clear();
        self.starts.push(0);
        for (pair, (truth, prediction)) in pairs.truths().iter().zip(pairs.predictions()).enumerate() {
            let visible = || truth.objects.iter().enumerate().filter(|(_, object)| is_visible(object));
            let (objects, slots) = (visible().count(), prediction.objects.len());
            if objects > slots {
                return Err(LossError::TooFewSlots { pair, objects, slots });
            }
            cost.fill(visible().map(|(_, object)| object), &prediction.objects, &mut self.costs);
            let assignment = self.solver.solve(CostMatrix::new(objects, slots, &self.costs)?)?;
            for ((truth, object), slot) in visible().zip(&assignment.column_of) {
                let Some(slot) = *slot else { continue };
                let turn = object.pose.rotation - prediction.objects[slot].pose.rotation;
                let order = object
                    .shape
                    .descriptors()?
                    .reference_symmetry_order(REFERENCE_SYMMETRY_HARMONICS, T::of(REFERENCE_SYMMETRY_THRESHOLD));
                self.matches.push(Match { pair, truth, prediction: slot, turn, order });
                match self.orders.iter_mut().find(|entry| (entry.objects, entry.order) == (objects, order)) {
                    Some(entry) => entry.count += 1,
                    None => self.orders.push(OrderCount { objects, order, count: 1 }),
                }
            }
            self.starts.push(self.matches.len());
        }
        Ok(())
    }
}

/// A true object counts if its rounded confidence is 1 (1/2 rounds to even, as in the reference).
fn is_visible<T: Real>(object: &Object<T>) -> bool {
    object.confidence > T::of(0.5)
}
