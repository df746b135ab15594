//! The two number types of the crate, f32 and f64: behind one sealed trait where the type is known at compile time, and
//! as [`Values`] of a [`DType`] where it is chosen at run time.

mod values;

use alloc::vec::Vec;
use core::fmt::{Debug, Display};
use core::iter::Sum;
use core::ops::{AddAssign, DivAssign, MulAssign, SubAssign};

use num_traits::Float;

pub use values::{DType, Values, ValuesRef};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
}

/// A real number: f32 to work with, f64 to check gradients with.
///
/// The arithmetic is that of [`num_traits::Float`] (libm where std is off).
pub trait Real:
    sealed::Sealed
    + Float
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + Sum
    + Default
    + Debug
    + Display
    + Send
    + Sync
    + 'static
{
    /// The glam vector of the geometry in the public API: [`glam::Vec2`] or [`glam::DVec2`].
    type Vec2: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// The type as a value.
    const DTYPE: DType;

    /// The nearest value to an f64.
    fn of(value: f64) -> Self;
    /// The nearest value to a count.
    fn of_usize(value: usize) -> Self;
    /// The value as f64; exact.
    fn as_f64(self) -> f64;
    /// The value as f32; rounded for f64.
    fn as_f32(self) -> f32;
    /// The value without its fraction; 0 for NaN and below 0, 2^31 - 1 (above any number of pixels) above it.
    fn to_count(self) -> usize;
    /// The nearest whole number (of two as near, the even one) to one in [0, 2^22], without branches or calls, so that
    /// loops over it vectorize; for all others some number or other.
    fn round_lanes(self) -> u32;
    /// Numbers of this type as numbers of a type chosen at run time.
    fn into_values(values: Vec<Self>) -> Values;
    /// The way back; none if they are of the other type.
    fn from_values(values: Values) -> Option<Vec<Self>>;
    /// The numbers, borrowed; none if they are of the other type.
    fn borrow_values(values: ValuesRef<'_>) -> Option<&[Self]>;
    /// A glam vector of two components.
    fn vec2(x: Self, y: Self) -> Self::Vec2;
    /// The components of a glam vector.
    fn xy(vector: Self::Vec2) -> [Self; 2];
    /// e^x by a polynomial, without branches or calls, so that loops over it vectorize. The argument is clamped to
    /// [-87, 87] (f32) or [-708, 708] (f64), so that the reciprocal is a normal number too; relative error below 2e-7 (f32) or 1e-14 (f64).
    /// For `FUSED` see [`Self::times_plus`].
    fn exp_lanes<const FUSED: bool>(self) -> Self;

    /// self x factor + term, rounded once if `FUSED`. That takes one instruction where the instruction set has it (see
    /// [`Kernel::run_fused`](crate::simd::Kernel::run_fused)), and a slow call elsewhere.
    #[inline(always)]
    fn times_plus<const FUSED: bool>(self, factor: Self, term: Self) -> Self {
        if FUSED { self.mul_add(factor, term) } else { self * factor + term }
    }
}

impl Real for f32 {
    type Vec2 = glam::Vec2;
    const DTYPE: DType = DType::F32;

    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
    #[inline(always)]
    fn of(value: f64) -> Self {
        value as f32
    }
    #[expect(clippy::cast_precision_loss, reason = "rounding is what is asked for")]
    #[inline(always)]
    fn of_usize(value: usize) -> Self {
        value as f32
    }
    #[inline(always)]
    fn as_f64(self) -> f64 {
        f64::from(self)
    }
    #[inline(always)]
    fn as_f32(self) -> f32 {
        self
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is what is asked for")]
    #[inline(always)]
    fn to_count(self) -> usize {
        (self as i32).max(0) as usize
    }
    #[inline(always)]
    fn round_lanes(self) -> u32 {
        // Beside 2^23 the last bit of the fraction is worth 1.
        (self + 8_388_608.0).to_bits() & 0x007f_ffff
    }
    fn into_values(values: Vec<Self>) -> Values {
        Values::F32(values)
    }
    fn from_values(values: Values) -> Option<Vec<Self>> {
        if let Values::F32(values) = values { Some(values) } else { None }
    }
    fn borrow_values(values: ValuesRef<'_>) -> Option<&[Self]> {
        if let ValuesRef::F32(values) = values { Some(values) } else { None }
    }
    #[inline(always)]
    fn vec2(x: Self, y: Self) -> Self::Vec2 {
        glam::Vec2::new(x, y)
    }
    #[inline(always)]
    fn xy(vector: Self::Vec2) -> [Self; 2] {
        vector.to_array()
    }
    #[inline(always)]
    fn exp_lanes<const FUSED: bool>(self) -> Self {
        // x = k ln 2 + r, |r| <= h = ln 2 / 2; e^r by its Taylor polynomial, economized to degree 5: the terms of degree 6
        // and 7 are replaced by the polynomials closest to them on [-h, h] (off by h^6 / (32 6!) = 8e-8). Adding
        // 1.5 * 2^23 rounds to an integer that then stands in the low mantissa bits.
        const MAGIC: f32 = 12_582_912.0;
        let x = self.clamp(-87.0, 87.0);
        let shifted = x.times_plus::<FUSED>(core::f32::consts::LOG2_E, MAGIC);
        let k = shifted - MAGIC;
        let r = k.times_plus::<FUSED>(-0.693_359_4, x);
        let r = k.times_plus::<FUSED>(2.121_944_4e-4, r);
        let p = 0.008_375_039;
        let p = p.times_plus::<FUSED>(r, 0.041_916_903);
        let p = p.times_plus::<FUSED>(r, 0.166_664_17);
        let p = p.times_plus::<FUSED>(r, 0.499_988_73);
        let p = p.times_plus::<FUSED>(r, 1.0);
        let p = p.times_plus::<FUSED>(r, 1.0);
        let scale = f32::from_bits(shifted.to_bits().wrapping_add(127) << 23);
        p * scale
    }
}

impl Real for f64 {
    type Vec2 = glam::DVec2;
    const DTYPE: DType = DType::F64;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }
    #[expect(clippy::cast_precision_loss, reason = "rounding is what is asked for")]
    #[inline(always)]
    fn of_usize(value: usize) -> Self {
        value as f64
    }
    #[inline(always)]
    fn as_f64(self) -> f64 {
        self
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
    #[inline(always)]
    fn as_f32(self) -> f32 {
        self as f32
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturation is what is asked for")]
    #[inline(always)]
    fn to_count(self) -> usize {
        (self as i32).max(0) as usize
    }
    #[expect(clippy::cast_possible_truncation, reason = "the number is in the lower bits")]
    #[inline(always)]
    fn round_lanes(self) -> u32 {
        // As for f32, beside 2^52.
        (self + 4_503_599_627_370_496.0).to_bits() as u32
    }
    fn into_values(values: Vec<Self>) -> Values {
        Values::F64(values)
    }
    fn from_values(values: Values) -> Option<Vec<Self>> {
        if let Values::F64(values) = values { Some(values) } else { None }
    }
    fn borrow_values(values: ValuesRef<'_>) -> Option<&[Self]> {
        if let ValuesRef::F64(values) = values { Some(values) } else { None }
    }
    #[inline(always)]
    fn vec2(x: Self, y: Self) -> Self::Vec2 {
        glam::DVec2::new(x, y)
    }
    #[inline(always)]
    fn xy(vector: Self::Vec2) -> [Self; 2] {
        vector.to_array()
    }
    #[inline(always)]
    fn exp_lanes<const FUSED: bool>(self) -> Self {
        // As for f32, with degree 12 (next term 1.7e-16 relative) and the magic number 1.5 * 2^52.
        const MAGIC: f64 = 6_755_399_441_055_744.0;
        const TERMS: [f64; 13] = [
            1.0 / 479_001_600.0,
            1.0 / 39_916_800.0,
            1.0 / 3_628_800.0,
            1.0 / 362_880.0,
            1.0 / 40_320.0,
            1.0 / 5_040.0,
            1.0 / 720.0,
            1.0 / 120.0,
            1.0 / 24.0,
            1.0 / 6.0,
            0.5,
            1.0,
            1.0,
        ];
        let x = self.clamp(-708.0, 708.0);
        let shifted = x.times_plus::<FUSED>(core::f64::consts::LOG2_E, MAGIC);
        let k = shifted - MAGIC;
        let r = k.times_plus::<FUSED>(-0.693_147_180_369_123_8, x);
        let r = k.times_plus::<FUSED>(-1.908_214_929_270_587_7e-10, r);
        let mut p = TERMS[0];
        for &term in &TERMS[1..] {
            p = p.times_plus::<FUSED>(r, term);
        }
        let scale = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
        p * scale
    }
}

#[cfg(test)]
mod tests {
    use super::Real;

    #[test]
    fn exp_lanes_follows_exp() {
        follow_exp::<false>();
        follow_exp::<true>();
    }

    fn follow_exp<const FUSED: bool>() {
        for i in -8600..=8700 {
            let x = f64::from(i) / 100.0;
            let exact = libm::exp(x);
            assert!((x.exp_lanes::<FUSED>() - exact).abs() <= 1e-14 * exact, "f64 at {x}");
            let y = f32::of(x);
            let exact = libm::exp(f64::from(y));
            assert!((f64::from(y.exp_lanes::<FUSED>()) - exact).abs() <= 3e-7 * exact, "f32 at {x}");
        }
    }

    #[test]
    fn round_lanes_rounds() {
        for whole in [1_u32, 2, 63, 64, 4095] {
            for off in [-0.49, 0.0, 0.49] {
                let x = f64::from(whole) + off;
                assert_eq!((x.round_lanes(), f32::of(x).round_lanes()), (whole, whole), "{x}");
            }
        }
        assert_eq!(
            (0.0_f64.round_lanes(), 4_194_304.0_f64.round_lanes(), 4_194_304.0_f32.round_lanes()),
            (0, 1 << 22, 1 << 22)
        );
        assert_eq!((0.49_f32.round_lanes(), 2.5_f64.round_lanes(), 3.5_f32.round_lanes()), (0, 2, 4));
    }
}
