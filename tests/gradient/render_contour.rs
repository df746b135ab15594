//! Gradients of the contour renderer, both ways of mixing, by every input: vertices, colors, confidences, background.
//!
//! Differences across kinks and jumps of coverage mean nothing: the cotangent of pixels that come near is zero.

use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, Renderer};
use dvp_core::{Drawing, DrawingGrad, Image, ImageSize};
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;

use super::smooth::smooth;

/// Not a multiple of a chunk, not square.
fn size() -> ImageSize {
    ImageSize::new(27, 22).unwrap()
}

/// At 22 px a pixel is 1/11 of the doubled frame: the band is about 2 px wide on both sides.
fn squared() -> EdgeProfile<f64> {
    EdgeProfile { offset: 0.012, sigma: 0.003, cut: 0.03, ..EdgeProfile::reference() }
}

fn renderer(compositing: Compositing) -> ContourRenderer<f64> {
    ContourRenderer::new(squared(), compositing)
}

/// Every law; exact areas have tests of their own.
fn profile() -> impl Strategy<Value = EdgeProfile<f64>> {
    prop_oneof![
        Just(squared()),
        (-0.1..0.1, 0.01..0.08).prop_map(|(offset, sigma)| {
            EdgeProfile { offset, cut: offset + 7.0 * sigma, ..EdgeProfile::distance(sigma) }
        })
    ]
}

/// Up to four objects that overlap, some of them partly outside.
fn drawing() -> impl Strategy<Value = Drawing<f64>> {
    let object = (strategy::star_px(), prop::array::uniform2(-8.0..8.0), strategy::color(), 0.05..0.95);
    (prop::collection::vec(object, 1..5), strategy::color()).prop_map(|(objects, background)| {
        let mut drawing = Drawing { background, ..Drawing::default() };
        for (star, shift, color, confidence) in objects {
            let outline: Vec<_> = star.iter().map(|v| [(v[0] + shift[0]) / 22.0, (v[1] + shift[1]) / 22.0]).collect();
            drawing.push(&outline, color, confidence);
        }
        drawing
    })
}

fn compositing() -> impl Strategy<Value = Compositing> {
    prop_oneof![Just(Compositing::Blend), Just(Compositing::Over)]
}

fn cotangent() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0, 3 * 27 * 22)
}

pub(crate) fn flat(drawing: &Drawing<f64>) -> Vec<f64> {
    let mut x = drawing.background.to_vec();
    x.extend(drawing.vertices.as_flattened());
    x.extend(drawing.colors.as_flattened());
    x.extend(&drawing.confidences);
    x
}

pub(crate) fn flat_grad(grad: &DrawingGrad<f64>) -> Vec<f64> {
    let mut x = grad.background.to_vec();
    x.extend(grad.vertices.as_flattened());
    x.extend(grad.colors.as_flattened());
    x.extend(&grad.confidences);
    x
}

pub(crate) fn unflat(x: &[f64], like: &Drawing<f64>) -> Drawing<f64> {
    let (background, x) = x.split_at(3);
    let (vertices, x) = x.split_at(2 * like.vertices.len());
    let (colors, confidences) = x.split_at(3 * like.colors.len());
    Drawing {
        background: background.try_into().unwrap(),
        vertices: vertices.as_chunks().0.to_vec(),
        starts: like.starts.clone(),
        breaks: like.breaks.clone(),
        colors: colors.as_chunks().0.to_vec(),
        confidences: confidences.to_vec(),
        ..Drawing::default()
    }
}

fn render(renderer: &ContourRenderer<f64>, drawing: &Drawing<f64>) -> Vec<f64> {
    let mut image = Image::zeros(size());
    renderer.render(drawing, size(), &mut Default::default(), image.data_mut()).unwrap();
    image.data().to_vec()
}

fn vjp(renderer: &ContourRenderer<f64>, drawing: &Drawing<f64>, cotangent: &[f64]) -> Vec<f64> {
    let mut grad = DrawingGrad::default();
    grad.reset(drawing);
    renderer.render_vjp(drawing, size(), &mut Default::default(), cotangent, &mut grad).unwrap();
    flat_grad(&grad)
}

