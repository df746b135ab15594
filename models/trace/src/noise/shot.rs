//! Noise that grows with the light: a camera counts photons, and a count of n is off by the root of n.
//!
//! In: a picture. Out: how its noise depends on the value ([`NoiseLaw`]), and the picture with noise that is the same everywhere
//! ([`evened`]), for those who read it to know one level. Source of the law: Foi et al., *Practical Poissonian-Gaussian noise modeling and fitting for
//! single-image raw-data* (2008); of the transform in which such noise is even: Anscombe (1948).

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::{Image, ImageView, sort};

use super::level::{NORMAL_MEDIAN, TIE, middle, second_difference};
use super::means::{DenoiseSettings, denoise};
use super::{DenoiseScratch, level_above_rounding};
use crate::tuning::{DENOISE_LEFT, DENOISE_REACH, SHOT_MISSED, SHOT_RATIO};

/// Groups of alike blocks whose noise is measured.
const GROUPS: usize = 24;
/// Least blocks of a group: where all channels are the same, a third of them tells its level within about 15 %.
const LEAST_BLOCKS: usize = 192;
/// Largest share of blocks without a difference: noise of the rounding of 8 bits, three quarters of a step, leaves a quarter of them without. More is of few
/// colors.
const MOST_EQUAL: f64 = 0.3;
/// Most blocks looked at.
const MOST_BLOCKS: usize = 24_576;
/// Largest share of a group's blocks with black or white in them: where there are more, these cut the noise off.
const MOST_CUT_OFF: f64 = 0.1;

/// The variance of a channel's noise as a line over its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLaw {
    /// Variance at the value 0, as the line has it.
    at_black: f64,
    /// Variance per value.
    slope: f64,
    /// Values between which it was measured.
    measured: [f64; 2],
}

/// A picture whose noise is even.
#[derive(Clone, Debug)]
pub struct Evened {
    /// The picture.
    pub image: Image<f32>,
    /// Standard deviation of its noise, everywhere.
    pub level: f64,
    /// What the noise was before.
    pub law: NoiseLaw,
}

impl NoiseLaw {
    /// Variance of a value's noise; below the darkest that was measured it is as there.
    #[must_use]
    pub fn variance(&self, value: f64) -> f64 {
        self.at_black + self.slope * value.max(self.measured[0])
    }

    /// The law of a picture; none if too little of it is neither black nor white, or if there is none: textures have as much of what looks like noise as
    /// they have.
    fn of(image: &ImageView<'_, f32>) -> Option<Self> {
        let mut blocks = blocks(image);
        let whole = || blocks.iter().filter(|block| !block.is_cut_off);
        let equal = whole().filter(|block| f64::from(block.difference) <= TIE).count();
        if equal as f64 > MOST_EQUAL * whole().count() as f64 {
            return None;
        }
        sort::ascending(&mut blocks, |block| f64::from(block.value));
        let size = blocks.len().div_ceil(GROUPS).max(LEAST_BLOCKS);
        let groups: Vec<[f64; 2]> = blocks.chunks(size).filter_map(group).collect();
        if groups.len() < blocks.len().div_ceil(2 * size) {
            return None;
        }
        // The line that most groups are near to: those with edges have more.
        let (mut best, mut least) = (None, f64::INFINITY);
        for (k, a) in groups.iter().enumerate() {
            let level = core::iter::once((a[1], 0.0));
            let lines = groups[k + 1..].iter().filter(|b| b[0] > a[0]).map(|b| {
                let slope = (b[1] - a[1]) / (b[0] - a[0]);
                (a[1] - slope * a[0], slope)
            });
            for (at_black, slope) in level.chain(lines) {
                let law = Self { at_black, slope, measured: [groups[0][0], groups[groups.len() - 1][0]] };
                let missed = groups.iter().map(|&[value, variance]| (law.variance(value) / variance).ln().abs()).sum();
                // NaN where a line falls below 0.
                if missed < least {
                    (best, least) = (Some(law), missed);
                }
            }
        }
        best.filter(|_| least <= SHOT_MISSED * groups.len() as f64)
    }

    /// How many times the standard deviation at the darkest that was measured is that at the brightest.
    fn ratio(&self) -> f64 {
        let [dark, bright] = self.measured.map(|value| self.variance(value));
        (bright / dark).sqrt()
    }

