//! The command tests: `dvp` from its arguments to its files, streams and exit code; a module per concern.
#![expect(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test, in helpers too")]

extern crate alloc;

mod bad_input;
mod chart;
mod coded;
mod decompose;
mod edges;
mod evaluate;
mod exports;
mod fit;
mod generate;
mod gradients;
mod interrupted;
mod look;
mod network;
mod parsimony;
mod picture_kinds;
mod pictures;
mod prototypes;
mod raw_png;
mod refine;
mod rows;
mod runner;
mod suites;
mod svg;
mod train;
mod transparent;
