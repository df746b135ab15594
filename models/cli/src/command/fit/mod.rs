//! `dvp fit`: pictures to scenes.

mod exports;
mod inputs;
mod masks;
mod report;

use alloc::sync::Arc;
use core::time::Duration;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use dvp_core::render::Compositing;
use dvp_fit::FitOptions;
use dvp_fit::paint::Canvas;

use self::exports::{ExportArguments, Measurable, PictureFile};
use self::inputs::Input;
use self::report::{FoundScene, Report};
use super::options::{BankChoice, BatchArguments, CompositingName};
use super::{Console, Outcome, in_words};
use crate::format::{
    Picture, Place, SceneJson, encode_png, encode_png_rgba, labels_beside, read_npy, read_picture, write_atomic,
};
use crate::method::{Memory, load_network};
use crate::solve::{MethodChoice, Solved, Solver, Start};
use crate::svg::to_svg_numbered;

/// Finds the objects of pictures: shapes, poses and colors.
///
/// Pictures may have 8 or 16 bits, be gray, in color or have a palette; what is transparent is put over a color that the picture does
/// not show. Writes for every picture STEM.json (the scene, and what is known of its numbers), STEM.svg (its outlines) and STEM.png
/// (the reconstruction, of 16 bits for pictures of more than 8).
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp fit picture.png --out out\n         \
                         dvp fit photos/ 'more/*.jpg' --out out --json > fits.json\n         \
                         dvp fit noisy.png --start net --model run/best.safetensors --out out\n         \
                         dvp fit cells/ --out out --table cells.csv --scale 0.65mm/px --labels\n         \
                         dvp fit --masks labels.tif picture.png --out out --geojson")]
pub struct Arguments {
    /// Pictures, folders of pictures, patterns, NumPy files (.npy) of float pixels
    #[arg(required_unless_present = "masks", value_name = "PICTURES")]
    pictures: Vec<PathBuf>,
    /// Outlines of another program's masks instead: a label map, or a pattern; PICTURES, if any, give the colors
    ///
    /// A label map is a gray PNG or TIFF, 0 the background. Colors of 8 bits (a palette mostly) are labels as well: black is the
    /// background, the others are numbered from 1 in the order in which they come, row by row.
    ///
    /// One label map goes with one picture. Of several, each goes with the picture whose name its own begins with:
    /// cell1_mask.tif with cell1.png, and cell10_mask.tif with cell10.png.
    #[arg(long, value_name = "LABELS")]
    #[arg(conflicts_with_all = ["bank", "method", "max_objects", "objects", "segments", "start", "model", "seed", "compositing"])]
    masks: Option<PathBuf>,
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Known shapes: mdshr (heart, square, ellipse), a bank file, or none: shapes are found, too
    #[arg(long, default_value = "none", value_name = "BANK")]
    bank: BankChoice,
    /// How scenes are found
    #[arg(long, value_enum, default_value_t)]
    method: MethodChoice,
    /// Most objects per picture: those stay without which most of it would be unexplained
    #[arg(long, value_name = "N")]
    max_objects: Option<usize>,
    /// Objects per picture, for opt-iter and rand-opt-p, which cannot tell; for live the most [default: 4, live 8, live-published 5]
    #[arg(long, value_name = "N")]
    objects: Option<usize>,
    /// Cubics of each path, for live [default: 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..))]
    segments: Option<u16>,
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
    #[command(flatten)]
    exports: ExportArguments,
}

impl Arguments {
    fn solver(&self) -> Result<Solver> {
        let defaults = FitOptions::default();
        let max_objects = self.max_objects.unwrap_or(defaults.max_objects);
        let compositing = self.compositing.map(Compositing::from);
        let options = defaults.with_bank(self.bank.load()?).with_max_objects(max_objects).with_compositing(compositing);
        if self.model.is_some() && self.start != StartChoice::Net {
            bail!("--model goes with --start net only");
        }
        let start = match &self.start {
            StartChoice::Segment => Start::Picture,
            StartChoice::Folder(folder) => Start::Folder(folder.clone()),
            StartChoice::Net if self.bank != BankChoice::None => {
                bail!("--start net takes the shapes that the network knows: leave --bank away")
            }
            StartChoice::Net => Start::Network(Arc::new(load_network(self.model.as_deref())?)),
        };
        if self.segments.is_some() && !self.method.draws_paths() {
            bail!("--segments goes with --method live and live-published only");
        }
        let solver = Solver::new(self.method, options, start, self.objects, self.seed)?;
        Ok(solver.with_segments(self.segments.map(usize::from)))
    }

