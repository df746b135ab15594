//! How far outlines are from the middles of pixels when their numbers change, and the change that meets what is missed.

use alloc::vec;
use alloc::vec::Vec;

use crate::outline::Skyline;

/// How exactly, pixels.
const SOFT: f64 = 0.01;
/// How far a number moves for a pixel that is on the wrong side by the same, pixels.
const LOOSE: f64 = 0.5;
/// Rounds in which what a step would miss is added to what it is held by.
const ROUNDS: usize = 6;

/// How depths change with numbers.
pub(super) struct Slopes {
    /// Of each number: how far, pixels, it moves an outline for a change of 1.
    pub(super) levers: Vec<f64>,
    pub(super) depths: Vec<Depth>,
}

/// How far an outline is from the middle of a pixel, and by how much the few numbers of the curve that is nearest change that, in their order.
pub(super) struct Depth {
    pub(super) value: f64,
    pub(super) slopes: Vec<(usize, f64)>,
}

impl Depth {
    /// After a change of all numbers, to first order.
    fn after(&self, change: &[f64]) -> f64 {
        self.value + self.slopes.iter().map(|&(number, slope)| slope * change[number]).sum::<f64>()
    }
}

impl Slopes {
    /// How numbers change so that outlines meet what they miss and miss nothing else, to first order.
    pub(super) fn change(&self, damping: f64, margin: f64) -> Option<Vec<f64>> {
        let Self { levers, depths } = self;
        // Numbers meet those of the same curve and of the next one.
        let mut first: Vec<usize> = (0..levers.len()).collect();
        for Depth { slopes, .. } in depths {
            let least = slopes.first().map_or(0, |&(number, _)| number);
            slopes.iter().for_each(|&(number, _)| first[number] = first[number].min(least));
        }
        let mut normal = Skyline::new(first);
        let mut change = vec![0.0; levers.len()];
        let mut active = vec![false; depths.len()];
        for _ in 0..ROUNDS {
            // What is missed after the change so far, with what was missed before: it holds the outline where it gets to.
            let mut is_new = false;
            for (depth, is_active) in depths.iter().zip(&mut active) {
                let is_missed = depth.after(&change) < margin;
                is_new |= is_missed && !*is_active;
                *is_active |= is_missed;
            }
            if !is_new {
                break;
            }
            let weight = 1.0 / (SOFT * SOFT);
            normal.clear();
            change.fill(0.0);
            for (number, lever) in levers.iter().enumerate() {
                normal.add_outer(&[(number, lever / LOOSE)], damping);
            }
            for Depth { value, slopes } in
                depths.iter().zip(&active).filter_map(|(depth, active)| active.then_some(depth))
            {
                normal.add_outer(slopes, weight);
                slopes.iter().for_each(|&(number, slope)| change[number] += weight * slope * (margin - value));
            }
            normal.factorize(0.0, 0.0)?;
            normal.solve(&mut change);
        }
        Some(change)
    }
}
