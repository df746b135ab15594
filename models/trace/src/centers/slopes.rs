//! How far outlines are from the middles of pixels when their numbers change, and the change that meets what is missed.

use alloc::vec;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

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
        let mut normal = vec![0.0; count * count];
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
            let held = || (0..depths.len()).filter(|&i| active[i]);
            for i in 0..count {
                let (slopes, lever) = &columns[i];
                for j in 0..=i {
                    normal[i * count + j] = held().map(|k| slopes[k] * columns[j].0[k]).sum::<f64>() / (SOFT * SOFT);
                }
                normal[i * count + i] += damping * (lever / LOOSE).powi(2);
                change[i] = held().map(|k| slopes[k] * (margin - depths[k])).sum::<f64>() / (SOFT * SOFT);
            }
            if !solve(&mut normal, &mut change) {
                return None;
            }
        }
        Some(change)
    }
}

/// Solves normal equations, of which the lower triangle is given; false if they are singular.
fn solve(normal: &mut [f64], right: &mut [f64]) -> bool {
    let count = right.len();
    for i in 0..count {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| normal[i * count + k] * normal[j * count + k]).sum();
            let value = normal[i * count + j] - sum;
            if i == j {
                if value.is_nan() || value <= 0.0 {
                    return false;
                }
                normal[i * count + i] = value.sqrt();
            } else {
                normal[i * count + j] = value / normal[j * count + j];
            }
        }
    }
    for i in 0..count {
        let sum: f64 = (0..i).map(|k| normal[i * count + k] * right[k]).sum();
        right[i] = (right[i] - sum) / normal[i * count + i];
    }
    for i in (0..count).rev() {
        let sum: f64 = (i + 1..count).map(|k| normal[k * count + i] * right[k]).sum();
        right[i] = (right[i] - sum) / normal[i * count + i];
    }
    true
}
