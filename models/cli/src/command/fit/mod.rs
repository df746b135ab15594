//! `dvp fit`: pictures to scenes.

mod inputs;
mod report;
mod solver;

use alloc::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use dvp_core::render::Compositing;
use dvp_fit::{Bank, Fit, FitOptions};

use self::inputs::Input;
use self::report::{FoundScene, Report};
use self::solver::{Method, Scratch, Solver, Start};
use super::options::{BankChoice, BatchArguments, CompositingName};
use super::{Console, Outcome, in_words};
use crate::format::{Picture, Place, SceneJson, encode_png, read_npy, read_picture, write_atomic};
use crate::method::load_network;
use crate::paint::{PaintScratch, Painter};
use crate::svg::to_svg;

/// Finds the objects of pictures: shapes, poses and colors.
///
/// Pictures may have 8 or 16 bits, be gray, in color or have a palette; what is transparent is put over a color that the picture does
/// not show. Writes for every picture STEM.json (the scene, and what is known of its numbers), STEM.svg (its outlines) and STEM.png
/// (the reconstruction, of 16 bits for pictures of more than 8).
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp fit picture.png --out out\n         \
                         dvp fit photos/ 'more/*.jpg' --out out --json > fits.json\n         \
                         dvp fit noisy.png --start net --model run/best.safetensors --out out")]
pub(super) struct Arguments {
    /// Pictures, folders of pictures, patterns, NumPy files (.npy) of float pixels
    #[arg(required = true, value_name = "PICTURES")]
    pictures: Vec<PathBuf>,
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Known shapes: mdshr (heart, square, ellipse), a bank file, or none: shapes are found, too
    #[arg(long, default_value = "none", value_name = "BANK")]
    bank: BankChoice,
    /// How scenes are found
    #[arg(long, value_enum, default_value_t)]
    method: Method,
    /// Most objects per picture: those stay without which most of it would be unexplained
    #[arg(long, value_name = "N")]
    max_objects: Option<usize>,
    /// Objects per picture, for opt-iter and rand-opt-p, which cannot tell
    #[arg(long, default_value_t = 4, value_name = "N")]
    objects: usize,
    /// What fits start from: segment, net (what a network sees, with its shapes), or for opt-p a folder of STEM.json
    #[arg(long, default_value = "segment", value_name = "START")]
    start: StartChoice,
    /// Weights of the network for --start net, as `dvp train` writes them [default: built in]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Number that random starts are drawn from, for rand-opt-p
    #[arg(long, default_value_t = 1234)]
    seed: u64,
    /// How overlapping objects mix in the pictures [default: as the picture shows]
    #[arg(long, value_enum)]
    compositing: Option<CompositingName>,
    #[command(flatten)]
    batch: BatchArguments,
    /// Write no SVG
    #[arg(long)]
    no_svg: bool,
    /// Write no reconstruction
    #[arg(long)]
    no_png: bool,
}

impl Arguments {
    fn solver(&self) -> Result<Solver> {
        let defaults = FitOptions::default();
        let options = FitOptions {
            bank: self.bank.load()?,
            max_objects: self.max_objects.unwrap_or(defaults.max_objects),
            compositing: self.compositing.map(Compositing::from),
            ..defaults
        };
        if self.model.is_some() && self.start != StartChoice::Net {
            bail!("--model goes with --start net only");
        }
        let start = match &self.start {
            StartChoice::Segment => Start::Picture,
            StartChoice::Folder(folder) => Start::Folder(folder.clone()),
            StartChoice::Net if self.bank != BankChoice::None => {
                bail!("--start net takes the shapes that the network knows: leave --bank away")
            }
            StartChoice::Net => Start::Network(Box::new(load_network(self.model.as_deref())?)),
        };
        Solver::new(self.method, options, start, self.objects, self.seed)
    }

    fn target(&self, input: &Input, ending: &str) -> PathBuf {
        self.out.join(format!("{}.{ending}", input.stem))
    }
}

/// What fits start from.
#[derive(Clone, Debug, PartialEq, Eq)]
enum StartChoice {
    Segment,
    Net,
    Folder(PathBuf),
}

impl From<&str> for StartChoice {
    fn from(text: &str) -> Self {
        match text {
            "segment" => Self::Segment,
            "net" => Self::Net,
            _ => Self::Folder(PathBuf::from(text)),
        }
    }
}

