//! Neighboring regions merged, the least different first, until every boundary that is left pays for its length
//! (piecewise-constant Mumford-Shah by region merging; Koepfler, Lopez and Morel 1994).

use alloc::collections::{BTreeMap, BinaryHeap};
use alloc::vec::Vec;
use core::cmp::Reverse;

use crate::tuning::{HALO_COLOR, HALO_PIXELS, HALO_WIDTH_PX, REGION_LENGTH_PX};
use dvp_core::contour::{Connectivity, label_by};
use dvp_core::geometry::DisjointSets;
use dvp_core::{ImageView, Real};

/// Regions that cover all pixels, with their boundaries; kept between images as memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct Merger<T> {
    /// Pixels of one zone, then zones of one region.
    sets: DisjointSets,
    sums: Vec<[T; 3]>,
    counts: Vec<u32>,
    neighbors: Vec<Vec<u32>>,
    /// Boundary (px) between two regions, the lower first.
    lengths: BTreeMap<(u32, u32), u32>,
    queue: BinaryHeap<Reverse<(u64, u32, u32)>>,
    left: usize,
}

/// When to stop merging.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop<T> {
    /// Squared error that a pixel of boundary must save.
    pub(crate) price: T,
    /// Differences up to this share of the largest contrast around the smaller region are what compression left of it.
    pub(crate) halo: T,
    /// Fewest regions that merging goes on for regardless of the price.
    pub(crate) most_regions: usize,
}

