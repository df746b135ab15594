//! Soft triangles against the reference's object coverages, images and gradients.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use dvp_core::render::triangles::{Face, Triangulate, TriangulationReport};
use dvp_core::render::{Compositing, EdgeProfile, PixelLoss, Renderer, SoftTriangles, TileRenderer, TriangleRenderer};
use dvp_core::scene::rotation_from_pair_vjp;
use dvp_core::shape::{OutlineBasis, Rings};
use dvp_core::{Drawing, DrawingGrad, Image, ImageSize, Real, Scene, SceneGrad};
use dvp_tests::coverage::coverage;
use dvp_tests::fixture::{fixture_scenes, read_npy, shared};
use serde::Deserialize;

const SIDE: usize = 128;

/// Faces that were cut elsewhere, each list with the first vertex of its outline in pixels.
#[derive(Clone, Debug)]
struct GivenFaces(Vec<([f64; 2], Vec<Face>)>);

impl Triangulate for GivenFaces {
    fn triangulate<T: Real>(&self, rings: Rings<'_, T>, faces: &mut Vec<Face>) -> TriangulationReport {
        let first = rings.vertices[0].map(Real::as_f64);
        let far = |at: [f64; 2]| (at[0] - first[0]).hypot(at[1] - first[1]);
        let nearest = self.0.iter().min_by(|(a, _), (b, _)| far(*a).total_cmp(&far(*b))).unwrap();
        assert!(far(nearest.0) < 1e-3, "no faces for an outline that begins at {first:?}");
        faces.clone_from(&nearest.1);
        TriangulationReport::default()
    }
}

impl GivenFaces {
    /// Faces of outlines in scene units.
    fn new<'a>(outlines: impl Iterator<Item = (&'a [[f64; 2]], Vec<Face>)>) -> Self {
        Self(outlines.map(|(outline, faces)| (outline[0].map(|x| x * 128.0 - 0.5), faces)).collect())
    }

    fn model(self) -> SoftTriangles<f64, Self> {
        SoftTriangles { edge: EdgeProfile::reference(), faces: self }
    }
}

fn size() -> ImageSize {
    ImageSize::new(SIDE, SIDE).unwrap()
}

/// Mean and largest absolute difference.
fn errors(found: impl IntoIterator<Item = f64>, expected: &[f32]) -> (f64, f64) {
    let (mut sum, mut worst) = (0.0, 0.0_f64);
    for (found, &expected) in found.into_iter().zip(expected) {
        let error = (found - f64::from(expected)).abs();
        sum += error;
        worst = worst.max(error);
    }
    (sum / f64::of_usize(expected.len()), worst)
}

#[test]
fn coverage_agrees_with_the_committed_sample() {
    #[derive(Deserialize)]
    struct Sample {
        outline: Vec<[f64; 2]>,
        faces: Vec<Face>,
        coverage: Vec<(usize, usize, f64)>,
    }
    let sample: Sample = serde_json::from_str(include_str!("../golden_data/triangles.json")).unwrap();
    let faces = GivenFaces::new(core::iter::once((&sample.outline[..], sample.faces)));
    let outline_px: Vec<_> = sample.outline.iter().map(|v| v.map(|x| x * 128.0)).collect();
    let found = coverage(faces.model(), &outline_px, size()).unwrap();
    assert!(sample.coverage.len() > 300);
    for (row, column, expected) in sample.coverage {
        let found = found[row * SIDE + column];
        // The reference works in f32: 1e-7 of a coordinate is 5e-5 of a logistic whose sigma is 1e-4.
        assert!((found - expected).abs() < 1e-4, "({row}, {column}): {found} instead of {expected}");
    }
}

/// The reference's outlines and ear-cut faces of one scene.
#[derive(Deserialize)]
struct Geometry {
    /// (x, -y, depth) in scene units, 64 per object; a batch of one.
    verts_ndc: [Vec<[f64; 3]>; 1],
    faces: Vec<Face>,
}

impl Geometry {
    fn read(shared: &Path) -> Vec<Self> {
        let file = File::open(shared.join("fixtures/a_geometry.json")).unwrap();
        serde_json::from_reader(BufReader::new(file)).unwrap()
    }

    /// Outline of object k, scene units.
    fn outline(&self, k: usize) -> Vec<[f64; 2]> {
        self.verts_ndc[0][64 * k..64 * (k + 1)].iter().map(|v| [v[0], -v[1]]).collect()
    }

    fn faces(&self) -> GivenFaces {
        let outlines: Vec<_> = (0..4).map(|k| self.outline(k)).collect();
        GivenFaces::new(outlines.iter().enumerate().map(|(k, outline)| {
            let own = self.faces.iter().filter(|face| face[0] / 64 == k).map(|face| face.map(|vertex| vertex - 64 * k));
            (&outline[..], own.collect())
        }))
    }
}

