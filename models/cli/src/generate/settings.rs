//! What random scenes are drawn from.

use core::fmt;
use core::str::FromStr;

use dvp_core::render::{Compositing, EdgeProfile};

/// A closed range, written `0.1..0.3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Smallest value.
    pub low: f32,
    /// Largest value.
    pub high: f32,
}

impl Range {
    /// A range from `low` to `high`.
    #[must_use]
    pub const fn new(low: f32, high: f32) -> Self {
        Self { low, high }
    }
}

impl FromStr for Range {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("'{text}' is no range; write two numbers as 0.1..0.3, the smaller one first");
        let (low, high) = text.split_once("..").unwrap_or((text, text));
        let low: f32 = low.trim().parse().map_err(|_| wrong())?;
        let high: f32 = high.trim().trim_start_matches('=').parse().map_err(|_| wrong())?;
        if low.is_finite() && high.is_finite() && low <= high { Ok(Self { low, high }) } else { Err(wrong()) }
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}..{}", self.low, self.high)
    }
}

/// The distribution of random scenes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneSettings {
    /// Fewest visible objects.
    pub fewest: usize,
    /// Most visible objects.
    pub most: usize,
    /// Objects that are placed, visible or not; at least `most`.
    pub slots: usize,
    /// Draws of all positions, of which the one with the largest smallest distance is taken; at least 1.
    pub placements: usize,
    /// Free border for object centers, as a share of the image side.
    pub margin: f32,
    /// Scale of the unit outline, scene units.
    pub scale: Range,
    /// Each channel of an object's color.
    pub color: Range,
    /// Each channel of the background.
    pub background: Range,
    /// Whether invisible slots stay in the scene, with confidence 0.
    pub keep_hidden: bool,
    /// How coverage falls off at an outline.
    pub edge: EdgeProfile<f32>,
    /// How overlapping objects mix.
    pub compositing: Compositing,
}

impl SceneSettings {
    /// MDS-HR, for images of 128 x 128 pixels.
    #[must_use]
    pub fn mds_hr() -> Self {
        Self {
            fewest: 1,
            most: 4,
            slots: 4,
            placements: 8,
            margin: 0.05,
            scale: Range::new(0.1, 0.3),
            color: Range::new(0.0, 1.0),
            background: Range::new(0.0, 1.0),
            keep_hidden: false,
            edge: EdgeProfile::reference(),
            compositing: Compositing::Blend,
        }
    }

    /// Like Multi-dSprites (colored sprites on a colored ground), for images of 64 x 64 pixels: smaller objects with hard
    /// edges that hide each other.
    #[must_use]
    pub fn multi_dsprites() -> Self {
        Self {
            fewest: 2,
            most: 5,
            slots: 5,
            placements: 1,
            margin: 0.1,
            scale: Range::new(0.08, 0.2),
            // Squared, a ramp of 1e-4 px at 64 px: every pixel is inside or outside.
            edge: EdgeProfile { offset: 0.0, sigma: 1e-11, cut: 5.21e-11, ..EdgeProfile::reference() },
            compositing: Compositing::Over,
            ..Self::mds_hr()
        }
    }

    /// Says what is wrong with the settings.
    ///
    /// # Errors
    /// A sentence with the option to change.
    pub fn check(&self) -> Result<(), String> {
        let within = |range: Range| range.low >= 0.0 && range.high <= 1.0;
        let problem = if self.fewest > self.most {
            "--visible must be written smaller..larger"
        } else if self.most > self.slots {
            "--slots must be at least the largest number of visible objects"
        } else if self.slots > 1000 {
            "--slots must be at most 1000"
        } else if self.placements == 0 || self.placements > 10_000 {
            "--placements must be 1 to 10000"
        } else if !(0.0..0.5).contains(&self.margin) {
            "--margin must be at least 0 and below 0.5"
        } else if self.scale.low <= 0.0 || self.scale.high > 10.0 {
            "--scale must be above 0 and at most 10"
        } else if !within(self.color) || !within(self.background) {
            "--color and --background must lie in 0..1"
        } else {
            return Ok(());
        };
        Err(problem.to_owned())
    }
}
