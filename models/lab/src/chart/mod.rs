//! Charts of marks on two axes, as SVG and PNG. Charts of lines are [`dvp_cli::chart`]'s.
//!
//! | file | holds |
//! |---|---|
//! | `scatter` | [`Scatter`]: marks on two logarithmic axes, with labels |
//! | `marks` | the shapes of marks |
//! | `labels` | where labels find room |
//! | `raster` | a drawing as PNG, with a font that comes along |

mod labels;
mod marks;
mod raster;
mod scatter;
#[cfg(test)]
mod tests;

pub use marks::Shape;
pub use scatter::{Mark, Scatter, Series, Strip};
