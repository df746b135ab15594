//! The library behind the command `dvp`: formats, data sets, sub-commands.
//!
//! | module | does |
//! |---|---|
//! | [`mod@format`] | files in and out |
//! | [`export`] | what people measure, and what other programs read |
//! | [`chart`] | line charts |
//! | [`svg`] | scenes as vector graphics |
//! | [`paint`] | scenes to images with a renderer chosen by name |
//! | [`generate`] | random scenes |
//! | [`method`] | the methods that find scenes, by name |
//! | [`solve`] | pictures to scenes: what `dvp fit` does with each |
//! | [`score`] | scenes against what was drawn: what `dvp evaluate` does with each |
//! | [`agreement`] | whether a scene found is the true one |
//! | [`command`] | the sub-commands: arguments, threads, tables |
//!
//! Everything but [`command`], [`method`] and [`chart`] has its own error enum; those three use anyhow.

extern crate alloc;

// Its compiled code is what is used.
#[cfg(feature = "lab")]
use dvp_double as _;

#[cfg(feature = "lab")]
pub mod agreement;
pub mod chart;
pub mod command;
pub mod export;
pub mod format;
pub mod generate;
pub mod method;
pub mod paint;
pub mod score;
pub mod solve;
mod statistics;
pub mod svg;
