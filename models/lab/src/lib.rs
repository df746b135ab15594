//! The laboratory: what the methods that find scenes can do, measured and drawn.
//!
//! | module | does |
//! |---|---|
//! | [`chart`] | marks on two axes with labels that find room, as SVG and PNG |
//! | [`hard`] | scenes of hard geometry: twins of one color, objects that leave the picture |
//! | [`agreement`] | whether a scene found is the true one |
//! | [`command`] | `dvp chart`, `gradients`, `parsimony` and `stability` |
//!
//! It stands on [`dvp_cli`], whose methods, scenes and scores it uses; the program `dvp` calls it if it is built with its feature
//! `lab`. With `burn` and `candle` the renderers of tensor operations are timed on these frameworks too.
//!
//! Proved by `tests/command` and by the reports in `tests/report`, which it made.

extern crate alloc;

pub mod agreement;
pub mod chart;
pub mod command;
pub mod hard;
