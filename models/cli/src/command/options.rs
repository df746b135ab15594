//! Options that several commands share.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use dvp_core::render::Compositing;
use dvp_core::{ImageSize, Real};
use dvp_fit::Bank;
use rayon::prelude::*;

use super::progress;
use crate::format::{DEFAULT_MAX_PIXELS, mdshr_bank, read_bank};
use crate::paint::{Painter, RendererName};

/// How scenes are painted.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct PaintArguments {
    /// Renderer
    #[arg(long, value_enum, default_value_t)]
    renderer: RendererName,
    /// Vertices per outline, the repeated one counted
    #[arg(long, default_value_t = 64, value_name = "K", value_parser = clap::value_parser!(u16).range(4..))]
    vertices: u16,
}

impl PaintArguments {
    pub(super) fn painter(self) -> Painter {
        Painter { renderer: self.renderer, vertices: usize::from(self.vertices) }
    }
}

/// How commands that work through many pictures do so.
#[derive(Clone, Copy, Debug, Args)]
pub struct BatchArguments {
    /// Largest picture that is read
    #[arg(long, default_value_t = DEFAULT_MAX_PIXELS, value_name = "N")]
    pub max_pixels: usize,
    /// Threads; 0 means one per core
    #[arg(long, default_value_t = 0, value_name = "N")]
    threads: usize,
    /// Print the figures as JSON
    #[arg(long)]
    pub json: bool,
}

impl BatchArguments {
    /// What `work` makes of each item and its index, in their order; on all threads, each with memory of its own. Progress shows
    /// the `name` of the item begun last.
    ///
    /// # Errors
    /// If the system has no more threads.
    pub fn each<S: Default, I: Sync, R: Send>(
        &self,
        items: &[I],
        name: impl Fn(&I) -> String + Sync,
        work: impl Fn(&mut S, usize, &I) -> R + Sync,
    ) -> Result<Vec<R>> {
        let bar = progress::bar(items.len() as u64, 0);
        let one = |scratch: &mut S, (index, item)| {
            bar.set_message(name(item));
            let result = work(scratch, index, item);
            bar.inc(1);
            result
        };
        let results = with_threads(self.threads, || items.par_iter().enumerate().map_init(S::default, one).collect())?;
        bar.finish_and_clear();
        Ok(results)
    }
}

/// `blend` or `over`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum CompositingName {
    /// Overlaps show the mean of the colors
    Blend,
    /// Later objects hide earlier ones
    Over,
}

impl From<CompositingName> for Compositing {
    fn from(name: CompositingName) -> Self {
        match name {
            CompositingName::Blend => Self::Blend,
            CompositingName::Over => Self::Over,
        }
    }
}

/// Known shapes: built in, from a file, or none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum BankChoice {
    None,
    Mdshr,
    File(PathBuf),
}

impl From<&str> for BankChoice {
    fn from(text: &str) -> Self {
        match text {
            "none" => Self::None,
            "mdshr" => Self::Mdshr,
            _ => Self::File(PathBuf::from(text)),
        }
    }
}

impl BankChoice {
    pub(super) fn load<T: Real>(&self) -> Result<Option<Bank<T>>> {
        Ok(match self {
            Self::None => None,
            Self::Mdshr => Some(mdshr_bank()),
            Self::File(path) => Some(read_bank(path)?),
        })
    }
}

/// Whether a file's name ends so, in small or capital letters.
pub(super) fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

/// Runs `work` on `threads` threads; 0 means one per core.
///
/// # Errors
/// If the system has no more threads.
pub fn with_threads<R: Send>(threads: usize, work: impl FnOnce() -> R + Send) -> Result<R> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().context("threads cannot be started")?;
    Ok(pool.install(work))
}

/// The size that the options ask for, one side standing for both, or else `otherwise`.
pub(super) fn size_or(width: Option<usize>, height: Option<usize>, otherwise: ImageSize) -> Result<ImageSize> {
    let size = match (width, height) {
        (None, None) => return Ok(otherwise),
        (Some(width), Some(height)) => ImageSize::new(width, height),
        (Some(side), None) | (None, Some(side)) => ImageSize::new(side, side),
    };
    size.context("--width and --height")
}

/// The size of a square image of `side` pixels.
///
/// # Errors
/// If `side` is 0 or so large that the pixels cannot be counted.
pub fn square(side: usize) -> Result<ImageSize> {
    ImageSize::new(side, side).context("image size")
}

/// The folder that a file stands in.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}
