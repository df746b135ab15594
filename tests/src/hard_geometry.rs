//! Scenes of hard geometry at 128 x 128: twins of one color and objects that leave the image, and how they are scored.

#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test with a line number")]

use dvp::format::mdshr_bank;
use dvp_core::contour::contains;
use dvp_core::metric::Ownership;
use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Image, ImageSize, Object, Pose, Scene};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const SIDE: usize = 128;
const HARMONICS: usize = 64;

/// Two objects of one prototype and color, scale 0.1, their centers `gap` apart; rotations are independent.
#[must_use]
pub fn twins(gap: f32, index: u64) -> Scene<f32> {
    let mut rng = ChaCha8Rng::seed_from_u64(0x7717 + index);
    let background: [f32; 3] = rng.random();
    let color = contrasting(&mut rng, background);
    let bank = mdshr_bank();
    let prototype = rng.random_range(0..bank.prototypes.len());
    let angle = rng.random_range(0.0..core::f32::consts::TAU);
    let middle = [rng.random_range(0.25..0.75), rng.random_range(0.25..0.75)];
    let objects = [0.5, -0.5].map(|side| {
        let pose = Pose {
            translation: [middle[0] + side * gap * angle.cos(), middle[1] + side * gap * angle.sin()],
            scale: 0.1,
            rotation: rng.random_range(0.0..core::f32::consts::TAU),
        };
        Object::of_efd(pose, color, 1.0, bank.prototypes[prototype].1.clone(), Some(prototype))
    });
    Scene { objects: objects.into(), ..Scene::empty(background) }
}

/// One object of which the share `hidden` (within 0.03) lies outside the image, and one that is wholly inside.
#[must_use]
pub fn cropped(hidden: f32, index: u64) -> Scene<f32> {
    let mut rng = ChaCha8Rng::seed_from_u64(0xc409 + index);
    let background: [f32; 3] = rng.random();
    let bank = mdshr_bank();
    let basis = basis();
    loop {
        let prototype = rng.random_range(0..bank.prototypes.len());
        let pose = Pose {
            translation: [rng.random_range(-0.3..1.3), rng.random_range(-0.3..1.3)],
            scale: rng.random_range(0.1..0.3),
            rotation: rng.random_range(0.0..core::f32::consts::TAU),
        };
        let efd = bank.prototypes[prototype].1.clone();
        let color = contrasting(&mut rng, background);
        let object = Object::of_efd(pose, color, 1.0, efd, Some(prototype));
        let scene = Scene { objects: vec![object], ..Scene::empty(background) };
        if (1.0 - visible_area(&scene, &basis) - hidden).abs() > 0.03 {
            continue;
        }
        let [x, y] = pose.translation;
        let other = Pose { translation: [1.0 - x.clamp(0.2, 0.8), 1.0 - y.clamp(0.2, 0.8)], scale: 0.1, rotation: x };
        if (x - other.translation[0]).hypot(y - other.translation[1]) < pose.scale * 1.3 + 0.15 {
            continue;
        }
        let prototype = rng.random_range(0..bank.prototypes.len());
        let color = contrasting(&mut rng, background);
        let efd = bank.prototypes[prototype].1.clone();
        let mut scene = scene;
        scene.objects.push(Object::of_efd(other, color, 1.0, efd, Some(prototype)));
        return scene;
    }
}

/// A color at least 0.15 off the background in some channel.
fn contrasting(rng: &mut ChaCha8Rng, background: [f32; 3]) -> [f32; 3] {
    loop {
        let color: [f32; 3] = rng.random();
        if (0..3).any(|c| (color[c] - background[c]).abs() > 0.15) {
            return color;
        }
    }
}

fn basis() -> OutlineBasis<f32> {
    OutlineBasis::new(REFERENCE_VERTICES, HARMONICS).unwrap()
}

fn draw(scene: &Scene<f32>, basis: &OutlineBasis<f32>) -> Drawing<f32> {
    let mut drawing = Drawing::default();
    scene.draw(basis, &mut drawing).unwrap();
    drawing
}

fn size() -> ImageSize {
    ImageSize::new(SIDE, SIDE).unwrap()
}

/// Share of the first object's area that lies in the image.
fn visible_area(scene: &Scene<f32>, basis: &OutlineBasis<f32>) -> f32 {
    let drawing = draw(scene, basis);
    let inside = mask(drawing.outline(0)).iter().filter(|&&covered| covered).count();
    let area = dvp_core::contour::signed_area(drawing.outline(0)).abs();
    #[expect(clippy::cast_precision_loss, reason = "few pixels")]
    let share = inside as f32 / (area * (SIDE * SIDE) as f32);
    share
}

/// Pixels whose centers the outline encloses.
fn mask(outline: &[[f32; 2]]) -> Vec<bool> {
    #[expect(clippy::cast_precision_loss, reason = "few pixels")]
    let center = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    (0..SIDE * SIDE).map(|i| contains(outline, [center(i % SIDE), center(i / SIDE)])).collect()
}

/// Whether there are as many objects as in `truth`, and for each one of its own whose mask agrees to the given IoU.
#[must_use]
pub fn all_found(truth: &Scene<f32>, found: &Scene<f32>, iou: f64) -> bool {
    let basis = basis();
    let (expected, drawn) = (draw(truth, &basis), draw(found, &basis));
    if expected.object_count() != drawn.object_count() {
        return false;
    }
    let mut left: Vec<Vec<bool>> = (0..drawn.object_count()).map(|k| mask(drawn.outline(k))).collect();
    (0..expected.object_count()).all(|k| {
        let own = mask(expected.outline(k));
        let best = (0..left.len()).map(|i| (agreement(&own, &left[i]), i)).max_by(|a, b| a.0.total_cmp(&b.0));
        best.filter(|&(value, _)| value >= iou).map(|(_, i)| left.swap_remove(i)).is_some()
    })
}

#[expect(clippy::cast_precision_loss, reason = "few pixels")]
fn agreement(a: &[bool], b: &[bool]) -> f64 {
    let both = a.iter().zip(b).filter(|&(&x, &y)| x && y).count();
    let either = a.iter().zip(b).filter(|&(&x, &y)| x || y).count();
    both as f64 / either.max(1) as f64
}

/// The scene as the reference draws it, without seams.
///
/// # Panics
/// If the scene cannot be drawn.
#[must_use]
pub fn paint(scene: &Scene<f32>) -> Image<f32> {
    let mut image = Image::zeros(size());
    let drawing = draw(scene, &basis());
    ContourRenderer::new(scene.edge, scene.compositing)
        .render(&drawing, size(), &mut Default::default(), image.data_mut())
        .unwrap();
    image
}

/// The pixels each object owns.
///
/// # Panics
/// If the scene cannot be drawn.
#[must_use]
pub fn ownership(scene: &Scene<f32>) -> Ownership {
    let drawing = draw(scene, &basis());
    let mut coverage = vec![0.0; drawing.object_count() * size().pixels()];
    let mut owned = Ownership::default();
    ContourRenderer::new(scene.edge, scene.compositing)
        .object_coverage(&drawing, size(), &mut Default::default(), &mut coverage)
        .unwrap();
    owned.fill(size().pixels(), &coverage, &drawing.confidences).unwrap();
    owned
}

/// The image in steps of 1 / 255.
#[must_use]
pub fn rounded(image: &Image<f32>) -> Image<f32> {
    let mut image = image.clone();
    image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0).round() / 255.0);
    image
}
