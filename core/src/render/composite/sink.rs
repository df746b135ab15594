//! What happens to pixels: stored, multiplied with a given gradient, or compared with a target.

use core::marker::PhantomData;

use super::Place;
use crate::real::Real;
use crate::render::tile::{LANES, Lanes};
use crate::simd::{lanes, total};

/// Takes pixels, and gives back the gradient of the scalar with respect to them.
pub(in crate::render) trait PixelSink<T: Real> {
    /// Whether gradients are wanted; if not, what comes back is not looked at.
    const BACKWARD: bool;

    /// Takes a chunk; the gradient is 0 in the lanes beyond its length.
    fn chunk(&mut self, channel: usize, place: Place, values: &Lanes<T>) -> Lanes<T>;

    /// Takes `len` pixels of one value; returns the sum of their gradients.
    fn span(&mut self, channel: usize, start: usize, len: usize, value: T) -> T;

    /// The loss, if there is one.
    fn finish(self) -> T;
}

/// Stores the image.
pub(in crate::render) struct Forward<'a, T> {
    pub(in crate::render) image: &'a mut [T],
    /// Pixels of a plane.
    pub(in crate::render) pixels: usize,
}

impl<T: Real> PixelSink<T> for Forward<'_, T> {
    const BACKWARD: bool = false;

    #[inline(always)]
    fn chunk(&mut self, channel: usize, place: Place, values: &Lanes<T>) -> Lanes<T> {
        let start = channel * self.pixels + place.start;
        if place.len == LANES {
            self.image[start..start + LANES].copy_from_slice(values);
        } else {
            self.image[start..start + place.len].copy_from_slice(&values[..place.len]);
        }
        [T::zero(); LANES]
    }

    #[inline(always)]
    fn span(&mut self, channel: usize, start: usize, len: usize, value: T) -> T {
        let start = channel * self.pixels + start;
        self.image[start..start + len].fill(value);
        T::zero()
    }

    #[inline(always)]
    fn finish(self) -> T {
        T::zero()
    }
}

/// Pulls a given gradient of the image back.
pub(in crate::render) struct Pull<'a, T> {
    pub(in crate::render) grad_image: &'a [T],
    /// Pixels of a plane.
    pub(in crate::render) pixels: usize,
}

impl<T: Real> PixelSink<T> for Pull<'_, T> {
    const BACKWARD: bool = true;

    #[inline(always)]
    fn chunk(&mut self, channel: usize, place: Place, _: &Lanes<T>) -> Lanes<T> {
        load(self.grad_image, channel * self.pixels, place, &[T::zero(); LANES])
    }

    #[inline(always)]
    fn span(&mut self, channel: usize, start: usize, len: usize, _: T) -> T {
        let start = channel * self.pixels + start;
        let mut sums = [T::zero(); LANES];
        let (blocks, rest) = self.grad_image[start..start + len].as_chunks::<LANES>();
        for block in blocks {
            sums = lanes(|i| sums[i] + block[i]);
        }
        for (sum, &g) in sums.iter_mut().zip(rest) {
            *sum += g;
        }
        total(sums)
    }

    #[inline(always)]
    fn finish(self) -> T {
        T::zero()
    }
}

/// A loss per value.
pub(in crate::render) trait ValueLoss<T: Real> {
    /// The loss at a difference.
    fn value(difference: T) -> T;
    /// Its derivative.
    fn slope(difference: T) -> T;
}

/// |d|.
pub(in crate::render) struct Mae;

impl<T: Real> ValueLoss<T> for Mae {
    #[inline(always)]
    fn value(difference: T) -> T {
        difference.abs()
    }
    #[inline(always)]
    fn slope(difference: T) -> T {
        let up = if difference > T::zero() { T::one() } else { T::zero() };
        let down = if difference < T::zero() { T::one() } else { T::zero() };
        up - down
    }
}

/// d^2.
pub(in crate::render) struct Mse;

impl<T: Real> ValueLoss<T> for Mse {
    #[inline(always)]
    fn value(difference: T) -> T {
        difference * difference
    }
    #[inline(always)]
    fn slope(difference: T) -> T {
        difference + difference
    }
}

/// The mean of a loss per value against a target; with its gradient if `BACKWARD`.
pub(in crate::render) struct Loss<'a, T, L, const BACKWARD: bool> {
    target: &'a [T],
    /// Pixels of a plane.
    pixels: usize,
    /// 1 / number of values.
    share: T,
    sum: f64,
    lanes: Lanes<T>,
    loss: PhantomData<L>,
}

impl<'a, T: Real, L: ValueLoss<T>, const BACKWARD: bool> Loss<'a, T, L, BACKWARD> {
    /// Against planar `target` with planes of `pixels`.
    pub(in crate::render) fn new(target: &'a [T], pixels: usize) -> Self {
        let share = T::one() / T::of_usize(target.len());
        Self { target, pixels, share, sum: 0.0, lanes: [T::zero(); LANES], loss: PhantomData }
    }
}

impl<T: Real, L: ValueLoss<T>, const BACKWARD: bool> PixelSink<T> for Loss<'_, T, L, BACKWARD> {
    const BACKWARD: bool = BACKWARD;

    #[inline(always)]
    fn chunk(&mut self, channel: usize, place: Place, values: &Lanes<T>) -> Lanes<T> {
        let target = load(self.target, channel * self.pixels, place, values);
        let difference: Lanes<T> = lanes(|i| values[i] - target[i]);
        self.lanes = lanes(|i| self.lanes[i] + L::value(difference[i]));
        if BACKWARD { lanes(|i| L::slope(difference[i]) * self.share) } else { [T::zero(); LANES] }
    }

    #[inline(always)]
    fn span(&mut self, channel: usize, start: usize, len: usize, value: T) -> T {
        let start = channel * self.pixels + start;
        let (blocks, rest) = self.target[start..start + len].as_chunks::<LANES>();
        let (mut losses, mut slopes) = ([T::zero(); LANES], [T::zero(); LANES]);
        for block in blocks {
            let difference: Lanes<T> = lanes(|i| value - block[i]);
            losses = lanes(|i| losses[i] + L::value(difference[i]));
            if BACKWARD {
                slopes = lanes(|i| slopes[i] + L::slope(difference[i]));
            }
        }
        for (i, &t) in rest.iter().enumerate() {
            losses[i] += L::value(value - t);
            if BACKWARD {
                slopes[i] += L::slope(value - t);
            }
        }
        self.sum += total(losses).as_f64();
        total(slopes) * self.share
    }

    #[inline(always)]
    fn finish(self) -> T {
        T::of(self.sum + total(self.lanes).as_f64()) * self.share
    }
}

/// A chunk of the plane that starts at `plane`; lanes beyond its length are taken from `beyond`.
#[inline(always)]
fn load<T: Real>(planes: &[T], plane: usize, place: Place, beyond: &Lanes<T>) -> Lanes<T> {
    let start = plane + place.start;
    let mut lanes = *beyond;
    if place.len == LANES {
        lanes.copy_from_slice(&planes[start..start + LANES]);
    } else {
        lanes[..place.len].copy_from_slice(&planes[start..start + place.len]);
    }
    lanes
}
