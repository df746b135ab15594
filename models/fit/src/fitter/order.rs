//! Which of two touching objects is in front.
//!
//! The outline between them belongs to the one in front; the other goes on behind it, unseen. Each is fitted with and
//! without the shared stretch: a disk keeps its circle, while the crescent left of the one behind needs many harmonics, or
//! fits no prototype. The assignment with the shorter description wins; if they are as long, the smaller object is in front.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

use super::run::Run;
use crate::free::grow::Freedom;
use crate::pose::search::Effort;
use crate::price::{coefficient_bits, misfit_bits};
use crate::tuning::CLEARLY_SHORTER_BITS;

/// What an object without any fit is taken to cost: more than any that fits.
const NO_FIT_BITS: f64 = 1e6;

impl<T: Real> Run<'_, T> {
    /// Decides all open borders of the reading.
    pub(super) fn decide_order(&mut self) {
        let borders = self.scratch.segmentation.borders();
        if borders.iter().all(|border| border.front.is_some()) {
            return;
        }
        let count = self.scratch.segmentation.segments().len();
        let mut alone: Vec<Option<f64>> = vec![None; count];
        let mut decided = Vec::new();
        for at in 0..self.scratch.segmentation.borders().len() {
            let border = self.scratch.segmentation.borders()[at];
            if border.front.is_some() {
                continue;
            }
            let [a, b] = border.objects;
            let [behind_a, behind_b] = [a, b].map(|object| {
                let held = alone[object as usize];
                held.unwrap_or_else(|| *alone[object as usize].insert(self.part_bits(object)))
            });
            let [before_a, before_b] = [a, b].map(|object| {
                self.scratch.segmentation.set_front(at, Some(object));
                self.part_bits(object)
            });
            self.scratch.segmentation.set_front(at, None);
            let gain = (behind_a + before_b) - (before_a + behind_b);
            // Objects are numbered by size: of two that could both be in front, the smaller is taken to be.
            decided.push((at, if gain > CLEARLY_SHORTER_BITS { a } else { b }));
        }
        for (at, front) in decided {
            self.scratch.segmentation.set_front(at, Some(front));
        }
    }

    /// Bits of the shape of an object and of what its samples miss, from the borders that are decided for it.
    pub(super) fn part_bits(&mut self, object: u32) -> f64 {
        let size = self.image.size();
        self.scratch.segmentation.gather_object(object, size, &self.kind);
        if self.fitter.prototypes.is_empty() {
            let prices = self.fitter.options.prices;
            let grown = self.outline_of(object as usize, Freedom::Full);
            return grown.map_or(NO_FIT_BITS, |grown| {
                let rows = &grown.outline.rows;
                grown.bits.as_f64() - prices.equal_bits(rows.len()) + coefficient_bits(rows)
            });
        }
        self.search(object, Effort::Usual);
        let samples = &self.scratch.segmentation.segments()[object as usize].samples;
        let noise = T::one() / self.noise();
        let weights: T = samples.iter().map(|sample| (sample.weight * noise).powi(2)).sum();
        let best = self.scratch.candidates.first();
        best.map_or(NO_FIT_BITS, |best| (best.cost * weights * misfit_bits()).as_f64())
    }

    /// Objects from the back to the front; where the order is free, larger ones first.
    pub(super) fn painting_order(&self) -> Vec<u32> {
        let segmentation = &self.scratch.segmentation;
        let count = segmentation.segments().len();
        // Per object, how many behind it are not painted yet.
        let mut waiting = vec![0_usize; count];
        for border in segmentation.borders() {
            if let Some(front) = border.front {
                waiting[front as usize] += 1;
            }
        }
        let mut painted = vec![false; count];
        let mut order = Vec::with_capacity(count);
        for _ in 0..count {
            // Objects that hide one another in a circle have no order: the one that hides fewest goes first.
            let open = (0..count).filter(|&object| !painted[object]);
            let Some(next) = open.min_by_key(|&object| waiting[object]) else { break };
            painted[next] = true;
            #[expect(clippy::cast_possible_truncation, reason = "objects are numbered in u32")]
            let next = next as u32;
            order.push(next);
            for border in segmentation.borders() {
                if let Some(front) = border.front
                    && border.objects.contains(&next)
                    && front != next
                {
                    waiting[front as usize] = waiting[front as usize].saturating_sub(1);
                }
            }
        }
        order
    }
}