/// Zeroes the cotangent of pixels whose coverage is not smooth; returns how many are left.
fn leave_out_kinks(renderer: &ContourRenderer<f64>, drawing: &Drawing<f64>, cotangent: &mut [f64]) -> usize {
    let smooth = smooth(renderer, drawing, size());
    for (g, &smooth) in cotangent.iter_mut().zip(smooth.iter().cycle()) {
        *g = if smooth { *g } else { 0.0 };
    }
    smooth.into_iter().filter(|&smooth| smooth).count()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn vjp_matches_differences(
        drawing in drawing(),
        profile in profile(),
        compositing in compositing(),
        mut cotangent in cotangent(),
    ) {
        let renderer = ContourRenderer::new(profile, compositing);
        let left = leave_out_kinks(&renderer, &drawing, &mut cotangent);
        prop_assert!(left > 500, "only {left} of 594 pixels are left");
        let grad = vjp(&renderer, &drawing, &cotangent);
        compare(&flat(&drawing), &grad, 1e-5, |x| dot(&render(&renderer, &unflat(x, &drawing)), &cotangent))
            .map_err(TestCaseError::fail)?;
    }

    #[test]
    fn vjp_is_linear_and_adds(
        drawing in drawing(),
        compositing in compositing(),
        (a, b) in (cotangent(), cotangent()),
    ) {
        let renderer = renderer(compositing);
        let (of_a, of_b) = (vjp(&renderer, &drawing, &a), vjp(&renderer, &drawing, &b));
        let mixed: Vec<_> = a.iter().zip(&b).map(|(a, b)| 2.0 * a - 3.0 * b).collect();
        // Into a gradient that already holds something, with a scratch that has painted something else.
        let mut scratch = Default::default();
        let mut grad = DrawingGrad::default();
        grad.reset(&drawing);
        renderer.render_vjp(&drawing, size(), &mut scratch, &b, &mut grad).unwrap();
        renderer.render_vjp(&drawing, size(), &mut scratch, &mixed, &mut grad).unwrap();
        for (found, (a, b)) in flat_grad(&grad).iter().zip(of_a.iter().zip(&of_b)) {
            let expected = 2.0 * a - 2.0 * b;
            prop_assert!((found - expected).abs() < 1e-9 * (1.0 + a.abs() + b.abs()), "{found}, not {expected}");
        }
    }

    #[test]
    fn what_was_painted_before_does_not_matter(
        before in drawing(),
        drawing in drawing(),
        profile in profile(),
        compositing in compositing(),
        cotangent in cotangent(),
    ) {
        let renderer = ContourRenderer::new(profile, compositing);
        let mut scratch = Default::default();
        let mut grad = DrawingGrad::default();
        for drawing in [&before, &drawing] {
            grad.reset(drawing);
            renderer.render_vjp(drawing, size(), &mut scratch, &cotangent, &mut grad).unwrap();
        }
        let (found, expected) = (flat_grad(&grad), vjp(&renderer, &drawing, &cotangent));
        for (lane, (found, expected)) in found.iter().zip(expected).enumerate() {
            prop_assert!((found - expected).abs() <= 0.0, "number {lane}: {found}, not {expected}");
        }
    }

    #[test]
    fn fused_loss_is_render_then_loss_then_vjp(
        drawing in drawing(),
        compositing in compositing(),
        target in prop::collection::vec(0.0..1.0, 3 * 27 * 22),
        mae in any::<bool>(),
    ) {
        let renderer = renderer(compositing);
        let image = render(&renderer, &drawing);
        let count = image.len() as f64;
        let difference: Vec<f64> = image.iter().zip(&target).map(|(a, b)| a - b).collect();
        let (loss, expected, cotangent): (_, f64, Vec<_>) = if mae {
            let sum = difference.iter().map(|d| d.abs()).sum::<f64>();
            (PixelLoss::Mae, sum / count, difference.iter().map(|d| d.signum() / count).collect())
        } else {
            let sum = difference.iter().map(|d| d * d).sum::<f64>();
            (PixelLoss::Mse, sum / count, difference.iter().map(|d| 2.0 * d / count).collect())
        };
        let target = Image::from_planar(size(), target).unwrap();
        let mut grad = DrawingGrad::default();
        grad.reset(&drawing);
        let found = renderer.loss_and_grad(&drawing, target.view(), loss, &mut Default::default(), &mut grad).unwrap();
        prop_assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        for (found, expected) in flat_grad(&grad).iter().zip(vjp(&renderer, &drawing, &cotangent)) {
            prop_assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        }
    }
}

#[test]
fn objects_outside_the_view_get_no_gradient() {
    let mut drawing = Drawing { background: [0.5; 3], ..Drawing::default() };
    for far in [3.0, -40.0, 1e300] {
        drawing.push(&[[far, far], [far + 0.3, far], [far, far + 0.3]], [1.0, 0.0, 0.2], 1.0);
    }
    let grad = vjp(&renderer(Compositing::Blend), &drawing, &vec![1.0; 3 * size().pixels()]);
    assert!(grad[3..].iter().all(|&g| g == 0.0), "{grad:?}");
    assert!((grad[0] - 594.0).abs() < 1e-9, "the background is all there is to see");
}

#[test]
fn hidden_objects_pull_on_confidence_only_through_their_color() {
    // One object with confidence 0 in the middle: pixel = b + p f (c - b), so that d/df = sum g p (c - b) and all else is 0.
    let mut drawing = Drawing { background: [0.25; 3], ..Drawing::default() };
    drawing.push(&[[0.3, 0.3], [0.7, 0.3], [0.7, 0.7], [0.3, 0.7]], [0.75, 0.25, 0.25], 0.0);
    let renderer = renderer(Compositing::Blend);
    let mut coverage = vec![0.0; size().pixels()];
    renderer.object_coverage(&drawing, size(), &mut Default::default(), &mut coverage).unwrap();
    let grad = vjp(&renderer, &drawing, &vec![1.0; 3 * size().pixels()]);
    assert!(grad[3..14].iter().all(|&g| g == 0.0), "{grad:?}");
    assert!((grad[14] - 0.5 * coverage.iter().sum::<f64>()).abs() < 1e-9);
}
