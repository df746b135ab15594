//! Run-time choice of the instruction set for hot loops.
//!
//! A [`Kernel`] is plain generic code, written so that it vectorizes (loops over fixed-size arrays, no branches inside).
//! [`dispatch`] compiles its `run` once per instruction set and picks the best one the processor has: with the feature
//! `std` AVX-512, AVX2 with FMA, or the compile-time target; without it the compile-time target. Everything that `run`
//! calls in a hot loop must be `#[inline(always)]`: a function that stays a call is compiled for the compile-time
//! target only.

use core::ops::Add;

/// A piece of work to compile for several instruction sets.
pub trait Kernel {
    /// What [`Self::run`] returns.
    type Output;

    /// Does the work. Implementations mark it `#[inline(always)]`.
    fn run(self) -> Self::Output;

    /// As [`Self::run`], called instead of it where the instruction set has fused multiply-adds: there
    /// [`Real::times_plus`](crate::Real::times_plus) may fuse. Implementations mark it `#[inline(always)]`.
    #[inline(always)]
    fn run_fused(self) -> Self::Output
    where
        Self: Sized,
    {
        self.run()
    }
}

/// Runs `kernel` with the best instruction set of this processor.
#[cfg(feature = "std")]
#[inline]
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    static ARCH: std::sync::OnceLock<pulp::Arch> = std::sync::OnceLock::new();

    struct Plain<K>(K);
    impl<K: Kernel> pulp::NullaryFnOnce for Plain<K> {
        type Output = K::Output;

        #[inline(always)]
        fn call(self) -> K::Output {
            self.0.run()
        }
    }

    let arch = *ARCH.get_or_init(pulp::Arch::new);
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        struct Fused<K>(K);
        impl<K: Kernel> pulp::NullaryFnOnce for Fused<K> {
            type Output = K::Output;

            #[inline(always)]
            fn call(self) -> K::Output {
                self.0.run_fused()
            }
        }

        match arch {
            pulp::Arch::V3(level) => pulp::Simd::vectorize(level, Fused(kernel)),
            pulp::Arch::V4(level) => pulp::Simd::vectorize(level, Fused(kernel)),
            _ => arch.dispatch(Plain(kernel)),
        }
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    arch.dispatch(Plain(kernel))
}

/// Runs `kernel` with the instruction set of the compile-time target.
#[cfg(not(feature = "std"))]
#[inline]
pub fn dispatch<K: Kernel>(kernel: K) -> K::Output {
    kernel.run()
}

/// One number per lane, each made by `f` of the lane's index.
///
/// Kernels string such steps together, one operation each: that vectorizes reliably, where a loop over lanes with several
/// operations and choices in it may become branches. (`core::array::from_fn` does the same, but may stay a call.)
#[inline(always)]
pub fn lanes<T: Copy + Default, const N: usize>(f: impl Fn(usize) -> T) -> [T; N] {
    let mut lanes = [T::default(); N];
    for (i, lane) in lanes.iter_mut().enumerate() {
        *lane = f(i);
    }
    lanes
}

/// Sums `values` in 16 parts side by side: a sum in order waits for each addition, and its rounding grows faster.
///
/// For use inside kernels and outside: it vectorizes for the instruction set of its caller.
#[inline(always)]
pub fn sum<T: Copy + Default + Add<Output = T>>(values: &[T]) -> T {
    const LANES: usize = 16;
    let (parts, rest) = values.as_chunks::<LANES>();
    let mut sums = [T::default(); LANES];
    for part in parts {
        sums = lanes(|i| sums[i] + part[i]);
    }
    rest.iter().fold(total(sums), |sum, &value| sum + value)
}

/// The sum of the lanes, a power of two of them, by halves so that it vectorizes.
#[inline(always)]
pub fn total<T: Copy + Add<Output = T>, const N: usize>(mut lanes: [T; N]) -> T {
    let mut half = N / 2;
    while half > 0 {
        for i in 0..half {
            lanes[i] = lanes[i] + lanes[i + half];
        }
        half /= 2;
    }
    lanes[0]
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use crate::simd::sum;

    #[test]
    fn a_sum_takes_every_value_once() {
        for count in [0_u16, 1, 15, 16, 17, 100] {
            let values: Vec<f32> = (1..=count).map(f32::from).collect();
            let expected = f32::from(count) * f32::from(count + 1) / 2.0;
            assert!((sum(&values) - expected).abs() < 1e-6, "{count}");
        }
    }
}
