//! `dvp render`: a scene to a picture or to vector graphics.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use dvp_core::{ImageSize, Scene};

use super::options::{BankChoice, PaintArguments, folder_of, size_or, square};
use super::{Console, Outcome};
use crate::format::{BitDepth, Place, SceneJson, bank_near, encode_png, read_scene, read_scene_lines, write_atomic};
use crate::svg::to_svg;

/// Draws a scene as PNG or SVG.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp render out/picture.json -o again.png --width 512\n         \
                         dvp render data/scenes.jsonl --index 3 -o third.svg")]
pub(super) struct Arguments {
    /// A scene (JSON), or the scenes of a data set (JSONL, with --index)
    scene: PathBuf,
    /// Picture to write: .png or .svg
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Which scene of a .jsonl file, from 0
    #[arg(long, value_name = "I")]
    index: Option<usize>,
    /// Columns; without --height also the rows [from the scene, or 128]
    #[arg(long)]
    width: Option<usize>,
    /// Rows; without --width also the columns
    #[arg(long)]
    height: Option<usize>,
    /// Shapes for scenes that only name them: mdshr or a bank file [beside the scene, or mdshr]
    #[arg(long, value_name = "BANK")]
    bank: Option<BankChoice>,
    #[command(flatten)]
    paint: PaintArguments,
}

pub(super) fn run(arguments: &Arguments, _: &mut Console<'_>) -> Result<Outcome> {
    let ending = arguments.output.extension().and_then(|ending| ending.to_str()).unwrap_or("");
    let (json, place) = load(arguments)?;
    let bank = match &arguments.bank {
        Some(choice) => choice.load()?,
        None => Some(bank_near(folder_of(&arguments.scene))?),
    };
    let scene: Scene<f32> = json.to_scene(bank.as_ref(), &place)?;
    let size = size(arguments, &json, &place)?;
    let bytes = match ending {
        "svg" => to_svg(&scene, size)?.into_bytes(),
        "png" => encode_png(arguments.paint.painter().paint(&scene, size)?.view(), BitDepth::Eight)?,
        _ => bail!("{}: the output must end in .png or .svg", arguments.output.display()),
    };
    write_atomic(&arguments.output, &bytes)?;
    Ok(Outcome::Done)
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

fn size(arguments: &Arguments, json: &SceneJson, place: &Place) -> Result<ImageSize> {
    let own = match json.size(place)? {
        Some(size) => size,
        None => square(128)?,
    };
    size_or(arguments.width, arguments.height, own)
}
