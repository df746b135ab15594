//! What a drawing leaves open: how far its poses may be off, and which of its things have run together.

#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::contour::{contains, resample};
use dvp_core::{Drawing, Real as _};
use dvp_trace::ObjectDoubt;

use crate::Ambiguity;

/// Places of an outline that are asked whether others cover them.
const ASKED: usize = 64;

/// What is known of poses as a fit says it: covariances of (x, y, log scale, rotation, log stretch), NaN where nothing is known, and which
/// objects look alike at every angle.
pub(super) fn of_poses(doubts: &[ObjectDoubt]) -> (Vec<[f32; 25]>, Vec<Ambiguity>) {
    if doubts.iter().all(|doubt| doubt.pose.is_none()) {
        return (Vec::new(), Vec::new());
    }
    let mut ambiguity = Vec::new();
    let covariance = doubts.iter().enumerate().map(|(object, doubt)| {
        let Some(known) = &doubt.pose else { return [f32::NAN; 25] };
        if known.is_round {
            ambiguity.push(Ambiguity::Symmetry { object, order: 0 });
        }
        core::array::from_fn(|k| f32::of(known.numbers[k / 5][k % 5]))
    });
    let covariance = covariance.collect();
    (covariance, ambiguity)
}

/// Which objects have run together with others of their color: of each the first of those, and how much of its outline lies in none of them.
pub(super) fn merged(drawing: &Drawing<f32>, doubts: &[ObjectDoubt]) -> Vec<Ambiguity> {
    let merged = |object: usize| {
        let heap = doubts[object].heap?;
        let others = || (0..doubts.len()).filter(|&k| k != object && doubts[k].heap == Some(heap));
        let outline = resample(drawing.outline(object), ASKED);
        let is_hidden = |at: &&[f32; 2]| others().any(|other| contains(drawing.outline(other), **at));
        let hidden = outline.iter().filter(is_hidden).count();
        let visible = 1.0 - hidden as f64 / ASKED as f64;
        Some(Ambiguity::Merged { object, other: others().next()?, visible })
    };
    (0..doubts.len()).filter_map(merged).collect()
}
