//! Charts of lines, as SVG.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | colors and names |
//! | `lines` | [`Chart`]: lines over one axis |

mod lines;

use std::path::Path;

use anyhow::{Result, bail};
use plotters::style::RGBColor;

pub use lines::{Chart, Line};

/// The font of all charts: viewers of SVG take their own of this kind.
pub const FONT: &str = "sans-serif";

/// Colors of lines, in order; the first six are told apart also without colors of red and green.
pub const COLORS: [RGBColor; 14] = [
    RGBColor(0, 90, 181),
    RGBColor(220, 50, 32),
    RGBColor(80, 80, 80),
    RGBColor(230, 160, 0),
    RGBColor(0, 158, 115),
    RGBColor(170, 90, 180),
    RGBColor(86, 180, 233),
    RGBColor(120, 80, 40),
    RGBColor(230, 120, 170),
    RGBColor(150, 150, 40),
    RGBColor(0, 110, 110),
    RGBColor(60, 50, 120),
    RGBColor(120, 160, 60),
    RGBColor(200, 110, 60),
];

/// Refuses names that charts are not written to, before any work is done.
///
/// # Errors
/// If the name does not end in .svg.
pub fn check_name(file: &Path) -> Result<()> {
    if file.extension().is_none_or(|ending| ending != "svg") {
        bail!("{}: charts are drawn as .svg", file.display());
    }
    Ok(())
}
