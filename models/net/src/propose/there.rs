//! Which slots of a proposed scene are objects.
//!
//! The model says how sure it is of each; where it is in doubt, the picture decides: an object is there if painting it pays.

use dvp_core::{Image, Object, Scene};

use crate::error::NetError;
use crate::scene_steps::SceneSteps;

/// Slots of a confidence between these are in doubt.
const DOUBTFUL: [f32; 2] = [0.05, 0.95];
/// An object pays if without it the squared error of the picture would be this many times as large.
const PAYS: f64 = 1.03;
/// Doubts are gone through at most so many times: what one object pays depends on the others.
const ROUNDS: usize = 2;

/// Two candidates stand for one thing if their centers are less than this apart, in units of the smaller scale...
const SAME_PLACE: f32 = 0.35;
/// ... the larger scale is less than this many times the smaller ...
const SAME_SCALE: f32 = 1.5;
/// ... and no channel of their colors differs by more than this.
const SAME_COLOR: f32 = 0.15;

/// Keeps the objects that are there, opaque, for the picture `target`.
///
/// # Errors
/// As [`SceneSteps::paint`].
pub(super) fn keep_objects(
    mut scene: Scene<f32>,
    target: &Image<f32>,
    painter: &SceneSteps<f32>,
) -> Result<Scene<f32>, NetError> {
    drop_doubles(&mut scene);
    scene.objects.retain(|object| object.confidence > DOUBTFUL[0]);
    // The least certain first.
    let certainty = |object: &Object<f32>| (object.confidence - 0.5).abs();
    let mut doubts: Vec<usize> =
        (0..scene.objects.len()).filter(|&at| scene.objects[at].confidence < DOUBTFUL[1]).collect();
    doubts.sort_by(|&a, &b| certainty(&scene.objects[a]).total_cmp(&certainty(&scene.objects[b])));
    // Nothing is painted of an object without confidence.
    for object in &mut scene.objects {
        object.confidence = if object.confidence > 0.5 { 1.0 } else { 0.0 };
    }
    if !doubts.is_empty() {
        let mut error = squared_error(&scene, target, painter)?;
        for _ in 0..ROUNDS {
            let mut changed = false;
            for &at in &doubts {
                let was_there = scene.objects[at].confidence > 0.5;
                scene.objects[at].confidence = if was_there { 0.0 } else { 1.0 };
                let other = squared_error(&scene, target, painter)?;
                let (with, without) = if was_there { (error, other) } else { (other, error) };
                if (without > PAYS * with) == was_there {
                    scene.objects[at].confidence = if was_there { 1.0 } else { 0.0 };
                } else {
                    (error, changed) = (other, true);
                }
            }
            if !changed {
                break;
            }
        }
    }
    scene.keep_visible();
    Ok(scene)
}

fn squared_error(scene: &Scene<f32>, target: &Image<f32>, painter: &SceneSteps<f32>) -> Result<f64, NetError> {
    let painted = painter.paint(scene, target.size())?;
    Ok(painted.data().iter().zip(target.data()).map(|(a, b)| f64::from(a - b).powi(2)).sum())
}

/// Of candidates for one thing keeps the most confident, the first of equals; the order stays.
fn drop_doubles(scene: &mut Scene<f32>) {
    let mut order: Vec<usize> = (0..scene.objects.len()).collect();
    order.sort_by(|&a, &b| scene.objects[b].confidence.total_cmp(&scene.objects[a].confidence));
    let mut kept: Vec<usize> = Vec::with_capacity(order.len());
    for candidate in order {
        if !kept.iter().any(|&other| is_double(&scene.objects[candidate], &scene.objects[other])) {
            kept.push(candidate);
        }
    }
    let mut index = 0..scene.objects.len();
    scene.objects.retain(|_| index.next().is_some_and(|index| kept.contains(&index)));
}

fn is_double(one: &Object<f32>, other: &Object<f32>) -> bool {
    let [a, b] = [one, other].map(|object| object.pose);
    let apart = (a.translation[0] - b.translation[0]).hypot(a.translation[1] - b.translation[1]);
    let (smaller, larger) = (a.scale.min(b.scale), a.scale.max(b.scale));
    let colors = one.color.iter().zip(&other.color);
    apart < SAME_PLACE * smaller
        && larger < SAME_SCALE * smaller
        && colors.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) < SAME_COLOR
}
