//! Description length: what a scene costs to write down, and what it leaves unexplained, in bits.

use dvp_core::{Real, Scene};
use num_traits::Float;

/// Bits of a color: 8 per channel.
const COLOR_BITS: f64 = 24.0;
/// Bits of a pose: position to a hundredth of a pixel of 128, scale and angle alike.
const POSE_BITS: f64 = 4.0 * 12.0;
/// Bits of one coefficient of a free shape: its precision is about a 200th of the object.
pub(crate) const COEFFICIENT_BITS: f64 = 8.0;

/// Bits of an object whose shape is one of `bank` prototypes.
pub(crate) fn known_object_bits(bank: usize) -> f64 {
    OBJECT_BITS + choice_bits(bank)
}

/// Bits of a free shape that repeats itself `symmetry` times around (0: a disk): a k-fold symmetric outline has every k-th
/// harmonic only.
pub(crate) fn free_shape_bits(harmonics: usize, symmetry: usize) -> f64 {
    let needed = if symmetry == 0 { 1 } else { harmonics.div_ceil(symmetry) };
    equal_bits(needed)
}

/// Bits of a choice among `bank` shapes.
fn choice_bits(bank: usize) -> f64 {
    Float::log2(f64::of_usize(bank.max(1)))
}

/// Bits of an object but for its shape.
pub(crate) const OBJECT_BITS: f64 = COLOR_BITS + POSE_BITS;

/// Bits of background and objects; a prototype costs the choice among `bank` shapes, a free shape its coefficients.
pub(crate) fn scene_bits<T: Real>(scene: &Scene<T>, bank: usize) -> f64 {
    let shape = |at: usize| {
        let object = &scene.objects[at];
        if object.prototype.is_some() {
            choice_bits(bank)
        } else if at > 0 && scene.objects[at - 1].efd == object.efd {
            0.0
        } else {
            equal_bits(object.efd.harmonic_count())
        }
    };
    COLOR_BITS + (0..scene.objects.len()).map(|at| OBJECT_BITS + shape(at)).sum::<f64>()
}

/// Bits of the coefficients of a free shape, all alike.
pub(crate) fn equal_bits(harmonics: usize) -> f64 {
    4.0 * COEFFICIENT_BITS * f64::of_usize(harmonics)
}

/// Bits of the coefficients of a free shape if small ones cost less: each as many as tell it to a 200th of the first
/// harmonic. Unlike the number of harmonics, which a hidden stretch may raise, this compares shapes by how simple they are.
pub(crate) fn coefficient_bits<T: Real>(rows: &[[T; 4]]) -> f64 {
    let square = |row: &[T; 4]| row.iter().map(|&v| v * v).sum::<T>();
    let first = rows.first().map_or(T::one(), square);
    // The first harmonic of a circle has two coefficients of its radius.
    let size = (first * T::of(0.5)).sqrt().max(T::of(1e-9));
    let steps = T::of(Float::powf(2.0, COEFFICIENT_BITS)) / size;
    rows.iter().flatten().map(|&v| Float::log2((T::one() + v.abs() * steps).as_f64())).sum()
}

/// Bits per unit of the robust cost: half a squared residual in units of the noise, in base 2.
pub(crate) fn misfit_bits<T: Real>() -> T {
    T::of(0.5 * core::f64::consts::LOG2_E)
}
