//! Objects that the border of the picture cuts off.

use anyhow::Result;

use super::Case;
use super::base::{SIDE, case, narrow};
use crate::hard;

/// One object of which the share `level` lies outside, and one inside.
pub(super) fn cropped(level: f64, seed: u64) -> Result<Case> {
    case(hard::cropped(narrow(level), seed)?, SIDE)
}
