//! `dvp render`: a scene or a drawing to a picture, to vector graphics or to a scene.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use dvp_core::{ImageSize, Real, Scene};
use dvp_fit::Bank;

use super::options::{BankChoice, PaintArguments, folder_of, square};
use super::{Console, Outcome};
use crate::format::{
    BitDepth, DEFAULT_MAX_PIXELS, Place, SceneJson, bank_near, encode_png, encode_png_rgba, read_scene,
    read_scene_lines, read_text, write_atomic,
};
use crate::svg::{SvgDrawing, from_svg, to_svg};

/// Draws a scene or an SVG as PNG, SVG or scene.
///
/// A PNG has alpha where the scene has no background. What a scene cannot hold of an SVG (gradients, text, filters) is named on
/// stderr.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp render out/picture.json -o again.png --width 512\n         \
                         dvp render icon.svg -o icon.json\n         \
                         dvp render data/scenes.jsonl --index 3 -o third.svg")]
pub(super) struct Arguments {
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
    if arguments.scene.extension().is_some_and(|ending| ending == "svg") {
        if arguments.index.is_some() {
            bail!("--index is for .jsonl files; {} holds one drawing", arguments.scene.display());
        }
        let SvgDrawing { scene, size, losses } = read_svg(&arguments.scene)?;
        if !losses.is_empty() {
            writeln!(console.err, "{}: {losses}", arguments.scene.display())?;
        }
        return write(arguments, &scene, size_of(arguments, size)?, None);
    }
    let (json, place) = load(arguments)?;
    let bank = match &arguments.bank {
        Some(choice) => choice.load()?,
        None => Some(bank_near(folder_of(&arguments.scene))?),
    };
    let scene: Scene<f32> = json.to_scene(bank.as_ref(), &place)?;
    let own = match json.size(&place)? {
        Some(size) => size,
        None => square(128)?,
    };
    write(arguments, &scene, size_of(arguments, own)?, bank.as_ref())
}

/// Writes the output in the format of its ending.
fn write<T: Real>(arguments: &Arguments, scene: &Scene<T>, size: ImageSize, bank: Option<&Bank<T>>) -> Result<Outcome> {
    let output = &arguments.output;
    let bytes = match output.extension().and_then(|ending| ending.to_str()).unwrap_or("") {
        "svg" => to_svg(scene, size, bank)?.into_bytes(),
        "json" => (SceneJson::from_scene(scene, size)?.to_line(&Place::file(output))? + "\n").into_bytes(),
        "png" => png(arguments, scene, size)?,
        _ => bail!("{}: the output must end in .png, .svg or .json", output.display()),
    };
    write_atomic(output, &bytes)?;
    Ok(Outcome::Done)
}

fn png<T: Real>(arguments: &Arguments, scene: &Scene<T>, size: ImageSize) -> Result<Vec<u8>> {
    let (width, height, limit) = (size.width(), size.height(), arguments.max_pixels);
    if size.pixels() > limit {
        bail!("a picture of {width} x {height} pixels, must be at most {limit}; give --width, or raise --max-pixels");
    }
    let painter = arguments.paint.painter();
    Ok(if scene.transparent {
        encode_png_rgba(&painter.paint_rgba(scene, size)?, BitDepth::Eight)?
    } else {
        encode_png(painter.paint(scene, size)?.view(), BitDepth::Eight)?
    })
}

fn read_svg(path: &Path) -> Result<SvgDrawing> {
    let text = String::from_utf8(read_text(path)?);
    let text = text.with_context(|| format!("{}: an SVG must be UTF-8", path.display()))?;
    from_svg(&text).with_context(|| path.display().to_string())
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

fn load(arguments: &Arguments) -> Result<(SceneJson, Place)> {
    let path = &arguments.scene;
    let is_lines = path.extension().is_some_and(|ending| ending == "jsonl");
    match (is_lines, arguments.index) {
        (false, None) => Ok((read_scene(path)?, Place::file(path))),
        (false, Some(_)) => bail!("--index is for .jsonl files; {} holds one scene", path.display()),
        (true, index) => {
            let index = index.context("a .jsonl file holds many scenes; say which with --index")?;
            let scenes = read_scene_lines(path)?;
            let count = scenes.len();
            scenes
                .into_iter()
                .nth(index)
                .with_context(|| format!("{} holds {count} scenes: --index {index} must be below that", path.display()))
        }
    }
}
