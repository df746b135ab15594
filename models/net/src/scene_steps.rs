//! The core's differentiable steps on predicted scenes: outlines, poses, images, losses.

use alloc::sync::Arc;
use core::fmt;

use dvp_core::diff_op::{Batched, HostOp};
use dvp_core::loss::{SceneLoss, SceneLossOp, SceneTerms};
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, RenderLossOp, RenderOp, Renderer};
use dvp_core::scene::PoseOp;
use dvp_core::shape::{EfdModel, OutlineBasis, OutlineOp, REFERENCE_VERTICES};
use dvp_core::tensor::{Backend, Tensor, TensorError};
use dvp_core::{Drawing, Image, ImageSize, Real, Scene};

use crate::error::NetError;
use crate::model::Prediction;

/// Most harmonics of a true outline: those that MDS-HR is generated with.
const TRUE_HARMONICS: usize = 64;

/// Slots of the reference's model.
const REFERENCE_SLOTS: usize = 8;

/// What predictions of one extent are painted and judged by.
#[derive(Clone)]
pub struct SceneSteps<T: Real> {
    outline: Arc<dyn HostOp>,
    pose: Arc<dyn HostOp>,
    renderer: ContourRenderer<T>,
    edge: EdgeProfile<T>,
    basis: OutlineBasis<T>,
    loss: SceneLoss<T>,
    objects: usize,
    harmonics: usize,
}

impl<T: Real> fmt::Debug for SceneSteps<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SceneSteps").field("objects", &self.objects).field("harmonics", &self.harmonics).finish()
    }
}

impl<T: Real> SceneSteps<T> {
    /// Steps for scenes of `objects` objects with `harmonics` harmonics, painted with `edge`, overlaps blended; L_p with
    /// the reference's settings.
    ///
    /// # Errors
    /// [`NetError::Shape`] without a harmonic; [`NetError::Tensor`] if the extents are too large.
    pub fn new(objects: usize, harmonics: usize, edge: EdgeProfile<T>) -> Result<Self, NetError> {
        let basis = OutlineBasis::new(REFERENCE_VERTICES, harmonics)?;
        let outline = OutlineOp::new::<T>(EfdModel::new(basis), objects).map_err(TensorError::from)?;
        let pose = PoseOp::new(objects, REFERENCE_VERTICES).map_err(TensorError::from)?;
        let widest = harmonics.max(TRUE_HARMONICS);
        let mut loss = SceneLoss::reference(REFERENCE_VERTICES, widest)?;
        // The reference takes the mean over 8 slots: an object that is missed counts as much among more.
        loss.weights.confidence = T::of_usize(objects.max(REFERENCE_SLOTS)) / T::of_usize(REFERENCE_SLOTS);
        Ok(Self {
            outline: Arc::new(Batched::<T, _>::new(outline)),
            pose: Arc::new(Batched::<T, _>::new(pose)),
            renderer: ContourRenderer::new(edge, Compositing::Blend),
            edge,
            basis: OutlineBasis::new(REFERENCE_VERTICES, widest)?,
            loss,
            objects,
            harmonics,
        })
    }

    /// The weights of the terms of L_p.
    pub fn weights_mut(&mut self) -> &mut SceneTerms<T> {
        &mut self.loss.weights
    }

    /// The edge profile that scenes are painted with.
    #[must_use]
    pub fn edge(&self) -> EdgeProfile<T> {
        self.edge
    }

    /// Posed outlines, batch x objects x vertices x 2, scene units.
    fn outlines<B: Backend>(&self, scenes: &Prediction<B>) -> Result<Tensor<B>, TensorError> {
        let batch = scenes.background.dims().get(0).unwrap_or(0);
        let rows = scenes.descriptors.reshape(&[batch, self.objects, 4 * self.harmonics])?;
        let unit = Tensor::apply_shared(&self.outline, &[&rows])?;
        Tensor::apply_shared(&self.pose, &[&unit, &scenes.translations, &scenes.scales, &scenes.rotations])
    }

    /// Images of predicted scenes, batch x 3 x height x width.
    ///
    /// # Errors
    /// [`NetError::Tensor`] if a scene cannot be painted, or is of other extents than these steps.
    pub fn render<B: Backend>(&self, scenes: &Prediction<B>, size: ImageSize) -> Result<Tensor<B>, NetError> {
        let op = RenderOp::new(self.renderer, size, self.objects, REFERENCE_VERTICES).map_err(TensorError::from)?;
        let outlines = self.outlines(scenes)?;
        let inputs = [&outlines, &scenes.colors, &scenes.confidences, &scenes.background];
        Ok(Tensor::apply::<T, _>(op, &inputs)?)
    }

    /// L_x: the pixel loss of predicted scenes against a target each, mean over the batch.
    ///
    /// # Errors
    /// As [`Self::render`].
    pub fn image_loss<B: Backend>(
        &self,
        scenes: &Prediction<B>,
        targets: Vec<Image<T>>,
        loss: PixelLoss,
    ) -> Result<Tensor<B>, NetError> {
        let op = RenderLossOp::new(self.renderer, loss, targets, self.objects, REFERENCE_VERTICES)
            .map_err(TensorError::from)?;
        let outlines = self.outlines(scenes)?;
        let inputs = [&outlines, &scenes.colors, &scenes.confidences, &scenes.background];
        Ok(Tensor::apply::<T, _>(op, &inputs)?.mean_all()?)
    }

    /// L_p: the loss of predicted scenes against a true one each, mean over the batch.
    ///
    /// # Errors
    /// [`NetError::Tensor`] if there are more true objects than slots, or the extents are not those of these steps.
    pub fn parameter_loss<B: Backend>(
        &self,
        scenes: &Prediction<B>,
        truths: Vec<Scene<T>>,
    ) -> Result<Tensor<B>, NetError> {
        let op =
            SceneLossOp::new(self.loss.clone(), truths, self.objects, self.harmonics).map_err(TensorError::from)?;
        Ok(Tensor::apply::<T, _>(op, &scenes.parts())?.mean_all()?)
    }

    /// The image of a scene, without a gradient.
    ///
    /// # Errors
    /// [`NetError::Shape`] if it has more than 64 harmonics, [`NetError::Render`] if a number is out of range.
    pub fn paint(&self, scene: &Scene<T>, size: ImageSize) -> Result<Image<T>, NetError> {
        let (mut drawing, mut image) = (Drawing::default(), Image::zeros(size));
        scene.draw(&self.basis, &mut drawing)?;
        self.renderer.render(&drawing, size, &mut Default::default(), image.data_mut())?;
        Ok(image)
    }
}

/// Images of one size as a tensor, batch x 3 x height x width.
///
/// # Errors
/// [`TensorError::Values`] if their sizes differ.
#[inline(never)]
pub fn image_tensor<T: Real, B: Backend>(images: &[Image<T>], device: &B::Device) -> Result<Tensor<B>, TensorError> {
    let size = images.first().map_or([0; 2], |image| [image.size().height(), image.size().width()]);
    let values: Vec<T> = images.iter().flat_map(|image| image.data()).copied().collect();
    Tensor::new(values, &[images.len(), 3, size[0], size[1]], device)
}
