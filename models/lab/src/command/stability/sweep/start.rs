//! Starts that are off in one way, all else being true.

use anyhow::Result;
use dvp_core::{AnyShape, Object, Real, Scene};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::Case;
use super::base::{SIDE, case, mds_hr, narrow, random};
use dvp_cli::format::mdshr_bank;

/// Every object displaced by `level` px in a direction of its own.
pub(super) fn displaced(level: f64, seed: u64) -> Result<Case> {
    moved(mds_hr(seed)?, seed, |object, rng| {
        let direction = rng.random_range(0.0..core::f32::consts::TAU);
        let distance = narrow(level) / f32::of_usize(SIDE);
        object.pose.translation[0] += distance * direction.cos();
        object.pose.translation[1] += distance * direction.sin();
    })
}

/// Every object turned by `level` degrees, one way or the other; all are hearts, whose angle is seen.
pub(super) fn turned(level: f64, seed: u64) -> Result<Case> {
    let mut truth = mds_hr(seed)?;
    let heart = mdshr_bank().prototypes[0].1.clone();
    for object in &mut truth.objects {
        object.shape = AnyShape::of_efd(heart.clone(), Some(0));
    }
    moved(truth, seed, |object, rng| {
        let way = if rng.random() { 1.0 } else { -1.0 };
        object.pose.rotation += way * narrow(level).to_radians();
    })
}

/// Every object `level` times as large.
pub(super) fn scaled(level: f64, seed: u64) -> Result<Case> {
    moved(mds_hr(seed)?, seed, |object, _| object.pose.scale *= narrow(level))
}

fn moved(truth: Scene<f32>, seed: u64, change: impl Fn(&mut Object<f32>, &mut ChaCha8Rng)) -> Result<Case> {
    let (mut start, mut rng) = (truth.clone(), random(seed));
    start.objects.iter_mut().for_each(|object| change(object, &mut rng));
    Ok(Case { start: Some(start), ..case(truth, SIDE)? })
}
