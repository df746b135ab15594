//! What a drawing leaves open: how far its poses may be off, and which of its things have run together.

use alloc::vec::Vec;

use dvp_core::contour::contains;
use dvp_core::{Drawing, Real as _};
use dvp_trace::PoseCovariance;

use crate::Ambiguity;

/// What is known of poses as a fit says it: covariances of (x, y, log scale, rotation, log stretch), NaN where nothing is known, and which
/// objects look alike at every angle.
pub(super) fn of_poses(known: &[Option<PoseCovariance>]) -> (Vec<[f32; 25]>, Vec<Ambiguity>) {
    if known.iter().all(Option::is_none) {
        return (Vec::new(), Vec::new());
    }
    let mut ambiguity = Vec::new();
    let covariance = known.iter().enumerate().map(|(object, known)| {
        let Some(known) = known else { return [f32::NAN; 25] };
        if known.is_round {
            ambiguity.push(Ambiguity::Symmetry { object, order: 0 });
        }
        core::array::from_fn(|k| f32::of(known.numbers[k / 5][k % 5]))
    });
    let covariance = covariance.collect();
    (covariance, ambiguity)
}

/// Which objects have run together with others of their color: of each the first of those, and how much of its outline lies in none of them.
pub(super) fn merged(drawing: &Drawing<f32>, known: &[Option<PoseCovariance>]) -> Vec<Ambiguity> {
    let heap = |k: usize| known[k].as_ref().and_then(|known| known.heap);
    let merged = |object: usize| {
        let own = heap(object)?;
        let others = || (0..known.len()).filter(|&k| k != object && heap(k) == Some(own));
        let outline = drawing.outline(object);
        let is_hidden = |at: &&[f32; 2]| others().any(|other| contains(drawing.outline(other), **at));
        let hidden = outline.iter().filter(is_hidden).count();
        let visible = 1.0 - hidden as f64 / outline.len() as f64;
        Some(Ambiguity::Merged { object, other: others().next()?, visible })
    };
    (0..known.len()).filter_map(merged).collect()
}
