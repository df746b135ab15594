//! What the tests share: strategies, finite differences, golden numbers.

// Its compiled code is what is used.
use dvp_double as _;

extern crate alloc;

pub mod coverage;
pub mod draw_svg;
pub mod finite_difference;
pub mod fixture;
pub mod golden;
pub mod hard_geometry;
pub mod inside_integral;
pub mod picture_set;
pub mod scene_strategy;
pub mod shape_strategy;
pub mod strategy;

/// The README's example, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
