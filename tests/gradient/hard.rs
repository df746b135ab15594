//! Gradients of hard coverage: colors, confidence and background have one, geometry has none.

use dvp_core::render::{Compositing, HardRenderer, Renderer};
use dvp_core::{DrawingGrad, ImageSize};
use dvp_tests::coverage::drawing;
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;

proptest! {
    #[test]
    fn colors_have_a_gradient_and_vertices_none(
        star in strategy::star_px(),
        numbers in prop::array::uniform7(0.1..0.9),
        blend in any::<bool>(),
        cotangent in prop::collection::vec(-1.0..1.0, 3 * 576),
    ) {
        let size = ImageSize::new(24, 24).unwrap();
        let compositing = if blend { Compositing::Blend } else { Compositing::Over };
        let renderer = HardRenderer { compositing, ..HardRenderer::default() };
        let mut drawing = drawing(&star, size);
        let mut scratch = Default::default();
        let mut set = |x: &[f64]| {
            drawing.background.copy_from_slice(&x[..3]);
            drawing.colors[0].copy_from_slice(&x[3..6]);
            drawing.confidences[0] = x[6];
            drawing.clone()
        };
        let drawn = set(&numbers);
        let mut grad = DrawingGrad::default();
        grad.reset(&drawn);
        renderer.render_vjp(&drawn, size, &mut scratch, &cotangent, &mut grad).unwrap();
        prop_assert!(grad.vertices.as_flattened().iter().all(|g| g.abs() <= 0.0));
        let flat = [&grad.background[..], &grad.colors[0], &grad.confidences].concat();
        let mut image = vec![0.0; cotangent.len()];
        compare(&numbers, &flat, 1e-6, |x| {
            renderer.render(&set(x), size, &mut scratch, &mut image).unwrap();
            dot(&image, &cotangent)
        })
        .map_err(TestCaseError::fail)?;
    }
}
