//! The library behind the command `dvp`: formats, data sets, sub-commands.
//!
//! | module | does |
//! |---|---|
//! | [`mod@format`] | files in and out |
//! | [`svg`] | scenes as vector graphics |
//! | [`paint`] | scenes to images with a renderer chosen by name |
//! | [`generate`] | random scenes |
//! | [`command`] | the sub-commands: arguments, threads, tables |
//!
//! Everything but [`command`] has its own error enum; [`command`] alone uses anyhow.

extern crate alloc;

pub mod command;
pub mod format;
pub mod generate;
pub mod paint;
pub mod svg;
