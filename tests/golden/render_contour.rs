//! The contour renderer against the reference's images, masks and gradients.
//!
//! All differences come from one thing: along the inner edges of its triangles the reference's coverage dips to 0.9933,
//! logistic(5), and pulls on vertices; a contour has no such seams.

use dvp_core::render::{ContourRenderer, PixelLoss, Renderer};
use dvp_core::scene::rotation_from_pair_vjp;
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, DrawingGrad, Image, ImageSize, Real, Scene, SceneGrad};
use dvp_tests::fixture::{FixtureScene, fixture_scenes, mdshr_val, read_npy, shared};
use dvp_tests::golden;
use serde::Deserialize;

/// Fields of a scene in the fixtures' order: translation, scale, rotation pair, color, confidence, background, EFD.
const FIELDS: [&str; 7] = ["t", "s", "r", "c", "f", "b", "e"];

/// 1 - logistic(5): how far a seam's coverage is from 1.
const SEAM: f64 = 0.006_692_851;

fn size() -> ImageSize {
    ImageSize::new(128, 128).unwrap()
}

fn draw(scene: &Scene<f64>) -> Drawing<f64> {
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(64, 64).unwrap(), &mut drawing).unwrap();
    drawing
}

fn render(scene: &Scene<f64>) -> Image<f64> {
    let mut image = Image::zeros(size());
    ContourRenderer::default().render(&draw(scene), size(), &mut Default::default(), image.data_mut()).unwrap();
    image
}

/// The gradients of a loss, field by field in the fixtures' layout.
fn gradients(fixture: &FixtureScene, target: &Image<f64>, loss: PixelLoss) -> [Vec<f64>; 7] {
    let scene = fixture.to_scene(&[]);
    let drawing = draw(&scene);
    let (mut grad, mut grad_drawing) = (SceneGrad::default(), DrawingGrad::default());
    grad_drawing.reset(&drawing);
    grad.reset(&scene);
    let renderer = ContourRenderer::default();
    renderer.loss_and_grad(&drawing, target.view(), loss, &mut Default::default(), &mut grad_drawing).unwrap();
    scene.draw_vjp(&OutlineBasis::new(64, 64).unwrap(), &grad_drawing, &mut grad).unwrap();
    let mut fields: [Vec<f64>; 7] = Default::default();
    let [t, s, r, c, f, b, e] = &mut fields;
    b.extend(grad.background);
    for (object, fixture) in grad.objects.iter().zip(&fixture.objects) {
        let mut pair = [0.0; 2];
        rotation_from_pair_vjp(fixture.rotation_vec, object.rotation, &mut pair);
        t.extend(object.translation);
        s.extend([object.scale, 0.0]);
        r.extend(pair);
        c.extend(object.color);
        f.push(object.confidence);
        e.extend(&object.numbers);
    }
    fields
}

/// Asserts cosine similarity and relative distance of each field.
fn assert_agree(set: &str, ours: &[Vec<f64>; 7], reference: &[Vec<f64>; 7]) {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    for (name, (ours, reference)) in FIELDS.iter().zip(ours.iter().zip(reference)) {
        assert_eq!(ours.len(), reference.len(), "{set} {name}");
        let difference: Vec<f64> = ours.iter().zip(reference).map(|(a, b)| a - b).collect();
        let norm = dot(reference, reference).sqrt();
        let cosine = dot(ours, reference) / (norm * dot(ours, ours).sqrt());
        let distance = dot(&difference, &difference).sqrt() / norm;
        // Seams pull on the vertices of inner edges, hence a little on pose and most on the descriptors.
        let most = if "cfb".contains(name) { 0.005 } else { 0.01 };
        assert!(cosine > 0.9999 && distance < most, "{set} {name}: cosine {cosine}, distance {distance}");
    }
}

#[test]
fn committed_pixels_and_gradients_agree() {
    #[derive(Deserialize)]
    struct Committed {
        scene: FixtureScene,
        target: FixtureScene,
        pixels: Vec<(usize, usize, f64, f64, f64)>,
        mae: [Vec<f64>; 7],
        mse: [Vec<f64>; 7],
    }
    let committed: Committed = golden::committed("render_contour.json").unwrap();
    let image = render(&committed.scene.to_scene(&[]));
    assert_eq!(committed.pixels.len(), 396);
    for &(row, column, r, g, b) in &committed.pixels {
        let ours = image.view().pixel(row * 128 + column);
        for (ours, reference) in ours.into_iter().zip([r, g, b]) {
            assert!((ours - reference).abs() < 0.006, "({row}, {column}): {ours}, not {reference}");
        }
    }
    let target = render(&committed.target.to_scene(&[]));
    assert_agree("mae", &gradients(&committed.scene, &target, PixelLoss::Mae), &committed.mae);
    assert_agree("mse", &gradients(&committed.scene, &target, PixelLoss::Mse), &committed.mse);
}

