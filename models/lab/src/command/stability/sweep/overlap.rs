//! Objects that overlap.

use anyhow::Result;
use dvp_core::contour::contains;
use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Object, Pose, Real, Scene};
use rand::RngExt;

use super::Case;
use super::base::{REACH, SIDE, case, narrow, random};
use crate::hard::{self, contrasting};
use dvp_cli::command::options::square;
use dvp_cli::format::mdshr_bank;
use dvp_cli::paint::Painter;

/// Scales of the object behind and of the one in front, which can hide it whole.
const REAR: f32 = 0.13;
const FRONT: f32 = 0.2;
/// Index of the square in the bank.
const SQUARE: usize = 1;
/// Halvings of a distance: to a thousandth of a pixel.
const HALVINGS: usize = 16;

/// Two objects of one color and shape, `level` apart.
pub(super) fn twins(level: f64, seed: u64) -> Result<Case> {
    case(hard::twins(narrow(level), seed), SIDE)
}

/// A square in front of an object, of which it hides the share `level`; drawn as drawing programs do.
pub(super) fn occluded(level: f64, seed: u64) -> Result<Case> {
    let mut rng = random(seed);
    let bank = mdshr_bank();
    let background: [f32; 3] = rng.random();
    let rear = contrasting(&mut rng, background);
    let front = loop {
        let color = contrasting(&mut rng, background);
        if (0..3).any(|c| (color[c] - rear[c]).abs() > 0.15) {
            break color;
        }
    };
    let shape = rng.random_range(0..bank.prototypes.len());
    let direction = rng.random_range(0.0..core::f32::consts::TAU);
    let object = |prototype: usize, scale, color, rotation| {
        let pose = Pose { translation: [0.5; 2], scale, rotation };
        Object::of_efd(pose, color, 1.0, bank.prototypes[prototype].1.clone(), Some(prototype))
    };
    let mut angle = || rng.random_range(0.0..core::f32::consts::TAU);
    let objects = vec![object(shape, REAR, rear, angle()), object(SQUARE, FRONT, front, angle())];
    let (edge, compositing) = (EdgeProfile::area(), Compositing::Over);
    let mut scene = Scene { objects, edge, compositing, ..Scene::empty(background) };
    // The two move apart until so much is hidden and no more.
    let (mut near, mut far) = (0.0, (REAR + FRONT) * REACH);
    if level > 0.0 {
        for _ in 0..HALVINGS {
            let middle = f32::midpoint(near, far);
            place(&mut scene, middle, direction);
            if hidden(&scene)? > level { near = middle } else { far = middle }
        }
    }
    place(&mut scene, far, direction);
    case(scene, SIDE)
}

/// Puts the two objects of a scene so far apart, their middle in that of the picture.
fn place(scene: &mut Scene<f32>, distance: f32, direction: f32) {
    for (object, side) in scene.objects.iter_mut().zip([-0.5, 0.5]) {
        let along = side * distance;
        object.pose.translation = [0.5 + along * direction.cos(), 0.5 + along * direction.sin()];
    }
}

/// Share of the first object behind the second one.
fn hidden(scene: &Scene<f32>) -> Result<f64> {
    let drawing = Painter::default().draw(scene, square(SIDE)?)?;
    let (mut area, mut behind) = (0_usize, 0_usize);
    let fine = 2 * SIDE;
    for at in 0..fine * fine {
        let point = [at % fine, at / fine].map(|i| (f32::of_usize(i) + 0.5) / f32::of_usize(fine));
        if contains(drawing.outline(0), point) {
            area += 1;
            behind += usize::from(contains(drawing.outline(1), point));
        }
    }
    Ok(f64::of_usize(behind) / f64::of_usize(area.max(1)))
}
