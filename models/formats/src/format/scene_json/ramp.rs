//! Color ramps as they stand in a file.

use serde::{Deserialize, Serialize};

use super::strict::maps_only;

/// Colors that change from place to place. They move with the object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct RampJson {
    /// Along a line, or away from a center.
    pub kind: RampKindJson,
    /// In the frame of the shape, as its lengths are. Two of a linear ramp: where the offset is 0, and where it is 1. Three of a
    /// radial one: the center, where the offset is 0, and two points of the ellipse where it is 1, in conjugate directions.
    pub points: Vec<[f64; 2]>,
    /// 1 to 256 colors; before the first and behind the last one the color stays.
    pub stops: Vec<ColorStopJson>,
}

/// How offsets run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum RampKindJson {
    /// Along a line; the same color across it.
    Linear,
    /// Away from a center; the same color along ellipses around it.
    Radial,
}

/// A color that a ramp reaches, and where.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct ColorStopJson {
    /// 0 at the beginning of the ramp, 1 at its end, at most 1e6 away from 0; never below that of the stop before.
    pub offset: f64,
    /// RGB, [0, 1].
    pub color: [f64; 3],
}

maps_only!(RampJson, ColorStopJson);
