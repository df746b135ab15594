//! Description length: what a scene costs to write down, and what it leaves unexplained, in bits.

use dvp_core::shape::Shape as _;
use dvp_core::{Object, Real, Scene};
use num_traits::Float;

/// Bits of a color: 8 per channel.
const COLOR_BITS: f64 = 24.0;
/// Bits of a pose: position to a hundredth of a pixel of 128, scale and angle alike.
const POSE_BITS: f64 = 4.0 * 12.0;
/// Bits of one coefficient of a free shape: its precision is 1/256 of the object.
const COEFFICIENT_BITS: f64 = 8.0;

/// Bits of an object but for its shape.
const OBJECT_BITS: f64 = COLOR_BITS + POSE_BITS;

/// What parts of a scene cost while it is fitted, in units of the law of [`scene_bits`], which [`Default`] is. Others show what
/// each price is good for (`dvp parsimony`); [`Fit::bits`](crate::Fit) is counted at them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Prices {
    /// Of an object but for its shape.
    pub object: f64,
    /// Of a harmonic of a free shape.
    pub harmonic: f64,
    /// Of the boundary between two regions of a picture that is not clean.
    pub boundary: f64,
    /// Whether an object with the mean color of two others must show that it pays for itself.
    pub mixed: bool,
}

impl Default for Prices {
    fn default() -> Self {
        Self { object: 1.0, harmonic: 1.0, boundary: 1.0, mixed: true }
    }
}

impl Prices {
    /// Bits of an object but for its shape.
    pub(crate) fn object_bits(&self) -> f64 {
        self.object * OBJECT_BITS
    }

    /// Bits of an object whose shape is one of `bank` prototypes.
    pub(crate) fn known_object_bits(&self, bank: usize) -> f64 {
        self.object_bits() + choice_bits(bank)
    }

    /// Bits of the coefficients of a free shape, all alike.
    pub(crate) fn equal_bits(&self, harmonics: usize) -> f64 {
        self.harmonic * 4.0 * COEFFICIENT_BITS * f64::of_usize(harmonics)
    }

    /// Bits of a free shape that repeats itself `symmetry` times around (0: a disk): a k-fold symmetric outline has every k-th
    /// harmonic only.
    pub(crate) fn free_shape_bits(&self, harmonics: usize, symmetry: usize) -> f64 {
        self.equal_bits(if symmetry == 0 { 1 } else { harmonics.div_ceil(symmetry) })
    }

    /// As [`scene_bits`], at these prices.
    pub(crate) fn scene_bits<T: Real>(&self, scene: &Scene<T>, bank: usize) -> f64 {
        let shape = |(at, object): (usize, &Object<T>)| {
            if object.prototype().is_some() {
                choice_bits(bank)
            } else if scene.objects[..at].iter().any(|before| before.shape == object.shape) {
                0.0
            } else {
                self.harmonic * COEFFICIENT_BITS * f64::of_usize(object.shape.number_count())
            }
        };
        let shapes = scene.objects.iter().enumerate().map(shape).sum::<f64>();
        COLOR_BITS + self.object_bits() * f64::of_usize(scene.objects.len()) + shapes
    }
}

/// Bits that a scene costs to write down: its background (24) and per object color (24) and pose (48); a prototype costs the
/// choice among `bank` shapes, any other shape 8 for each of its numbers, the first time that it occurs. Confidences are
/// free. The order of the objects does not matter.
///
/// This is the law by which fits decide what a picture needs; see [`Unexplained::bits`](crate::Unexplained) for what a scene
/// leaves of it.
#[must_use]
#[inline(never)]
pub fn scene_bits<T: Real>(scene: &Scene<T>, bank: usize) -> f64 {
    Prices::default().scene_bits(scene, bank)
}

/// Bits of a choice among `bank` shapes.
fn choice_bits(bank: usize) -> f64 {
    Float::log2(f64::of_usize(bank.max(1)))
}

/// Bits of the coefficients of a free shape if small ones cost less: each as many as tell it to 1/256 of the first
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
