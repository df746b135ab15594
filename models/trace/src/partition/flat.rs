//! What is of one color beyond doubt: blocks of two by two pixels that are equal up to noise.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;

use super::NoPartition;
use crate::tuning;

/// How far pixels of one color differ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// Most difference of a channel inside a flat block.
    pub(super) flat: f32,
    /// Most difference of a channel from the mixture that explains a pixel.
    pub(super) mixed: f32,
    /// Standard deviation of a channel in a pixel of an edge.
    pub(super) sigma: f64,
    /// Least difference of a channel that makes a color of its own of pixels that nothing else explains.
    pub(super) contrast: f64,
    /// Fewest pixels that do.
    pub(super) fewest: usize,
}

/// Pixels in flat blocks, and the regions that these make.
#[derive(Debug)]
pub(super) struct Flats {
    /// Region of every pixel; `NONE` outside of flat blocks.
    pub(super) regions: Vec<u32>,
    /// Mean color and pixels of every region.
    pub(super) means: Vec<([f64; 3], usize)>,
}

/// Marks pixels that are in no flat block.
pub(super) const NONE: u32 = u32::MAX;

impl Noise {
    /// From the blocks themselves: in a clean picture nearly all that are not equal are edges; noise leaves many that differ a little.
    pub(super) fn of(pixels: &[[f32; 3]], size: [usize; 2], coded: bool) -> Result<Self, NoPartition> {
        if coded {
            return Ok(Self {
                flat: tuning::CODED_STEP,
                mixed: tuning::CODED_MIX,
                sigma: tuning::CODED_SIGMA,
                contrast: tuning::CODED_CONTRAST,
                fewest: tuning::CODED_THIN,
            });
        }
        let [mut little, mut much] = [0usize; 2];
        for range in ranges(pixels, size, [1.0; 3]).map(|(_, range)| range) {
            if range > tuning::CLEAN_STEP && range <= tuning::CODED_STEP {
                little += 1;
            } else if range > tuning::CODED_STEP {
                much += 1;
            }
        }
        if little > tuning::NOISY_BLOCKS * much {
            return Err(NoPartition::Noisy);
        }
        Ok(Self {
            flat: tuning::CLEAN_STEP,
            mixed: tuning::CLEAN_MIX,
            sigma: tuning::ROUNDING,
            contrast: tuning::LEAST_CONTRAST,
            fewest: tuning::LEAST_THIN,
        })
    }
}

impl Noise {
    /// Weights of the channels where pixels or regions of one color are compared: color differences of coded pictures, which pass slowly into one
    /// another, are not made less of there.
    pub(super) fn weights(&self) -> [f32; 3] {
        let color = if self.is_coded() { 1.0 / tuning::CODED_COLOR_WEIGHT as f32 } else { 1.0 };
        [1.0, color, color]
    }

    /// How often colors are looked for around a pixel, further off each time.
    pub(super) fn reaches(&self) -> usize {
        if self.is_coded() { 2 } else { 1 }
    }

    /// Whether it is that of a coder.
    pub(super) fn is_coded(&self) -> bool {
        self.flat > tuning::CLEAN_STEP
    }
}

impl Flats {
    /// How many pixels are in flat blocks.
    pub(super) fn pure_count(&self) -> usize {
        self.means.iter().map(|&(_, count)| count).sum()
    }

    /// Numbers the regions anew, those that are not kept left out.
    pub(super) fn keep(&mut self, is_kept: &[bool]) {
        let mut number = vec![NONE; is_kept.len()];
        let kept = is_kept.iter().enumerate().filter(|&(_, &kept)| kept).map(|(region, _)| region);
        kept.enumerate().for_each(|(new, region)| number[region] = index(new));
        for region in self.regions.iter_mut().filter(|region| **region != NONE) {
            *region = number[*region as usize];
        }
        let mut kept = is_kept.iter();
        self.means.retain(|_| kept.next().copied().unwrap_or(false));
    }
}

/// Upper left corner (pixel index) of every block of two by two pixels, and the most that a channel, times its weight, differs inside.
fn ranges(pixels: &[[f32; 3]], [width, height]: [usize; 2], weights: [f32; 3]) -> impl Iterator<Item = (usize, f32)> {
    let blocks = (0..height.saturating_sub(1)).flat_map(move |y| (0..width - 1).map(move |x| y * width + x));
    blocks.map(move |i| {
        let four = [pixels[i], pixels[i + 1], pixels[i + width], pixels[i + width + 1]];
        let range = |c: usize| {
            let [low, high] =
                four.iter().fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], p| [low.min(p[c]), high.max(p[c])]);
            weights[c] * (high - low)
        };
        (i, range(0).max(range(1)).max(range(2)))
    })
}

pub(super) fn find(pixels: &[[f32; 3]], size: [usize; 2], noise: &Noise) -> Flats {
    let width = size[0];
    let mut sets = DisjointSets::default();
    sets.reset(u32::try_from(pixels.len()).unwrap_or(NONE));
    let mut is_flat = vec![false; pixels.len()];
    // The last block that was flat, and those of the row above.
    let (mut last, mut above) = (None, vec![false; width]);
    for (i, range) in ranges(pixels, size, noise.weights()) {
        let is_block = range <= noise.flat;
        let is_above_flat = core::mem::replace(&mut above[i % width], is_block);
        if !is_block {
            continue;
        }
        // What two blocks share is of one region already.
        let is_left_flat = last.is_some_and(|last: usize| last + 1 == i);
        last = Some(i);
        for (j, is_united) in [(i + 1, is_above_flat), (i + width, is_left_flat), (i + width + 1, false)] {
            is_flat[j] = true;
            if !is_united {
                sets.unite(index(i), index(j));
            }
        }
        is_flat[i] = true;
    }
    let mut number = vec![NONE; pixels.len()];
    let mut means: Vec<([f64; 3], usize)> = Vec::new();
    let mut regions = vec![NONE; pixels.len()];
    for (i, pixel) in pixels.iter().enumerate().filter(|&(i, _)| is_flat[i]) {
        let root = sets.root(index(i)) as usize;
        if number[root] == NONE {
            number[root] = index(means.len());
            means.push(([0.0; 3], 0));
        }
        let (sum, count) = &mut means[number[root] as usize];
        for (total, &value) in sum.iter_mut().zip(pixel) {
            *total += f64::from(value);
        }
        *count += 1;
        regions[i] = number[root];
    }
    for (sum, count) in &mut means {
        *sum = sum.map(|total| total / *count as f64);
    }
    Flats { regions, means }
}

/// An index into pixels: pictures have fewer than 2^32 of them.
pub(super) fn index(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(NONE)
}
