//! `dvp parsimony`: whether methods model no more than a scene needs.
//!
//! | file | does |
//! |---|---|
//! | `spent` | what a scene spends: objects, shapes, harmonics, numbers, bits |
//! | `truth` | what the true scene costs by the same law |
//! | `trial` | runs methods, and segment-and-fit without one price after the other |
//! | `traced` | the size of drawings, those of other programs too |
//! | `summary` | means: CSV, JSON, tables, and what is asked for and not met |
//! | `figure` | the chart |
//! | `page` | all of it as one HTML page |

mod figure;
mod page;
mod spent;
mod summary;
#[cfg(test)]
mod tests;
mod traced;
mod trial;
mod truth;

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use clap::Args;
use serde_json::json;

use self::page::Page;
use self::summary::Summary;
use self::trial::{Contender, Subject};
use super::arguments::{ReportArguments, SceneArguments};
use super::pictures::Picture;
use super::{pictures, report};
use dvp_cli::command::{Console, Outcome, generated};
use dvp_cli::format::{BitDepth, DataSet, encode_png};
use dvp_cli::generate::SceneSettings;
use dvp_cli::method::load_network;
use dvp_cli::paint::RendererName;

/// Most images with noise, or of twins, that prices are tried on; in full and quick.
const PRICED: [usize; 2] = [144, 18];
/// One image without objects to so many with them.
const EMPTY: u64 = 8;
/// Standard deviation of the noise that prices are also tried under.
const NOISE: f64 = 0.02;
/// How far apart the centers of twins are: the outlines of most cross.
const TWINS_GAP: f32 = 0.15;

/// Shows whether methods model no more than a scene needs: objects, shapes, harmonics, numbers and bits of what they find
/// beside those of the true scene. Scenes that are drawn at random are followed by some without objects.
///
/// Bits of both are counted by the law that fits decide by: 24 for the background, 72 for color and pose of an object, the
/// choice among the shapes of a bank (segment-bank, opt-p, net, net-lm), or 32 per harmonic of a shape that is written out
/// (segment-free, opt-iter). True shapes are then written with the fewest harmonics that pay, once for all objects that share
/// them. Asked are a right count in 99.9 % of the images, always 0 where there is nothing, and at most 1.2 times the bits.
/// Also shows segment-and-fit without each of its prices. Writes parsimony.csv, prices.csv, images.csv, a chart as SVG and
/// PNG, index.html with all of it, and the pictures for other programs to trace.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp parsimony --out parsimony --quick\n         \
                         dvp parsimony --out parsimony --data data --json > parsimony.json")]
pub struct Arguments {
    #[command(flatten)]
    report: ReportArguments,
    #[command(flatten)]
    scenes: SceneArguments<512, 24>,
    /// Folder of an SVG per picture, as VTracer traces pictures/: their sizes are counted too
    #[arg(long, value_name = "DIR")]
    traced: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let clock = Instant::now();
    let Arguments { report: to, scenes, .. } = arguments;
    let (bank, pictures) = arguments.pictures()?;
    let stems: Vec<&str> = pictures.iter().map(|picture| picture.stem.as_str()).collect();
    let traced = arguments.traced.as_deref().map(|folder| traced::read(folder, stems.iter().copied())).transpose()?;
    let contenders = Contender::methods(&bank, load_network(None)?)?;
    let shapes = bank.prototypes.len();
    let subjects = |pictures: &[Picture], noise: Option<f64>| -> Result<Vec<Subject>> {
        pictures.iter().map(|picture| Subject::new(picture.clone(), shapes, noise, scenes.seed)).collect()
    };
    let shown = subjects(&pictures, None)?;
    let trials = trial::run(&contenders, &shown, shapes, scenes.seed);
    let mut methods: Vec<Summary> =
        contenders.iter().zip(&trials).map(|(contender, trials)| Summary::of("clean", contender, trials)).collect();
    if let Some(drawings) = traced {
        let objects: Vec<usize> = shown.iter().map(|subject| subject.picture.truth.objects.len()).collect();
        methods.push(Summary::of_drawings(&drawings, &objects));
    }
    let apart = pictures.len().div_ceil(PRICED[usize::from(scenes.quick)]);
    let some: Vec<Picture> = pictures.iter().step_by(apart).cloned().collect();
    let sets = [
        ("clean", subjects(&pictures, None)?),
        ("noisy", subjects(&some, Some(NOISE))?),
        ("twins", subjects(&pictures::twins(TWINS_GAP, some.len() as u64)?, None)?),
    ];
    let mut prices = Vec::new();
    for (set, shown) in &sets {
        let contenders = Contender::ablations(&bank, *set == "noisy")?;
        let trials = trial::run(&contenders, shown, shapes, scenes.seed);
        prices.extend(contenders.iter().zip(&trials).map(|(contender, own)| Summary::of(set, contender, own)));
    }

