//! Gradients of objects of several rings by every renderer, both ways of mixing, RGB and RGBA, by every number.

use core::fmt::Debug;
use core::ops::Range;

use dvp_core::image::RgbaImage;
use dvp_core::render::{
    Compositing, ContourDistance, ContourRenderer, CoverageModel, EdgeProfile, ExactArea, HardMask, PixelLoss,
    Renderer, SoftTriangles, TileRenderer,
};
use dvp_core::shape::Outline;
use dvp_core::{Drawing, DrawingGrad, ImageSize};
use dvp_tests::coverage::coverage_vjp_of_rings;
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

use super::render_contour::{flat, flat_grad, unflat};
use super::smooth::smooth;

/// Not a multiple of a chunk, not square.
fn size() -> ImageSize {
    ImageSize::new(27, 22).unwrap()
}

/// What is painted: the channels, and how objects mix.
#[derive(Clone, Copy, Debug)]
struct Mode {
    rgba: bool,
    compositing: Compositing,
}

fn mode() -> impl Strategy<Value = Mode> {
    (any::<bool>(), prop_oneof![Just(Compositing::Blend), Just(Compositing::Over)])
        .prop_map(|(rgba, compositing)| Mode { rgba, compositing })
}

/// One to three objects of several rings, holes of both directions among them, some partly outside; rings may cross.
fn drawing() -> impl Strategy<Value = Drawing<f64>> {
    drawing_of(strategy::rings_px())
}

fn drawing_of(rings: impl Strategy<Value = Outline<f64>>) -> impl Strategy<Value = Drawing<f64>> {
    let object = (rings, prop::array::uniform2(-8.0..8.0), strategy::color(), 0.05..0.95);
    (prop::collection::vec(object, 1..4), strategy::color()).prop_map(|(objects, background)| {
        let mut drawing = Drawing { background, ..Drawing::default() };
        for (mut outline, shift, color, confidence) in objects {
            outline.vertices.iter_mut().for_each(|v| *v = [(v[0] + shift[0]) / 22.0, (v[1] + shift[1]) / 22.0]);
            drawing.push_rings(outline.rings(), color, confidence);
        }
        drawing
    })
}

/// For RGB and RGBA alike: the first three or all four channels.
fn cotangent() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0, 4 * 27 * 22)
}

/// The vjp against central differences in every number of the drawing but those `held`.
fn check<C: CoverageModel<f64> + Debug>(
    coverage: C,
    Mode { rgba, compositing }: Mode,
    drawing: &Drawing<f64>,
    cotangent: &[f64],
    (tolerance, held): (f64, Range<usize>),
) -> Result<(), TestCaseError> {
    let renderer = TileRenderer { coverage, compositing };
    let channels = if rgba { 4 } else { 3 };
    let cotangent = &cotangent[..channels * size().pixels()];
    let (mut grad, mut scratch, mut image) = (DrawingGrad::default(), Default::default(), vec![0.0; cotangent.len()]);
    grad.reset(drawing);
    if rgba {
        renderer.render_rgba_vjp(drawing, size(), &mut scratch, cotangent, &mut grad).unwrap();
    } else {
        renderer.render_vjp(drawing, size(), &mut scratch, cotangent, &mut grad).unwrap();
    }
    let (mut numbers, mut grad) = (flat(drawing), flat_grad(&grad));
    prop_assert!(grad.drain(held.clone()).all(|g| g.abs() <= 0.0), "what is held has no gradient");
    let fixed: Vec<f64> = numbers.drain(held.clone()).collect();
    compare(&numbers, &grad, tolerance, |x| {
        let moved = unflat(&[&x[..held.start], &fixed, &x[held.start..]].concat(), drawing);
        if rgba {
            renderer.render_rgba(&moved, size(), &mut scratch, &mut image).unwrap();
        } else {
            renderer.render(&moved, size(), &mut scratch, &mut image).unwrap();
        }
        dot(&image, cotangent)
    })
    .map_err(TestCaseError::fail)
}

/// Laws of the contour renderer that have a distance.
fn profile() -> impl Strategy<Value = EdgeProfile<f64>> {
    prop_oneof![
        Just(EdgeProfile { offset: 0.012, sigma: 0.003, cut: 0.03, ..EdgeProfile::reference() }),
        (-0.1..0.1, 0.01..0.08).prop_map(|(offset, sigma)| {
            EdgeProfile { offset, cut: offset + 7.0 * sigma, ..EdgeProfile::distance(sigma) }
        })
    ]
}

