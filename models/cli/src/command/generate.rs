//! `dvp generate`: a data set of random scenes.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use dvp_core::{ImageSize, Scene};
use dvp_fit::Bank;
use rayon::prelude::*;

use super::options::{BankChoice, CompositingName, PaintArguments, size_or, square, with_threads};
use super::{Console, Outcome, progress};
use crate::format::{
    BitDepth, Place, SCENES_FILE, SceneJson, ShapeJson, bank_to_json, edge_cut, encode_png, write_atomic,
};
use crate::generate::{Range, SceneSettings, sample_scene};
use crate::paint::Painter;

/// Draws random scenes and their images, as MDS-HR or as you like.
///
/// Writes scenes.jsonl (one scene per line), bank.json (the shapes that scenes refer to) and 00000.png, 00001.png, ...
/// The same options give the same bytes, on any number of threads.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp generate --count 100 --out data\n         \
                         dvp generate --preset multi-dsprites --count 100 --out data")]
pub struct Arguments {
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Number of images
    #[arg(long, short = 'n', default_value_t = 16)]
    count: usize,
    /// Number that the data set is drawn from
    #[arg(long, default_value_t = 1234)]
    seed: u64,
    /// Distribution to start from; the options below change it
    #[arg(long, value_enum, default_value_t)]
    preset: Preset,
    /// Columns; without --height also the rows [128, multi-dsprites: 64]
    #[arg(long)]
    width: Option<usize>,
    /// Rows; without --width also the columns
    #[arg(long)]
    height: Option<usize>,
    /// Visible objects per scene [1..4, multi-dsprites: 2..5]
    #[arg(long, value_name = "A..B", value_parser = parse_counts)]
    visible: Option<(usize, usize)>,
    /// Objects that are placed, visible or not [4, multi-dsprites: 5]
    #[arg(long)]
    slots: Option<usize>,
    /// Draws of the positions, of which the best spread one is taken [8, multi-dsprites: 1]
    #[arg(long)]
    placements: Option<usize>,
    /// Border without object centers, as a share of the image side [0.05, multi-dsprites: 0.1]
    #[arg(long)]
    margin: Option<f32>,
    /// Scale of the unit outline; the shorter image side is 1 [0.1..0.3, multi-dsprites: 0.08..0.2]
    #[arg(long, value_name = "A..B")]
    scale: Option<Range>,
    /// Each channel of the object colors [0..1]
    #[arg(long, value_name = "A..B")]
    color: Option<Range>,
    /// Each channel of the background [0..1]
    #[arg(long, value_name = "A..B")]
    background: Option<Range>,
    /// Keep invisible slots as objects with confidence 0
    #[arg(long)]
    keep_hidden: bool,
    /// Signed squared distance of half coverage, doubled frame [5e-4, multi-dsprites: 0]
    #[arg(long, value_name = "D2")]
    edge_offset: Option<f32>,
    /// Softness of edges, doubled frame squared [1e-4, multi-dsprites: 1e-11]
    #[arg(long, value_name = "D2")]
    edge_sigma: Option<f32>,
    /// How overlapping objects mix [blend, multi-dsprites: over]
    #[arg(long, value_enum)]
    compositing: Option<CompositingName>,
    /// Shapes: mdshr (heart, square, ellipse) or a bank file
    #[arg(long, default_value = "mdshr", value_name = "BANK")]
    bank: BankChoice,
    #[command(flatten)]
    paint: PaintArguments,
    /// Threads; 0 means one per core
    #[arg(long, default_value_t = 0, value_name = "N")]
    threads: usize,
    /// Replace a data set that is already there
    #[arg(long)]
    overwrite: bool,
}

/// Named distributions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Preset {
    /// 128 x 128, soft edges, blended overlaps
    #[default]
    MdsHr,
    /// 64 x 64, hard edges, occlusion, smaller objects
    MultiDsprites,
}

