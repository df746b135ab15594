//! Which slots of a proposed scene are objects.
//!
//! The model says how sure it is of each; where it is in doubt, the picture decides: an object is there if painting it pays.

use dvp_core::{Image, Object, Real, Scene};

use crate::error::NetError;
use crate::scene_steps::SceneSteps;

/// Slots of a confidence between these are in doubt.
const DOUBTFUL: [f64; 2] = [0.05, 0.95];
/// An object pays if without it the squared error of the picture would be this many times as large.
const PAYS: f64 = 1.03;
/// Doubts are gone through at most so many times: what one object pays depends on the others.
const ROUNDS: usize = 2;

/// Two candidates stand for one thing if their centers are less than this apart, in units of the sum of their scales...
const SAME_PLACE: f64 = 0.7;
/// ... and no channel of their colors differs by more than this.
const SAME_COLOR: f64 = 0.15;

/// The slots of a scene that are objects of the picture `target`, in their order.
///
/// # Errors
/// As [`SceneSteps::paint`].
pub(crate) fn there<T: Real>(
    scene: &Scene<T>,
    target: &Image<T>,
    painter: &SceneSteps<T>,
) -> Result<Vec<usize>, NetError> {
    let slots = candidates(&scene.objects);
    let sure = |slot: usize| scene.objects[slot].confidence.as_f64();
    // Nothing is painted of an object without confidence.
    let opaque = |&slot: &usize| {
        let object = &scene.objects[slot];
        Object { confidence: if sure(slot) > 0.5 { T::one() } else { T::zero() }, ..object.clone() }
    };
    let mut tried = Scene { objects: slots.iter().map(opaque).collect(), ..scene.clone() };
    let confidence = |at: usize| sure(slots[at]);
    let mut doubts: Vec<usize> = (0..slots.len()).filter(|&at| confidence(at) < DOUBTFUL[1]).collect();
    // The least certain first.
    doubts.sort_by(|&a, &b| (confidence(a) - 0.5).abs().total_cmp(&(confidence(b) - 0.5).abs()));
    let mut error = if doubts.is_empty() { 0.0 } else { squared_error(&tried, target, painter)? };
    for _ in 0..ROUNDS {
        let mut changed = false;
        for &at in &doubts {
            let before = tried.objects[at].confidence;
            tried.objects[at].confidence = T::one() - before;
            let other = squared_error(&tried, target, painter)?;
            let was_there = before == T::one();
            let (with, without) = if was_there { (error, other) } else { (other, error) };
            if (without > PAYS * with) == was_there {
                tried.objects[at].confidence = before;
            } else {
                (error, changed) = (other, true);
            }
        }
        if !changed {
            break;
        }
    }
    Ok((0..slots.len()).filter(|&at| tried.objects[at].confidence == T::one()).map(|at| slots[at]).collect())
}

/// Leaves the objects of a scene that are objects of the picture `target`, with confidence 1.
///
/// # Errors
/// As [`SceneSteps::paint`].
pub(crate) fn keep_there<T: Real>(
    scene: &mut Scene<T>,
    target: &Image<T>,
    painter: &SceneSteps<T>,
) -> Result<(), NetError> {
    let slots = there(scene, target, painter)?;
    scene.objects =
        slots.into_iter().map(|slot| Object { confidence: T::one(), ..scene.objects[slot].clone() }).collect();
    Ok(())
}

/// The slots that may be objects, in their order: those that are more than hardly there, and of several for one thing the most confident.
pub(crate) fn candidates<T: Real>(objects: &[Object<T>]) -> Vec<usize> {
    let mut slots = without_doubles(objects);
    slots.retain(|&slot| objects[slot].confidence.as_f64() > DOUBTFUL[0]);
    slots
}

fn squared_error<T: Real>(scene: &Scene<T>, target: &Image<T>, painter: &SceneSteps<T>) -> Result<f64, NetError> {
    let painted = painter.paint(scene, target.size())?;
    Ok(painted.data().iter().zip(target.data()).map(|(a, b)| (*a - *b).as_f64().powi(2)).sum())
}

/// Of candidates for one thing the most confident, the first of equals; in their order.
fn without_doubles<T: Real>(objects: &[Object<T>]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..objects.len()).collect();
    order.sort_by(|&a, &b| objects[b].confidence.as_f64().total_cmp(&objects[a].confidence.as_f64()));
    let mut kept: Vec<usize> = Vec::with_capacity(order.len());
    for candidate in order {
        if !kept.iter().any(|&other| is_double(&objects[candidate], &objects[other])) {
            kept.push(candidate);
        }
    }
    kept.sort_unstable();
    kept
}

/// Rationale: things of one color that overlap are rare, and look like one. Asking for nearly the same place and size as well
/// leaves halves of one thing beside each other: of the weights that come with the program the exact count falls from .90 to
/// .88, and what TI-TP dreams comes to hold twice as many objects as its pictures.
fn is_double<T: Real>(one: &Object<T>, other: &Object<T>) -> bool {
    let [a, b] = [one, other].map(|object| object.pose);
    let apart = (a.translation[0] - b.translation[0]).hypot(a.translation[1] - b.translation[1]);
    let colors = one.color().into_iter().zip(other.color());
    apart.as_f64() < SAME_PLACE * (a.scale + b.scale).as_f64()
        && colors.map(|(a, b)| (a - b).as_f64().abs()).fold(0.0, f64::max) < SAME_COLOR
}
