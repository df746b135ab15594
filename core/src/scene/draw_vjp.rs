//! The way back of [`Scene::draw`]: the gradient of a drawing to the gradient of a scene.

use alloc::vec::Vec;

use super::{ColorRamp, ColorStop, DrawingGrad, Object, ObjectGrad, PoseGrad, RampKind, Scene, SceneGrad};
use crate::diff_op::add_scaled;
use crate::real::Real;
use crate::shape::{AnyShape, Efd, Flattening, Outline, OutlineBasis, Prototype, Shape as _, ShapeError};

/// Harmonics pulled back at a time, on the stack.
const ROWS: usize = 32;

impl<T: Real> Scene<T> {
    /// Adds to `grad` the gradient of the scene, given that of its drawing. Allocates nothing for scenes of descriptors;
    /// the rings of other shapes are worked out again.
    ///
    /// *Dimensions*: `grad_drawing` as [`Scene::draw`] laid the drawing out, with the same `how`; `grad` as
    /// [`SceneGrad::reset`] lays it out.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if a layout differs, others as in [`Scene::draw`].
    pub fn draw_vjp<'a>(
        &self,
        how: impl Into<Flattening<'a, T>>,
        grad_drawing: &DrawingGrad<T>,
        grad: &mut SceneGrad<T>,
    ) -> Result<(), ShapeError> {
        self.pull_back_flattened(how.into(), grad_drawing, grad)
    }

    #[inline(never)]
    pub(crate) fn pull_back_flattened(
        &self,
        how: Flattening<'_, T>,
        grad_drawing: &DrawingGrad<T>,
        grad: &mut SceneGrad<T>,
    ) -> Result<(), ShapeError> {
        self.check_layout(how.basis, grad_drawing, grad)?;
        for (value, &g) in grad.background.iter_mut().zip(&grad_drawing.background) {
            *value += g;
        }
        let (mut unit, mut grad_unit) = (Outline::default(), Vec::new());
        let mut rest = &grad_drawing.vertices[..];
        let (mut ramps, mut stops) = (grad_drawing.ramps.iter(), &grad_drawing.stops[..]);
        for ((k, object), grad_object) in self.objects.iter().enumerate().zip(&mut grad.objects) {
            for (value, &g) in grad_object.color.iter_mut().zip(&grad_drawing.colors[k]) {
                *value += g;
            }
            grad_object.confidence += grad_drawing.confidences[k];
            if let Some((ramp, grad_kind)) = object.paint.ramp().zip(ramps.next()) {
                let (own, others) = stops.split_at(ramp.stops.len());
                stops = others;
                pull_back_ramp(object, ramp, grad_kind, own, grad_object);
            }
            let what = "gradient of the vertices";
            let mut take = |expected: usize| {
                let (own, others) =
                    rest.split_at_checked(expected).ok_or(ShapeError::Length { what, expected, len: rest.len() })?;
                rest = others;
                Ok(own)
            };
            match &object.shape {
                AnyShape::Efd(efd) | AnyShape::Prototype(Prototype { efd, .. }) => {
                    pull_back_descriptors(how.basis, object, efd, take(how.basis.vertex_count())?, grad_object);
                }
                shape => {
                    let how = how.magnified(object.pose.scale);
                    unit.clear();
                    shape.flatten(&how, &mut unit)?;
                    let grad_outline = take(unit.vertices.len())?;
                    grad_unit.clear();
                    grad_unit.resize(grad_outline.len(), [T::zero(); 2]);
                    let mut pose = PoseGrad::default();
                    object.pose.transform_vjp(&unit.vertices, grad_outline, &mut pose, &mut grad_unit);
                    pose.add_to(grad_object);
                    shape.flatten_vjp(&how, &grad_unit, &mut grad_object.numbers)?;
                }
            }
        }
        if rest.is_empty() {
            Ok(())
        } else {
            let len = grad_drawing.vertices.len();
            Err(ShapeError::Length { what: "gradient of the vertices", expected: len - rest.len(), len })
        }
    }

    fn ramps(&self) -> impl Iterator<Item = &ColorRamp<T>> {
        self.objects.iter().filter_map(|object| object.paint.ramp())
    }

    fn check_layout(
        &self,
        basis: &OutlineBasis<T>,
        grad_drawing: &DrawingGrad<T>,
        grad: &SceneGrad<T>,
    ) -> Result<(), ShapeError> {
        let count = self.objects.len();
        let lengths = [
            ("gradient of the colors", count, grad_drawing.colors.len()),
            ("gradient of the confidences", count, grad_drawing.confidences.len()),
            ("gradient of the objects", count, grad.objects.len()),
            ("gradient of the ramps", self.ramps().count(), grad_drawing.ramps.len()),
            ("gradient of the stops", self.ramps().map(|ramp| ramp.stops.len()).sum(), grad_drawing.stops.len()),
        ];
        for (what, expected, len) in lengths {
            if len != expected {
                return Err(ShapeError::Length { what, expected, len });
            }
        }
        for (object, grad_object) in self.objects.iter().zip(&grad.objects) {
            let (expected, len) = (object.shape.number_count(), grad_object.numbers.len());
            if len != expected {
                return Err(ShapeError::Length { what: "gradient of the numbers", expected, len });
            }
            let harmonic_count = object.efd_rows().len();
            if harmonic_count > basis.harmonic_count() {
                return Err(ShapeError::TooManyHarmonics { harmonic_count, limit: basis.harmonic_count() });
            }
        }
        Ok(())
    }
}

