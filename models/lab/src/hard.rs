//! Scenes of hard geometry on a square picture: twins of one color and objects that leave the picture.

use dvp_core::contour::{contains, signed_area};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Object, Pose, Real, Scene};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use dvp_cli::format::mdshr_bank;
use dvp_cli::paint::PaintError;

/// Points per side at which it is asked how much of an object shows.
const SIDE: usize = 128;

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

/// One object of which the share `hidden` (within 0.03) lies outside the picture, and one that is wholly inside.
///
/// # Errors
/// The painter's.
pub fn cropped(hidden: f32, index: u64) -> Result<Scene<f32>, PaintError> {
    let mut rng = ChaCha8Rng::seed_from_u64(0xc409 + index);
    let background: [f32; 3] = rng.random();
    let bank = mdshr_bank();
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
        if (1.0 - visible_share(&scene)? - hidden).abs() > 0.03 {
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
        return Ok(scene);
    }
}

/// A color at least 0.15 off `other` in some channel.
pub fn contrasting(rng: &mut ChaCha8Rng, other: [f32; 3]) -> [f32; 3] {
    loop {
        let color: [f32; 3] = rng.random();
        if (0..3).any(|c| (color[c] - other[c]).abs() > 0.15) {
            return color;
        }
    }
}

/// Share of the first object's area that lies in the picture.
fn visible_share(scene: &Scene<f32>) -> Result<f32, PaintError> {
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(REFERENCE_VERTICES, scene.harmonic_count())?, &mut drawing)?;
    let outline = drawing.outline(0);
    let center = |i: usize| (f32::of_usize(i) + 0.5) / f32::of_usize(SIDE);
    let seen = (0..SIDE * SIDE).filter(|&i| contains(outline, [center(i % SIDE), center(i / SIDE)])).count();
    Ok(f32::of_usize(seen) / (signed_area(outline).abs() * f32::of_usize(SIDE * SIDE)))
}