#[test]
fn images_agree() {
    let Some(shared) = shared() else { return };
    for set in ["target", "perturbed"] {
        let scenes = fixture_scenes(&shared, &format!("a_{set}_scenes.json"));
        let (dims, images) = read_npy(&shared.join(format!("fixtures/a_{set}_image.npy")));
        assert_eq!(dims[1..], [128, 128, 3]);
        for (i, (scene, reference)) in scenes.iter().zip(images.chunks_exact(3 * size().pixels())).enumerate() {
            let image = render(&scene.to_scene(&[])).to_interleaved();
            let errors = || image.iter().zip(reference).map(|(a, &b)| (a - f64::from(b)).abs());
            let (worst, mean) = (errors().fold(0.0, f64::max), errors().sum::<f64>() / f64::of_usize(image.len()));
            assert!(worst <= 0.006 && mean <= 2e-4, "{set} {i}: worst {worst}, mean {mean}");
        }
    }
}

#[test]
fn gradients_agree() {
    let Some(shared) = shared() else { return };
    let scenes = fixture_scenes(&shared, "a_perturbed_scenes.json");
    let (dims, targets) = read_npy(&shared.join("fixtures/a_target_image.npy"));
    for (set, loss) in [("grad", PixelLoss::Mae), ("gradmse", PixelLoss::Mse)] {
        let mut ours: [Vec<f64>; 7] = Default::default();
        for (scene, target) in scenes.iter().take(dims[0]).zip(targets.chunks_exact(3 * size().pixels())) {
            let target: Vec<f64> = target.iter().map(|&v| f64::from(v)).collect();
            let target = Image::from_interleaved(size(), &target).unwrap();
            for (all, one) in ours.iter_mut().zip(gradients(scene, &target, loss)) {
                all.extend(one);
            }
        }
        let mut reference: [Vec<f64>; 7] = Default::default();
        for (i, name) in FIELDS.iter().enumerate() {
            let (dims, values) = read_npy(&shared.join(format!("fixtures/a_{set}_{name}.npy")));
            // The reference's gradients are of the mean over its batch; images are there for the first half of it.
            reference[i] = values[..ours[i].len()].iter().map(|&g| f64::of_usize(dims[0]) * f64::from(g)).collect();
        }
        assert_agree(set, &ours, &reference);
    }
}

#[test]
fn coverage_and_masks_agree() {
    let Some(shared) = shared() else { return };
    let (dims, reference) = read_npy(&shared.join("fixtures/a_target_object_prob.npy"));
    for (i, fixture) in fixture_scenes(&shared, "a_target_scenes.json").iter().take(dims[0]).enumerate() {
        let drawing = draw(&fixture.to_scene(&[]));
        let mut coverage = vec![0.0; 4 * size().pixels()];
        let renderer = ContourRenderer::<f64>::default();
        renderer.object_coverage(&drawing, size(), &mut Default::default(), &mut coverage).unwrap();
        for (k, coverage) in coverage.chunks_exact(size().pixels()).enumerate() {
            for (pixel, &ours) in coverage.iter().enumerate() {
                let theirs = f64::from(reference[(i * size().pixels() + pixel) * 4 + k]);
                assert!(
                    (ours - theirs).abs() < SEAM + 1e-6,
                    "scene {i}, object {k}, pixel {pixel}: {ours}, not {theirs}"
                );
                assert_eq!(ours > 0.0, theirs > 0.0, "mask of scene {i}, object {k}, pixel {pixel}");
            }
        }
    }
}

#[test]
fn true_parameters_explain_the_data_set() {
    let Some(shared) = shared() else { return };
    let (dims, images) = read_npy(&shared.join("mdshr/val_first32_f32.npy"));
    let mut sum = 0.0;
    for (scene, reference) in mdshr_val(&shared, dims[0]).iter().zip(images.chunks_exact(3 * size().pixels())) {
        let image = render(scene).to_interleaved();
        sum += image.iter().zip(reference).map(|(a, &b)| (a - f64::from(b)).abs()).sum::<f64>()
            / f64::of_usize(image.len());
    }
    // The heart was traced anew, the square and the ellipse are the reference's: what is left is seams.
    assert!(sum / f64::of_usize(dims[0]) < 1.1e-4, "mean absolute error {}", sum / f64::of_usize(dims[0]));
}
