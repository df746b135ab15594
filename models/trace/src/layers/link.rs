//! Which visible stretch of a boundary goes on as which other behind what hides it.
//!
//! A walk around what is seen goes from one stretch to the next along the layer in front. Behind that layer the boundary may go on
//! otherwise: the outer circle of a ring that a bar crosses goes on to itself, and so does the inner one.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;

use crate::sample::{RingSamples, Sample};

/// Samples at the end of a stretch that tell its direction.
const TIP: usize = 4;

/// Price of a pixel on the way in which something else is seen, in squared radians: more than any turn.
const SEEN: f64 = 50.0;

/// The open stretches of rings linked again by the smoothest ways; none if these are the links that they have. `is_seen`: whether a pixel,
/// [column, row], is known to be of no hidden boundary.
pub(super) fn relinked(rings: &[RingSamples], is_seen: impl Fn(Vec2<f64>) -> bool) -> Option<Vec<RingSamples>> {
    let (closed, open): (Vec<&RingSamples>, Vec<&RingSamples>) = rings.iter().partition(|ring| ring.closed);
    let mut next: Vec<usize> = Vec::new();
    for ring in &open {
        let (first, count) = (next.len(), ring.runs.len());
        next.extend((0..count).map(|k| first + (k + 1) % count));
    }
    let runs: Vec<&Vec<Sample>> = open.iter().flat_map(|ring| &ring.runs).collect();
    let count = runs.len();
    if count < 2 {
        return None;
    }
    let tips: Vec<[Tip; 2]> =
        runs.iter().map(|run| Some([Tip::of(run.iter())?, Tip::of(run.iter().rev())?])).collect::<Option<_>>()?;
    let price = |from: usize, to: usize| tips[from][1].price(&tips[to][0], &is_seen);
    let prices: Vec<f64> = (0..count * count).map(|k| price(k / count, k % count)).collect();
    let mut is_changed = false;
    loop {
        let mut best = (1e-6, 0, 0);
        for a in 0..count {
            for b in 0..a {
                let now = prices[a * count + next[a]] + prices[b * count + next[b]];
                let then = prices[a * count + next[b]] + prices[b * count + next[a]];
                if now - then > best.0 {
                    best = (now - then, a, b);
                }
            }
        }
        let (_, a, b) = best;
        if a == b {
            break;
        }
        next.swap(a, b);
        is_changed = true;
    }
    if !is_changed {
        return None;
    }
    let mut linked: Vec<RingSamples> = closed.into_iter().cloned().collect();
    let mut is_done = vec![false; count];
    for first in 0..count {
        let mut ring = RingSamples::default();
        let mut k = first;
        while !is_done[k] {
            is_done[k] = true;
            ring.runs.push(runs[k].clone());
            k = next[k];
        }
        if !ring.runs.is_empty() {
            linked.push(ring);
        }
    }
    Some(linked)
}

/// The end of a stretch.
#[derive(Clone, Copy, Debug)]
struct Tip {
    at: Vec2<f64>,
    /// Into what is hidden, a unit vector.
    direction: Vec2<f64>,
}

impl Tip {
    /// The tip where `samples` begin.
    fn of<'a>(mut samples: impl Iterator<Item = &'a Sample>) -> Option<Self> {
        let at = samples.next()?.point;
        let inner = samples.take(TIP).last()?.point;
        Some(Self { at, direction: (at - inner).normalized()? })
    }

    /// What it takes to go on from here to where another stretch begins: the bending of the smoothest way (for small angles, whatever
    /// the distance), and the pixels that it must not pass.
    fn price(&self, to: &Self, is_seen: impl Fn(Vec2<f64>) -> bool) -> f64 {
        let chord = to.at - self.at;
        let Some(along) = chord.normalized() else { return 0.0 };
        let angle = |from: Vec2<f64>, to: Vec2<f64>| from.cross(to).atan2(from.dot(to));
        let (first, last) = (angle(self.direction, along), angle(along, -to.direction));
        let length = chord.length();
        let steps = length as usize;
        let seen = (2..steps.saturating_sub(1)).filter(|&k| is_seen(self.at + along * k as f64)).count();
        4.0 * (first * first + last * last - first * last) + SEEN * seen as f64 + 0.01 * length
    }
}
