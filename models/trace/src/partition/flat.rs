//! What is of one color beyond doubt: blocks of two by two pixels that are equal up to noise.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::geometry::DisjointSets;

use super::runs::{renumber, runs};
use super::{NoPartition, Reading};
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
    /// How the picture is read.
    pub(super) reading: Reading,
}

/// Pixels in flat blocks, and the regions that these make.
#[derive(Debug)]
pub(super) struct Flats {
    /// Region of every pixel; `NONE` outside of flat blocks.
    pub(super) regions: Vec<u32>,
    /// Mean color and pixels of every region.
    pub(super) means: Vec<([f64; 3], usize)>,
    /// Blocks that differ by more than what is equal in a clean picture, but no more than what is in a coded one; and those that differ by more.
    unequal: [usize; 2],
}

/// Marks pixels that are in no flat block.
pub(super) const NONE: u32 = u32::MAX;

impl Noise {
    /// Of a picture that is read in some way.
    pub(super) fn of(reading: Reading) -> Self {
        let Reading { coded, noise, .. } = reading;
        let clean = Self {
            flat: tuning::CLEAN_STEP,
            mixed: tuning::CLEAN_MIX,
            sigma: tuning::ROUNDING,
            contrast: tuning::LEAST_CONTRAST,
            fewest: tuning::LEAST_THIN,
            reading,
        };
        if coded {
            return Self {
                flat: tuning::CODED_STEP,
                mixed: tuning::CODED_MIX,
                sigma: tuning::CODED_SIGMA,
                contrast: tuning::CODED_CONTRAST,
                fewest: tuning::CODED_THIN,
                ..clean
            };
        }
        if noise > 0.0 {
            let mixed = tuning::CLEAN_MIX + tuning::NOISY_MIX * noise;
            return Self {
                flat: tuning::CLEAN_STEP + tuning::NOISY_STEP * noise,
                mixed,
                sigma: tuning::ROUNDING.hypot(tuning::NOISY_SIGMA * f64::from(noise)),
                contrast: tuning::LEAST_CONTRAST.max(2.0 * f64::from(mixed)),
                fewest: tuning::CODED_THIN,
                ..clean
            };
        }
        clean
    }

    /// Whether nothing is known to have changed the flat parts of the picture.
    pub(super) fn is_clean(&self) -> bool {
        !self.reading.coded && self.reading.noise <= 0.0
    }

    /// Weights of the channels where pixels or regions of one color are compared: color differences of coded pictures, which pass slowly into one
    /// another, are not made less of there.
    pub(super) fn weights(&self) -> [f32; 3] {
        let color = if self.reading.coded { 1.0 / tuning::CODED_COLOR_WEIGHT as f32 } else { 1.0 };
        [1.0, color, color]
    }

    /// How often colors are looked for around a pixel, further off each time.
    pub(super) fn reaches(&self) -> usize {
        match self.reading {
            Reading { soft: true, .. } => 3,
            Reading { coded: true, .. } => 2,
            _ => 1,
        }
    }
}

impl Flats {
    /// How many pixels are in flat blocks.
    pub(super) fn pure_count(&self) -> usize {
        self.means.iter().map(|&(_, count)| count).sum()
    }

