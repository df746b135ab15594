//! What the command `dvp` is made of: formats, data sets, methods by name, sub-commands.
//!
//! The program itself is the crate `dvp`, which adds the laboratory (`dvp-lab`) if it is asked for.
//!
//! | module | does |
//! |---|---|
//! | [`mod@format`] | files in and out |
//! | [`export`] | what people measure, and what other programs read |
//! | [`chart`] | charts of lines |
//! | [`svg`] | scenes as vector graphics |
//! | [`paint`] | scenes to images with a renderer chosen by name |
//! | [`generate`] | random scenes |
//! | [`spoil`] | what happens to pictures on their way: noise, blur, JPEG |
//! | [`method`] | the methods that find scenes, by name |
//! | [`solve`] | pictures to scenes: what `dvp fit` does with each |
//! | [`score`] | scenes against what was drawn: what `dvp evaluate` does with each |
//! | [`suite`] | the benchmarks of the field: published files to data sets |
//! | [`statistics`] | means and quantiles |
//! | [`command`] | the sub-commands: arguments, threads, tables |
//!
//! Everything but [`command`] and [`chart`] has its own error enum; those two use anyhow.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | `burn`, `candle` | training on these frameworks |
//! | `wgpu` | training on graphics cards, by burn: Vulkan, Metal, DirectX |
//! | `double` | methods in 64 bits too ([`method::Precision`]) |
//! | `parquet` | tables as Apache Parquet |

extern crate alloc;

// Its compiled code is what is used.
#[cfg(feature = "double")]
use dvp_double as _;

pub mod chart;
pub mod command;
pub mod export;
pub mod format;
pub mod generate;
pub mod method;
pub mod paint;
pub mod score;
pub mod solve;
pub mod spoil;
pub mod statistics;
pub mod suite;
pub mod svg;
