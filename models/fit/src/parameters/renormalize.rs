//! Descriptors back to their normal form, the outline staying where it is.

use dvp_core::Real;

/// Differences of the two axes of the first harmonic, relative to their sum, below which its phase is noise.
///
/// Normal form turns the starting point to the long axis; the first harmonic of a square is a circle and has none. Below
/// this the turn fades out and the phase that is there stays.
const CIRCLE: f64 = 1e-2;

/// Brings `rows` to A_1 = 1, C_1 = 0 and, unless the first harmonic is nearly a circle, B_1 = 0, and multiplies `scale`
/// by what they lose in size. Returns the angle they lose, to be added to the rotation. Allocates nothing.
///
/// The posed curve stays the same; its sampled vertices slide along it if the starting point turns. A first harmonic of
/// zero, or one that is not finite, leaves all as it is.
///
/// *Units*: radians. *Source*: Kuhl and Giardina, Elliptic Fourier features of a closed contour, 1982, with the turn of
/// the starting point limited to 45 degrees.
pub fn renormalize<T: Real>(rows: &mut [[T; 4]], scale: &mut T) -> T {
    let zero = T::zero();
    let Some(&[a, b, c, d]) = rows.first() else {
        return zero;
    };
    let two = T::of(2.0);
    let (major, minor) = (a * a + c * c, b * b + d * d);
    let (product, gap) = (a * b + c * d, major - minor);
    let floor = T::of(CIRCLE) * (major + minor);
    // tan(2 phase) = 2 product / gap, with gap / (gap^2 + floor^2) for 1 / gap.
    let phase = (two * product * gap / (gap * gap + floor * floor)).atan() / two;
    let (sin, cos) = phase.sin_cos();
    let first = [a * cos + b * sin, c * cos + d * sin];
    let size = first[0].hypot(first[1]);
    if !(size > zero && size.is_finite()) {
        return zero;
    }
    let turn = first[1].atan2(first[0]);
    let (turn_sin, turn_cos) = (first[1] / size, first[0] / size);
    // (cos, sin) of n times the phase by the addition theorem.
    let (mut sin_n, mut cos_n) = (sin, cos);
    for row in rows.iter_mut() {
        let [a, b, c, d] = row.map(|value| value / size);
        let [a, b] = [a * cos_n + b * sin_n, b * cos_n - a * sin_n];
        let [c, d] = [c * cos_n + d * sin_n, d * cos_n - c * sin_n];
        *row = [
            turn_cos * a + turn_sin * c,
            turn_cos * b + turn_sin * d,
            turn_cos * c - turn_sin * a,
            turn_cos * d - turn_sin * b,
        ];
        (sin_n, cos_n) = (sin_n * cos + cos_n * sin, cos_n * cos - sin_n * sin);
    }
    *scale *= size;
    turn
}
