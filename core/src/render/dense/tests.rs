//! The dense renderer against the contour renderer, on the host.

use alloc::vec;
use alloc::vec::Vec;

use super::{DenseRenderer, TensorDrawing};
use crate::diff_op::{Batched, HostOp};
use crate::dims::ImageSize;
use crate::image::Image;
use crate::real::Values;
use crate::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, RenderLossOp, RenderOp};
use crate::tensor::{Host, HostDevice, Tensor};

const OBJECTS: usize = 3;
const VERTICES: usize = 12;

/// Wobbly disks that overlap, one of them partly outside of the image: outlines, colors, confidences, background.
fn drawing() -> [Vec<f64>; 4] {
    let mut outlines = Vec::new();
    for k in 0..OBJECTS {
        let center = [0.35 + 0.3 * k as f64, 0.45 + 0.1 * k as f64];
        for i in 0..VERTICES {
            let angle = core::f64::consts::TAU * i as f64 / VERTICES as f64 + 0.1;
            let radius = 0.2 + 0.03 * libm::sin(3.0 * angle + k as f64);
            outlines.extend([center[0] + radius * libm::cos(angle), center[1] + radius * libm::sin(angle)]);
        }
    }
    let colors = vec![0.9, 0.2, 0.1, 0.1, 0.8, 0.3, 0.2, 0.1, 0.7];
    [outlines, colors, vec![1.0, 0.8, 0.6], vec![0.5, 0.6, 0.4]]
}

fn tensors(parts: &[Vec<f64>; 4]) -> TensorDrawing<Host> {
    let tensor = |values: &[f64], extents: &[usize]| {
        Tensor::new(values.to_vec(), extents, &HostDevice).unwrap().parameter().unwrap()
    };
    TensorDrawing {
        outlines: tensor(&parts[0], &[1, OBJECTS, VERTICES, 2]),
        colors: tensor(&parts[1], &[1, OBJECTS, 3]),
        confidences: tensor(&parts[2], &[1, OBJECTS]),
        background: tensor(&parts[3], &[1, 3]),
    }
}

fn settings() -> [(EdgeProfile<f64>, Compositing); 4] {
    let soft = EdgeProfile::distance(0.03);
    [
        (EdgeProfile::reference(), Compositing::Blend),
        (EdgeProfile::reference(), Compositing::Over),
        (soft, Compositing::Blend),
        (soft, Compositing::Over),
    ]
}

/// Coverage within 1e-6 of 1 counts as 1 in the contour renderer, and its e^x is off by 1e-14.
const SATURATION: f64 = 3e-6;
/// What that leaves out of a gradient, in parts of the largest: 2.7e-6 here.
const GRADIENT: f64 = 1e-5;

#[test]
fn images_and_gradients_are_the_contour_renderers() {
    assert_agrees(&[]);
}

#[test]
fn rings_are_those_of_the_contour_renderer() {
    // Two rings of five vertices, two of one, which have no edge, and one of none.
    assert_agrees(&[5, 10, 11, 11]);
}

#[test]
fn rings_out_of_order_are_refused() {
    let size = ImageSize::new(4, 4).unwrap();
    let parts = drawing();
    for breaks in [vec![5, 4], vec![VERTICES + 1]] {
        let dense = DenseRenderer::new(EdgeProfile::reference(), Compositing::Blend, size).unwrap();
        assert!(dense.with_breaks(breaks.clone()).render(&tensors(&parts)).is_err());
        let op = RenderOp::new(ContourRenderer::default(), size, OBJECTS, VERTICES).unwrap().with_breaks(breaks);
        let op = Batched::<f64, _>::new(op);
        assert!(op.forward(1, Values::F64(parts.concat()).as_ref(), false).is_err());
    }
}

/// Images and gradients of outlines whose rings begin at `breaks`.
fn assert_agrees(breaks: &[usize]) {
    let size = ImageSize::new(33, 25).unwrap();
    let parts = drawing();
    let flat = Values::F64(parts.concat());
    for (edge, compositing) in settings() {
        let renderer = ContourRenderer::new(edge, compositing);
        let op = Batched::<f64, _>::new(
            RenderOp::new(renderer, size, OBJECTS, VERTICES).unwrap().with_breaks(breaks.to_vec()),
        );
        let (expected, saved) = op.forward(1, flat.as_ref(), true).unwrap();
        let dense =
            DenseRenderer::new(edge, compositing, size).unwrap().with_chunk_values(3000).with_breaks(breaks.to_vec());
        let own = tensors(&parts);
        let image = dense.render(&own).unwrap();
        let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let expected = expected.to_f64();
        assert!(far(&image.to_f64().unwrap(), &expected) < SATURATION, "{compositing:?}, image");

        let pull: Vec<f64> = (0..expected.len()).map(|i| libm::sin(0.7 * i as f64)).collect();
        let grad = op.vjp(1, flat.as_ref(), saved.as_ref(), Values::F64(pull.clone()).as_ref()).unwrap().to_f64();
        let pull = image.like(pull, image.dims().extents()).unwrap();
        let gradients = image.mul(&pull).unwrap().sum_all().unwrap().backward().unwrap();
        let found: Vec<f64> =
            own.parts().iter().flat_map(|part| gradients.of(part).unwrap().to_f64().unwrap()).collect();
        let scale = grad.iter().fold(0.0_f64, |most, &g| most.max(g.abs()));
        assert!(far(&found, &grad) < GRADIENT * scale, "{compositing:?}, gradients: {} of {scale}", far(&found, &grad));
    }
}

#[test]
fn the_chunked_loss_is_the_fused_one() {
    let size = ImageSize::new(20, 31).unwrap();
    let parts = drawing();
    let target = Image::from_planar(size, vec![0.45; 3 * size.pixels()]).unwrap();
    for loss in [PixelLoss::Mae, PixelLoss::Mse] {
        let renderer = ContourRenderer::new(EdgeProfile::reference(), Compositing::Blend);
        let op = RenderLossOp::new(renderer, loss, vec![target.clone()], OBJECTS, VERTICES).unwrap();
        let own = tensors(&parts);
        let fused = Tensor::apply::<f64, _>(op, &own.parts()).unwrap();
        let targets = fused.like(target.data().to_vec(), &[1, 3, 31, 20]).unwrap();
        let dense =
            DenseRenderer::new(EdgeProfile::reference(), Compositing::Blend, size).unwrap().with_chunk_values(1);
        let chunked = dense.pixel_loss(&own, &targets, loss).unwrap();
        assert!((chunked.number().unwrap() - fused.number().unwrap()).abs() < SATURATION);
        let [a, b] = [fused, chunked].map(|loss| loss.affine(3.0, 0.0).unwrap().sum_all().unwrap().backward().unwrap());
        for part in own.parts() {
            let [a, b] = [&a, &b].map(|gradients| gradients.of(part).unwrap().to_f64().unwrap());
            let scale = a.iter().fold(0.0_f64, |most, &g| most.max(g.abs()));
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < GRADIENT * scale), "{loss:?}: {a:?} and {b:?}");
        }
    }
}

#[test]
fn area_coverage_is_refused() {
    let size = ImageSize::new(4, 4).unwrap();
    let error = DenseRenderer::new(EdgeProfile::area(), Compositing::Blend, size).unwrap_err();
    assert!(matches!(error, crate::render::RenderError::Setting { .. }));
}
