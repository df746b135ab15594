//! Random numbers for scenes.

use super::settings::Range;

/// Random numbers, written out so that data sets do not change with a library.
///
/// *Source*: SplitMix64; Steele, Lea and Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
pub(super) struct Chance(u64);

impl Chance {
    /// Scrambling the seed before the index is added keeps data sets of neighboring seeds apart.
    pub(super) fn new(seed: u64, index: u64) -> Self {
        let start = Self(seed).next_u64().wrapping_add(index);
        Self(Self(start).next_u64())
    }

    fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}

/// Uniform, on a grid of 2^24 steps.
pub(super) fn uniform(rng: &mut Chance, range: Range) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "24 bits fit an f32")]
    let unit = (rng.next_u64() >> 40) as f32 / 16_777_216.0;
    range.low + (range.high - range.low) * unit
}

/// Uniform in 0..count (0 if `count` is 0).
pub(super) fn below(rng: &mut Chance, count: usize) -> usize {
    (((rng.next_u64() >> 32) * count as u64) >> 32) as usize
}

pub(super) fn color(rng: &mut Chance, range: Range) -> [f32; 3] {
    [uniform(rng, range), uniform(rng, range), uniform(rng, range)]
}