impl<T: Real> PoseGrad<T> {
    fn add_to(&self, grad: &mut ObjectGrad<T>) {
        add_scaled(&mut grad.translation, &self.translation, T::one());
        grad.scale += self.scale;
        grad.rotation += self.rotation;
    }
}

/// Gradients of pose and ramp from those of the posed ramp. What moves all stops moves the object's color.
fn pull_back_ramp<T: Real>(
    object: &Object<T>,
    ramp: &ColorRamp<T>,
    grad_kind: &RampKind<T>,
    grad_stops: &[ColorStop<T>],
    grad: &mut ObjectGrad<T>,
) {
    let grad_ramp = grad.ramp.get_or_insert_with(|| ramp.zero());
    let mut pose = PoseGrad::default();
    object.pose.transform_vjp(ramp.kind.points(), grad_kind.points(), &mut pose, grad_ramp.kind.points_mut());
    for (sum, stop) in grad_ramp.stops.iter_mut().zip(grad_stops) {
        sum.offset += stop.offset;
        add_scaled(&mut sum.color, &stop.color, T::one());
        add_scaled(&mut grad.color, &stop.color, T::one());
    }
    pose.add_to(grad);
}

/// Gradients of pose and descriptors from those of the posed outline.
///
/// The outline is linear in the descriptors and rotation mixes only x with y, so that the unit outline is not needed:
/// with F the descriptors' gradient as if the pose were the identity, and H = R^T F (rows (a, b) with (c, d)),
/// the gradient is scale H for the descriptors E, <H, E> for the scale and scale <H, J E> for the angle, J a quarter turn.
fn pull_back_descriptors<T: Real>(
    basis: &OutlineBasis<T>,
    object: &Object<T>,
    efd: &Efd<T>,
    grad_outline: &[[T; 2]],
    grad: &mut ObjectGrad<T>,
) {
    for &[gx, gy] in grad_outline {
        grad.translation[0] += gx;
        grad.translation[1] += gy;
    }
    let scale = object.pose.scale;
    let (sin, cos) = object.pose.rotation.sin_cos();
    let chunks = efd.rows().chunks(ROWS).zip(grad.numbers.as_chunks_mut::<4>().0.chunks_mut(ROWS));
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
