//! The paper's L_p as a differentiable step of a batch.

use alloc::vec::Vec;

use super::{Loss, LossError, SceneLoss, SceneLossScratch, ScenePairs};
use crate::diff_op::{DiffOp, OpInput, Signature, add_scaled};
use crate::dims::{Dims, DimsError};
use crate::real::Real;
use crate::scene::{Object, Pose, Scene, SceneGrad};
use crate::shape::Efd;

/// Predicted scenes to their L_p against a true scene each: a number per item; the batch's loss is the mean over items.
///
/// Inputs: translations (objects x 2, scene units), scales (objects), rotations (objects, radians), colors (objects x 3),
/// confidences (objects), descriptors (objects x harmonics x 4), background (3).
///
/// *Derivative*: that of [`SceneLoss`]; matched once, when the loss is worked out, whose gradient is kept.
#[derive(Clone, Debug)]
pub struct SceneLossOp<T> {
    loss: SceneLoss<T>,
    truths: Vec<Scene<T>>,
    signature: Signature,
}

impl<T: Real> SceneLossOp<T> {
    /// Losses against `truths`, one per item, of predictions of `objects` objects with `harmonics` harmonics.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(loss: SceneLoss<T>, truths: Vec<Scene<T>>, objects: usize, harmonics: usize) -> Result<Self, DimsError> {
        let inputs = [
            OpInput::new("translations", &[objects, 2])?,
            OpInput::new("scales", &[objects])?,
            OpInput::new("rotations", &[objects])?,
            OpInput::new("colors", &[objects, 3])?,
            OpInput::new("confidences", &[objects])?,
            OpInput::new("descriptors", &[objects, harmonics, 4])?,
            OpInput::new("background", &[3])?,
        ];
        let signature = Signature::new("scene loss", inputs, Dims::SCALAR).for_batch(truths.len()).keeping_gradient();
        Ok(Self { loss, truths, signature })
    }

    /// The scene of an item's values.
    fn scene(&self, item: &[T]) -> Scene<T> {
        let [translations, scales, rotations, colors, confidences, rows, background] = self.signature.split(item);
        let mut scene = Scene::empty([T::zero(); 3]);
        scene.background.copy_from_slice(background);
        let harmonics = (rows.len() / 4 / scales.len().max(1)).max(1);
        let shapes = rows.as_chunks::<4>().0.chunks_exact(harmonics);
        for (k, shape) in shapes.enumerate() {
            let translation = [translations[2 * k], translations[2 * k + 1]];
            let pose = Pose { translation, scale: scales[k], rotation: rotations[k] };
            let color = [colors[3 * k], colors[3 * k + 1], colors[3 * k + 2]];
            scene.objects.push(Object::of_efd(pose, color, confidences[k], Efd::new(shape.to_vec()), None));
        }
        scene
    }

    /// Adds a scene's gradient in the layout of the inputs.
    fn give(&self, grad: &SceneGrad<T>, values: &mut [T]) {
        let [translations, scales, rotations, colors, confidences, rows, background] = self.signature.split_mut(values);
        add_scaled(background, &grad.background, T::one());
        let harmonics = rows.len() / 4 / scales.len().max(1);
        for (k, object) in grad.objects.iter().enumerate() {
            add_scaled(&mut translations[2 * k..], &object.translation, T::one());
            add_scaled(&mut scales[k..], &[object.scale], T::one());
            add_scaled(&mut rotations[k..], &[object.rotation], T::one());
            add_scaled(&mut colors[3 * k..], &object.color, T::one());
            add_scaled(&mut confidences[k..], &[object.confidence], T::one());
            add_scaled(&mut rows[4 * harmonics * k..], &object.numbers, T::one());
        }
    }
}

impl<T: Real> DiffOp<T> for SceneLossOp<T> {
    type Scratch = SceneLossScratch<T>;
    type Error = LossError;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(
        &self,
        item: usize,
        input: &[T],
        output: &mut [T],
        saved: &mut [T],
        scratch: &mut Self::Scratch,
    ) -> Result<(), LossError> {
        let scene = self.scene(input);
        let pairs = ScenePairs::new(core::slice::from_ref(&scene), core::slice::from_ref(&self.truths[item]))?;
        if saved.is_empty() {
            output[0] = self.loss.value(pairs, scratch)?;
            return Ok(());
        }
        let mut grad = SceneGrad::default();
        grad.reset(&scene);
        output[0] = self.loss.vjp(pairs, T::one(), scratch, core::slice::from_mut(&mut grad))?;
        self.give(&grad, saved);
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        _: &[T],
        saved: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        _: &mut Self::Scratch,
    ) -> Result<(), LossError> {
        add_scaled(grad_input, saved, grad_output[0]);
        Ok(())
    }
}
