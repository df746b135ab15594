//! What is known of a boundary: positions along it, each with its doubt.

use alloc::vec::Vec;

use dvp_core::Vec2;

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
