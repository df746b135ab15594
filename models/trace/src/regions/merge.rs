//! Regions that grow by merging.

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;

use dvp_core::ImageView;
use dvp_core::geometry::DisjointSets;
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Boundary of a region that costs as much as that there is one more region, pixels.
const REGION_LENGTH: f64 = 16.0;
/// Squares that a pixel of a boundary is worth, in units of the variance of what is not seen: two natural logarithms for every bit, of which one is what
/// the next step of a boundary takes, and half of one its doubt.
const WORTH: f64 = 2.0;
/// Standard deviation of what is not seen, of 1.
const UNSEEN: f64 = 0.03;
/// What merges costs first is this share of what regions are worth, and then so many times as much, stage by stage.
const FIRST: f64 = 1.0 / 64.0;
/// See [`FIRST`].
const NEXT: f64 = 2.0;
/// A round in which a smaller share of the regions goes is the last one of its stage: the next stage merges those that are left, too.
const FEW: f64 = 0.05;

/// What is known of a region: pixels, and the sum of their colors.
#[derive(Clone, Copy)]
struct Region {
    pixels: f64,
    sum: [f64; 3],
}

impl Region {
    fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| sum / self.pixels)
    }

    fn with(&self, other: &Self) -> Self {
        Self { pixels: self.pixels + other.pixels, sum: core::array::from_fn(|c| self.sum[c] + other.sum[c]) }
    }
}

/// Two neighbors, the lower one first, and the length of the boundary between them, pixels.
#[derive(Clone, Copy)]
struct Border {
    between: [u32; 2],
    length: u32,
}

/// An order of numbers that is not that of the picture: where many borders cost the same, as in gradients of 8 bits, neighbors of the lowest one each
/// would be merged one pair after the other.
fn shuffled(at: usize) -> u32 {
    (at as u32).wrapping_mul(0x9e37_79b9)
}

/// Regions of a picture, and the borders between them.
pub(super) struct Merging {
    /// By root.
    regions: Vec<Region>,
    sets: DisjointSets,
    borders: Vec<Border>,
    count: usize,
}

impl Merging {
    /// Every pixel by itself, but for neighbors of one color.
    pub(super) fn of(image: &ImageView<'_, f32>) -> Self {
        let (width, pixels) = (image.size().width(), image.size().pixels());
        let regions = (0..pixels).map(|i| Region { pixels: 1.0, sum: image.pixel(i).map(f64::from) }).collect();
        let mut sets = DisjointSets::default();
        sets.reset(pixels as u32);
        let mut merging = Self { regions, sets, borders: Vec::new(), count: pixels };
        for i in 0..pixels {
            let right = ((i + 1) % width != 0).then_some(i + 1);
            let below = (i + width < pixels).then_some(i + width);
            for next in [right, below].into_iter().flatten() {
                let between = [i as u32, next as u32];
                if image.pixel(i).map(f32::to_bits) == image.pixel(next).map(f32::to_bits) {
                    merging.unite(between);
                } else {
                    merging.borders.push(Border { between, length: 1 });
                }
            }
        }
        merging.join_borders();
        merging
    }

    /// Makes one region of two, unless they are.
    fn unite(&mut self, between: [u32; 2]) {
        let [a, b] = between.map(|region| self.sets.root(region));
        if a != b {
            let region = self.regions[a as usize].with(&self.regions[b as usize]);
            let root = self.sets.unite(a, b);
            self.regions[root as usize] = region;
            self.count -= 1;
        }
    }

    /// Merges what is not worth a border, and then what is worth least until there are no more than `most`.
    pub(super) fn run(&mut self, most: usize, noise: f64) {
        let worth = WORTH * (noise * noise + UNSEEN * UNSEEN);
        let mut limit = FIRST * worth;
        while limit < worth {
            self.stage(limit, 1, FEW);
            limit *= NEXT;
        }
        // All that does not pay for itself.
        self.stage(worth, 1, 0.0);
        // What does stays, unless there is too much of it.
        while self.count > most && !self.borders.is_empty() {
            self.stage(limit, most, 0.0);
            limit *= NEXT;
        }
    }

    /// Rounds of merging at a cost within `limit`, down to `least` regions, until a share of no more than `few` of them goes in one.
    fn stage(&mut self, limit: f64, least: usize, few: f64) {
        loop {
            let before = self.count;
            self.round(limit, least);
            if (before - self.count) as f64 <= few * before as f64 {
                return;
            }
        }
    }

    /// Merges neighbors that are each other's best at a cost within `limit`, while there are more than `least`.
    fn round(&mut self, limit: f64, least: usize) {
        if self.count <= least {
            return;
        }
        let costs: Vec<f64> = self.borders.iter().map(|border| self.cost(border)).collect();
        let mut best = vec![u32::MAX; self.regions.len()];
        for (at, (border, &cost)) in self.borders.iter().zip(&costs).enumerate() {
            for region in border.between {
                let known = &mut best[region as usize];
                let is_better = |known: usize| match cost.total_cmp(&costs[known]) {
                    Ordering::Equal => shuffled(at) < shuffled(known),
                    order => order == Ordering::Less,
                };
                if *known == u32::MAX || is_better(*known as usize) {
                    *known = at as u32;
                }
            }
        }
        let is_mutual =
            |at: &usize| self.borders[*at].between.iter().all(|&region| best[region as usize] == *at as u32);
        let mut merged: Vec<usize> =
            (0..costs.len()).filter(|&at| costs[at] <= limit).filter(|at| is_mutual(at)).collect();
        if merged.is_empty() {
            return;
        }
        if self.count - merged.len() < least {
            sort::ascending(&mut merged, |&at| costs[at]);
            merged.truncate(self.count - least);
        }
        merged.into_iter().for_each(|at| self.unite(self.borders[at].between));
        self.join_borders();
    }

    /// By how much the squares that two regions miss grow if they become one, per pixel of the border between them.
    fn cost(&self, border: &Border) -> f64 {
        let [a, b] = border.between.map(|region| &self.regions[region as usize]);
        let (one, other) = (a.mean(), b.mean());
        let apart: f64 = (0..3).map(|c| (one[c] - other[c]).powi(2)).sum();
        a.pixels * b.pixels / (a.pixels + b.pixels) * apart / (f64::from(border.length) + REGION_LENGTH)
    }

    /// Borders between what is left; several between the same two are one.
    fn join_borders(&mut self) {
        for border in &mut self.borders {
            let [a, b] = border.between.map(|region| self.sets.root(region));
            border.between = [a.min(b), a.max(b)];
        }
        self.borders.retain(|border| border.between[0] != border.between[1]);
        self.borders.sort_unstable_by_key(|border| border.between);
        self.borders.dedup_by(|next, first| {
            let is_same = next.between == first.between;
            first.length += if is_same { next.length } else { 0 };
            is_same
        });
    }

    /// The region of every pixel, numbered as they come, and their colors.
    pub(super) fn finish(mut self) -> (Vec<u32>, Vec<[f32; 3]>) {
        let mut number = vec![u32::MAX; self.regions.len()];
        let mut colors = Vec::new();
        let labels = (0..self.regions.len() as u32).map(|pixel| {
            let root = self.sets.root(pixel) as usize;
            if number[root] == u32::MAX {
                number[root] = colors.len() as u32;
                colors.push(self.regions[root].mean().map(|value| value as f32));
            }
            number[root]
        });
        (labels.collect(), colors)
    }
}
