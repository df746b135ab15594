//! Polygons of several rings.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::{PoseFreedom, Shape, check_finite, check_length, check_numbers};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::Boundary;
use crate::shape::{Flattening, Outline, ShapeError};

/// What lies inside of an odd number of closed polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygon<T> {
    /// The corners of each ring; the edge from the last corner to the first is part of it.
    pub rings: Vec<Vec<[T; 2]>>,
}

impl<T: Real> Polygon<T> {
    /// A polygon of several rings.
    ///
    /// # Errors
    /// [`ShapeError::TooFewPoints`] if a ring has less than three corners, [`ShapeError::NotFinite`].
    pub fn new(rings: Vec<Vec<[T; 2]>>) -> Result<Self, ShapeError> {
        if let Some(ring) = rings.iter().find(|ring| ring.len() < 3) {
            return Err(ShapeError::TooFewPoints { len: ring.len() });
        }
        check_finite(rings.iter().flatten().flatten())?;
        Ok(Self { rings })
    }
}

impl<T: Real> Shape<T> for Polygon<T> {
    fn kind(&self) -> &'static str {
        "polygon"
    }

    fn number_count(&self) -> usize {
        self.rings.iter().map(|ring| 2 * ring.len()).sum()
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        numbers.extend(self.rings.iter().flatten().flatten());
    }

    fn number_names(&self) -> Vec<String> {
        let corners = self.rings.iter().enumerate().flat_map(|(i, ring)| (0..ring.len()).map(move |k| (i, k)));
        corners.flat_map(|(i, k)| [0, 1].map(|axis| format!("rings[{i}][{k}][{axis}]"))).collect()
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        check_numbers(self.number_count(), numbers)?;
        self.rings.iter_mut().flatten().flatten().zip(numbers).for_each(|(place, &number)| *place = number);
        Ok(())
    }

    fn pose_freedom(&self) -> PoseFreedom {
        PoseFreedom::NONE
    }

    fn flatten(&self, _: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        check_finite(self.rings.iter().flatten().flatten())?;
        self.rings.iter().for_each(|ring| outline.push_ring(ring.iter().copied()));
        Ok(())
    }

    fn flatten_vjp(
        &self,
        _: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        let count = self.number_count();
        check_length("gradient of the numbers", count, grad_numbers.len())?;
        check_length("gradient of the vertices", count / 2, grad_vertices.len())?;
        grad_numbers.iter_mut().zip(grad_vertices.as_flattened()).for_each(|(sum, &grad)| *sum += grad);
        Ok(())
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        check_finite(self.rings.iter().flatten().flatten())?;
        let mut boundary = Boundary::default();
        for ring in &self.rings {
            boundary.push_polygon(&ring.iter().map(|&corner| Vec2::from(corner)).collect::<Vec<_>>());
        }
        Ok(boundary)
    }
}
