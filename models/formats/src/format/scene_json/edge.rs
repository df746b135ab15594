//! How edges and overlaps look, as it stands in a file.

use dvp_core::render::{EdgeLaw, EdgeProfile};
use serde::{Deserialize, Serialize};

use super::strict::{maps_only, present};

/// ln(1e4 - 1) - 5: the reference cuts at d2 = ln(1e4 - 1) sigma, which is its offset plus this many sigma.
const CUT_SIGMAS: f64 = 4.210_240_366_975_849;

/// An edge profile as it stands in a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct EdgeJson {
    /// What coverage is measured by.
    #[serde(default, skip_serializing_if = "EdgeLawJson::is_squared_distance")]
    pub law: EdgeLawJson,
    /// Where coverage is 1/2: signed squared distance or signed distance, doubled frame (the shorter image side is 2).
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Softness, in the same unit; above 0.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub sigma: Option<f64>,
    /// Beyond it coverage is 0, in the same unit; if missing `offset + 4.21 sigma`, or `offset + 6.91 sigma` in distance.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub cut: Option<f64>,
}

maps_only!(EdgeJson);

/// What coverage at an edge is measured by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum EdgeLawJson {
    /// Signed squared distance, the reference renderer's; version 1 knows no other.
    #[default]
    SquaredDistance,
    /// Signed distance: blur.
    Distance,
    /// The pixel's area inside the outline; there are no numbers.
    Area,
}

impl EdgeLawJson {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
    fn is_squared_distance(&self) -> bool {
        *self == Self::SquaredDistance
    }
}

/// `blend` or `over`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CompositingJson {
    /// The paper's confidence-weighted mean.
    #[default]
    Blend,
    /// Painter's order.
    Over,
}

/// Where coverage becomes 0, for a profile that does not say: where it falls to 0.0146, as in the reference profile, and in
/// distance to 0.001.
#[must_use]
pub fn edge_cut(law: EdgeLaw, offset: f64, sigma: f64) -> f64 {
    match law {
        EdgeLaw::SquaredDistance => offset + CUT_SIGMAS * sigma,
        _ => offset + EdgeProfile::distance(sigma).cut,
    }
}
