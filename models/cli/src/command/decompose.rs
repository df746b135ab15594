//! `dvp decompose`: what a network that divides pictures into parts makes of them, as one picture to look at.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use dvp_core::Image;
use dvp_net::decompose::on_square;

use super::generated::mds_hr;
use super::options::square;
use super::sheet::{of_parts, sheet};
use super::{Console, Outcome};
use crate::format::{BitDepth, DEFAULT_MAX_PIXELS, encode_png, read_picture, write_atomic};
use crate::method::load_divider;
use crate::paint::Painter;

/// Draws what MONet or Slot Attention makes of pictures.
///
/// A row for each: the picture as the network sees it, the reconstruction, the mask of every part (white where it is), and what every
/// part shows under its mask.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp decompose --model masks/best.safetensors --generated 8 -o parts.png\n         \
                         dvp decompose --model masks/best.safetensors picture.png -o parts.png")]
pub struct Arguments {
    /// Pictures
    #[arg(value_name = "PICTURES", required_unless_present = "generated", conflicts_with = "generated")]
    pictures: Vec<PathBuf>,
    /// Weights, as `dvp train --model monet` or `slots` writes them
    #[arg(long, value_name = "FILE")]
    model: PathBuf,
    /// Instead of pictures so many scenes of MDS-HR: those of `dvp generate` with the same seed
    #[arg(long, value_name = "N")]
    generated: Option<u64>,
    /// Number that generated scenes are drawn from; better not one that was trained with
    #[arg(long, default_value_t = 1234)]
    seed: u64,
    /// PNG file to write
    #[arg(long, short, value_name = "FILE")]
    out: PathBuf,
    /// Largest picture that is read
    #[arg(long, default_value_t = DEFAULT_MAX_PIXELS, value_name = "N")]
    max_pixels: usize,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    if arguments.out.extension().is_none_or(|ending| !ending.eq_ignore_ascii_case("png")) {
        bail!("{}: the name of a PNG file is needed, ending in .png", arguments.out.display());
    }
    let divider = load_divider(&arguments.model)?;
    let side = divider.config().side();
    let mut rows = Vec::new();
    for picture in pictures(arguments)? {
        let image = on_square(picture.view(), side)?;
        rows.push(of_parts(&image, &divider.divide(image.view())?)?);
    }
    let sheet = sheet(&rows)?;
    write_atomic(&arguments.out, &encode_png(sheet.view(), BitDepth::Eight)?)?;
    writeln!(console.out, "{} pictures, {} parts each", rows.len(), divider.config().slots())?;
    writeln!(console.out, "{}", arguments.out.display())?;
    Ok(Outcome::Done)
}

fn pictures(arguments: &Arguments) -> Result<Vec<Image<f32>>> {
    let Some(count) = arguments.generated else {
        let read = |path: &PathBuf| Ok(read_picture(path, arguments.max_pixels)?.image);
        return arguments.pictures.iter().map(read).collect();
    };
    let (data, painter) = (mds_hr(count, arguments.seed)?, Painter::default());
    let size = square(dvp_net::propose::TRAINED_SIDE)?;
    let paint = |sample: &crate::format::Sample| {
        let (json, place) = sample.scene.as_ref().context("a generated scene")?;
        Ok(painter.paint(&json.to_scene(Some(&data.bank), place)?, size)?)
    };
    data.samples.iter().map(paint).collect()
}
