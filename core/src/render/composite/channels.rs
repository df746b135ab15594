//! What the channels of a pass stand for: three are red, green and blue, a fourth is alpha.
//!
//! Alpha needs no formulas of its own. It is a channel in which every object has the color 1 and the background 0; with a
//! background of 0 the other three are then the colors times alpha: what is painted is premultiplied.

use crate::image::CHANNELS;
use crate::real::Real;
use crate::render::tile::{LANES, Lanes};
use crate::scene::Drawing;

/// The color of an object in a channel.
#[inline(always)]
pub(super) fn tint<T: Real>(color: &[T; CHANNELS], channel: usize) -> T {
    if channel < CHANNELS { color[channel] } else { T::one() }
}

/// The colors of an object's pixels in a channel.
#[inline(always)]
pub(super) fn tints<T: Real>(colors: &[Lanes<T>; CHANNELS], channel: usize) -> Lanes<T> {
    if channel < CHANNELS { colors[channel] } else { [T::one(); LANES] }
}

/// The color of nothing in a channel of `N`: the background, or clear.
#[inline(always)]
pub(super) fn ground<T: Real, const N: usize>(drawing: &Drawing<T>, channel: usize) -> T {
    if N == CHANNELS { drawing.background[channel] } else { T::zero() }
}
