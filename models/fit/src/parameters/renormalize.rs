//! Descriptors back to unit size and angle zero, the outline staying where it is.

use dvp_core::Real;

/// Brings `rows` to A_1 = 1, C_1 = 0 and multiplies `scale` by the size they lose. Returns the angle they lose, to be
/// added to the rotation. The posed outline stays the same, vertex by vertex. Allocates nothing.
///
/// The starting point, which the normal form of [`Efd::normalize`](dvp_core::Efd::normalize) moves to the long axis,
/// stays: it changes no outline, and of a first harmonic that is nearly a circle (a square's) the axis is noise that
/// would shuffle the vertices in each step. A first harmonic that starts at the origin, or is not finite, leaves
/// all as it is.
///
/// *Units*: radians. *Source*: the evaluation of the paper's optimizers, which normalizes fully.
pub fn renormalize<T: Real>(rows: &mut [[T; 4]], scale: &mut T) -> T {
    let Some(&[x, _, y, _]) = rows.first() else {
        return T::zero();
    };
    let size = x.hypot(y);
    if !size.is_normal() {
        return T::zero();
    }
    let (cos, sin) = (x / (size * size), y / (size * size));
    for row in rows.iter_mut() {
        let [a, b, c, d] = *row;
        *row = [cos * a + sin * c, cos * b + sin * d, cos * c - sin * a, cos * d - sin * b];
    }
    *scale *= size;
    y.atan2(x)
}
