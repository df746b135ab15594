//! Which color is reached after which way: measured, and as few stops as explain it.

use alloc::vec::Vec;

use dvp_core::scene::ColorStop;

use super::STEP;
use crate::partition::Color;

/// Colors along a way, one per pixel of it at most, where there is any.
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
        let mut sums = alloc::vec![(0.0, 0.0, [0.0; 3]); (high - low) as usize + 1];
        for (way, color) in samples {
            let (count, ways, colors) = &mut sums[(way - low) as usize];
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
        let [first, .., last] = &self.places[..] else {
            return (self.places.first().map_or([0.0; 3], |place| place.1), [0.0; 3]);
        };
        let _ = (first, last);
        let next = self.places.partition_point(|place| place.0 <= way).clamp(1, self.places.len() - 1);
        let ((from, a), (to, b)) = (self.places[next - 1], self.places[next]);
        let slope = [0, 1, 2].map(|c| (b[c] - a[c]) / (to - from));
        ([0, 1, 2].map(|c| a[c] + slope[c] * (way - from)), slope)
    }

    /// Whether nothing is missing between two places but a few pixels over which the color goes on as it did.
    pub(super) fn is_connected(&self, most_gap: f64) -> bool {
        self.places.windows(2).all(|pair| {
            let (gap, jump) = (pair[1].0 - pair[0].0, difference(pair[0].1, pair[1].1));
            gap <= 2.0 || gap <= most_gap && jump <= 3.0 * f64::from(STEP) + gap * self.steepest()
        })
    }

    /// Most that a channel changes over a pixel of the way.
    fn steepest(&self) -> f64 {
        let slopes = self.places.windows(2).filter(|pair| pair[1].0 - pair[0].0 <= 2.0);
        slopes.map(|pair| difference(pair[0].1, pair[1].1) / (pair[1].0 - pair[0].0)).fold(0.0, f64::max)
    }

    /// The fewest places between which straight ways explain all others within `tolerance`, by halving where most is missed; their colors by
    /// least squares.
    pub(super) fn simplified(&self, tolerance: f64) -> Self {
        let mut kept = alloc::vec![0, self.places.len() - 1];
        kept.dedup();
        loop {
            let rough = self.solved(&kept);
            let missed = self.places.iter().map(|&(way, color)| difference(rough.at(way).0, color));
            let worst = missed.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
            let Some((worst, _)) = worst.filter(|&(worst, missed)| missed > tolerance && !kept.contains(&worst)) else {
                return rough;
            };
            kept.push(worst);
            kept.sort_unstable();
        }
    }

    /// The colors at `kept` places with which straight ways between them are nearest to all places.
    fn solved(&self, kept: &[usize]) -> Self {
        let n = kept.len();
        let (mut diagonal, mut beside, mut right) =
            (alloc::vec![1e-9; n], alloc::vec![0.0; n], alloc::vec![[0.0; 3]; n]);
        for (i, color) in right.iter_mut().enumerate() {
            *color = self.places[kept[i]].1.map(|value| 1e-9 * value);
        }
        for (&(way, color), &count) in self.places.iter().zip(&self.counts) {
            let next = kept.partition_point(|&k| self.places[k].0 <= way).min(n - 1);
            let from = next.saturating_sub(1);
            let length = self.places[kept[next]].0 - self.places[kept[from]].0;
            let share = if length > 0.0 { (way - self.places[kept[from]].0) / length } else { 1.0 };
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
            for c in 0..3 {
                right[i][c] -= factor * right[i - 1][c];
            }
        }
        for i in (0..n).rev() {
            for c in 0..3 {
                let above = if i + 1 < n { beside[i] * right[i + 1][c] } else { 0.0 };
                right[i][c] = (right[i][c] - above) / diagonal[i];
            }
        }
        let places = kept.iter().zip(right).map(|(&k, color)| (self.places[k].0, color)).collect();
        Self { places, counts: alloc::vec![1.0; n] }
    }

    /// Stops, with the offset 0 at the way `from` and 1 at `to`.
    pub(super) fn stops(&self, [from, to]: [f64; 2]) -> Vec<ColorStop<f32>> {
        let stop = |&(way, color): &(f64, Color)| ColorStop {
            offset: ((way - from) / (to - from)) as f32,
            color: color.map(|value| value.clamp(0.0, 1.0) as f32),
        };
        self.places.iter().map(stop).collect()
    }
}

/// Most that two colors differ in a channel.
pub(super) fn difference(a: Color, b: Color) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
