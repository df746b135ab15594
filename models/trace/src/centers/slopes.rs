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
    pub(super) depths: Vec<f64>,
    /// Of each number: by how much it changes each of the depths, and its lever.
    pub(super) columns: Vec<(Vec<f64>, f64)>,
}

impl Slopes {
    /// How numbers change so that outlines meet what they miss and miss nothing else, to first order.
    pub(super) fn change(&self, damping: f64, margin: f64) -> Option<Vec<f64>> {
        let Self { depths, columns } = self;
        let count = columns.len();
        // Every number may meet every other one.
        let mut normal = Skyline::new(vec![0; count]);
        let mut change = vec![0.0; count];
        let mut active = vec![false; depths.len()];
        for _ in 0..ROUNDS {
            // What is missed after the change so far, with what was missed before: it holds the outline where it gets to.
            let mut is_new = false;
            for (i, is_active) in active.iter_mut().enumerate() {
                let depth = depths[i]
                    + columns.iter().zip(&change).map(|((slopes, _), change)| slopes[i] * change).sum::<f64>();
                is_new |= depth < margin && !*is_active;
                *is_active |= depth < margin;
            }
            if !is_new {
                break;
            }
            let weight = 1.0 / (SOFT * SOFT);
            normal.clear();
            change.fill(0.0);
            for (number, (_, lever)) in columns.iter().enumerate() {
                normal.add_outer(&[(number, lever / LOOSE)], damping);
            }
            for i in (0..depths.len()).filter(|&i| active[i]) {
                let all = columns.iter().map(|(slopes, _)| slopes[i]).enumerate();
                let slopes: Vec<(usize, f64)> = all.filter(|&(_, slope)| slope != 0.0).collect();
                normal.add_outer(&slopes, weight);
                slopes.iter().for_each(|&(number, slope)| change[number] += weight * slope * (margin - depths[i]));
            }
            normal.factorize(0.0, 0.0)?;
            normal.solve(&mut change);
        }
        Some(change)
    }
}