    /// What the names of the files of a picture end with.
    fn endings(&self) -> impl Iterator<Item = &'static str> {
        let scenes = [(true, "json"), (!self.no_svg, "svg"), (!self.no_png, "png")];
        let scenes = scenes.into_iter().filter_map(|(is_asked, ending)| is_asked.then_some(ending));
        scenes.chain(self.exports.endings())
    }

    fn target(&self, stem: &str, ending: &str) -> PathBuf {
        self.out.join(format!("{stem}.{ending}"))
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
    arguments.exports.check()?;
    let (mut reports, mut failures) = match &arguments.masks {
        Some(masks) => masks::fit_all(arguments, masks)?,
        None => fit_all(arguments)?,
    };
    failures.extend(reports.iter().filter_map(|report| report.error.clone()));
    failures.extend(arguments.exports.write_run(&exports::measured(&mut reports)));
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

/// What came of every picture, and of what led to none.
fn fit_all(arguments: &Arguments) -> Result<(Vec<Report>, Vec<String>)> {
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
    refuse_overwriting(arguments, inputs.iter(), core::iter::empty())?;
    let fit = |memory: &mut Memory, _: usize, input: &Input| fit_one(arguments, &solver, &stacks, input, memory);
    Ok((arguments.batch.each(&inputs, Input::name, fit)?, failures))
}

/// What is written must not replace what is read, nor the label maps beside it, which are the truth of these pictures.
fn refuse_overwriting<'a>(
    arguments: &Arguments,
    inputs: impl Iterator<Item = &'a Input> + Clone,
    also_read: impl Iterator<Item = &'a PathBuf> + Clone,
) -> Result<()> {
    let exports = &arguments.exports;
    let files = |input: &'a Input| arguments.endings().map(move |ending| arguments.target(&input.stem, ending));
    let read = inputs.clone().map(|input| &input.path).chain(also_read);
    let kept = read.clone().cloned().chain(read.filter_map(|path| labels_beside(path)));
    exports::refuse_overwriting(kept, inputs.flat_map(files), exports.run_files())
}

fn fit_one(arguments: &Arguments, solver: &Solver, stacks: &[Stack], input: &Input, memory: &mut Memory) -> Report {
    report_of(input, input.name(), try_fit(arguments, solver, stacks, input, memory))
}

/// What came of an input; `picture` is what tables and data sets call the picture that its objects are on.
fn report_of(input: &Input, picture: String, result: Result<FoundScene>) -> Report {
    let path = input.name();
    let (found, error) = match result {
        Ok(found) => (Some(found), None),
        Err(error) => {
            let text = in_words(&error);
            (None, Some(if text.starts_with(&path) { text } else { format!("{path}: {text}") }))
        }
    };
    Report { path, picture, stem: input.stem.clone(), error, found }
}

fn try_fit(
    arguments: &Arguments,
    solver: &Solver,
    stacks: &[Stack],
    input: &Input,
    memory: &mut Memory,
) -> Result<FoundScene> {
    let read;
    let picture = match input.frame {
        None => {
            read = read_picture(&input.path, arguments.batch.max_pixels)?;
            &read
        }
        Some(frame) => stack_picture(stacks, &input.path, frame).context("image of the stack is gone")?,
    };
    let Solved { fit, time } = solver.solve(picture, &input.stem, memory)?;
    let scene = Measurable::new(&fit, solver.bank(), &picture.image);
    finish(arguments, [&*input.name(), &input.stem], picture, &scene, time, memory.canvas())
}

/// Writes what is asked for of a scene, and says what it is. It has two names: that of its picture and the stem of its files.
fn finish(
    arguments: &Arguments,
    names: [&str; 2],
    picture: &Picture<f32>,
    scene: &Measurable<'_>,
    time: Duration,
    canvas: &mut Canvas<f32>,
) -> Result<FoundScene> {
    let target = |ending: &str| arguments.target(names[1], ending);
    let mut found = FoundScene::new(scene.fit, picture, time.as_secs_f64() * 1e3);
    // Nothing is written unless all can be.
    let mut files = encode_results(arguments, scene, picture, &target("json"), canvas)?;
    found.measured = arguments.exports.of_picture(scene, names, &mut files)?;
    for (ending, bytes) in files {
        write_atomic(&target(ending), &bytes)?;
    }
    Ok(found)
}

fn stack_picture<'a>(stacks: &'a [Stack], path: &Path, frame: usize) -> Option<&'a Picture<f32>> {
    stacks.iter().find(|(stack, _)| stack == path).and_then(|(_, pictures)| pictures.get(frame))
}

/// The scene file, which is to be called `json`, the SVG and the reconstruction.
fn encode_results(
    arguments: &Arguments,
    scene: &Measurable<'_>,
    picture: &Picture<f32>,
    json: &Path,
    canvas: &mut Canvas<f32>,
) -> Result<Vec<PictureFile>> {
    let &Measurable { fit, bank, size, .. } = scene;
    let line = SceneJson::from_fit(fit, picture)?.to_line(&Place::file(json))? + "\n";
    let mut files = vec![("json", line.into_bytes())];
    if !arguments.no_svg {
        files.push(("svg", to_svg_numbered(&fit.scene, size, bank, &scene.numbers())?.into_bytes()));
    }
    if !arguments.no_png {
        let bytes = if fit.scene.transparent {
            encode_png_rgba(&canvas.paint_rgba(&fit.scene, size)?, picture.bits)?
        } else {
            encode_png(canvas.paint(&fit.scene, size)?.0.view(), picture.bits)?
        };
        files.push(("png", bytes));
    }
    Ok(files)
}
