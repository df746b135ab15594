//! Free descriptors as a shape model: 4 N parameters, a_1, b_1, c_1, d_1, a_2, ...

use super::{OutlineBasis, ShapeError, ShapeModel};
use crate::real::Real;

/// The model whose parameters are the descriptors themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct EfdModel<T> {
    basis: OutlineBasis<T>,
}

impl<T: Real> EfdModel<T> {
    /// A model with as many harmonics and vertices as `basis`.
    #[must_use]
    pub fn new(basis: OutlineBasis<T>) -> Self {
        Self { basis }
    }

    /// The table behind it.
    #[must_use]
    pub fn basis(&self) -> &OutlineBasis<T> {
        &self.basis
    }
}

impl<T: Real> ShapeModel<T> for EfdModel<T> {
    fn parameter_count(&self) -> usize {
        4 * self.basis.harmonic_count()
    }

    fn vertex_count(&self) -> usize {
        self.basis.vertex_count()
    }

    fn outline(&self, parameters: &[T], vertices: &mut [[T; 2]]) -> Result<(), ShapeError> {
        self.check(parameters, vertices)?;
        self.basis.outline(parameters.as_chunks().0, vertices)
    }

    fn outline_vjp(
        &self,
        parameters: &[T],
        grad_vertices: &[[T; 2]],
        grad_parameters: &mut [T],
    ) -> Result<(), ShapeError> {
        self.check(parameters, grad_vertices)?;
        self.check(grad_parameters, grad_vertices)?;
        self.basis.outline_vjp(grad_vertices, grad_parameters.as_chunks_mut().0)
    }
}
