//! What is known of a boundary: positions along it, each with its doubt.

use alloc::vec::Vec;

use dvp_core::Vec2;

use crate::tuning;

/// Where a boundary passes, as one window of pixels (a piece of a column or of a row) tells.
///
/// The coverage summed over the window is the area of the face there, whatever the blur; divided by the width of the window, one
/// pixel, it is the mean position of the boundary along the window's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// A point of the boundary, pixels; the mean over the window is corrected for the bend of the boundary.
    pub point: Vec2<f64>,
    /// The axis along which the position is known: (1, 0) for a window along a row, (0, 1) for one along a column; for points of
    /// other origin the unit normal of the boundary.
    pub axis: Vec2<f64>,
    /// Standard deviation of the position along `axis`, pixels.
    pub sigma: f64,
    /// Whether the window has no mixed pixel in a picture whose edges mix them: the boundary goes along the whole of a crack there, and no corner
    /// lies in the window.
    pub is_exact: bool,
}

impl Sample {
    /// A position along an axis with its standard deviation, pixels.
    #[must_use]
    pub fn new(point: Vec2<f64>, axis: Vec2<f64>, sigma: f64) -> Self {
        Self { point, axis, sigma, is_exact: false }
    }
}

/// The samples along a closed boundary, in order: the object lies on the side to which +x is turned into +y, that is to the
/// right of the walker as the picture is seen (y down), so that the signed area of outer rings is positive.
///
/// Where the boundary is hidden behind other objects, or leaves the picture, there are no samples: between the end of one run
/// and the beginning of the next (the first follows the last) the outline may go where it likes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RingSamples {
    /// Stretches that are seen. One alone, of a boundary that is seen whole, is closed: no gap between its end and its start.
    pub runs: Vec<Vec<Sample>>,
    /// Whether the only run closes on itself.
    pub closed: bool,
}

/// Variance of a position that was corrected for the bend, per variance of what the windows told: with d of the second and f of the fourth difference
/// the sum of the squares of 1 + 2 d + 6 f, twice d + 4 f, twice f. Over many windows the corrections cancel, and nothing of this is left.
pub(crate) const STRAIGHTENED_NOISE: f64 = {
    let [d, f] = [1.0 / 24.0, 3.0 / 640.0];
    let [here, beside, beyond] = [1.0 + 2.0 * d + 6.0 * f, d + 4.0 * f, f];
    here * here + 2.0 * (beside * beside + beyond * beyond)
};

/// How far the position in the middle of a window lies from the mean over it, by the means over the windows beside it and beyond those, less the
/// one over it; none where there is a corner between them.
pub(crate) fn straightened([before, behind]: [f64; 2], beyond: Option<[f64; 2]>) -> Option<f64> {
    let bend = before + behind;
    let fourth = match beyond {
        // Where they say that the boundary is not smooth they are not believed.
        Some([first, last]) => (first + last - 4.0 * bend).clamp(-bend.abs(), bend.abs()),
        None => 0.0,
    };
    (bend.abs() < tuning::MOST_BEND).then_some(fourth * (3.0 / 640.0) - bend / 24.0)
}
