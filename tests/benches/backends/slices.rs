//! The step on slices, item by item, in memory kept from step to step: what the core costs without any tensors.

use dvp_core::Image;
use dvp_core::diff_op::DiffOp;
use dvp_core::real::Real;
use dvp_core::render::{ContourRenderer, RenderLossOp, RenderOp};
use dvp_core::scene::PoseOp;
use dvp_core::shape::{OutlineOp, PrototypeModel};
use dvp_fit::adam::Adam;

use super::{LEARNING_RATE, OBJECTS, Outcome, PROTOTYPES, SCALES, VERTICES, size, width};

/// A number for each parameter of each item, in the order of [`PARAMETERS`](super::PARAMETERS).
pub(crate) type Batch = [Vec<f32>; 7];

/// Outlines to their pixel losses.
pub(crate) type LossOp = RenderLossOp<f32, ContourRenderer<f32>>;

/// Numbers in the outlines of an item.
const OUTLINES: usize = OBJECTS * VERTICES * 2;

/// Steps and memory. What is per item is overwritten by the next.
pub(crate) struct Slices {
    outline: OutlineOp<PrototypeModel<f32>>,
    pose: PoseOp,
    items: usize,
    /// Parameters in the units of scenes, and gradients of the loss.
    scenes: Batch,
    grads: Batch,
    /// Inputs of the pose of one item, and of its renderer; what the loss keeps; gradients of both inputs.
    posing: Vec<f32>,
    drawing: Vec<f32>,
    saved: Vec<f32>,
    grad_posing: Vec<f32>,
    grad_drawing: Vec<f32>,
    scratch: <LossOp as DiffOp<f32>>::Scratch,
}

impl Slices {
    pub(crate) fn new(outline: OutlineOp<PrototypeModel<f32>>, pose: PoseOp, items: usize) -> Self {
        let zeros = || core::array::from_fn(|k| vec![0.0; items * width(k)]);
        let posing = vec![0.0; DiffOp::<f32>::signature(&pose).input_len()];
        let drawing = vec![0.0; OUTLINES + width(1) + width(2) + width(0)];
        Self {
            outline,
            pose,
            items,
            scenes: zeros(),
            grads: zeros(),
            grad_posing: posing.clone(),
            posing,
            saved: drawing.clone(),
            grad_drawing: drawing.clone(),
            drawing,
            scratch: Default::default(),
        }
    }

    /// The images of scenes.
    pub(crate) fn paint(&mut self, raw: &Batch, renderer: ContourRenderer<f32>) -> Outcome<Vec<Image<f32>>> {
        activate(raw, &mut self.scenes);
        let (op, items) = (RenderOp::new(renderer, size(), OBJECTS, VERTICES)?, self.items);
        let image = |item| {
            self.draw(item)?;
            let mut image = Image::zeros(size());
            op.forward(item, &self.drawing, image.data_mut(), &mut [], &mut self.scratch)?;
            Ok(image)
        };
        (0..items).map(image).collect()
    }

    /// One step; the mean loss before it.
    pub(crate) fn step(&mut self, loss: &LossOp, raw: &mut Batch, adam: &mut [Adam<f32>; 7]) -> Outcome<f64> {
        activate(raw, &mut self.scenes);
        let share = 1.0 / self.items as f64;
        let mut mean = 0.0;
        for item in 0..self.items {
            self.draw(item)?;
            self.saved.fill(0.0);
            let mut value = [0.0];
            loss.forward(item, &self.drawing, &mut value, &mut self.saved, &mut self.scratch)?;
            mean += share * f64::from(value[0]);
            self.grad_drawing.fill(0.0);
            let share = [f32::of(share)];
            loss.vjp(item, &self.drawing, &self.saved, &share, &mut self.grad_drawing, &mut self.scratch)?;
            self.pull_back(item)?;
        }
        activate_vjp(&self.scenes, &mut self.grads);
        for ((values, grad), adam) in raw.iter_mut().zip(&self.grads).zip(adam) {
            adam.step(values, grad, LEARNING_RATE);
        }
        Ok(mean)
    }

