//! Random numbers, the same on any machine.

use dvp_core::Real;

/// A random sequence small enough to carry without a dependency.
///
/// *Source*: Steele, Lea and Flood, Fast splittable pseudorandom number generators, OOPSLA 2014 (SplitMix64).
#[derive(Debug)]
pub(crate) struct SplitMix(pub(crate) u64);

impl SplitMix {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1): the upper 32 bits, which an f64 holds exactly.
    pub(crate) fn unit(&mut self) -> f64 {
        let upper = (self.next() >> 32) as u32;
        f64::from(upper) / 4_294_967_296.0
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a floor in 0..count")]
        let index = (self.unit() * f64::of_usize(count)) as usize;
        index.min(count - 1)
    }

    pub(crate) fn color<T: Real>(&mut self) -> [T; 3] {
        core::array::from_fn(|_| T::of(self.unit()))
    }

    /// 1 or -1.
    pub(crate) fn sign<T: Real>(&mut self) -> T {
        if self.next() >> 63 == 0 { T::one() } else { -T::one() }
    }
}
