//! `dvp render`: a scene or a drawing to a picture, to vector graphics or to a scene.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use dvp_core::{ImageSize, Real};

use super::drawing::{Drawn, OutputFormat, is_svg, read_json, read_svg};
use super::options::{BankChoice, PaintArguments, square};
use super::{Console, Outcome};
use crate::format::DEFAULT_MAX_PIXELS;

/// Draws a scene or an SVG as PNG, SVG or scene.
///
/// A PNG has alpha where the scene has no background. What a scene cannot hold of an SVG (text, filters, patterns) is named on
/// stderr.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp render out/picture.json -o again.png --width 512\n         \
                         dvp render icon.svg -o icon.json\n         \
                         dvp render data/scenes.jsonl --index 3 -o third.svg")]
pub struct Arguments {
    /// A scene (JSON), the scenes of a data set (JSONL, with --index), or an SVG
    scene: PathBuf,
    /// What to write: .png, .svg or .json
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Which scene of a .jsonl file, from 0
    #[arg(long, value_name = "I")]
    index: Option<usize>,
    /// Columns; without --height the ratio is kept [from the scene, or 128]
    #[arg(long)]
    width: Option<usize>,
    /// Rows; without --width the ratio is kept
    #[arg(long)]
    height: Option<usize>,
    /// Largest picture that is painted
    #[arg(long, default_value_t = DEFAULT_MAX_PIXELS, value_name = "N")]
    max_pixels: usize,
    /// Shapes for scenes that only name them: mdshr or a bank file [beside the scene, or mdshr]
    #[arg(long, value_name = "BANK")]
    bank: Option<BankChoice>,
    #[command(flatten)]
    paint: PaintArguments,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let path = &arguments.scene;
    if is_svg(path) {
        if arguments.index.is_some() {
            bail!("--index is for .jsonl files; {} holds one drawing", path.display());
        }
        write(arguments, read_svg(path, console)?)
    } else if OutputFormat::of(&arguments.output)? == OutputFormat::Png {
        // In the precision of the fit: the picture that the fit wrote comes back bit for bit.
        write(arguments, read_json::<f32>(path, arguments.index, arguments.bank.as_ref())?)
    } else {
        write(arguments, read_json::<f64>(path, arguments.index, arguments.bank.as_ref())?)
    }
}

fn write<T: Real>(arguments: &Arguments, drawn: Drawn<T>) -> Result<Outcome> {
    let own = match drawn.size {
        Some(size) => size,
        None => square(128)?,
    };
    let size = size_of(arguments, own)?;
    let (width, height, limit) = (size.width(), size.height(), arguments.max_pixels);
    if OutputFormat::of(&arguments.output)? == OutputFormat::Png && size.pixels() > limit {
        bail!("a picture of {width} x {height} pixels, must be at most {limit}; give --width, or raise --max-pixels");
    }
    drawn.write(&arguments.output, size, arguments.paint.painter())?;
    Ok(Outcome::Done)
}

/// The size that the options ask for, in the ratio of `own` if they name one side.
fn size_of(arguments: &Arguments, own: ImageSize) -> Result<ImageSize> {
    let other = |side: usize, from: usize, to: usize| {
        let exact = f64::of_usize(side) * f64::of_usize(to) / f64::of_usize(from);
        exact.round().to_count().max(1)
    };
    let size = match (arguments.width, arguments.height) {
        (None, None) => return Ok(own),
        (Some(width), Some(height)) => ImageSize::new(width, height),
        (Some(width), None) => ImageSize::new(width, other(width, own.width(), own.height())),
        (None, Some(height)) => ImageSize::new(other(height, own.height(), own.width()), height),
    };
    size.context("--width and --height")
}
