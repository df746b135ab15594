//! Free polygons as a shape model: 2 K parameters, x_0, y_0, x_1, y_1, ...

use super::{ShapeError, ShapeModel};
use crate::real::Real;

/// The model whose parameters are the vertices themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Polygon {
    vertex_count: usize,
}

impl Polygon {
    /// Polygons of `vertex_count` vertices.
    ///
    /// # Errors
    /// [`ShapeError::TooFewPoints`] below 3.
    pub fn new(vertex_count: usize) -> Result<Self, ShapeError> {
        if vertex_count < 3 {
            return Err(ShapeError::TooFewPoints { len: vertex_count });
        }
        Ok(Self { vertex_count })
    }
}

impl<T: Real> ShapeModel<T> for Polygon {
    fn parameter_count(&self) -> usize {
        2 * self.vertex_count
    }

    fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    fn outline(&self, parameters: &[T], vertices: &mut [[T; 2]]) -> Result<(), ShapeError> {
        self.check(parameters, vertices)?;
        vertices.copy_from_slice(parameters.as_chunks().0);
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
        for (value, &grad) in grad_parameters.iter_mut().zip(grad_vertices.as_flattened()) {
            *value += grad;
        }
        Ok(())
    }
}
