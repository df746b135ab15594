//! Outlines that are no simple polygons. No bank knows them.

use anyhow::Result;
use dvp_core::Efd;

use super::Case;
use super::base::{GAP, SCALES, SIDE, apart, case, narrow, random, whole};

const OBJECTS: usize = 2;

/// Limacons: a circle and `level` times its second harmonic. Above 1/2 the outline crosses itself, and the inner loop is a
/// hole.
pub(super) fn crossing(level: f64, seed: u64) -> Result<Case> {
    let second = narrow(level);
    let size = 1.0 / (1.0 + second);
    with_shape(&Efd::new(vec![[size, 0.0, 0.0, -size], [size * second, 0.0, 0.0, -size * second]]), seed)
}

/// A circle run through `level` times: of 63 edges so many lie in one place. An odd number of times is once.
pub(super) fn coincident(level: f64, seed: u64) -> Result<Case> {
    let mut efd = Efd::zeros(whole(level));
    if let Some(last) = efd.rows_mut().last_mut() {
        *last = [1.0, 0.0, 0.0, -1.0];
    }
    with_shape(&efd, seed)
}

fn with_shape(efd: &Efd<f32>, seed: u64) -> Result<Case> {
    let mut scene = apart(&mut random(seed), OBJECTS, SCALES, GAP);
    for object in &mut scene.objects {
        object.shape = efd.clone().into();
    }
    case(scene, SIDE)
}