/// A NumPy file holds many pictures; it is read once.
type Stack = (PathBuf, Vec<Picture<f32>>);

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let solver = arguments.solver()?;
    let found = inputs::find(&arguments.pictures);
    let mut failures = found.failures;
    let mut stacks: Vec<Stack> = Vec::new();
    let mut pictures = Vec::new();
    for path in found.paths {
        if path.extension().is_some_and(|ending| ending == "npy") {
            match read_npy(&path, arguments.batch.max_pixels) {
                Ok(images) => {
                    pictures.extend((0..images.len()).map(|frame| (path.clone(), Some(frame))));
                    stacks.push((path, images.into_iter().map(Picture::from).collect()));
                }
                Err(error) => failures.push(error.to_string()),
            }
        } else {
            pictures.push((path, None));
        }
    }
    let inputs = inputs::name(&pictures);
    refuse_overwriting(arguments, &inputs)?;
    let fit = |scratch: &mut Scratch, _: usize, input: &Input| fit_one(arguments, &solver, &stacks, input, scratch);
    let reports: Vec<Report> = arguments.batch.each(&inputs, Input::name, fit)?;
    let errors = reports.iter().filter_map(|report| report.error.clone());
    failures.extend(errors);
    for failure in &failures {
        writeln!(console.err, "error: {failure}")?;
    }
    if arguments.batch.json {
        writeln!(console.out, "{}", report::json(&reports)?)?;
    } else if !reports.is_empty() {
        writeln!(console.out, "{}", report::table(&reports))?;
    }
    Ok(if failures.is_empty() { Outcome::Done } else { Outcome::Partly })
}

/// A reconstruction must not replace the picture it was made from.
fn refuse_overwriting(arguments: &Arguments, inputs: &[Input]) -> Result<()> {
    if arguments.no_png {
        return Ok(());
    }
    let Ok(out) = arguments.out.canonicalize() else { return Ok(()) };
    let pictures: BTreeSet<PathBuf> = inputs.iter().filter_map(|input| input.path.canonicalize().ok()).collect();
    for input in inputs {
        let target = out.join(format!("{}.png", input.stem));
        if pictures.contains(&target) {
            bail!("{} would be replaced by its reconstruction; choose another --out, or --no-png", target.display());
        }
    }
    Ok(())
}

fn fit_one(arguments: &Arguments, solver: &Solver, stacks: &[Stack], input: &Input, scratch: &mut Scratch) -> Report {
    let path = input.name();
    let result = try_fit(arguments, solver, stacks, input, scratch);
    let (found, error) = match result {
        Ok(found) => (Some(found), None),
        Err(error) => {
            let text = in_words(&error);
            (None, Some(if text.starts_with(&path) { text } else { format!("{path}: {text}") }))
        }
    };
    Report { path, stem: input.stem.clone(), error, found }
}

fn try_fit(
    arguments: &Arguments,
    solver: &Solver,
    stacks: &[Stack],
    input: &Input,
    scratch: &mut Scratch,
) -> Result<FoundScene> {
    let read;
    let picture = match input.frame {
        None => {
            read = read_picture(&input.path, arguments.batch.max_pixels)?;
            &read
        }
        Some(frame) => stack_picture(stacks, &input.path, frame).context("image of the stack is gone")?,
    };
    let (mut fit, time) = solver.solve(picture.image.view(), &input.stem, scratch)?;
    // A transparent picture has no background; the one that was fitted is the color that the picture was put over.
    fit.scene.transparent = picture.transparent;
    write_results(arguments, solver.bank(), &fit, picture, input, &mut scratch.paint)?;
    Ok(FoundScene::new(&fit, picture, time.as_secs_f64() * 1e3))
}

fn stack_picture<'a>(stacks: &'a [Stack], path: &Path, frame: usize) -> Option<&'a Picture<f32>> {
    stacks.iter().find(|(stack, _)| stack == path).and_then(|(_, pictures)| pictures.get(frame))
}

fn write_results(
    arguments: &Arguments,
    bank: Option<&Bank<f32>>,
    fit: &Fit<f32>,
    picture: &Picture<f32>,
    input: &Input,
    scratch: &mut PaintScratch<f32>,
) -> Result<()> {
    let size = picture.image.size();
    let target = arguments.target(input, "json");
    let json = SceneJson::from_fit(fit, picture)?;
    write_atomic(&target, (json.to_line(&Place::file(&target))? + "\n").as_bytes())?;
    if !arguments.no_svg {
        write_atomic(&arguments.target(input, "svg"), to_svg(&fit.scene, size, bank)?.as_bytes())?;
    }
    if !arguments.no_png {
        let image = Painter::default().paint_in(&fit.scene, size, scratch)?;
        write_atomic(&arguments.target(input, "png"), &encode_png(image.view(), picture.bits)?)?;
    }
    Ok(())
}
