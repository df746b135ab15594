//! The renderer in tensor operations alone: on every backend the images, the losses and the gradients of the contour
//! renderer, which is a step of the core, and central differences.

use dvp_core::ImageSize;
use dvp_core::real::DType;
use dvp_core::render::{
    Compositing, ContourRenderer, DenseRenderer, EdgeProfile, PixelLoss, RenderLossOp, RenderOp, TensorDrawing,
};
use dvp_core::tensor::{Backend, Tensor, TensorError};
use proptest::prelude::*;

use crate::check::{Computation, agree, check, close, evaluate};
use crate::input::Input;
use crate::registry::{Outcome, Tally, Tested, for_cases, on_every_backend};
use crate::step::cases::{DRAWING, compositing, soft, targets};
use crate::step::{Step, step};

/// Most by which the output and the gradients may differ from those of the contour renderer, in a number type; relative to
/// the largest number of an array, or to 1 if that is smaller.
struct Apart {
    dtype: DType,
    output: f64,
    gradient: f64,
}

/// Soft edges have no pixel that either renderer cuts off or counts as full: what is left is the rounding of sums over edges
/// and of e^x. In f32 the distance of a pixel, a difference of positions, keeps fewer digits the closer it is to an edge,
/// and so does the direction in which the edge would have to move.
const SOFT: [Apart; 2] = [
    Apart { dtype: DType::F64, output: 1e-10, gradient: 1e-10 },
    Apart { dtype: DType::F32, output: 1e-6, gradient: 1e-3 },
];

/// With the reference's sharp edges coverage within 1e-6 of 1 is 1 in the contour renderer: what it leaves out of a gradient
/// that can reach several hundred per pixel (1 / (4 sigma) per squared distance, 0.2 of that per scene unit) is below 1e-4
/// for the cases here.
const SHARP: [Apart; 2] = [
    Apart { dtype: DType::F64, output: 1e-6, gradient: 1e-4 },
    Apart { dtype: DType::F32, output: 1e-5, gradient: 1e-4 },
];

/// Drawings to images or, with a loss and targets, to their losses.
#[derive(Clone, Debug)]
struct Dense {
    renderer: DenseRenderer,
    size: ImageSize,
    against: Option<(PixelLoss, Vec<f64>)>,
}

impl Computation for Dense {
    fn run<B: Backend>(&self, inputs: &[Tensor<B>]) -> Result<Tensor<B>, TensorError> {
        let [outlines, colors, confidences, background] = [0, 1, 2, 3].map(|k| inputs[k].clone());
        let drawing = TensorDrawing { outlines, colors, confidences, background };
        let Some((loss, targets)) = &self.against else { return self.renderer.render(&drawing) };
        let (height, width) = (self.size.height(), self.size.width());
        let extents = [targets.len() / 3 / self.size.pixels(), 3, height, width];
        self.renderer.pixel_loss(&drawing, &inputs[0].like(targets.clone(), &extents)?, *loss)
    }

    /// As that of the steps.
    fn rounding(&self) -> f64 {
        1e-3
    }
}

/// The dense renderer in chunks, the same as a step, and drawings for both.
type Case = (Dense, Step, Vec<Input>);

/// What a case is drawn from: items, objects, vertices; odd sides, as they leave a remainder in every chunk; numbers in a
/// chunk, from a row to the whole image.
fn settings() -> impl Strategy<Value = ([usize; 3], ImageSize, Compositing, usize)> {
    let counts = (1_usize..3, 1_usize..4, 3_usize..7).prop_map(|(batch, objects, vertices)| [batch, objects, vertices]);
    let size = (1_usize..5, 1_usize..5).prop_map(|(x, y)| ImageSize::new(2 * x + 1, 2 * y + 1).unwrap());
    (counts, size, compositing(), 1_usize..3000)
}

/// Images by one edge profile.
fn images(edge: EdgeProfile<f64>) -> impl Strategy<Value = Case> {
    settings().prop_flat_map(move |([batch, objects, vertices], size, compositing, chunk)| {
        let renderer = DenseRenderer::new(edge, compositing, size).unwrap().with_chunk_values(chunk);
        let dense = Dense { renderer, size, against: None };
        let step = step!(T => {
            RenderOp::new(ContourRenderer::<T>::new(edge_of(edge), compositing), size, objects, vertices).unwrap()
        });
        step.with_inputs(batch, &DRAWING).prop_map(move |(step, inputs)| (dense.clone(), step, inputs))
    })
}

fn edge_of<T: dvp_core::Real>(edge: EdgeProfile<f64>) -> EdgeProfile<T> {
    EdgeProfile { law: edge.law, offset: T::of(edge.offset), sigma: T::of(edge.sigma), cut: T::of(edge.cut) }
}