    /// How many blocks differ a little, or values turn back by a little, whichever is less, per block that differs much, in a clean picture: what coders
    /// and filters leave beside edges. Near colors leave such blocks, fine details such values.
    ///
    /// # Errors
    /// If it is not clean: nearly all blocks that are not equal are edges in such a picture, and noise leaves many that differ a little.
    pub(super) fn ripple(&self, pixels: &[[f32; 3]], size: [usize; 2]) -> Result<f64, NoPartition> {
        let [little, much] = self.unequal;
        if little > tuning::NOISY_BLOCKS * much {
            return Err(NoPartition::Noisy);
        }
        let per_much = |count: usize| count as f64 / much.max(1) as f64;
        let blocks = per_much(little);
        Ok(if blocks > tuning::RIPPLED { blocks.min(per_much(turns(pixels, size) / 3)) } else { blocks })
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

/// Calls `row` for every row of blocks of two by two pixels with what differs most in each: a channel, times its weight.
fn ranges(pixels: &[[f32; 3]], size: [usize; 2], weights: [f32; 3], mut row: impl FnMut(&[f32])) {
    let [width, _] = size;
    let weights: Vec<f32> = (0..3 * width.saturating_sub(1)).map(|k| weights[k % 3]).collect();
    let [mut low, mut high] = [vec![0.0; 3 * width], vec![0.0; 3 * width]];
    let (mut of_channels, mut most) = (vec![0.0; weights.len()], vec![0.0; weights.len() / 3]);
    // What is not finite never comes here, and `f32::max` would ask for it.
    let [min, max] = [|a: f32, b: f32| if a < b { a } else { b }, |a: f32, b: f32| if a > b { a } else { b }];
    let rows = || pixels.chunks_exact(width).map(<[_]>::as_flattened);
    for (upper, lower) in rows().zip(rows().skip(1)) {
        for (((low, high), &a), &b) in low.iter_mut().zip(&mut high).zip(upper).zip(lower) {
            (*low, *high) = (min(a, b), max(a, b));
        }
        let [lows, highs] = [&low, &high].map(|values| values.iter().zip(&values[3..]));
        for (((of, weight), (&a, &b)), (&c, &d)) in of_channels.iter_mut().zip(&weights).zip(lows).zip(highs) {
            *of = weight * (max(c, d) - min(a, b));
        }
        for (most, of) in most.iter_mut().zip(of_channels.as_chunks::<3>().0) {
            *most = max(max(of[0], of[1]), of[2]);
        }
        row(&most);
    }
}

/// How often a channel turns back by a little, along a row or a column. Edges go one way, whatever their colors and slopes are, and thin things go
/// there and back by their contrast; what coders and filters leave swings.
fn turns(pixels: &[[f32; 3]], [width, _]: [usize; 2]) -> usize {
    let turns_back = |before: f32, at: f32, after: f32| {
        let (from, to) = (at - before, at - after);
        let least = if from.abs() < to.abs() { from.abs() } else { to.abs() };
        u32::from((from * to > 0.0) & (least > tuning::CLEAN_STEP) & (least <= tuning::CODED_STEP))
    };
    let count = |before: &[f32], at: &[f32], after: &[f32]| {
        before.iter().zip(at).zip(after).map(|((&before, &at), &after)| turns_back(before, at, after)).sum::<u32>()
            as usize
    };
    let rows = |skipped| pixels.chunks_exact(width).map(<[_]>::as_flattened).skip(skipped);
    let along = rows(0).map(|row| row.get(6..).map_or(0, |after| count(row, &row[3..], after)));
    let across = rows(0).zip(rows(1)).zip(rows(2)).map(|((above, at), below)| count(above, at, below));
    along.chain(across).sum()
}

/// Whether one of the blocks that a pixel (its index) is in is flat.
pub(super) fn is_flat_at(pixels: &[[f32; 3]], [width, height]: [usize; 2], noise: &Noise, pixel: usize) -> bool {
    let (x, y) = (pixel % width, pixel / width);
    let weights = noise.weights();
    let is_flat = |first: usize| {
        let block = [first, first + 1, first + width, first + width + 1].map(|i| pixels[i]);
        (0..3).all(|c| {
            let values = block.map(|pixel| pixel[c]);
            let [low, high] =
                [values.into_iter().fold(values[0], f32::min), values.into_iter().fold(values[0], f32::max)];
            weights[c] * (high - low) <= noise.flat
        })
    };
    let rows = y.saturating_sub(1)..(y + 1).min(height.saturating_sub(1));
    rows.flat_map(|row| {
        (x.saturating_sub(1)..(x + 1).min(width.saturating_sub(1))).map(move |column| row * width + column)
    })
    .any(is_flat)
}

/// Finds the flat blocks of a picture. Blocks that share a pixel are of one region: runs of blocks are joined with those above that they touch.
pub(super) fn find(pixels: &[[f32; 3]], size: [usize; 2], noise: &Noise) -> Flats {
    let [width, _] = size;
    // Runs of flat blocks are numbered row by row; where pixels are of several they hold the last one.
    let mut regions = vec![NONE; pixels.len()];
    let mut sets = DisjointSets::default();
    let [mut above, mut row]: [Vec<(Range<usize>, u32)>; 2] = [Vec::new(), Vec::new()];
    let mut is_flat = vec![false; width.saturating_sub(1)];
    let mut unequal = [0; 2];
    let mut first = 0;
    ranges(pixels, size, noise.weights(), |ranges| {
        is_flat.iter_mut().zip(ranges).for_each(|(is_flat, &range)| *is_flat = range <= noise.flat);
        let more_than = |step: f32| ranges.iter().map(|&range| u32::from(range > step)).sum::<u32>() as usize;
        let [some, most] = [tuning::CLEAN_STEP, tuning::CODED_STEP].map(more_than);
        unequal = [unequal[0] + some - most, unequal[1] + most];
        core::mem::swap(&mut above, &mut row);
        row.clear();
        let mut next = 0;
        for (_, blocks) in runs(&is_flat).filter(|&(is_flat, _)| is_flat) {
            let number = sets.push();
            while above.get(next).is_some_and(|(other, _)| other.end < blocks.start) {
                next += 1;
            }
            let touching = above[next..].iter().take_while(|(other, _)| other.start <= blocks.end);
            touching.for_each(|&(_, other)| _ = sets.unite(other, number));
            for y in [first, first + width] {
                regions[y + blocks.start..=y + blocks.end].fill(number);
            }
            row.push((blocks, number));
        }
        first += width;
    });
    // A region is known by its first run: they are numbered in the order of their first pixels.
    let mut number = vec![NONE; sets.len()];
    let mut means: Vec<([f64; 3], usize)> = Vec::new();
    for (pixels, regions) in pixels.chunks_exact(width).zip(regions.chunks_exact_mut(width)) {
        renumber(regions, |run, columns| {
            if run == NONE {
                return NONE;
            }
            let root = sets.root(run) as usize;
            if number[root] == NONE {
                number[root] = index(means.len());
                means.push(([0.0; 3], 0));
            }
            let (sum, count) = &mut means[number[root] as usize];
            *count += columns.len();
            for pixel in &pixels[columns] {
                sum.iter_mut().zip(pixel).for_each(|(total, &value)| *total += f64::from(value));
            }
            number[root]
        });
    }
    for (sum, count) in &mut means {
        *sum = sum.map(|total| total / *count as f64);
    }
    Flats { regions, means, unequal }
}

/// An index into pixels: pictures have fewer than 2^32 of them.
pub(super) fn index(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(NONE)
}
