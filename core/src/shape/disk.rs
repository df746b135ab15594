//! The unit disk as a shape model without parameters.

use alloc::vec::Vec;

use num_traits::Float;

use super::{ShapeError, ShapeModel};
use crate::real::Real;

/// A regular polygon with its corners on the unit circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Disk<T> {
    vertices: Vec<[T; 2]>,
}

impl<T: Real> Disk<T> {
    /// A disk of `vertex_count` distinct vertices.
    ///
    /// # Errors
    /// [`ShapeError::TooFewPoints`] below 3.
    pub fn new(vertex_count: usize) -> Result<Self, ShapeError> {
        if vertex_count < 3 {
            return Err(ShapeError::TooFewPoints { len: vertex_count });
        }
        let step = core::f64::consts::TAU / f64::of_usize(vertex_count);
        let angles = (0..vertex_count).map(|i| step * f64::of_usize(i));
        Ok(Self { vertices: angles.map(|angle| [T::of(Float::cos(angle)), T::of(Float::sin(angle))]).collect() })
    }
}

impl<T: Real> ShapeModel<T> for Disk<T> {
    fn parameter_count(&self) -> usize {
        0
    }

    fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    fn outline(&self, parameters: &[T], vertices: &mut [[T; 2]]) -> Result<(), ShapeError> {
        self.check(parameters, vertices)?;
        vertices.copy_from_slice(&self.vertices);
        Ok(())
    }

    fn outline_vjp(
        &self,
        parameters: &[T],
        grad_vertices: &[[T; 2]],
        grad_parameters: &mut [T],
    ) -> Result<(), ShapeError> {
        self.check(parameters, grad_vertices)?;
        self.check(grad_parameters, grad_vertices)
    }
}
