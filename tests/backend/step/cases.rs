//! Cases of each step, away from where it has no derivative.

use dvp_core::diff_op::Atan2;
use dvp_core::loss::{ImageLossOp, Pyramid, SceneLoss, SceneLossOp, Ssim};
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, ExactRenderer, PixelLoss, RenderLossOp, RenderOp};
use dvp_core::scene::PoseOp;
use dvp_core::shape::{
    EfdModel, MixOp, NormalizeOp, OutlineBasis, OutlineOp, PrototypeBank, PrototypeModel, mdshr_bank,
};
use dvp_core::tensor::{Stride, Unfold};
use dvp_core::{Image, ImageSize, Real};
use dvp_tests::strategy;
use proptest::collection::vec;
use proptest::prelude::*;

use super::{Step, step};
use crate::input::{Domain, Input};

type Cases = BoxedStrategy<(Step, Vec<Input>)>;

/// Cases of a step, by its name.
pub(super) fn of(step: &str) -> Cases {
    match step {
        "Atan2" => atan2(),
        "ImageLossOp" => prop_oneof![3 => pixel_losses(), 1 => ssim()].boxed(),
        "MixOp" => mix(),
        "NormalizeOp" => normalize(),
        "OutlineOp" => prop_oneof![outline_of_descriptors(), outline_of_weights()].boxed(),
        "PoseOp" => pose(),
        "RenderLossOp" => render_loss(),
        "RenderOp" => prop_oneof![2 => render(), 1 => render_exactly()].boxed(),
        "SceneLossOp" => scene_loss(),
        "Unfold" => unfold(),
        other => panic!("no cases for {other}"),
    }
}

/// Items of a batch.
fn batch() -> core::ops::Range<usize> {
    1..4
}

/// At the origin there is no angle, and where x < 0 it jumps at y = 0.
fn atan2() -> Cases {
    (batch(), vec(1_usize..4, 1..3))
        .prop_flat_map(|(batch, dims)| {
            step!(T => Atan2::new(&dims).unwrap()).with_inputs(batch, &[Domain::AwayFromZero; 2])
        })
        .boxed()
}

fn unfold() -> Cases {
    (batch(), prop::array::uniform3(1_usize..4), prop::array::uniform2(1_usize..4), 1_usize..4, 0_usize..3)
        .prop_map(|(batch, image, window, step, padding)| (batch, image, window, Stride { step, padding }))
        .prop_filter("a window fits", |(_, [_, h, w], [kh, kw], stride)| {
            stride.windows(*h, *kh) > 0 && stride.windows(*w, *kw) > 0
        })
        .prop_flat_map(|(batch, image, window, stride)| {
            step!(T => Unfold::new(image, window, stride).unwrap()).with_inputs(batch, &[Domain::Any])
        })
        .boxed()
}

/// A few of the shapes of MDS-HR.
fn bank<T: Real>(harmonics: usize) -> PrototypeBank<T> {
    mdshr_bank(harmonics)
}

fn mix() -> Cases {
    (batch(), 1_usize..3, 1_usize..6)
        .prop_flat_map(|(batch, objects, harmonics)| {
            step!(T => MixOp::<T>::new(bank(harmonics), objects).unwrap()).with_inputs(batch, &[Domain::Any])
        })
        .boxed()
}

fn normalize() -> Cases {
    (batch(), 1_usize..3, 1_usize..6)
        .prop_flat_map(|(batch, objects, harmonics)| {
            step!(T => NormalizeOp::new(objects, harmonics).unwrap()).with_inputs(batch, &[Domain::Descriptors])
        })
        .boxed()
}

fn outline_of_descriptors() -> Cases {
    (batch(), 1_usize..3, 1_usize..5, 4_usize..9)
        .prop_flat_map(|(batch, objects, harmonics, vertices)| {
            // The op takes objects x parameters: rows of descriptors, one after the other.
            step!(T => {
                let basis = OutlineBasis::<T>::new(vertices, harmonics).unwrap();
                OutlineOp::new(EfdModel::new(basis), objects).unwrap()
            })
            .with_inputs(batch, &[Domain::Any])
        })
        .boxed()
}

fn outline_of_weights() -> Cases {
    (batch(), 1_usize..3, 4_usize..9)
        .prop_flat_map(|(batch, objects, vertices)| {
            step!(T => {
                let basis = OutlineBasis::<T>::new(vertices, 5).unwrap();
                OutlineOp::new(PrototypeModel::new(&bank(5), &basis).unwrap(), objects).unwrap()
            })
            .with_inputs(batch, &[Domain::Between(0.0, 1.0)])
        })
        .boxed()
}

fn pose() -> Cases {
    (batch(), 1_usize..3, 1_usize..6)
        .prop_flat_map(|(batch, objects, vertices)| {
            step!(T => PoseOp::new(objects, vertices).unwrap()).with_inputs(batch, &[Domain::Any; 4])
        })
        .boxed()
}

/// Posed outlines, colors, confidences, background.
pub(crate) const DRAWING: [Domain; 4] =
    [Domain::Outlines, Domain::Between(0.0, 1.0), Domain::Between(0.1, 0.9), Domain::Between(0.0, 1.0)];

