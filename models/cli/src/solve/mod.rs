//! A picture to the objects it is made of: what `dvp fit` does with each, for every other program.
//!
//! In: a [`Picture`](crate::format::Picture), from a file, from bytes or from pixels. Out: a [`Solved`], whose fit holds the scene and
//! its doubts. Label maps of other programs come in by [`fit_masks`].
//!
//! | file | holds |
//! |---|---|
//! | `choice.rs` | [`MethodChoice`]: what a user calls a method, and which one that is |
//! | `solver.rs` | [`Solver`]: a method made ready, to be run on many pictures |
//! | `masks.rs` | [`fit_masks`]: outlines of another program's masks |
//! | `error.rs` | [`SolveError`] |
//!
//! *Units*: scene units, the shorter side of the picture is 1. Proved by `tests/command`, which runs `dvp fit`.
//!
//! # Examples
//! ```
//! use dvp_cli::format::Picture;
//! use dvp_cli::method::Memory;
//! use dvp_cli::solve::{MethodChoice, Solver, Start};
//! use dvp_core::{Image, ImageSize};
//! use dvp_fit::FitOptions;
//! // A dark square on white.
//! let size = ImageSize::new(32, 32)?;
//! let dark = |i: usize| (8..24).contains(&(i % 32)) && (8..24).contains(&(i / 32));
//! let pixels: Vec<f32> = (0..size.pixels()).flat_map(|i| [if dark(i) { 0.1 } else { 1.0 }; 3]).collect();
//! let picture = Picture::from(Image::from_interleaved(size, &pixels)?);
//! let solver = Solver::new(MethodChoice::Segment, FitOptions::default(), Start::Picture, 4, 0)?;
//! let solved = solver.solve(&picture, "square", &mut Memory::default())?;
//! assert_eq!(solved.fit.scene.objects.len(), 1);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```

mod choice;
mod error;
mod masks;
mod solver;

pub use choice::MethodChoice;
pub use error::SolveError;
pub use masks::{MaskFit, fit_masks};
pub use solver::{Solved, Solver, Start};
