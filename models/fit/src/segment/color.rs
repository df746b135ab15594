//! Colors compared channel by channel.

use crate::tuning::SAME_COLOR_DOUBT;
use dvp_core::Real;
use dvp_core::image::distance;

/// Colors closer than this in every channel are one color (two rounding errors of 8 bits).
pub(crate) const SAME_COLOR: f64 = 0.008;

/// Whether two colors may be one, each with the standard deviation of its channels.
#[inline]
pub(crate) fn may_be_same<T: Real>(a: ([T; 3], T), b: ([T; 3], T)) -> bool {
    distance(a.0, b.0) <= T::of(SAME_COLOR) + T::of(SAME_COLOR_DOUBT) * a.1.hypot(b.1)
}

/// Whether two colors are one.
#[inline]
pub(crate) fn is_same<T: Real>(a: [T; 3], b: [T; 3]) -> bool {
    distance(a, b) <= T::of(SAME_COLOR)
}