/// So soft that coverage is neither cut off nor saturated, where it would jump, anywhere in the image.
pub(crate) fn soft<T: Real>(compositing: Compositing) -> ContourRenderer<T> {
    let sigma = T::of(0.15);
    ContourRenderer::new(EdgeProfile { cut: T::of(100.0), ..EdgeProfile::distance(sigma) }, compositing)
}

pub(crate) fn compositing() -> impl Strategy<Value = Compositing> {
    prop::sample::select(vec![Compositing::Blend, Compositing::Over])
}

fn size() -> impl Strategy<Value = ImageSize> {
    (3_usize..10, 3_usize..10).prop_map(|(width, height)| ImageSize::new(width, height).unwrap())
}

fn render() -> Cases {
    (batch(), 1_usize..4, 3_usize..8, size(), compositing())
        .prop_flat_map(|(batch, objects, vertices, size, compositing)| {
            step!(T => RenderOp::new(soft::<T>(compositing), size, objects, vertices).unwrap())
                .with_inputs(batch, &DRAWING)
        })
        .boxed()
}

fn render_exactly() -> Cases {
    (batch(), 1_usize..3, 3_usize..6, size())
        .prop_flat_map(|(batch, objects, vertices, size)| {
            step!(T => RenderOp::new(ExactRenderer::default(), size, objects, vertices).unwrap())
                .with_inputs(batch, &DRAWING)
        })
        .boxed()
}

/// Target images with numbers from `low` on, one per item.
pub(crate) fn targets<T: Real>(size: ImageSize, values: &[f64], low: f64) -> Vec<Image<T>> {
    let images = values.chunks_exact(3 * size.pixels());
    images.map(|image| Image::from_planar(size, image.iter().map(|&x| T::of(low + x)).collect()).unwrap()).collect()
}

/// A size, and numbers of 0 to 0.4 for one to three images of it.
fn sized_values(side: core::ops::Range<usize>) -> impl Strategy<Value = (ImageSize, Vec<f64>)> {
    (side.clone(), side, batch()).prop_flat_map(|(width, height, batch)| {
        let size = ImageSize::new(width, height).unwrap();
        (Just(size), vec(0.0..0.4, batch * 3 * size.pixels()))
    })
}

/// Targets brighter than anything drawn: MAE has no kink between.
fn render_loss() -> Cases {
    let loss = prop::sample::select(vec![PixelLoss::Mae, PixelLoss::Mse]);
    (1_usize..4, 3_usize..8, sized_values(3..9), compositing(), loss)
        .prop_flat_map(|(objects, vertices, (size, values), compositing, loss)| {
            let batch = values.len() / 3 / size.pixels();
            step!(T => {
                let targets = targets::<T>(size, &values, 1.1);
                RenderLossOp::new(soft::<T>(compositing), loss, targets, objects, vertices).unwrap()
            })
            .with_inputs(batch, &DRAWING)
        })
        .boxed()
}

/// Images brighter than their targets: MAE has no kink between.
fn pixel_losses() -> Cases {
    (sized_values(2..5), 0_usize..3)
        .prop_flat_map(|((size, values), which)| {
            let batch = values.len() / 3 / size.pixels();
            let step = match which {
                0 => step!(T => ImageLossOp::new(PixelLoss::Mae, size, targets::<T>(size, &values, 0.0)).unwrap()),
                1 => step!(T => ImageLossOp::new(PixelLoss::Mse, size, targets::<T>(size, &values, 0.0)).unwrap()),
                _ => step!(T => {
                    let loss = Pyramid::new(PixelLoss::Mse, 2).unwrap();
                    ImageLossOp::new(loss, size, targets::<T>(size, &values, 0.0)).unwrap()
                }),
            };
            step.with_inputs(batch, &[Domain::Between(0.5, 1.0)])
        })
        .boxed()
}

/// Its windows are 11 pixels wide.
fn ssim() -> Cases {
    sized_values(11..13)
        .prop_flat_map(|(size, values)| {
            let values = values[..3 * size.pixels()].to_vec();
            step!(T => ImageLossOp::new(Ssim::<T>::default(), size, targets::<T>(size, &values, 0.0)).unwrap())
                .with_inputs(1, &[Domain::Between(0.0, 1.0)])
        })
        .boxed()
}

fn scene_loss() -> Cases {
    let harmonics = 4;
    vec(strategy::scene(1..3, 4..5), batch())
        .prop_flat_map(move |truths| {
            step!(T => {
                let truths = truths.iter().map(dvp_core::Scene::cast).collect();
                SceneLossOp::new(SceneLoss::<T>::reference(12, harmonics).unwrap(), truths, 3, harmonics).unwrap()
            })
            .with_inputs(
                truths.len(),
                &[
                    Domain::Between(0.1, 0.9),
                    Domain::Between(0.1, 0.3),
                    Domain::Any,
                    Domain::Between(0.0, 1.0),
                    // Away from 0 and 1, where the cross entropy is cut.
                    Domain::Between(0.1, 0.9),
                    Domain::Descriptors,
                    Domain::Between(0.0, 1.0),
                ],
            )
        })
        .boxed()
}
