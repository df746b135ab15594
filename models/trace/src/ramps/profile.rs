//! Which color is reached after which way: measured, and as few stops as explain it.

use alloc::vec::Vec;
use core::ops::Range;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::scene::ColorStop;

use super::STEP;
use crate::partition::Color;

/// Stops that are nearer (pixels) are one.
const SAME: f64 = 0.1;
/// Most stops of a ramp: artists take few.
const MOST_STOPS: usize = 8;
/// Least distance between stops, pixels: what changes over less is an edge.
const LEAST_APART: f64 = 1.0;

/// Places per pixel of a way: at a stop colors turn within one.
const PLACES: f64 = 2.0;

/// Mean colors along a way, where there are any.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile {
    /// Way and mean color, rising by way.
    pub(super) places: Vec<(f64, Color)>,
    /// Their numbers of pixels.
    counts: Vec<f64>,
}

impl Profile {
    /// The mean colors of samples, by way.
    pub(super) fn of(samples: impl Iterator<Item = (f64, Color)> + Clone) -> Self {
        let ways = || samples.clone().map(|(way, _)| way);
        let (low, high) =
            ways().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), way| (low.min(way), high.max(way)));
        if low > high {
            return Self::default();
        }
        let mut sums = alloc::vec![(0.0, 0.0, [0.0; 3]); (PLACES * (high - low)) as usize + 1];
        for (way, color) in samples {
            let (count, ways, colors) = &mut sums[(PLACES * (way - low)) as usize];
            *count += 1.0;
            *ways += way;
            colors.iter_mut().zip(color).for_each(|(sum, value)| *sum += value);
        }
        sums.retain(|&(count, ..)| count > 0.0);
        let places = sums.iter().map(|&(count, way, colors)| (way / count, colors.map(|sum| sum / count))).collect();
        Self { places, counts: sums.iter().map(|&(count, ..)| count).collect() }
    }

    /// The color after a way, and its slope there; beyond the ends as the last part goes on.
    pub(super) fn at(&self, way: f64) -> (Color, Color) {
        if self.places.len() < 2 {
            return (self.places.first().map_or([0.0; 3], |place| place.1), [0.0; 3]);
        }
        let next = self.places.partition_point(|place| place.0 <= way).clamp(1, self.places.len() - 1);
        let ((from, a), (to, b)) = (self.places[next - 1], self.places[next]);
        let slope = [0, 1, 2].map(|c| (b[c] - a[c]) / (to - from));
        ([0, 1, 2].map(|c| a[c] + slope[c] * (way - from)), slope)
    }

    /// Whether nothing is missing between two places but a few pixels over which the color goes on as it did.
    pub(super) fn is_connected(&self, most_gap: f64) -> bool {
        let steepest = self.steepest();
        self.places.windows(2).all(|pair| {
            let (gap, jump) = (pair[1].0 - pair[0].0, difference(pair[0].1, pair[1].1));
            gap <= 2.0 || gap <= most_gap && jump <= 3.0 * f64::from(STEP) + gap * steepest
        })
    }

    /// Most that a channel changes over a pixel of the way.
    fn steepest(&self) -> f64 {
        let slopes = self.places.windows(2).filter(|pair| pair[1].0 - pair[0].0 <= 2.0);
        slopes.map(|pair| difference(pair[0].1, pair[1].1) / (pair[1].0 - pair[0].0)).fold(0.0, f64::max)
    }

    /// Most that a channel changes from one place to any other.
    pub(super) fn range(&self) -> f64 {
        let ranges = (0..3).map(|c| {
            let values = self.places.iter().map(|(_, color)| color[c]);
            values.clone().fold(f64::NEG_INFINITY, f64::max) - values.fold(f64::INFINITY, f64::min)
        });
        ranges.fold(0.0, f64::max)
    }

    /// As few stops as explain all places within `tolerance`, straight ways between them: one more where most is missed, as long as that is too
    /// much and there are not too many, moved with the stops beside it to where they miss least.
    pub(super) fn simplified(&self, tolerance: f64) -> Self {
        let mut ways: Vec<f64> = self.places.iter().map(|place| place.0).collect();
        ways.drain(1..ways.len().saturating_sub(1).max(1));
        ways.dedup();
        let mut rough = self.solved(&ways).0;
        while ways.len() < MOST_STOPS {
            let is_far = |way: f64| ways.iter().all(|stop| (way - stop).abs() >= LEAST_APART);
            let others = self.places.iter().filter(|place| is_far(place.0));
            let missed = others.map(|&(way, color)| (way, difference(rough.at(way).0, color)));
            let worst = missed.max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((worst, _)) = worst.filter(|&(_, missed)| missed > tolerance) else { break };
            let index = ways.partition_point(|&way| way < worst);
            ways.insert(index, worst);
            rough = self.polished(&mut ways, index.saturating_sub(1)..index + 2);
        }
        rough
    }

    /// The stops near `ways` that miss least, those of `moving` moved; the first and the last stay.
    fn polished(&self, ways: &mut [f64], moving: Range<usize>) -> Self {
        let mut best = self.solved(ways);
        for step in [4.0, 1.0, 0.25] {
            for stop in moving.start.max(1)..moving.end.min(ways.len() - 1) {
                for by in [-step, step] {
                    loop {
                        let (old, room) = (ways[stop], 0.5 * LEAST_APART);
                        let moved = old + by;
                        if moved - ways[stop - 1] < room || ways[stop + 1] - moved < room {
                            break;
                        }
                        ways[stop] = moved;
                        let other = self.solved(ways);
                        if other.1 >= best.1 {
                            ways[stop] = old;
                            break;
                        }
                        best = other;
                    }
                }
            }
        }
        best.0
    }

    /// The colors of stops at `ways` with which straight ways between them are nearest to all places, and the squares that they leave.
    fn solved(&self, ways: &[f64]) -> (Self, f64) {
        let n = ways.len();
        let (mut diagonal, mut beside, mut right) =
            (alloc::vec![1e-9; n], alloc::vec![0.0; n], alloc::vec![[0.0; 3]; n]);
        for (way, color) in ways.iter().zip(&mut right) {
            *color = self.at(*way).0.map(|value| 1e-9 * value);
        }
        for (&(way, color), &count) in self.places.iter().zip(&self.counts) {
            let next = ways.partition_point(|&stop| stop <= way).min(n - 1);
            let from = next.saturating_sub(1);
            let length = ways[next] - ways[from];
            let share = if length > 0.0 { (way - ways[from]) / length } else { 1.0 };
            for (i, weight) in [(from, 1.0 - share), (next, share)] {
                diagonal[i] += count * weight * weight;
                right[i].iter_mut().zip(color).for_each(|(sum, value)| *sum += count * weight * value);
            }
            if from != next {
                beside[from] += count * share * (1.0 - share);
            }
        }
        for i in 1..n {
            let factor = beside[i - 1] / diagonal[i - 1];
            diagonal[i] -= factor * beside[i - 1];
            let before = right[i - 1];
            right[i].iter_mut().zip(before).for_each(|(value, before)| *value -= factor * before);
        }
        for i in (0..n).rev() {
            let behind = right.get(i + 1).copied().unwrap_or_default();
            right[i]
                .iter_mut()
                .zip(behind)
                .for_each(|(value, behind)| *value = (*value - beside[i] * behind) / diagonal[i]);
        }
        let solved = Self { places: ways.iter().copied().zip(right).collect(), counts: alloc::vec![1.0; n] };
        let left = self.places.iter().zip(&self.counts).map(|(&(way, color), count)| {
            let found = solved.at(way).0;
            count * (0..3).map(|c| (found[c] - color[c]).powi(2)).sum::<f64>()
        });
        let left = left.sum();
        (solved, left)
    }

    /// Goes on by `more` at both ends, as colors change there, but not below `least`.
    pub(super) fn reach(&mut self, more: f64, least: f64) {
        let Some((&(first, _), &(last, _))) = self.places.first().zip(self.places.last()) else { return };
        let ends = [(first - more).max(least), last + more].map(|way| (way, self.at(way).0));
        self.places[0] = ends[0];
        let end = self.places.len() - 1;
        self.places[end] = ends[1];
    }

    /// Stops, with the offset 0 at the way `from` and 1 at `to`. Where a channel leaves [0, 1], it stays at the bound from there on.
    pub(super) fn stops(&self, [from, to]: [f64; 2]) -> Vec<ColorStop<f32>> {
        let mut ways: Vec<f64> = self.places.iter().map(|place| place.0).collect();
        for pair in self.places.windows(2) {
            let (length, crossings) = (pair[1].0 - pair[0].0, (0..6).map(|k| (k % 3, f64::from(u8::from(k > 2)))));
            let shares = crossings.map(|(c, bound)| (bound - pair[0].1[c]) / (pair[1].1[c] - pair[0].1[c]));
            ways.extend(shares.filter(|share| *share > 0.0 && *share < 1.0).map(|share| pair[0].0 + share * length));
        }
        ways.sort_by(f64::total_cmp);
        ways.dedup_by(|next, way| *next - *way < SAME);
        let stop = |way: f64| ColorStop {
            offset: ((way - from) / (to - from)) as f32,
            color: self.at(way).0.map(|value| value.clamp(0.0, 1.0) as f32),
        };
        ways.into_iter().map(stop).collect()
    }
}

/// Most that two colors differ in a channel.
pub(super) fn difference(a: Color, b: Color) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
