//! Unit outlines to their places, as one differentiable step of a batch.

use core::convert::Infallible;

use super::{Pose, PoseGrad};
use crate::diff_op::{DiffOp, OpInput, Signature};
use crate::dims::DimsError;
use crate::real::Real;

/// Unit outlines (objects x vertices x 2), translations (objects x 2, scene units), scales (objects) and rotations
/// (objects, radians) to posed outlines, objects x vertices x 2.
///
/// *Derivative*: [`Pose::transform_vjp`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PoseOp {
    signature: Signature,
    vertices: usize,
}

impl PoseOp {
    /// Poses of `objects` outlines of `vertices` vertices per item.
    ///
    /// # Errors
    /// As [`Dims::new`](crate::dims::Dims::new).
    pub fn new(objects: usize, vertices: usize) -> Result<Self, DimsError> {
        let inputs = [
            OpInput::new("unit outlines", &[objects, vertices, 2])?,
            OpInput::new("translations", &[objects, 2])?,
            OpInput::new("scales", &[objects])?,
            OpInput::new("rotations", &[objects])?,
        ];
        let posed = inputs[0].dims;
        Ok(Self { signature: Signature::new("pose", inputs, posed), vertices })
    }
}

impl<T: Real> DiffOp<T> for PoseOp {
    type Scratch = ();
    type Error = Infallible;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), Infallible> {
        let [outlines, translations, scales, rotations] = self.signature.split(input);
        output.copy_from_slice(outlines);
        let posed = output.as_chunks_mut().0.chunks_exact_mut(self.vertices.max(1));
        for (k, outline) in posed.enumerate() {
            pose(translations, scales, rotations, k).transform(outline);
        }
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        (): &mut (),
    ) -> Result<(), Infallible> {
        let [outlines, translations, scales, rotations] = self.signature.split(input);
        let [grad_outlines, grad_translations, grad_scales, grad_rotations] = self.signature.split_mut(grad_input);
        let count = self.vertices.max(1);
        let units =
            outlines.as_chunks().0.chunks_exact(count).zip(grad_outlines.as_chunks_mut().0.chunks_exact_mut(count));
        for (k, ((unit, grad_unit), grad_posed)) in units.zip(grad_output.as_chunks().0.chunks_exact(count)).enumerate()
        {
            let mut grad = PoseGrad::default();
            pose(translations, scales, rotations, k).transform_vjp(unit, grad_posed, &mut grad, grad_unit);
            grad_translations[2 * k] += grad.translation[0];
            grad_translations[2 * k + 1] += grad.translation[1];
            grad_scales[k] += grad.scale;
            grad_rotations[k] += grad.rotation;
        }
        Ok(())
    }
}

/// The pose of object `k`.
fn pose<T: Real>(translations: &[T], scales: &[T], rotations: &[T], k: usize) -> Pose<T> {
    Pose { translation: [translations[2 * k], translations[2 * k + 1]], scale: scales[k], rotation: rotations[k] }
}
