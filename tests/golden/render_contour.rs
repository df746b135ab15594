//! The contour renderer against the reference's images and gradients.
#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, Image, ImageSize, Scene};
use dvp_tests::fixture::{fixture_scenes, read_npy, shared};

fn draw(scene: &Scene<f64>, harmonics: usize) -> Drawing<f64> {
    let basis = OutlineBasis::new(64, harmonics).unwrap();
    let mut drawing = Drawing::default();
    scene.draw(&basis, &mut drawing).unwrap();
    drawing
}

#[test]
fn images_agree_with_the_reference() {
    let Some(shared) = shared() else { return };
    let size = ImageSize::new(128, 128).unwrap();
    let renderer = ContourRenderer::default();
    for set in ["target", "perturbed"] {
        let scenes = fixture_scenes(&shared, &format!("a_{set}_scenes.json"));
        let (dims, reference) = read_npy(&shared.join(format!("fixtures/a_{set}_image.npy")));
        assert_eq!(dims[1..], [128, 128, 3]);
        for (i, scene) in scenes.iter().take(dims[0]).enumerate() {
            let scene = scene.to_scene(&[]);
            let mut image = Image::zeros(size);
            let mut scratch = Default::default();
            renderer.render(&draw(&scene, 64), size, &mut scratch, image.data_mut()).unwrap();
            let reference = &reference[i * size.pixels() * 3..(i + 1) * size.pixels() * 3];
            let (mut worst, mut sum) = (0.0_f64, 0.0);
            for (a, &b) in image.to_interleaved().iter().zip(reference) {
                let error = (a - f64::from(b)).abs();
                worst = worst.max(error);
                sum += error;
            }
            // The reference's coverage dips to 0.993 along the inner edges of its triangles; a contour has no such seams.
            assert!(worst <= 0.006, "{set} {i}: worst {worst}");
            let mean = sum / reference.len() as f64;
            assert!(mean <= 2e-4, "{set} {i}: mean {mean}");
        }
    }
}