    /// What the renderer takes of an item, into `drawing`.
    fn draw(&mut self, item: usize) -> Outcome<()> {
        let scene = self.scenes.each_ref().map(|values| row(values, item, self.items));
        let [background, colors, confidences, weights, rotations, scales, translations] = scene;
        let (units, poses) = self.posing.split_at_mut(OUTLINES);
        self.outline.forward(item, weights, units, &mut [], &mut ())?;
        join([translations, scales, rotations], poses);
        let (outlines, rest) = self.drawing.split_at_mut(OUTLINES);
        self.pose.forward(item, &self.posing, outlines, &mut [], &mut ())?;
        join([colors, confidences, background], rest);
        Ok(())
    }

    /// The gradient of `drawing` to that of the item's scene.
    fn pull_back(&mut self, item: usize) -> Outcome<()> {
        let (outlines, rest) = self.grad_drawing.split_at(OUTLINES);
        self.grad_posing.fill(0.0);
        self.pose.vjp(item, &self.posing, &[], outlines, &mut self.grad_posing, &mut ())?;
        let (units, poses) = self.grad_posing.split_at(OUTLINES);
        let grads = self.grads.each_mut().map(|values| {
            let len = values.len() / self.items;
            &mut values[item * len..][..len]
        });
        let [background, colors, confidences, weights, rotations, scales, translations] = grads;
        weights.fill(0.0);
        self.outline.vjp(item, row(&self.scenes[3], item, self.items), &[], units, weights, &mut ())?;
        cut(poses, [translations, scales, rotations]);
        cut(rest, [colors, confidences, background]);
        Ok(())
    }
}

/// An item's numbers.
fn row(values: &[f32], item: usize, items: usize) -> &[f32] {
    let len = values.len() / items;
    &values[item * len..][..len]
}

/// Parts one after the other.
fn join(parts: [&[f32]; 3], mut to: &mut [f32]) {
    for part in parts {
        let (head, tail) = to.split_at_mut(part.len());
        head.copy_from_slice(part);
        to = tail;
    }
}

/// Undoes [`join`].
fn cut(mut from: &[f32], parts: [&mut [f32]; 3]) {
    for part in parts {
        let (head, tail) = from.split_at(part.len());
        part.copy_from_slice(head);
        from = tail;
    }
}

/// Parameters to the units of scenes.
fn activate(raw: &Batch, scenes: &mut Batch) {
    for (scene, raw) in scenes.iter_mut().zip(raw) {
        scene.copy_from_slice(raw);
    }
    for k in [0, 1, 2, 5, 6] {
        scenes[k].iter_mut().for_each(|x| *x = 1.0 / (1.0 + (-*x).exp()));
    }
    for weights in scenes[3].chunks_exact_mut(PROTOTYPES) {
        let most = weights.iter().copied().fold(f32::MIN, f32::max);
        weights.iter_mut().for_each(|x| *x = (*x - most).exp());
        let sum: f32 = weights.iter().sum();
        weights.iter_mut().for_each(|x| *x /= sum);
    }
    scenes[5].iter_mut().for_each(|x| *x = f32::of(SCALES[0]) * *x + f32::of(SCALES[1]));
}

/// Gradients of what [`activate`] gave to those of what it took, in place.
fn activate_vjp(scenes: &Batch, grads: &mut Batch) {
    for (k, factor) in [(0, 1.0), (1, 1.0), (2, 1.0), (5, SCALES[0]), (6, 1.0)] {
        let offset = if k == 5 { SCALES[1] } else { 0.0 };
        for (slope, &value) in grads[k].iter_mut().zip(&scenes[k]) {
            let unit = (value - f32::of(offset)) / f32::of(factor);
            *slope *= f32::of(factor) * unit * (1.0 - unit);
        }
    }
    for (slopes, weights) in grads[3].chunks_exact_mut(PROTOTYPES).zip(scenes[3].chunks_exact(PROTOTYPES)) {
        let mean: f32 = slopes.iter().zip(weights).map(|(slope, weight)| slope * weight).sum();
        slopes.iter_mut().zip(weights).for_each(|(slope, weight)| *slope = weight * (*slope - mean));
    }
}
