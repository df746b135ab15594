//! How well what is seen of an object agrees with what is there, if it is off by what its pose may be off by.

use dvp_core::Real;

/// An outline that may be displaced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Displaced<'a, T> {
    /// The closed posed outline (px).
    pub(crate) outline: &'a [[T; 2]],
    /// The point it turns and grows about (px).
    pub(crate) center: [T; 2],
    /// Pixels per scene unit.
    pub(crate) unit_px: T,
    /// Row-major covariance of (x, y in scene units, log scale, rotation), in rows of `stride` numbers.
    pub(crate) covariance: &'a [T],
    pub(crate) stride: usize,
    /// Variance (px^2) of what a piece of the outline is off by on its own.
    pub(crate) own: T,
}

impl<T: Real> Displaced<'_, T> {
    /// The intersection over union to expect of what is seen, [0, 1]: edges that `is_seen` are off by the mean of a normal distribution's
    /// absolute values, and stand for `length` px of outline around `area` px^2. What leaves the picture, or lies behind something,
    /// may be off by more and counts for nothing. 0 if no edge is seen.
    pub(crate) fn expected_iou(&self, is_seen: impl Fn(usize) -> bool, length: T, area: T) -> T {
        let (mut moved, mut sum) = (T::zero(), T::zero());
        let seen = self.outline.windows(2).enumerate().filter(|&(k, _)| is_seen(k));
        for edge in seen.map(|(_, edge)| edge) {
            let along = [0, 1].map(|c| edge[1][c] - edge[0][c]);
            let span = (along[0] * along[0] + along[1] * along[1]).sqrt();
            if span > T::zero() {
                moved += self.variance(edge, along, span).sqrt() * span;
                sum += span;
            }
        }
        if sum <= T::zero() || area <= T::zero() {
            return T::zero();
        }
        let displaced = T::of(core::f64::consts::FRAC_2_PI).sqrt() * moved / sum * length;
        ((area + area - displaced) / (area + area + displaced)).max(T::zero())
    }

    /// Variance (px^2) of the middle of an edge across itself.
    fn variance(&self, edge: &[[T; 2]], along: [T; 2], span: T) -> T {
        let normal = [along[1] / span, -along[0] / span];
        let arm = [0, 1].map(|c| T::of(0.5) * (edge[0][c] + edge[1][c]) - self.center[c]);
        let row = [
            normal[0] * self.unit_px,
            normal[1] * self.unit_px,
            normal[0] * arm[0] + normal[1] * arm[1],
            normal[1] * arm[0] - normal[0] * arm[1],
        ];
        let mut of_pose = T::zero();
        for (i, &a) in row.iter().enumerate() {
            for (j, &b) in row.iter().enumerate() {
                of_pose += a * b * self.covariance[self.stride * i + j];
            }
        }
        of_pose.max(T::zero()) + self.own
    }
}
