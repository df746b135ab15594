//! Banks of prototypes: weights in, mixed descriptors or outlines out.

use alloc::vec;
use alloc::vec::Vec;

use super::{Efd, OutlineBasis, ShapeError, ShapeModel};
use crate::real::Real;

/// Prototype shapes with one number of harmonics.
///
/// *Soft index*: a mixture by weights, [`Self::mix`]; the reference system takes weights from a softmax and brings the mixture to its
/// [normal form](Efd::normalize) again. *Hard index*: one prototype, [`Self::strongest`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PrototypeBank<T> {
    prototypes: Vec<Efd<T>>,
}

impl<T: Real> PrototypeBank<T> {
    /// A bank of `prototypes`, padded with zeros to the largest number of harmonics among them.
    #[must_use]
    pub fn new(mut prototypes: Vec<Efd<T>>) -> Self {
        let harmonic_count = prototypes.iter().map(Efd::harmonic_count).max().unwrap_or(0);
        for efd in &mut prototypes {
            efd.rows.resize(harmonic_count, [T::zero(); 4]);
        }
        Self { prototypes }
    }

    /// The prototypes, one number of harmonics.
    #[must_use]
    pub fn prototypes(&self) -> &[Efd<T>] {
        &self.prototypes
    }

    /// Harmonics of each prototype.
    #[must_use]
    pub fn harmonic_count(&self) -> usize {
        self.prototypes.first().map_or(0, Efd::harmonic_count)
    }

    /// Writes the descriptors sum weight_m x prototype_m.
    ///
    /// *Dimensions*: a weight per prototype, a row per harmonic. *Derivative*: [`Self::mix_vjp`].
    ///
    /// # Errors
    /// [`ShapeError::Length`] if a slice has another length.
    pub fn mix(&self, weights: &[T], rows: &mut [[T; 4]]) -> Result<(), ShapeError> {
        self.check(weights, rows)?;
        rows.fill([T::zero(); 4]);
        for (&weight, prototype) in weights.iter().zip(&self.prototypes) {
            for (value, &part) in rows.as_flattened_mut().iter_mut().zip(prototype.rows.as_flattened()) {
                *value += weight * part;
            }
        }
        Ok(())
    }

    /// Adds to `grad_weights` the gradient of sum(grad_rows x mix); the mixture is linear, so that no weights are needed.
    ///
    /// # Errors
    /// As [`Self::mix`].
    pub fn mix_vjp(&self, grad_rows: &[[T; 4]], grad_weights: &mut [T]) -> Result<(), ShapeError> {
        self.check(grad_weights, grad_rows)?;
        for (grad, prototype) in grad_weights.iter_mut().zip(&self.prototypes) {
            *grad += dot(prototype.rows.as_flattened(), grad_rows.as_flattened());
        }
        Ok(())
    }

    /// The index of the largest weight, the first of equals; none if there are no weights but NaN.
    #[must_use]
    pub fn strongest(weights: &[T]) -> Option<usize> {
        let numbers = weights.iter().copied().enumerate().filter(|(_, weight)| !weight.is_nan());
        numbers.reduce(|best, next| if next.1 > best.1 { next } else { best }).map(|(index, _)| index)
    }

    fn check(&self, weights: &[T], rows: &[[T; 4]]) -> Result<(), ShapeError> {
        let lengths =
            [("weights", self.prototypes.len(), weights.len()), ("mixed EFD", self.harmonic_count(), rows.len())];
        lengths.into_iter().try_for_each(|(what, expected, len)| {
            if len == expected { Ok(()) } else { Err(ShapeError::Length { what, expected, len }) }
        })
    }
}

/// Mixtures of a bank as a shape model: a parameter per prototype, its weight.
///
/// Outlines are linear in descriptors, so that the prototypes' outlines are made once and mixed.
#[derive(Clone, Debug, PartialEq)]
pub struct PrototypeModel<T> {
    vertex_count: usize,
    /// Prototype after prototype.
    outlines: Vec<[T; 2]>,
}

impl<T: Real> PrototypeModel<T> {
    /// The outlines of `bank` in `basis`.
    ///
    /// # Errors
    /// [`ShapeError::TooManyHarmonics`] if the bank has more harmonics than the basis.
    pub fn new(bank: &PrototypeBank<T>, basis: &OutlineBasis<T>) -> Result<Self, ShapeError> {
        let vertex_count = basis.vertex_count();
        let mut outlines = vec![[T::zero(); 2]; vertex_count * bank.prototypes.len()];
        for (prototype, outline) in bank.prototypes.iter().zip(outlines.chunks_exact_mut(vertex_count)) {
            basis.outline(prototype.rows(), outline)?;
        }
        Ok(Self { vertex_count, outlines })
    }
}

impl<T: Real> ShapeModel<T> for PrototypeModel<T> {
    fn parameter_count(&self) -> usize {
        self.outlines.len() / self.vertex_count
    }

    fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    fn outline(&self, parameters: &[T], vertices: &mut [[T; 2]]) -> Result<(), ShapeError> {
        self.check(parameters, vertices)?;
        vertices.fill([T::zero(); 2]);
        for (&weight, outline) in parameters.iter().zip(self.outlines.chunks_exact(self.vertex_count)) {
            for (value, &part) in vertices.as_flattened_mut().iter_mut().zip(outline.as_flattened()) {
                *value += weight * part;
            }
        }
        Ok(())
    }

    fn outline_vjp(
        &self,
        parameters: &[T],
        grad_vertices: &[[T; 2]],
        grad_parameters: &mut [T],
    ) -> Result<(), ShapeError> {
        self.check(parameters, grad_vertices)?;
        self.check(grad_parameters, grad_vertices)?;
        for (grad, outline) in grad_parameters.iter_mut().zip(self.outlines.chunks_exact(self.vertex_count)) {
            *grad += dot(outline.as_flattened(), grad_vertices.as_flattened());
        }
        Ok(())
    }
}

fn dot<T: Real>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).map(|(&a, &b)| a * b).sum()
}
