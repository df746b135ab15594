//! The way back of [`Efd::normalize`].

use super::normalize::largest;
use super::{Efd, ShapeError};
use crate::real::Real;

/// Below this relative difference of the squared axes of the first harmonic its long axis has no direction worth a
/// derivative.
const CIRCULAR: f64 = 1e-6;

impl<T: Real> Efd<T> {
    /// Adds to `grad` the gradient of sum(grad_normalized x normalize(self).efd) with respect to the raw descriptors.
    ///
    /// *Dimensions*: as many rows as harmonics. Where the first harmonic is a circle to 1e-6 there is no derivative with
    /// respect to the phase: that part is left out.
    ///
    /// # Errors
    /// As [`Self::normalize`]; [`ShapeError::Length`] if a slice has another number of rows.
    pub fn normalize_vjp(&self, grad_normalized: &[[T; 4]], grad: &mut [[T; 4]]) -> Result<(), ShapeError> {
        let expected = self.harmonic_count();
        for (what, len) in
            [("gradient of the normalized EFD", grad_normalized.len()), ("gradient of the EFD", grad.len())]
        {
            if len != expected {
                return Err(ShapeError::Length { what, expected, len });
            }
        }
        let normalized = self.normalize()?;
        let (sin, cos) = normalized.rotation.sin_cos();
        let inverse = normalized.scale.recip();
        // Gradients with respect to scale and rotation; with u the normalized rows: du/dscale = -u / scale and
        // du/drotation = -J u, J the quarter turn (a, b, c, d) -> (-c, -d, a, b).
        let (mut grad_scale, mut grad_rotation) = (T::zero(), T::zero());
        for (u, g) in normalized.efd.rows().iter().zip(grad_normalized) {
            grad_scale -= inverse * (g[0] * u[0] + g[1] * u[1] + g[2] * u[2] + g[3] * u[3]);
            grad_rotation += g[0] * u[2] + g[1] * u[3] - g[2] * u[0] - g[3] * u[1];
        }
        // Scale and rotation are length and angle of (a, c) of the shifted first row, which is scale (cos, sin).
        let length_and_angle =
            [grad_scale * cos - grad_rotation * sin * inverse, grad_scale * sin + grad_rotation * cos * inverse];
        let mut grad_phase = T::zero();
        let rows = self.rows().iter().zip(grad_normalized).zip(grad.iter_mut());
        for (n, ((&[a, b, c, d], &g), grad_row)) in (1..).zip(rows) {
            // With respect to the shifted row: rotated back, and divided by the scale.
            let mut h =
                [cos * g[0] - sin * g[2], cos * g[1] - sin * g[3], sin * g[0] + cos * g[2], sin * g[1] + cos * g[3]]
                    .map(|value| value * inverse);
            if n == 1 {
                h[0] += length_and_angle[0];
                h[2] += length_and_angle[1];
            }
            let n = T::of_usize(n);
            let (sin_n, cos_n) = (n * normalized.phase).sin_cos();
            let shifted = [a * cos_n + b * sin_n, b * cos_n - a * sin_n, c * cos_n + d * sin_n, d * cos_n - c * sin_n];
            grad_phase += n * (h[0] * shifted[1] - h[1] * shifted[0] + h[2] * shifted[3] - h[3] * shifted[2]);
            let back = [
                h[0] * cos_n - h[1] * sin_n,
                h[0] * sin_n + h[1] * cos_n,
                h[2] * cos_n - h[3] * sin_n,
                h[2] * sin_n + h[3] * cos_n,
            ];
            grad_row.iter_mut().zip(back).for_each(|(value, back)| *value += back);
        }
        if let (Some(&row), Some(grad_row)) = (self.rows().first(), grad.first_mut()) {
            add_phase_gradient(row, grad_phase, grad_row);
        }
        Ok(())
    }
}

/// Adds grad_phase x the derivative of phase = atan2(p, q) / 2, p = 2 (a b + c d), q = a^2 - b^2 + c^2 - d^2.
fn add_phase_gradient<T: Real>(row: [T; 4], grad_phase: T, grad_row: &mut [T; 4]) {
    // The phase is the same in any unit; see the way forward.
    let unit = largest(row);
    let ([a, b, c, d], grad_phase) = (row.map(|value| value / unit), grad_phase / unit);
    let two = T::of(2.0);
    let (p, q) = (two * (a * b + c * d), a * a - b * b + c * c - d * d);
    let squared = p * p + q * q;
    let size = (a * a + b * b + c * c + d * d) * T::of(CIRCULAR);
    if squared <= size * size {
        return;
    }
    // The halves of atan2 / 2 and of 2 (a db + ...) cancel.
    let (grad_p, grad_q) = (grad_phase * q / squared, -grad_phase * p / squared);
    grad_row[0] += b * grad_p + a * grad_q;
    grad_row[1] += a * grad_p - b * grad_q;
    grad_row[2] += d * grad_p + c * grad_q;
    grad_row[3] += c * grad_p - d * grad_q;
}