/// Fixed cases, because a random one within 1e-6 of a kink would fail for no fault. Coverage by triangles has kinks where two
/// edges are equally near; by area where rings cross in a pixel whose mean winding number is a whole number; blending has
/// one where a weight meets its guard, at a coverage of 1e-7 exp(10 (1 - f)).
fn runner(cases: u32) -> TestRunner {
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn contour_matches_differences(
        drawing in drawing(),
        profile in profile(),
        mode in mode(),
        mut cotangent in cotangent(),
    ) {
        let renderer = ContourRenderer::new(profile, mode.compositing);
        let smooth = smooth(&renderer, &drawing, size());
        prop_assert!(smooth.iter().filter(|&&smooth| smooth).count() > 400, "few pixels are left");
        for (g, &smooth) in cotangent.iter_mut().zip(smooth.iter().cycle()) {
            *g = if smooth { *g } else { 0.0 };
        }
        check(renderer.coverage, mode, &drawing, &cotangent, (1e-5, 0..0))?;
    }

    #[test]
    fn hard_matches_differences(drawing in drawing(), mode in mode(), cotangent in cotangent()) {
        // A vertex that moves changes no pixel, but for one whose center an edge comes across.
        let vertices = 3..3 + 2 * drawing.vertices.len();
        check(HardMask, mode, &drawing, &cotangent, (1e-6, vertices))?;
    }

    #[test]
    fn area_gradient_is_that_of_the_rings(rings in strategy::nested_rings_px()) {
        // With a cotangent of 1, sum(coverage) is the area between the rings, whose derivative by a vertex is half the normal
        // to the chord of its neighbors: outward for rings that add, inward for those that take away.
        let outline = strategy::outline_of(rings.clone());
        let size = ImageSize::new(24, 24).unwrap();
        let grad = coverage_vjp_of_rings(ExactArea, outline.rings(), size, &[1.0; 576]).unwrap();
        let mut found = grad.iter();
        for (k, ring) in rings.iter().enumerate() {
            let turn = dvp_core::contour::signed_area(ring).signum() * if k % 2 == 0 { 0.5 } else { -0.5 };
            for i in 0..ring.len() {
                let (before, after) = (ring[(i + ring.len() - 1) % ring.len()], ring[(i + 1) % ring.len()]);
                let expected = [turn * (after[1] - before[1]), turn * (before[0] - after[0])];
                let found = found.next().unwrap();
                for axis in 0..2 {
                    prop_assert!((found[axis] - expected[axis]).abs() < 1e-9, "ring {k}: {found:?}, not {expected:?}");
                }
            }
        }
    }

    #[test]
    fn wild_rings_have_finite_gradients(outline in strategy::wild_rings(), cotangent in cotangent()) {
        let size = ImageSize::new(24, 24).unwrap();
        let cotangent = &cotangent[..size.pixels()];
        for grad in [
            coverage_vjp_of_rings(ContourDistance::default(), outline.rings(), size, cotangent).unwrap(),
            coverage_vjp_of_rings(ExactArea, outline.rings(), size, cotangent).unwrap(),
            coverage_vjp_of_rings(SoftTriangles::default(), outline.rings(), size, cotangent).unwrap(),
        ] {
            prop_assert!(grad.as_flattened().iter().all(|g| g.is_finite()));
        }
    }

    #[test]
    fn fused_rgba_loss_is_render_then_loss_then_vjp(
        drawing in drawing(),
        mode in mode(),
        target in prop::collection::vec(0.0..1.0, 4 * 27 * 22),
        mae in any::<bool>(),
    ) {
        let renderer = TileRenderer { coverage: ExactArea, compositing: mode.compositing };
        let (mut scratch, mut image) = (Default::default(), RgbaImage::transparent(size()));
        renderer.render_rgba(&drawing, size(), &mut scratch, image.data_mut()).unwrap();
        let count = image.data().len() as f64;
        let difference: Vec<f64> = image.data().iter().zip(&target).map(|(a, b)| a - b).collect();
        let (loss, expected, cotangent): (_, f64, Vec<_>) = if mae {
            let sum = difference.iter().map(|d| d.abs()).sum::<f64>();
            (PixelLoss::Mae, sum / count, difference.iter().map(|d| d.signum() / count).collect())
        } else {
            let sum = difference.iter().map(|d| d * d).sum::<f64>();
            (PixelLoss::Mse, sum / count, difference.iter().map(|d| 2.0 * d / count).collect())
        };
        let target = RgbaImage::from_premultiplied(size(), target).unwrap();
        let mut grads = [DrawingGrad::default(), DrawingGrad::default()];
        grads.iter_mut().for_each(|grad| grad.reset(&drawing));
        let [fused, pulled] = &mut grads;
        let found = renderer.loss_and_grad(&drawing, target.view(), loss, &mut scratch, fused).unwrap();
        prop_assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        renderer.render_rgba_vjp(&drawing, size(), &mut scratch, &cotangent, pulled).unwrap();
        prop_assert!(fused.background.iter().all(|g| g.abs() <= 0.0), "RGBA has no background");
        for (found, expected) in flat_grad(fused).iter().zip(flat_grad(pulled)) {
            prop_assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        }
    }
}

#[test]
fn exact_matches_differences() {
    let outcome = runner(96).run(&(drawing(), mode(), cotangent()), |(drawing, mode, cotangent)| {
        // The second derivative is bounded but jumps where an edge crosses a corner of a pixel.
        check(ExactArea, mode, &drawing, &cotangent, (1e-4, 0..0))
    });
    outcome.unwrap();
}

#[test]
fn triangles_match_differences() {
    // Half coverage 1.4 px outside, soft over about 1 px, and cut where coverage is 4e-18, too little for a jump to show.
    let edge = EdgeProfile { offset: 0.02, sigma: 0.004, cut: 0.18, ..EdgeProfile::reference() };
    let model = SoftTriangles { edge, ..SoftTriangles::default() };
    // Where rings cross, triangles follow the edge that was first and jump when a vertex moves: nested rings do not cross.
    let drawing = drawing_of(strategy::nested_rings_px().prop_map(strategy::outline_of));
    let outcome = runner(24).run(&(drawing, mode(), cotangent()), |(drawing, mode, cotangent)| {
        check(model, mode, &drawing, &cotangent, (1e-5, 0..0))
    });
    outcome.unwrap();
}
