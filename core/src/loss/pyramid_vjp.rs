//! The way back of halving an image.

use super::pyramid::under;
use crate::dims::ImageSize;
use crate::real::Real;

/// Adds the gradient of a halved image to that of the image it was made of.
pub(super) fn halve_vjp<T: Real>(size: ImageSize, grad: &mut [T], above: ImageSize, grad_above: &[T]) {
    let planes = grad.chunks_exact_mut(size.pixels()).zip(grad_above.chunks_exact(above.pixels()));
    for (plane, plane_above) in planes {
        for (r, row_above) in plane_above.chunks_exact(above.width()).enumerate() {
            let rows = under(r, size.height());
            for (c, &value) in row_above.iter().enumerate() {
                let columns = under(c, size.width());
                let each = value / T::of_usize(rows.len() * columns.len());
                for y in rows.clone() {
                    plane[y * size.width()..][columns.clone()].iter_mut().for_each(|grad| *grad += each);
                }
            }
        }
    }
}