#[test]
fn images_agree_with_the_same_faces() {
    let Some(shared) = shared() else { return };
    let geometry = Geometry::read(&shared);
    assert_eq!(geometry.len(), 4);
    let scenes = fixture_scenes(&shared, "a_target_scenes.json");
    let (_, images) = read_npy(&shared.join("fixtures/a_target_image.npy"));
    let (dims, object_coverage) = read_npy(&shared.join("fixtures/a_target_object_prob.npy"));
    assert_eq!(dims[1..], [SIDE, SIDE, 4]);
    for (i, geometry) in geometry.iter().enumerate() {
        let mut drawing = Drawing { background: scenes[i].background, ..Drawing::default() };
        for (k, object) in scenes[i].objects.iter().enumerate() {
            drawing.push(&geometry.outline(k), object.color, object.confidence);
        }
        let renderer = TileRenderer { coverage: geometry.faces().model(), compositing: Compositing::Blend };
        let mut scratch = Default::default();
        let mut coverage = vec![0.0; 4 * size().pixels()];
        renderer.object_coverage(&drawing, size(), &mut scratch, &mut coverage).unwrap();
        let expected = &object_coverage[i * 4 * size().pixels()..][..4 * size().pixels()];
        let interleaved = (0..expected.len()).map(|at| coverage[at % 4 * size().pixels() + at / 4]);
        let (mean, worst) = errors(interleaved, expected);
        // f32 in the reference, as above.
        assert!(mean < 1e-6 && worst < 2e-4, "coverage of scene {i}: mean {mean:e}, worst {worst:e}");
        let mut image = Image::zeros(size());
        renderer.render(&drawing, size(), &mut scratch, image.data_mut()).unwrap();
        let (mean, worst) = errors(image.to_interleaved(), &images[i * 3 * size().pixels()..][..3 * size().pixels()]);
        assert!(mean < 2e-6 && worst < 2e-4, "image of scene {i}: mean {mean:e}, worst {worst:e}");
    }
}

fn draw(scene: &Scene<f64>, basis: &OutlineBasis<f64>) -> Drawing<f64> {
    let mut drawing = Drawing::default();
    scene.draw(basis, &mut drawing).unwrap();
    drawing
}

#[test]
fn images_agree_with_own_faces() {
    let Some(shared) = shared() else { return };
    let basis = OutlineBasis::new(64, 64).unwrap();
    let renderer = TriangleRenderer::default();
    let mut scratch = Default::default();
    for set in ["target", "perturbed"] {
        let scenes = fixture_scenes(&shared, &format!("a_{set}_scenes.json"));
        let (dims, images) = read_npy(&shared.join(format!("fixtures/a_{set}_image.npy")));
        for (i, (scene, expected)) in scenes.iter().zip(images.chunks(3 * size().pixels())).enumerate() {
            let mut image = Image::zeros(size());
            let drawing = draw(&scene.to_scene(&[]), &basis);
            renderer.render(&drawing, size(), &mut scratch, image.data_mut()).unwrap();
            let (mean, worst) = errors(image.to_interleaved(), expected);
            // What is left are seams: dips to 0.993 of a full contrast, on diagonals other than the ear-cut ones.
            assert!(mean < 5e-4 && worst < 0.0068, "{set} {i}: mean {mean:e}, worst {worst:e}");
        }
        assert!(dims[0] >= 8);
    }
}

/// Our gradient of the reference's batch loss, flat per parameter group, and the reference's.
struct Group {
    name: &'static str,
    found: Vec<f64>,
    expected: Vec<f64>,
}

impl Group {
    /// Length of the difference relative to the reference's length.
    fn relative_error(&self) -> f64 {
        let norm = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
        norm(&mut self.found.iter().zip(&self.expected).map(|(f, e)| f - e)) / norm(&mut self.expected.iter().copied())
    }
}

/// The gradients of the perturbed scenes whose targets are among the fixtures, next to the reference's in `files`.
fn gradients(shared: &Path, loss: PixelLoss, files: &str) -> Vec<Group> {
    let basis = OutlineBasis::new(64, 16).unwrap();
    let renderer = TriangleRenderer::default();
    let mut scratch = Default::default();
    let fixtures = fixture_scenes(shared, "a_perturbed_scenes.json");
    let (dims, images) = read_npy(&shared.join("fixtures/a_target_image.npy"));
    let names = ["t", "s", "r", "c", "f", "b", "e"];
    let mut found: [Vec<f64>; 7] = Default::default();
    for (fixture, target) in fixtures.iter().zip(images.chunks(3 * size().pixels())) {
        let target: Vec<_> = target.iter().map(|&v| f64::from(v)).collect();
        let target = Image::from_interleaved(size(), &target).unwrap();
        let scene = fixture.to_scene(&[]);
        let drawing = draw(&scene, &basis);
        let (mut grad_drawing, mut grad) = (DrawingGrad::default(), SceneGrad::default());
        grad_drawing.reset(&drawing);
        grad.reset(&scene);
        renderer.loss_and_grad(&drawing, target.view(), loss, &mut scratch, &mut grad_drawing).unwrap();
        scene.draw_vjp(&basis, &grad_drawing, &mut grad).unwrap();
        found[5].extend(grad.background);
        for (object, fixture) in grad.objects.iter().zip(&fixture.objects) {
            found[0].extend(object.translation);
            // The reference keeps two scales and uses the first.
            found[1].extend([object.scale, 0.0]);
            let mut pair = [0.0; 2];
            rotation_from_pair_vjp(fixture.rotation_vec, object.rotation, &mut pair);
            found[2].extend(pair);
            found[3].extend(object.color);
            found[4].push(object.confidence);
            found[6].extend(&object.numbers);
        }
    }
    assert!(dims[0] >= 8);
    let groups = names.into_iter().zip(found).map(|(name, mut found)| {
        // The loss is the mean over the batch of 16.
        found.iter_mut().for_each(|g| *g /= 16.0);
        let (_, expected) = read_npy(&shared.join(format!("fixtures/{files}_{name}.npy")));
        let expected = expected.iter().take(found.len()).map(|&g| f64::from(g)).collect();
        Group { name, found, expected }
    });
    groups.collect()
}

#[test]
fn gradients_agree_with_own_faces() {
    let Some(shared) = shared() else { return };
    for (loss, files) in [(PixelLoss::Mse, "a_gradmse"), (PixelLoss::Mae, "a_grad")] {
        for group in gradients(&shared, loss, files) {
            let error = group.relative_error();
            // Seams, as above, on other diagonals: 0.03 % (background) to 0.9 % (descriptors).
            assert!(error < 0.01, "{files} {}: relative error {error:e}", group.name);
        }
    }
}