    /// A value where all noise has the standard deviation 1: the integral of 1 over that of the noise.
    fn stabilized(&self, value: f32) -> f32 {
        let value = f64::from(value);
        let dark = self.variance(self.measured[0]).sqrt();
        // Below what was measured straight on.
        let below = (value - self.measured[0]).min(0.0) / dark;
        (below + 2.0 * (self.variance(value).sqrt() - dark) / self.slope) as f32
    }
}

/// 2 x 2 values of a channel.
#[derive(Clone, Copy, Debug)]
struct Block {
    /// Their mean.
    value: f32,
    /// Their second difference, without its sign.
    difference: f32,
    /// Whether one of them is black or white.
    is_cut_off: bool,
}

/// Blocks of all channels.
fn blocks(image: &ImageView<'_, f32>) -> Vec<Block> {
    let (width, height) = (image.size().width(), image.size().height());
    let step = (3 * (width / 2) * (height / 2)).div_ceil(MOST_BLOCKS).max(1);
    let mut blocks = Vec::new();
    for channel in [0, 1, 2].map(|c| image.channel(c)) {
        for lines in channel.chunks_exact(2 * width).step_by(step) {
            let (above, below) = lines.split_at(width);
            blocks.extend(above.chunks_exact(2).zip(below.chunks_exact(2)).map(|(a, b)| Block {
                value: 0.25 * (a[0] + a[1] + b[0] + b[1]),
                difference: second_difference(a, b),
                is_cut_off: a.iter().chain(b).any(|&value| value <= 0.0 || value >= 1.0),
            }));
        }
    }
    blocks
}

/// Mean value and variance of the noise of alike blocks; none of few, or where it is cut off.
fn group(blocks: &[Block]) -> Option<[f64; 2]> {
    let whole = || blocks.iter().filter(|block| !block.is_cut_off);
    let count = whole().count();
    if blocks.len() < LEAST_BLOCKS || ((blocks.len() - count) as f64) > MOST_CUT_OFF * blocks.len() as f64 {
        return None;
    }
    let mut differences: Vec<f32> = whole().map(|block| block.difference).collect();
    let deviation = f64::from(middle(&mut differences)) / NORMAL_MEDIAN;
    let value = whole().map(|block| f64::from(block.value)).sum::<f64>() / count as f64;
    (deviation > 0.0).then_some([value, deviation * deviation])
}

/// The picture with noise of one level, that which [`noise_level`](super::noise_level) tells of it; none if its noise does not grow with the value
/// clearly, or is that of 8 bits or less.
///
/// Its noise is averaged away, all values being alike whose difference is noise where they are, and comes back by as much as is even. So edges stay
/// where they are, which values that were transformed would move.
#[must_use]
#[inline(never)]
pub fn evened(image: &ImageView<'_, f32>) -> Option<Evened> {
    let level = level_above_rounding(image)?;
    let law = NoiseLaw::of(image).filter(|law| law.ratio() >= SHOT_RATIO)?;
    let stabilized = |values: &[f32]| values.iter().map(|&value| law.stabilized(value)).collect::<Vec<f32>>();
    let (mut scratch, mut smooth) = (DenoiseScratch::default(), Vec::new());
    let left = (DENOISE_LEFT * DENOISE_LEFT) as f32;
    let mut guide = stabilized(image.data());
    // Of what is alike but for noise, two variances of 1 are to be expected; the second time of what the first has left.
    for [expected, limit] in [[2.0, 2.0], [2.0 * left, 4.0 * left]] {
        let view = ImageView::new(image.size(), &guide).ok()?;
        denoise(image, &view, DenoiseSettings { reach: DENOISE_REACH, expected, limit }, &mut scratch, &mut smooth);
        guide = stabilized(&smooth);
    }
    for (smooth, &seen) in smooth.iter_mut().zip(image.data()) {
        let share = f64::from(level) / law.variance(f64::from(*smooth)).sqrt();
        *smooth += (f64::from(seen - *smooth) * share) as f32;
    }
    Some(Evened { image: Image::from_planar(image.size(), smooth).ok()?, level: f64::from(level), law })
}
