//! The way back of [`Scene::draw`]: the gradient of a drawing to the gradient of a scene.

use super::{DrawingGrad, Object, ObjectGrad, Scene, SceneGrad};
use crate::real::Real;
use crate::shape::{OutlineBasis, ShapeError};

/// Harmonics pulled back at a time, on the stack.
const ROWS: usize = 32;

impl<T: Real> Scene<T> {
    /// Adds to `grad` the gradient of the scene, given that of its drawing; allocates nothing.
    ///
    /// *Dimensions*: `grad_drawing` as [`Scene::draw`] laid the drawing out, `grad` as [`SceneGrad::reset`] lays it out.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if a layout differs, [`ShapeError::TooManyHarmonics`] as in [`Scene::draw`].
    pub fn draw_vjp(
        &self,
        basis: &OutlineBasis<T>,
        grad_drawing: &DrawingGrad<T>,
        grad: &mut SceneGrad<T>,
    ) -> Result<(), ShapeError> {
        self.check_layout(basis, grad_drawing, grad)?;
        for (value, &g) in grad.background.iter_mut().zip(&grad_drawing.background) {
            *value += g;
        }
        let outlines = grad_drawing.vertices.chunks_exact(basis.vertex_count());
        for ((k, object), grad_outline) in self.objects.iter().enumerate().zip(outlines) {
            let grad_object = &mut grad.objects[k];
            for (value, &g) in grad_object.color.iter_mut().zip(&grad_drawing.colors[k]) {
                *value += g;
            }
            grad_object.confidence += grad_drawing.confidences[k];
            pull_back_outline(basis, object, grad_outline, grad_object);
        }
        Ok(())
    }

    fn check_layout(
        &self,
        basis: &OutlineBasis<T>,
        grad_drawing: &DrawingGrad<T>,
        grad: &SceneGrad<T>,
    ) -> Result<(), ShapeError> {
        let count = self.objects.len();
        let lengths = [
            ("gradient of the vertices", count * basis.vertex_count(), grad_drawing.vertices.len()),
            ("gradient of the colors", count, grad_drawing.colors.len()),
            ("gradient of the confidences", count, grad_drawing.confidences.len()),
            ("gradient of the objects", count, grad.objects.len()),
        ];
        for (what, expected, len) in lengths {
            if len != expected {
                return Err(ShapeError::Length { what, expected, len });
            }
        }
        for (object, grad_object) in self.objects.iter().zip(&grad.objects) {
            let (expected, len) = (object.efd.harmonic_count(), grad_object.efd.len());
            if len != expected {
                return Err(ShapeError::Length { what: "gradient of the EFD", expected, len });
            }
            if expected > basis.harmonic_count() {
                return Err(ShapeError::TooManyHarmonics { harmonic_count: expected, limit: basis.harmonic_count() });
            }
        }
        Ok(())
    }
}

/// Gradients of pose and descriptors from those of the posed outline.
///
/// The outline is linear in the descriptors and rotation mixes only x with y, so that the unit outline is not needed:
/// with F the descriptors' gradient as if the pose were the identity, and H = R^T F (rows (a, b) with (c, d)),
/// the gradient is scale H for the descriptors E, <H, E> for the scale and scale <H, J E> for the angle, J a quarter turn.
fn pull_back_outline<T: Real>(
    basis: &OutlineBasis<T>,
    object: &Object<T>,
    grad_outline: &[[T; 2]],
    grad: &mut ObjectGrad<T>,
) {
    for &[gx, gy] in grad_outline {
        grad.translation[0] += gx;
        grad.translation[1] += gy;
    }
    let scale = object.pose.scale;
    let (sin, cos) = object.pose.rotation.sin_cos();
    let chunks = object.efd.rows().chunks(ROWS).zip(grad.efd.chunks_mut(ROWS));
    for (chunk, (rows, grad_rows)) in chunks.enumerate() {
        let mut plain = [[T::zero(); 4]; ROWS];
        basis.pull_back(chunk * ROWS, grad_outline, &mut plain[..rows.len()]);
        for ((&[a, b, c, d], grad_row), &[fa, fb, fc, fd]) in rows.iter().zip(grad_rows).zip(&plain) {
            let [ha, hb] = [cos * fa + sin * fc, cos * fb + sin * fd];
            let [hc, hd] = [cos * fc - sin * fa, cos * fd - sin * fb];
            grad.scale += ha * a + hb * b + hc * c + hd * d;
            grad.rotation += scale * (hc * a + hd * b - ha * c - hb * d);
            for (value, h) in grad_row.iter_mut().zip([ha, hb, hc, hd]) {
                *value += scale * h;
            }
        }
    }
}
