//! Small objects, many objects, small and large pictures.

use anyhow::Result;
use dvp_core::Real;
use dvp_core::render::{Compositing, EdgeProfile};

use super::Case;
use super::base::{CROWD_GAP, GAP, SCALES, SIDE, apart, case, mds_hr, narrow, random, whole};
use dvp_cli::generate::Range;

const OBJECTS: usize = 3;
/// Side of the picture of many objects, and the scale at which 50 of them have room.
const CROWD_SIDE: usize = 256;
const CROWD_SCALE: f32 = 0.028;

/// Three objects of `level` px across.
pub(super) fn small_objects(level: f64, seed: u64) -> Result<Case> {
    let mut scene = apart(&mut random(seed), OBJECTS, SCALES, GAP);
    let scale = narrow(level) / 2.0 / f32::of_usize(SIDE);
    scene.objects.iter_mut().for_each(|object| object.pose.scale = scale);
    case(scene, SIDE)
}

/// `level` objects.
pub(super) fn many_objects(level: f64, seed: u64) -> Result<Case> {
    case(apart(&mut random(seed), whole(level), Range::new(CROWD_SCALE, CROWD_SCALE), CROWD_GAP), CROWD_SIDE)
}

/// A scene of MDS-HR on a square of `level` px, its edges as wide in proportion.
pub(super) fn pictures(level: f64, seed: u64) -> Result<Case> {
    case(mds_hr(seed)?, whole(level))
}

/// Objects that are apart on a square of `level` px, drawn as drawing programs do.
pub(super) fn sharp_pictures(level: f64, seed: u64) -> Result<Case> {
    let mut scene = apart(&mut random(seed), OBJECTS, SCALES, GAP);
    (scene.edge, scene.compositing) = (EdgeProfile::area(), Compositing::Over);
    case(scene, whole(level))
}
