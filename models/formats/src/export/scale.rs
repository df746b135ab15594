//! How large a pixel is.

use core::str::FromStr;

/// The size of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Side of a pixel, mm; above 0.
    pub mm_per_px: f64,
}

/// A text that is no scale.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("must be a number above 0 with its unit: 0.12mm/px (a pixel is 0.12 mm wide) or 8.5px/mm")]
pub struct ScaleError;

impl FromStr for Scale {
    type Err = ScaleError;

    /// Reads `0.12mm/px` or `8.5px/mm`; a space before the unit is allowed.
    fn from_str(text: &str) -> Result<Self, ScaleError> {
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| ScaleError);
        let mm_per_px = match (text.strip_suffix("mm/px"), text.strip_suffix("px/mm")) {
            (Some(size), _) => number(size)?,
            (None, Some(density)) => number(density)?.recip(),
            (None, None) => return Err(ScaleError),
        };
        if mm_per_px > 0.0 && mm_per_px.is_finite() { Ok(Self { mm_per_px }) } else { Err(ScaleError) }
    }
}
