//! Edge profiles far from the reference's.

use anyhow::Result;
use dvp_core::render::EdgeProfile;

use super::Case;
use super::base::{GAP, SCALES, SIDE, apart, case, narrow, random};

const OBJECTS: usize = 3;

/// The reference's cut lies so many sigma outside its offset.
const CUT: f32 = 4.21;

/// Softness `level`.
pub(super) fn sigma(level: f64, seed: u64) -> Result<Case> {
    with_edge(EdgeProfile { sigma: narrow(level), ..EdgeProfile::reference() }, seed)
}

/// Half coverage where the squared distance is `level`.
pub(super) fn offset(level: f64, seed: u64) -> Result<Case> {
    with_edge(EdgeProfile { offset: narrow(level), ..EdgeProfile::reference() }, seed)
}

fn with_edge(mut edge: EdgeProfile<f32>, seed: u64) -> Result<Case> {
    edge.cut = edge.offset + CUT * edge.sigma;
    let mut scene = apart(&mut random(seed), OBJECTS, SCALES, GAP);
    scene.edge = edge;
    case(scene, SIDE)
}
