//! `dvp refine`: the numbers of a drawing, moved to where it explains a picture best.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;
use dvp_core::image::{CHANNELS, RgbaImage};
use dvp_core::{ImageSize, Real, Scene};
use dvp_fit::StopReason;
use dvp_fit::scene_refine::{RefinedScene, SceneRefine};
use serde::Serialize;

use super::drawing::{Drawn, OutputFormat, is_svg, read_json, read_svg};
use super::options::BankChoice;
use super::{Console, Outcome};
use crate::format::{DEFAULT_MAX_PIXELS, read_picture_rgba};
use crate::paint::Painter;

/// Refines a drawing that is near a picture: all its numbers and colors at once, through the renderer.
///
/// The objects, their kinds and their order stay. The drawing should be within a pixel or two of the picture, which may have
/// any size in the drawing's ratio. A transparent drawing is compared with the alpha of the picture, if it has one.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp refine drawing.svg picture.png -o better.svg")]
pub struct Arguments {
    /// The drawing: an SVG or a scene (JSON)
    drawing: PathBuf,
    /// What it should look like
    picture: PathBuf,
    /// What to write: .svg or .json in the size of the drawing, .png in that of the picture
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Most steps
    #[arg(long, default_value_t = SceneRefine::default().max_steps, value_name = "N")]
    steps: usize,
    /// Largest picture that is read
    #[arg(long, default_value_t = DEFAULT_MAX_PIXELS, value_name = "N")]
    max_pixels: usize,
    /// Shapes for scenes that only name them: mdshr or a bank file [beside the scene, or mdshr]
    #[arg(long, value_name = "BANK")]
    bank: Option<BankChoice>,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// What came of it.
#[derive(Debug, Serialize)]
struct Summary {
    drawing: String,
    picture: String,
    /// Root of the mean squared error over pixels and channels, which go from 0 to 1.
    rms_before: f64,
    rms_after: f64,
    objects: usize,
    /// Numbers that could move.
    numbers: usize,
    steps: usize,
    stop: &'static str,
    seconds: f64,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let format = OutputFormat::of(&arguments.output)?;
    let drawn = if is_svg(&arguments.drawing) {
        read_svg(&arguments.drawing, console)?.cast()
    } else {
        read_json::<f32>(&arguments.drawing, None, arguments.bank.as_ref())?
    };
    if is_same(&arguments.output, &arguments.picture) {
        bail!("{} would be replaced by the drawing of it; choose another -o", arguments.picture.display());
    }
    let picture = read_picture_rgba(&arguments.picture, arguments.max_pixels)?;
    let own = drawn.size.unwrap_or(picture.size());
    check_ratio(arguments, own, picture.size())?;
    let start = Instant::now();
    let refined = refine(arguments.steps, &drawn.scene, &picture)?;
    let summary = Summary {
        drawing: arguments.drawing.display().to_string(),
        picture: arguments.picture.display().to_string(),
        rms_before: f64::from(refined.start_loss).sqrt(),
        rms_after: f64::from(refined.loss).sqrt(),
        objects: refined.scene.objects.len(),
        numbers: refined.number_count,
        steps: refined.steps,
        stop: match refined.stop {
            StopReason::StepLimit => "step limit",
            _ => "converged",
        },
        seconds: start.elapsed().as_secs_f64(),
    };
    let size = if format == OutputFormat::Png { picture.size() } else { own };
    // What was known of the numbers is not known of the refined ones.
    Drawn { scene: refined.scene, told: None, ..drawn }.write(&arguments.output, size, Painter::default())?;
    if arguments.json {
        writeln!(console.out, "{}", serde_json::to_string_pretty(&summary)?)?;
    } else {
        let Summary { picture, rms_before, rms_after, objects, numbers, steps, stop, seconds, .. } = summary;
        writeln!(
            console.out,
            "{picture}: root mean squared error {rms_before:.5} -> {rms_after:.5}; {objects} objects, {numbers} numbers, \
             {steps} steps ({stop}), {seconds:.2} s"
        )?;
    }
    Ok(Outcome::Done)
}

/// A transparent drawing is held against the picture's alpha; where the picture has none, as any other drawing, against the
/// picture, and what is behind it is found too.
fn refine(max_steps: usize, scene: &Scene<f32>, picture: &RgbaImage<f32>) -> Result<RefinedScene<f32>> {
    let settings = SceneRefine::default().with_max_steps(max_steps);
    let is_opaque = picture.view().channel(CHANNELS).iter().all(|&alpha| alpha >= 1.0);
    if scene.transparent && !is_opaque {
        return Ok(settings.fit(picture.view(), scene)?);
    }
    let opaque = Scene { transparent: false, ..scene.clone() };
    let mut refined = settings.fit(picture.on(scene.background).view(), &opaque)?;
    refined.scene.transparent = scene.transparent;
    Ok(refined)
}

/// Whether two paths lead to one file.
fn is_same(a: &Path, b: &Path) -> bool {
    a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b)
}

/// Refuses pictures whose shape is not that of the drawing, but for the rounding of a side to whole pixels.
fn check_ratio(arguments: &Arguments, drawing: ImageSize, picture: ImageSize) -> Result<()> {
    let [own, other] = [drawing, picture].map(|size| [size.width(), size.height()].map(f64::of_usize));
    // Sides of the drawing at the scale of the picture's shorter side, the unit of both.
    let scale = f64::of_usize(picture.unit_px()) / f64::of_usize(drawing.unit_px());
    if own.iter().zip(other).any(|(&own, other)| (own * scale - other).abs() > scale.max(1.0)) {
        bail!(
            "{}: {} x {} pixels are not in the ratio of {}, {} x {}",
            arguments.picture.display(),
            picture.width(),
            picture.height(),
            arguments.drawing.display(),
            drawing.width(),
            drawing.height()
        );
    }
    Ok(())
}
