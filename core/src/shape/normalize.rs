//! The normal form of descriptors: first harmonic with its long axis 1 along x, start on that axis.

use super::{Efd, ShapeError};
use crate::real::Real;

/// Normalized descriptors, and what was taken out to get them.
///
/// With r the raw and u the normalized outline, r(t) = `scale` R(`rotation`) u(t - `phase` / 2 pi). So an object keeps
/// its place if its pose takes over rotation and scale (see [`Self::restore`] for the descriptors).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Normalized<T> {
    /// The normal form: a_1 = 1, b_1 = c_1 = 0, |d_1| <= 1.
    pub efd: Efd<T>,
    /// Angle of the long axis of the first harmonic, radians in (-pi, pi\].
    pub rotation: T,
    /// Half the long axis of the first harmonic.
    pub scale: T,
    /// Where on the raw outline the normalized one starts, as an angle of the parameter, radians in \[-pi/2, pi/2\].
    pub phase: T,
}

impl<T: Real> Efd<T> {
    /// The normal form: unchanged by scale, rotation and starting point.
    ///
    /// Two caveats, as in the reference system and pyefd. An ellipse has two ends of its long axis: a shift of the
    /// starting point by half an outline gives the [half-turn twin](Self::half_turn). And a circular first harmonic (square,
    /// equilateral triangle, |d_1| = 1) has no long axis: phase and rotation are then rounding noise, though always
    /// consistent with each other, so that [`Normalized::restore`] and the pose lose nothing. Keep the descriptors of
    /// such a shape as they are rather than normalizing them over and over.
    ///
    /// *Derivative*: [`Self::normalize_vjp`]. *Source*: Kuhl and Giardina 1982, section 5; pyefd `normalize_efd`.
    ///
    /// # Errors
    /// [`ShapeError::Degenerate`] if the first harmonic is missing or zero, [`ShapeError::NotFinite`].
    #[inline(never)]
    pub fn normalize(&self) -> Result<Normalized<T>, ShapeError> {
        if let Some(index) = self.rows.iter().position(|row| !row.iter().all(|value| value.is_finite())) {
            return Err(ShapeError::NotFinite { index });
        }
        let &first = self.rows.first().ok_or(ShapeError::Degenerate)?;
        // In units of the largest number, so that no square under- or overflows.
        let unit = largest(first);
        if !unit.is_normal() {
            return Err(ShapeError::Degenerate);
        }
        let [a, b, c, d] = first.map(|value| value / unit);
        let two = T::of(2.0);
        let phase = (two * (a * b + c * d)).atan2(a * a - b * b + c * c - d * d) / two;
        let (sin, cos) = phase.sin_cos();
        let (x, y) = (a * cos + b * sin, c * cos + d * sin);
        let scale = unit * x.hypot(y);
        let rotation = y.atan2(x);
        let mut efd = self.clone();
        efd.shift(phase);
        efd.rotate_scale(-rotation, scale.recip());
        Ok(Normalized { efd, rotation, scale, phase })
    }

    /// Moves the start by `phase` (radians of the parameter, 2 pi = once around): t becomes t + phase / 2 pi.
    pub fn shift(&mut self, phase: T) {
        for (n, row) in (1..).zip(&mut self.rows) {
            let (sin, cos) = (T::of_usize(n) * phase).sin_cos();
            let [a, b, c, d] = *row;
            *row = [a * cos + b * sin, b * cos - a * sin, c * cos + d * sin, d * cos - c * sin];
        }
    }

    /// Turns the outline by `rotation` (radians) and scales it.
    pub fn rotate_scale(&mut self, rotation: T, scale: T) {
        let (sin, cos) = rotation.sin_cos();
        let (sin, cos) = (scale * sin, scale * cos);
        for row in &mut self.rows {
            let [a, b, c, d] = *row;
            *row = [cos * a - sin * c, cos * b - sin * d, sin * a + cos * c, sin * b + cos * d];
        }
    }

    /// The other normal form of the same outline: started half an outline later and turned by pi. Odd harmonics stay,
    /// even ones change their sign.
    #[must_use]
    pub fn half_turn(&self) -> Self {
        let mut twin = self.clone();
        twin.rows.iter_mut().skip(1).step_by(2).flatten().for_each(|value| *value = -*value);
        twin
    }
}

impl<T: Real> Normalized<T> {
    /// The raw descriptors again.
    #[must_use]
    pub fn restore(&self) -> Efd<T> {
        let mut efd = self.efd.clone();
        efd.rotate_scale(self.rotation, self.scale);
        efd.shift(-self.phase);
        efd
    }
}

/// The largest absolute value of a row.
pub(super) fn largest<T: Real>(row: [T; 4]) -> T {
    row.into_iter().fold(T::zero(), |largest, value| largest.max(value.abs()))
}
