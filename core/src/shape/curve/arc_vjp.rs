//! How the vertices of an arc move with its sweep.

use super::arc::{CutArc, excess, excess_slope, outward, root, sinc, sinc_slope, spread};
use crate::geometry::Vec2;
use crate::real::Real;

/// What [`CutArc::factor_slope`] needs beside the arc.
pub(crate) struct ArcSlopes<T> {
    /// Of `CutArc::sinc`, per radian of the sweep.
    sinc: T,
    /// Of `CutArc::push`.
    push: T,
}

impl<T: Real> CutArc<T> {
    /// The derivatives of the numbers of the arc.
    pub(crate) fn slopes(&self) -> ArcSlopes<T> {
        let (one, half, two) = (T::one(), T::of(0.5), T::of(2.0));
        let n = self.edges;
        let angle = self.sweep / n;
        let (value, slope) = (excess(angle), excess_slope(angle) / n);
        let (g, g_slope) = (angle * angle * value, squared_excess_slope(angle) / n);
        let spread_slope = n * (n - two) * g_slope / (two * root(n, g));
        let spread = spread(n, g);
        let sinc = half * sinc_slope(self.sweep * half);
        // push = value x sweep / (n x spread x sinc), by the rule of products.
        let scale = one / (n * spread * self.sinc);
        let push = scale * (slope * self.sweep + value) - self.push * (spread_slope / spread + sinc / self.sinc);
        ArcSlopes { sinc, push }
    }

    /// The derivative of [`Self::factor`] with respect to the sweep, the number of edges kept.
    pub(crate) fn factor_slope(&self, k: usize, slopes: &ArcSlopes<T>) -> Vec2<T> {
        let (one, half) = (T::one(), T::of(0.5));
        let share = T::of_usize(k) / self.edges;
        let at = share * self.sweep * half;
        let ratio = share * sinc(at) / self.sinc;
        let ratio_slope = share * share * half * sinc_slope(at) / self.sinc - ratio * slopes.sinc / self.sinc;
        let turn = (share - one) * half;
        let direction = Vec2::from_angle(turn * self.sweep);
        let away = outward(self.sweep * (share - half));
        direction * ratio_slope
            + direction.perp() * (ratio * turn)
            + away * slopes.push
            + away.perp() * (self.push * (share - half))
    }
}

/// The derivative of [`stand_out`](super::arc::stand_out) with respect to the sweep.
pub(crate) fn stand_out_slope<T: Real>(sweep: T, edges: usize) -> T {
    let (n, two) = (T::of_usize(edges), T::of(2.0));
    let angle = sweep / n;
    let (g, g_slope) = (angle * angle * excess(angle), squared_excess_slope(angle) / n);
    let spread_slope = n * (n - two) * g_slope / (two * root(n, g));
    let spread = spread(n, g);
    n * (g_slope - g * spread_slope / spread) / spread
}

/// The derivative of angle^2 x excess(angle).
fn squared_excess_slope<T: Real>(angle: T) -> T {
    angle * (angle * excess_slope(angle) + T::of(2.0) * excess(angle))
}
