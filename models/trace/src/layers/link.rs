//! Which visible stretch of a boundary goes on as which other behind what hides it.
//!
//! A walk around what is seen goes from one stretch to the next along the layer in front. Behind that layer the boundary may go on
//! otherwise: the outer circle of a ring that a bar crosses goes on to itself, and so does the inner one.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::sort;

use crate::sample::{RingSamples, Sample};

/// Samples at the end of a stretch that tell its direction.
const TIP: usize = 4;

/// Price of a pixel on the way in which something else is seen, in squared radians: some of them are more than any turn.
const SEEN: f64 = 5.0;

/// Fewest samples of a stretch that is linked: less tells no direction.
const LEAST_RUN: usize = 2;

/// The open stretches of rings linked again, by the ways that bend least first: at most `most` of them, without the links that they have.
/// `is_seen`: whether a place, pixels, is known to be of no hidden boundary.
pub(super) fn relinked(
    rings: &[RingSamples],
    is_seen: impl Fn(Vec2<f64>) -> bool,
    most: usize,
) -> Vec<Vec<RingSamples>> {
    let (closed, open): (Vec<&RingSamples>, Vec<&RingSamples>) = rings.iter().partition(|ring| ring.closed);
    let mut next: Vec<usize> = Vec::new();
    let mut runs: Vec<&Vec<Sample>> = Vec::new();
    for ring in &open {
        let first = next.len();
        runs.extend(ring.runs.iter().filter(|run| run.len() >= LEAST_RUN));
        let count = runs.len() - first;
        next.extend((0..count).map(|k| first + (k + 1) % count));
    }
    let count = runs.len();
    if count < 2 {
        return Vec::new();
    }
    let tips: Option<Vec<[Tip; 2]>> =
        runs.iter().map(|run| Some([Tip::of(run.iter())?, Tip::of(run.iter().rev())?])).collect();
    let Some(tips) = tips else { return Vec::new() };
    let price = |from: usize, to: usize| tips[from][1].price(&tips[to][0], &is_seen);
    let prices: Vec<f64> = (0..count * count).map(|k| price(k / count, k % count)).collect();
    let price = |from: usize, to: usize| prices[from * count + to];
    let mut ways = if count <= MOST_PERMUTED { permutations(count) } else { vec![swapped(next.clone(), price)] };
    ways.retain(|way| *way != next);
    sort::ascending(&mut ways, |way| way.iter().enumerate().map(|(from, &to)| price(from, to)).sum::<f64>());
    ways.truncate(most);
    ways.iter().map(|way| closed.iter().map(|&ring| ring.clone()).chain(followed(way, &runs)).collect()).collect()
}

/// Most stretches whose every link is tried.
const MOST_PERMUTED: usize = 5;

/// All orders of the first numbers.
fn permutations(count: usize) -> Vec<Vec<usize>> {
    let mut all = vec![Vec::new()];
    for _ in 0..count {
        let longer = |order: &Vec<usize>| {
            let order = order.clone();
            let free = (0..count).filter({
                let order = order.clone();
                move |k| !order.contains(k)
            });
            free.map(move |k| order.iter().copied().chain([k]).collect()).collect::<Vec<Vec<usize>>>()
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
}

/// What follows each stretch, with two exchanged again and again as long as that costs less. `price`: of a link from one stretch to another.
fn swapped(mut next: Vec<usize>, price: impl Fn(usize, usize) -> f64) -> Vec<usize> {
    loop {
        let mut best = (-1e-6, 0, 0);
        for a in 0..next.len() {
            for b in 0..a {
                let before = price(a, next[a]) + price(b, next[b]);
                let change = price(a, next[b]) + price(b, next[a]) - before;
                if change < best.0 {
                    best = (change, a, b);
                }
            }
        }
        let (_, a, b) = best;
        if a == b {
            return next;
        }
        next.swap(a, b);
    }
}

/// Square pixels that the polygon through the samples of a ring encloses, negative where it goes around what is free.
pub(super) fn area(ring: &RingSamples) -> f64 {
    let points: Vec<Vec2<f64>> = ring.runs.iter().flatten().map(|sample| sample.point).collect();
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(point, next)| 0.5 * point.cross(*next)).sum()
}

/// The rings that stretches make, each followed by the one that `next` names.
fn followed(next: &[usize], runs: &[&Vec<Sample>]) -> Vec<RingSamples> {
    let mut is_done = vec![false; next.len()];
    let mut rings = Vec::new();
    for first in 0..next.len() {
        let mut ring = RingSamples::default();
        let mut k = first;
        while !is_done[k] {
            is_done[k] = true;
            ring.runs.push(runs[k].clone());
            k = next[k];
        }
        if !ring.runs.is_empty() {
            rings.push(ring);
        }
    }
    rings
}

/// The end of a stretch.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tip {
    pub(super) at: Vec2<f64>,
    /// Into what is hidden, a unit vector.
    pub(super) direction: Vec2<f64>,
}

impl Tip {
    /// The tip where `samples` begin.
    pub(super) fn of<'a>(mut samples: impl Iterator<Item = &'a Sample>) -> Option<Self> {
        let at = samples.next()?.point;
        let inner = samples.take(TIP).last()?.point;
        Some(Self { at, direction: (at - inner).normalized()? })
    }

    /// What it takes to go on from here to where another stretch begins: the bending of the smoothest way, a cubic curve, and the pixels
    /// that it must not pass.
    fn price(&self, to: &Self, is_seen: impl Fn(Vec2<f64>) -> bool) -> f64 {
        let chord = to.at - self.at;
        let Some(along) = chord.normalized() else { return 0.0 };
        let angle = |from: Vec2<f64>, to: Vec2<f64>| from.cross(to).atan2(from.dot(to));
        let (first, last) = (angle(self.direction, along), angle(along, -to.direction));
        let length = chord.length();
        // The handles of a circular arc, for half the turn at each end.
        let handle = |angle: f64| length * 2.0 / 3.0 / (1.0 + angle.cos().max(-0.5));
        let (out, back) = (self.at + self.direction * handle(first), to.at + to.direction * handle(last));
        let at = |t: f64| {
            let s = 1.0 - t;
            self.at * (s * s * s) + out * (3.0 * s * s * t) + back * (3.0 * s * t * t) + to.at * (t * t * t)
        };
        let steps = (length as usize).min(MOST_STEPS);
        let seen = (2..steps.saturating_sub(1)).filter(|&k| is_seen(at(k as f64 / steps as f64))).count();
        let turned = 4.0 * (first * first + last * last - first * last);
        BENT * turned / length.max(1.0) + turned + SEEN * seen as f64 + 0.01 * length
    }
}

/// Price of bending by one radian within a pixel, beside that of the turn itself.
const BENT: f64 = 4.0;

/// Most places of a way that are looked at.
const MOST_STEPS: usize = 64;
