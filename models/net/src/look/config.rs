//! Sizes of a second look.

use serde::{Deserialize, Serialize};

use crate::error::{NetError, require};

/// Sizes of a [`Look`](super::Look).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct LookConfig {
    /// Places along a side of the window, a multiple of 8.
    pub side: usize,
    /// From the middle of the window to its sides, in scales of the object.
    pub reach: f64,
    /// Channels of the first grid, a quarter as fine as the window, and of the second, half as fine as the first.
    pub channels: [usize; 2],
    /// Width of the perceptron that reads the second grid.
    pub width: usize,
}

impl LookConfig {
    /// About 0.45 M numbers: those that come with the program.
    #[must_use]
    pub fn small() -> Self {
        Self { side: 32, reach: 1.9, channels: [48, 96], width: 192 }
    }

    /// About 4000 numbers: for tests.
    #[must_use]
    pub fn tiny() -> Self {
        Self { side: 16, reach: 1.9, channels: [6, 10], width: 24 }
    }

    /// Refuses sizes of which no network can be made.
    ///
    /// # Errors
    /// [`NetError::Config`], which names the key.
    pub fn validate(&self) -> Result<(), NetError> {
        let tiled = self.side > 0 && self.side.is_multiple_of(8);
        require(tiled, "side", self.side, "must be a multiple of 8, and at least 8")?;
        let reaches = self.reach.is_finite() && self.reach > 0.0;
        require(reaches, "reach", self.reach, "must be a number above 0")?;
        let channels = format!("{:?}", self.channels);
        require(!self.channels.contains(&0), "channels", channels, "must be two numbers of at least 1")?;
        require(self.width > 0, "width", self.width, "must be at least 1")
    }
}
