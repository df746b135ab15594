//! Drawings as files: scenes and SVG in; PNG, SVG and scenes out, by the ending of the name.

use std::path::Path;

use anyhow::{Context, Result, bail};
use dvp_core::{ImageSize, Real, Scene};
use dvp_fit::Bank;

use super::Console;
use super::options::{BankChoice, folder_of, has_ending};
use crate::format::{
    BitDepth, Place, SceneJson, bank_near, encode_png, encode_png_rgba, read_scene, read_scene_lines, read_text,
    write_atomic,
};
use crate::paint::Painter;
use crate::svg::{SvgDrawing, from_svg, to_svg};

/// A drawing as read.
#[derive(Debug)]
pub(super) struct Drawn<T> {
    pub(super) scene: Scene<T>,
    /// None if the file tells none.
    pub(super) size: Option<ImageSize>,
    /// The shapes that the scene's prototypes are from.
    pub(super) bank: Option<Bank<T>>,
    /// What a file told besides, true as long as no number of the scene changes.
    pub(super) told: Option<SceneJson>,
}

/// Whether a file is an SVG.
pub(super) fn is_svg(path: &Path) -> bool {
    has_ending(path, "svg")
}

/// Reads an SVG; tells on the second stream what a scene cannot hold.
pub(super) fn read_svg(path: &Path, console: &mut Console<'_>) -> Result<Drawn<f64>> {
    let text = String::from_utf8(read_text(path)?);
    let text = text.with_context(|| format!("{}: an SVG must be UTF-8", path.display()))?;
    let SvgDrawing { scene, size, losses } = from_svg(&text).with_context(|| path.display().to_string())?;
    if !losses.is_empty() {
        writeln!(console.err, "{}: {losses}", path.display())?;
    }
    Ok(Drawn { scene, size: Some(size), bank: None, told: None })
}

/// Reads a scene: of a .jsonl file that which `index` names. Its shapes may be in `bank`, else beside it.
pub(super) fn read_json<T: Real>(path: &Path, index: Option<usize>, bank: Option<&BankChoice>) -> Result<Drawn<T>> {
    let (json, place) = load(path, index)?;
    let bank = match bank {
        Some(choice) => choice.load()?,
        None => Some(bank_near(folder_of(path))?),
    };
    let scene = json.to_scene(bank.as_ref(), &place)?;
    Ok(Drawn { scene, size: json.size(&place)?, bank, told: Some(json) })
}

fn load(path: &Path, index: Option<usize>) -> Result<(SceneJson, Place)> {
    let is_lines = has_ending(path, "jsonl");
    match (is_lines, index) {
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

/// What a drawing is written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum OutputFormat {
    Png,
    Svg,
    Json,
}

impl OutputFormat {
    /// By the ending of a file's name.
    pub(super) fn of(path: &Path) -> Result<Self> {
        let known = [("png", Self::Png), ("svg", Self::Svg), ("json", Self::Json)];
        let found = known.into_iter().find(|(ending, _)| has_ending(path, ending));
        let (_, format) =
            found.with_context(|| format!("{}: the output must end in .png, .svg or .json", path.display()))?;
        Ok(format)
    }
}

impl Drawn<f64> {
    /// The drawing in the precision in which pictures are fitted. Without a bank: an SVG has none.
    pub(super) fn cast(self) -> Drawn<f32> {
        Drawn { scene: self.scene.cast(), size: self.size, bank: None, told: self.told }
    }
}

impl<T: Real> Drawn<T> {
    /// Writes the drawing in a size, in the format of the ending.
    pub(super) fn write(&self, output: &Path, size: ImageSize, painter: Painter) -> Result<()> {
        let Self { scene, bank, .. } = self;
        let bytes = match OutputFormat::of(output)? {
            OutputFormat::Svg => to_svg(scene, size, bank.as_ref())?.into_bytes(),
            OutputFormat::Json => (self.to_json(size)?.to_line(&Place::file(output))? + "\n").into_bytes(),
            // In the precision of the fit, whatever the numbers come in: painting in another one is code of its own.
            OutputFormat::Png => {
                let scene = scene.cast::<f32>();
                if scene.transparent {
                    encode_png_rgba(&painter.paint_rgba(&scene, size)?, BitDepth::Eight)?
                } else {
                    encode_png(painter.paint(&scene, size)?.view(), BitDepth::Eight)?
                }
            }
        };
        Ok(write_atomic(output, &bytes)?)
    }

    /// The scene, with what the file that it was read from told of it.
    fn to_json(&self, size: ImageSize) -> Result<SceneJson> {
        let mut json = SceneJson::from_scene(&self.scene, size)?;
        if let Some(told) = &self.told {
            (json.id, json.known) = (told.id, told.known.clone());
            for (object, told) in json.objects.iter_mut().zip(&told.objects) {
                object.known.clone_from(&told.known);
            }
        }
        Ok(json)
    }
}