fn pair(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

impl<T: Real> Merger<T> {
    /// Zones of pixels that differ by at most `tolerance` (per channel) from a direct neighbor in `smooth`, then merged by
    /// the colors of `image`. `labels` gets the number of each pixel's region, from 0; returns how many there are.
    pub(crate) fn partition(
        &mut self,
        image: &ImageView<'_, T>,
        smooth: &ImageView<'_, T>,
        tolerance: T,
        stop: Stop<T>,
        labels: &mut Vec<u32>,
    ) -> usize {
        self.find_zones(smooth, tolerance, labels);
        self.measure(image, labels);
        self.merge(stop);
        self.number(labels)
    }

    fn find_zones(&mut self, smooth: &ImageView<'_, T>, tolerance: T, labels: &mut Vec<u32>) {
        let [r, g, b] = [0, 1, 2].map(|c| smooth.channel(c));
        let alike =
            |i: usize, j: usize| (r[i] - r[j]).abs().max((g[i] - g[j]).abs()).max((b[i] - b[j]).abs()) <= tolerance;
        let zones = label_by(smooth.size(), Connectivity::Four, |_| true, alike);
        labels.clear();
        labels.extend(zones.labels.into_iter().map(|label| label - 1));
        self.left = zones.sizes.len();
    }

    /// From labels of zones to sums, boundaries and the queue of pairs.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
    fn measure(&mut self, image: &ImageView<'_, T>, labels: &[u32]) {
        let (width, zones) = (image.size().width(), self.left);
        self.sets.reset(zones as u32);
        self.sums.clear();
        self.sums.resize(zones, [T::zero(); 3]);
        self.counts.clear();
        self.counts.resize(zones, 0);
        self.neighbors.iter_mut().for_each(Vec::clear);
        self.neighbors.resize_with(self.neighbors.len().max(zones), Vec::new);
        self.lengths.clear();
        self.queue.clear();
        let mut steps: Vec<(u32, u32)> = Vec::new();
        for (i, &label) in labels.iter().enumerate() {
            let color = image.pixel(i);
            for (sum, part) in self.sums[label as usize].iter_mut().zip(color) {
                *sum += part;
            }
            self.counts[label as usize] += 1;
            if i % width != 0 && labels[i - 1] != label {
                steps.push(pair(labels[i - 1], label));
            }
            if i >= width && labels[i - width] != label {
                steps.push(pair(labels[i - width], label));
            }
        }
        steps.sort_unstable();
        for same in steps.chunk_by(|a, b| a == b) {
            let (a, b) = same[0];
            self.neighbors[a as usize].push(b);
            self.neighbors[b as usize].push(a);
            self.lengths.insert((a, b), same.len() as u32);
        }
        let cost = |(&(a, b), &length): (&(u32, u32), &u32)| Reverse((self.cost(a, b, length), a, b));
        self.queue = self.lengths.iter().map(cost).collect();
    }

    /// Squared error that merging adds, per boundary that it saves, as the bits of a number not below 0: they sort like it.
    fn cost(&self, a: u32, b: u32, length: u32) -> u64 {
        let [n, m] = [a, b].map(|region| T::of_usize(self.counts[region as usize] as usize));
        let added = self.contrast(a, b) * n * m / (n + m);
        (added.as_f64() / (f64::from(length) + REGION_LENGTH_PX)).max(0.0).to_bits()
    }

    fn merge(&mut self, stop: Stop<T>) {
        let price = stop.price.as_f64().to_bits();
        while let Some(Reverse((cost, a, b))) = self.queue.pop() {
            if cost > price && self.left <= stop.most_regions && stop.halo <= T::zero() {
                break;
            }
            let (a, b) = (self.sets.root(a), self.sets.root(b));
            let Some(&length) = self.lengths.get(&pair(a, b)) else { continue };
            let now = self.cost(a, b, length);
            if now > cost {
                // It grew since; a pair that fell was queued again when it did.
                self.queue.push(Reverse((now, a, b)));
            } else if now <= price || self.left > stop.most_regions || self.is_halo(a, b, now, stop.halo) {
                self.join(a, b);
            }
        }
    }

    /// Whether the smaller of two regions differs from the other by little, compared to the contrast that it stands beside.
    fn is_halo(&mut self, a: u32, b: u32, cost: u64, halo: T) -> bool {
        let small = if self.counts[a as usize] < self.counts[b as usize] { a } else { b };
        let mut most = T::zero();
        let mut boundary = 0;
        let mut neighbors = core::mem::take(&mut self.neighbors[small as usize]);
        neighbors.iter_mut().for_each(|other| *other = self.sets.root(*other));
        neighbors.sort_unstable();
        neighbors.dedup();
        for &other in &neighbors {
            most = most.max(self.contrast(small, other));
            boundary += self.lengths.get(&pair(small, other)).copied().unwrap_or(0);
        }
        self.neighbors[small as usize] = neighbors;
        let pixels = self.counts[small as usize];
        if pixels > HALO_PIXELS
            && 2 * pixels > HALO_WIDTH_PX * boundary
            && self.contrast(a, b) > T::of(HALO_COLOR * HALO_COLOR)
        {
            return false;
        }
        cost <= (halo * halo * most).as_f64().to_bits()
    }

    /// Squared difference of the colors of two regions.
    fn contrast(&self, a: u32, b: u32) -> T {
        let (a, b) = (a as usize, b as usize);
        let [n, m] = [self.counts[a], self.counts[b]].map(|count| T::of_usize(count as usize));
        let off = |c: usize| self.sums[a][c] / n - self.sums[b][c] / m;
        (0..3).map(|c| off(c) * off(c)).sum()
    }

    /// Merges two roots.
    fn join(&mut self, a: u32, b: u32) {
        let swap = self.neighbors[a as usize].len() < self.neighbors[b as usize].len();
        let (a, b) = if swap { (b, a) } else { (a, b) };
        self.left -= 1;
        self.sets.put_under(b, a);
        self.counts[a as usize] += self.counts[b as usize];
        let moved = self.sums[b as usize];
        for (sum, part) in self.sums[a as usize].iter_mut().zip(moved) {
            *sum += part;
        }
        self.lengths.remove(&pair(a, b));
        let moved = core::mem::take(&mut self.neighbors[b as usize]);
        for &other in &moved {
            let other = self.sets.root(other);
            // Already moved with another name, or the two that become one.
            let Some(length) = self.lengths.remove(&pair(b, other)) else { continue };
            let total = self.lengths.entry(pair(a, other)).or_insert(0);
            if *total == 0 {
                self.neighbors[a as usize].push(other);
                self.neighbors[other as usize].push(a);
            }
            *total += length;
            let total = *total;
            let cost = self.cost(a, other, total);
            self.queue.push(Reverse((cost, a, other)));
        }
    }

    /// Numbers the regions that are left in the order of their first pixels.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
    fn number(&mut self, labels: &mut [u32]) -> usize {
        const OPEN: u32 = u32::MAX;
        let mut names = core::mem::take(&mut self.counts);
        names.fill(OPEN);
        let mut count = 0;
        for label in labels.iter_mut() {
            let top = self.sets.root(*label) as usize;
            if names[top] == OPEN {
                names[top] = count as u32;
                count += 1;
            }
            *label = names[top];
        }
        self.counts = names;
        count
    }
}
