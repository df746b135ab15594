//! The mean length of unit outlines: a price on contours that wind.

use alloc::vec::Vec;

use super::length_vjp::outline_length_vjp;
use super::{Loss, LossError, check_length};
use crate::real::Real;
use crate::scene::{Object, ObjectGrad};
use crate::shape::OutlineBasis;

/// Mean over objects of the length of their unit outlines, pose left aside; 0 without objects.
///
/// *Source*: the price that the reference's Opt-Iter and Rand-OptP add to the image loss, there with weight 0.01.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourLength<T> {
    basis: OutlineBasis<T>,
}

impl<T: Real> ContourLength<T> {
    /// The length of the polygons that `basis` samples.
    #[must_use]
    pub fn new(basis: OutlineBasis<T>) -> Self {
        Self { basis }
    }
}

impl<T: Real> Loss<T> for ContourLength<T> {
    type Input<'a> = &'a [Object<T>];
    /// One per object; only `numbers` is written, which must have room for the object's descriptors.
    type Grad = [ObjectGrad<T>];
    /// The vertices of one outline and their gradient.
    type Scratch = [Vec<[T; 2]>; 2];

    fn value(&self, objects: &[Object<T>], [vertices, _]: &mut Self::Scratch) -> Result<T, LossError> {
        vertices.resize(self.basis.vertex_count(), [T::zero(); 2]);
        let mut sum = T::zero();
        for object in objects {
            self.basis.outline(object.shape.descriptors()?.rows(), vertices)?;
            sum += outline_length(vertices);
        }
        Ok(sum / T::of_usize(objects.len().max(1)))
    }

    fn vjp(
        &self,
        objects: &[Object<T>],
        cotangent: T,
        [vertices, grad_vertices]: &mut Self::Scratch,
        grad: &mut [ObjectGrad<T>],
    ) -> Result<T, LossError> {
        check_length("object gradients", grad, objects.len())?;
        let (zero, count) = ([T::zero(); 2], T::of_usize(objects.len().max(1)));
        vertices.resize(self.basis.vertex_count(), zero);
        let mut sum = T::zero();
        for (object, grad) in objects.iter().zip(grad) {
            let descriptors = object.shape.descriptors()?;
            check_length("gradient of the descriptors", grad.efd_rows(), descriptors.harmonic_count())?;
            self.basis.outline(descriptors.rows(), vertices)?;
            grad_vertices.clear();
            grad_vertices.resize(vertices.len(), zero);
            sum += outline_length_vjp(vertices, cotangent / count, grad_vertices);
            self.basis.outline_vjp(grad_vertices, grad.efd_rows_mut())?;
        }
        Ok(sum / count)
    }
}

/// The length of a closed polygon, the edge from its last vertex to its first included.
///
/// *Derivative*: [`outline_length_vjp`]; not differentiable where an edge has length 0, which then adds nothing.
#[must_use]
pub fn outline_length<T: Real>(vertices: &[[T; 2]]) -> T {
    edges(vertices.len()).map(|(i, j)| edge(vertices[i], vertices[j])[2]).sum()
}

/// Start and end of each edge of a closed polygon of `len` vertices.
pub(super) fn edges(len: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..len).map(move |i| (i, if i + 1 == len { 0 } else { i + 1 }))
}

/// The edge from `a` to `b`: dx, dy and its length.
pub(super) fn edge<T: Real>(a: [T; 2], b: [T; 2]) -> [T; 3] {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    [dx, dy, (dx * dx + dy * dy).sqrt()]
}
