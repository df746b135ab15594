//! Slopes of a pixel with respect to the coverages of its objects.

use dvp_core::render::Compositing;
use dvp_core::scene::Layer;
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;

/// Colors, coverages and confidences of a few objects: confident enough that the guard of the weights sleeps, or all so faint
/// that it acts.
fn layers() -> impl Strategy<Value = Vec<Layer<f64>>> {
    let layers = |coverage, confidence| {
        let layer = (strategy::color(), coverage, confidence);
        prop::collection::vec(layer.prop_map(|(color, p, f)| Layer::new(color, p, f)), 1..5)
    };
    prop_oneof![4 => layers(0.01..0.99, 0.01..1.0), 1 => layers(1e-5..2e-4, 0.0..0.05)]
}

proptest! {
    #[test]
    fn slopes_are_those_of_the_pixel(
        background in strategy::color(),
        layers in layers(),
        blend in any::<bool>(),
        cotangent in prop::array::uniform3(-1.0..1.0),
    ) {
        let compositing = if blend { Compositing::Blend } else { Compositing::Over };
        let (mut slopes, mut shares) = (vec![[0.0; 3]; layers.len()], vec![0.0; layers.len()]);
        compositing.slopes(background, &layers, &mut slopes);
        let coverages: Vec<f64> = layers.iter().map(|layer| layer.coverage).collect();
        let grad: Vec<f64> = slopes.iter().map(|slope| dot(slope, &cotangent)).collect();
        let mut moved = layers.clone();
        compare(&coverages, &grad, 1e-7, |coverages| {
            moved.iter_mut().zip(coverages).for_each(|(layer, &coverage)| layer.coverage = coverage);
            let clear = compositing.shares(&moved, &mut shares);
            let objects = moved.iter().zip(&shares).map(|(layer, share)| share * dot(&layer.color, &cotangent));
            clear * dot(&background, &cotangent) + objects.sum::<f64>()
        })
        .map_err(TestCaseError::fail)?;
    }
}