fn parse_counts(text: &str) -> Result<(usize, usize), String> {
    let wrong = |_| format!("'{text}' is no range of counts; write 1..4");
    let (low, high) = text.split_once("..").unwrap_or((text, text));
    Ok((low.parse().map_err(wrong)?, high.parse().map_err(wrong)?))
}

impl Arguments {
    fn settings(&self) -> Result<(SceneSettings, ImageSize)> {
        let (mut settings, side) = match self.preset {
            Preset::MdsHr => (SceneSettings::mds_hr(), 128),
            Preset::MultiDsprites => (SceneSettings::multi_dsprites(), 64),
        };
        if let Some((fewest, most)) = self.visible {
            (settings.fewest, settings.most) = (fewest, most);
            settings.slots = settings.slots.max(most);
        }
        settings.slots = self.slots.unwrap_or(settings.slots);
        settings.placements = self.placements.unwrap_or(settings.placements);
        settings.margin = self.margin.unwrap_or(settings.margin);
        settings.scale = self.scale.unwrap_or(settings.scale);
        settings.color = self.color.unwrap_or(settings.color);
        settings.background = self.background.unwrap_or(settings.background);
        settings.keep_hidden |= self.keep_hidden;
        if self.edge_offset.is_some() || self.edge_sigma.is_some() {
            let edge = &mut settings.edge;
            edge.offset = self.edge_offset.unwrap_or(edge.offset);
            edge.sigma = self.edge_sigma.unwrap_or(edge.sigma);
            #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
            let cut = edge_cut(edge.law, f64::from(edge.offset), f64::from(edge.sigma)) as f32;
            edge.cut = cut;
        }
        settings.compositing = self.compositing.map_or(settings.compositing, Into::into);
        settings.check().map_err(anyhow::Error::msg)?;
        Ok((settings, size_or(self.width, self.height, square(side)?)?))
    }
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let (settings, size) = arguments.settings()?;
    let bank: Bank<f32> = arguments.bank.load()?.context("--bank none: random scenes need shapes")?;
    let scenes_file = arguments.out.join(SCENES_FILE);
    if scenes_file.exists() && !arguments.overwrite {
        bail!("{} is already there; choose another --out or add --overwrite", scenes_file.display());
    }
    let painter = arguments.paint.painter();
    let bar = progress::bar(arguments.count as u64, 0);
    let one = |index: usize| {
        let scene = sample_scene(&settings, &bank, size, arguments.seed, index as u64);
        let line = write_image(arguments, &bank, painter, &scene, size, index);
        bar.inc(1);
        line
    };
    let lines: Result<Vec<String>> =
        with_threads(arguments.threads, || (0..arguments.count).into_par_iter().map(one).collect())?;
    bar.finish_and_clear();
    write_atomic(&arguments.out.join("bank.json"), bank_to_json(&bank).as_bytes())?;
    // Last: a folder with this file is a whole data set.
    write_atomic(&scenes_file, lines?.concat().as_bytes())?;
    writeln!(console.out, "{} images in {}", arguments.count, arguments.out.display())?;
    Ok(Outcome::Done)
}

/// Writes the image of a scene and returns its line.
fn write_image(
    arguments: &Arguments,
    bank: &Bank<f32>,
    painter: Painter,
    scene: &Scene<f32>,
    size: ImageSize,
    index: usize,
) -> Result<String> {
    let path = arguments.out.join(format!("{index:05}.png"));
    let mut json = SceneJson::from_scene(scene, size)?;
    json.id = Some(index as u64);
    for object in &mut json.objects {
        // The bank stands beside the scenes.
        if let ShapeJson::Prototype { efd, .. } = &mut object.shape {
            *efd = None;
        }
    }
    let place = Place::file(&path);
    // What is painted is what was written, after rounding.
    let scene = json.to_scene(Some(bank), &place)?;
    write_atomic(&path, &encode_png(painter.paint(&scene, size)?.view(), BitDepth::Eight)?)?;
    Ok(json.to_line(&place)? + "\n")
}
