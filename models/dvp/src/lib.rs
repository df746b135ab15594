//! dvp: pictures to the objects they are made of, and back. The command, and its parts as a library.
//!
//! | module | does |
//! |---|---|
//! | [`command`] | what the program does: the words of a command line in, files and an exit code out |
//! | the others | those of [`dvp_cli`], to be used without the command |
//!
//! Who embeds the renderer or the fit alone needs less: `dvp-core` and `dvp-fit` have no dependency on files, threads or std.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | `mimalloc` (default) | the allocator of the command, in C; programs that call this library keep theirs |
//! | `lab` | the sub-commands `chart`, `gradients`, `parsimony` and `stability` |
//! | `burn`, `candle` | `dvp train --backend burn` or `candle` |
//! | `wgpu` | `dvp train --backend wgpu`: graphics cards by Vulkan, Metal, DirectX, through burn |
//! | `parquet` | tables as Apache Parquet |
//!
//! None of the others is on by default: a first build takes half of the time without them. Released programs have `lab` and `parquet`.

pub mod command;

pub use dvp_cli::{chart, export, format, generate, method, paint, score, solve, spoil, svg};