    for picture in &pictures {
        to.write(&format!("pictures/{}.png", picture.stem), &encode_png(picture.image.view(), BitDepth::Eight)?)?;
    }
    to.write("parsimony.csv", &report::csv(&summary::csv_cells(&methods))?)?;
    to.write("prices.csv", &report::csv(&summary::csv_cells(&prices))?)?;
    to.write("images.csv", &report::csv(&summary::image_cells(&contenders, &stems, &trials))?)?;
    let svg = to.write_chart("bits", &figure::chart(&contenders, &trials))?;
    let misses: Vec<String> = methods.iter().flat_map(Summary::misses).collect();
    let page = Page {
        run: to.run(arguments.command(), pictures.len(), clock),
        methods: &methods,
        prices: &prices,
        misses: &misses,
        chart: &svg,
    };
    to.write("index.html", page.to_html().as_bytes())?;
    if to.json {
        let rows = |rows: &[Summary]| rows.iter().map(Summary::json).collect::<Vec<_>>();
        let all = json!({ "methods": rows(&methods), "prices": rows(&prices), "not_met": misses });
        writeln!(console.out, "{}", serde_json::to_string_pretty(&all)?)?;
    } else {
        let [methods, prices] = [summary::cells(&methods), summary::price_cells(&prices)].map(report::text_table);
        writeln!(console.out, "{methods}\n\n{prices}\n\nnot met:\n{}", misses.join("\n"))?;
    }
    let failed = methods.iter().chain(&prices).any(|own| !own.failed.is_empty());
    Ok(if failed { Outcome::Partly } else { Outcome::Done })
}

impl Arguments {
    /// The bank and the images, those without objects last.
    fn pictures(&self) -> Result<(dvp_fit::Bank<f32>, Vec<Picture>)> {
        let Self { scenes, .. } = self;
        let (count, most) = scenes.count()?;
        let renderer = RendererName::Triangles;
        if let Some(folder) = &scenes.data {
            let data = DataSet::open(folder)?;
            let all = pictures::painted(&data, most, renderer)?;
            return Ok((data.bank, all));
        }
        let data = generated::mds_hr(count, scenes.seed)?;
        let mut nothing = SceneSettings::mds_hr();
        (nothing.fewest, nothing.most) = (0, 0);
        let empty = generated::scenes(&nothing, count.div_ceil(EMPTY), scenes.seed)?;
        let mut all = pictures::painted(&data, most, renderer)?;
        for picture in pictures::painted(&empty, most, renderer)? {
            all.push(Picture { stem: format!("empty-{}", picture.stem), ..picture });
        }
        Ok((data.bank, all))
    }

    /// The command that makes the same report, but for the folder.
    fn command(&self) -> String {
        let traced = self.traced.as_ref().map(|folder| format!(" --traced {}", folder.display()));
        format!("dvp parsimony --out DIR{}{}", self.scenes.words(), traced.unwrap_or_default())
    }
}