/// Losses against targets brighter than anything drawn: MAE has no kink between.
fn losses() -> impl Strategy<Value = Case> {
    let loss = prop::sample::select(vec![PixelLoss::Mae, PixelLoss::Mse]);
    let values = proptest::collection::vec(1.1..1.5, 2 * 3 * 9 * 9);
    (settings(), loss, values).prop_flat_map(
        |(([batch, objects, vertices], size, compositing, chunk), loss, mut values)| {
            values.truncate(batch * 3 * size.pixels());
            let edge = soft::<f64>(compositing).coverage.edge;
            let renderer = DenseRenderer::new(edge, compositing, size).unwrap().with_chunk_values(chunk);
            let step = step!(T => {
                let targets = targets::<T>(size, &values, 0.0);
                RenderLossOp::new(soft::<T>(compositing), loss, targets, objects, vertices).unwrap()
            });
            let dense = Dense { renderer, size, against: Some((loss, values)) };
            step.with_inputs(batch, &DRAWING).prop_map(move |(step, inputs)| (dense.clone(), step, inputs))
        },
    )
}

/// The output and the gradients of the step, by tensor operations on one backend.
fn as_the_step<B: Tested>((dense, step, inputs): &Case, apart: &[Apart], tally: &Tally) -> Outcome {
    for &Apart { dtype, output, gradient } in apart {
        let [own, contour] = [evaluate::<B>(dense, inputs, dtype, 1)?, evaluate::<B>(step, inputs, dtype, 1)?];
        agree(tally, &format!("{dtype} against the contour renderer:"), &own, &contour, [output, gradient])?;
    }
    Ok(())
}

fn dense_images<B: Tested>(tally: &Tally) -> Outcome {
    for_cases(48, images(soft::<f64>(Compositing::Blend).coverage.edge), |case| {
        as_the_step::<B>(&case, &SOFT, tally)?;
        check::<B>(&case.0, &case.2, tally)
    })
}

fn dense_losses<B: Tested>(tally: &Tally) -> Outcome {
    for_cases(32, losses(), |case| {
        as_the_step::<B>(&case, &SOFT, tally)?;
        check::<B>(&case.0, &case.2, tally)
    })
}

/// The reference's profile, which has jumps: no central differences.
fn dense_sharp<B: Tested>(tally: &Tally) -> Outcome {
    for_cases(48, images(EdgeProfile::reference()), |case| as_the_step::<B>(&case, &SHARP, tally))
}

/// Without objects there is the background, and only it has a gradient that is not empty.
fn dense_empty<B: Tested>(tally: &Tally) -> Outcome {
    let size = ImageSize::new(5, 3).unwrap();
    let zeros = |extents: &[usize]| Tensor::<B>::full(0.0, extents, DType::F64, &B::place())?.parameter();
    let background = Tensor::<B>::new(vec![0.1, 0.2, 0.3, 0.4, 0.5, 0.6], &[2, 3], &B::place())?.parameter()?;
    let (outlines, colors, confidences) = (zeros(&[2, 0, 4, 2])?, zeros(&[2, 0, 3])?, zeros(&[2, 0])?);
    let drawing = TensorDrawing { outlines, colors, confidences, background: background.clone() };
    let expected: Vec<f64> = background.to_f64()?.iter().flat_map(|&channel| [channel; 15]).collect();
    for compositing in [Compositing::Blend, Compositing::Over] {
        let renderer = DenseRenderer::new(EdgeProfile::reference(), compositing, size).unwrap();
        let image = renderer.render(&drawing)?;
        tally.check(image.dims().extents() == [2, 3, 3, 5], || image.dims().to_string())?;
        close(tally, "background", &image.to_f64()?, &expected, 0.0)?;
        let gradients = image.sum_all()?.backward()?;
        close(tally, "its gradient", &gradients.of(&background).unwrap().to_f64()?, &[15.0; 6], 1e-14)?;
        let targets = image.affine(1.0, 0.5)?.detach()?;
        let losses = renderer.pixel_loss(&drawing, &targets, PixelLoss::Mse)?;
        close(tally, "losses", &losses.to_f64()?, &[0.25; 2], 1e-14)?;
        let gradients = losses.sum_all()?.backward()?;
        // d mean (b - t)^2 = 2 (b - t) / 3 per channel.
        close(tally, "their gradient", &gradients.of(&background).unwrap().to_f64()?, &[-1.0 / 3.0; 6], 1e-14)?;
    }
    Ok(())
}

#[test]
fn dense_empty_everywhere() {
    on_every_backend!(dense_empty);
}

#[test]
fn dense_images_everywhere() {
    on_every_backend!(dense_images);
}

#[test]
fn dense_losses_everywhere() {
    on_every_backend!(dense_losses);
}

#[test]
fn dense_sharp_everywhere() {
    on_every_backend!(dense_sharp);
}
