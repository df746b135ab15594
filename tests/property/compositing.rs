//! The law of one pixel is the law that renderers paint by.

use dvp_core::render::{Compositing, ContourRenderer, Renderer};
use dvp_core::scene::Layer;
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, Image, ImageSize, Scene};
use dvp_tests::strategy;
use proptest::prelude::*;

proptest! {
    #[test]
    fn shares_make_the_pixels_that_are_rendered(scene in strategy::scene(0..6, 1..4), blend in any::<bool>()) {
        let size = ImageSize::new(32, 24).unwrap();
        let compositing = if blend { Compositing::Blend } else { Compositing::Over };
        let renderer = ContourRenderer::new(scene.edge, compositing);
        let mut drawing = Drawing::default();
        Scene { compositing, ..scene }.draw(&OutlineBasis::new(32, 4).unwrap(), &mut drawing).unwrap();
        let (mut painted, mut scratch) = (Image::zeros(size), Default::default());
        renderer.render(&drawing, size, &mut scratch, painted.data_mut()).unwrap();
        let mut coverage = vec![0.0; drawing.object_count() * size.pixels()];
        renderer.object_coverage(&drawing, size, &mut scratch, &mut coverage).unwrap();
        let mut layers: Vec<Layer<f64>> = drawing.colors.iter().zip(&drawing.confidences)
            .map(|(&color, &confidence)| Layer::new(color, 0.0, confidence)).collect();
        let mut shares = vec![0.0; layers.len()];
        for pixel in 0..size.pixels() {
            layers.iter_mut().enumerate().for_each(|(k, layer)| layer.coverage = coverage[k * size.pixels() + pixel]);
            let clear = compositing.shares(&layers, &mut shares);
            for (channel, shown) in painted.view().pixel(pixel).into_iter().enumerate() {
                let objects: f64 = layers.iter().zip(&shares).map(|(layer, share)| share * layer.color[channel]).sum();
                let expected = drawing.background[channel] * clear + objects;
                prop_assert!((shown - expected).abs() < 1e-12, "pixel {pixel}: {shown} in place of {expected}");
            }
        }
    }
}
