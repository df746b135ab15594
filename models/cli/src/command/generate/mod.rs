//! `dvp generate`: a data set of random scenes, or of those of a published file.

mod published;

use alloc::collections::BTreeMap;
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
use crate::generate::{
    OPENINGS_SIDE, Range, SceneSettings, TETROMINO_SIDE, sample_openings, sample_scene, sample_tetrominoes,
};
use crate::paint::Painter;
use crate::suite::{CLASSES_FILE, Classes};

/// Draws random scenes and their images, as MDS-HR, as the benchmarks of the field or as you like.
///
/// Writes scenes.jsonl (one scene per line), bank.json (the shapes that scenes refer to; tetrominoes and csr have classes.json instead)
/// and 00000.png, 00001.png, ... The same options give the same bytes, on any number of threads.
///
/// With --from it writes the pictures of a published file, which object each pixel shows (00000.labels.png), where known every object
/// whole (00000.whole.png), and classes.json.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp generate --count 100 --out data\n         \
                         dvp generate --preset tetrominoes --count 100 --out data\n         \
                         dvp generate --preset multi-dsprites --from multi_dsprites_colored_on_colored.tfrecords --out data")]
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
    /// Published file to take the first --count scenes of: for multi-dsprites and tetrominoes the TFRecords of multi_object_datasets,
    /// for csr an .npz with the arrays image, segment and layers of one group of the HDF5
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
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
    /// 35 x 35, three tetrominoes of 17 turned shapes and 6 colors on black
    Tetrominoes,
    /// 64 x 64, two to four squares and triangles with openings, occlusion
    Csr,
}

/// What scenes are drawn from.
enum Source {
    /// A distribution over the shapes of a bank.
    Bank(Box<(SceneSettings, Bank<f32>)>),
    Tetrominoes,
    Openings,
}

fn parse_counts(text: &str) -> Result<(usize, usize), String> {
    let wrong = |_| format!("'{text}' is no range of counts; write 1..4");
    let (low, high) = text.split_once("..").unwrap_or((text, text));
    Ok((low.parse().map_err(wrong)?, high.parse().map_err(wrong)?))
}

impl Source {
    /// A scene and, where shapes are those of no bank, the classes of its objects.
    fn sample(&self, size: ImageSize, seed: u64, index: u64) -> (Scene<f32>, Option<Vec<u32>>) {
        let with_classes = |(scene, classes)| (scene, Some(classes));
        match self {
            Self::Bank(known) => (sample_scene(&known.0, &known.1, size, seed, index), None),
            Self::Tetrominoes => with_classes(sample_tetrominoes(seed, index)),
            Self::Openings => with_classes(sample_openings(seed, index)),
        }
    }

    /// The shapes that scenes refer to.
    fn bank(&self) -> Option<&Bank<f32>> {
        if let Self::Bank(known) = self { Some(&known.1) } else { None }
    }
}

impl Arguments {
    /// What scenes are drawn from, and the size of their images.
    fn source(&self) -> Result<(Source, ImageSize)> {
        let (source, side) = match self.preset {
            Preset::MdsHr => return self.settings(SceneSettings::mds_hr(), 128),
            Preset::MultiDsprites => return self.settings(SceneSettings::multi_dsprites(), 64),
            Preset::Tetrominoes => (Source::Tetrominoes, TETROMINO_SIDE),
            Preset::Csr => (Source::Openings, OPENINGS_SIDE),
        };
        if self.changes_the_preset() {
            bail!("tetrominoes and csr are drawn as they are: of the options that change a preset, leave all away");
        }
        Ok((source, square(side)?))
    }

    /// Whether an option is given that changes what a preset draws.
    fn changes_the_preset(&self) -> bool {
        self.width.or(self.height).or(self.slots).or(self.placements).is_some()
            || self.visible.is_some()
            || self.margin.or(self.edge_offset).or(self.edge_sigma).is_some()
            || self.scale.or(self.color).or(self.background).is_some()
            || self.keep_hidden
            || self.compositing.is_some()
            || self.bank != BankChoice::Mdshr
    }

    fn settings(&self, mut settings: SceneSettings, side: usize) -> Result<(Source, ImageSize)> {
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
        let bank = self.bank.load()?.context("--bank none: random scenes need shapes")?;
        Ok((Source::Bank(Box::new((settings, bank))), size_or(self.width, self.height, square(side)?)?))
    }
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    if let Some(file) = &arguments.from {
        return published::run(arguments, file, console);
    }
    let (source, size) = arguments.source()?;
    let scenes_file = arguments.out.join(SCENES_FILE);
    if scenes_file.exists() && !arguments.overwrite {
        bail!("{} is already there; choose another --out or add --overwrite", scenes_file.display());
    }
    let painter = arguments.paint.painter();
    let bar = progress::bar(arguments.count as u64, 0);
    let one = |index: usize| {
        let (scene, classes) = source.sample(size, arguments.seed, index as u64);
        let line = write_image(arguments, source.bank(), painter, &scene, size, index);
        bar.inc(1);
        Ok((line?, classes))
    };
    let lines: Result<Vec<(String, Option<Vec<u32>>)>> =
        with_threads(arguments.threads, || (0..arguments.count).into_par_iter().map(one).collect())?;
    let lines = lines?;
    bar.finish_and_clear();
    let (name, text) = match source.bank() {
        Some(bank) => ("bank.json", bank_to_json(bank)),
        None => {
            let objects =
                lines.iter().enumerate().filter_map(|(index, (_, classes))| Some((stem(index), classes.clone()?)));
            (CLASSES_FILE, Classes::new(objects.collect::<BTreeMap<_, _>>()).to_json()?)
        }
    };
    write_atomic(&arguments.out.join(name), text.as_bytes())?;
    // Last: a folder with this file is a whole data set.
    let lines: String = lines.into_iter().map(|(line, _)| line).collect();
    write_atomic(&scenes_file, lines.as_bytes())?;
    writeln!(console.out, "{} images in {}", arguments.count, arguments.out.display())?;
    Ok(Outcome::Done)
}

/// What the files of a picture are called by.
fn stem(index: usize) -> String {
    format!("{index:05}")
}

/// Writes the image of a scene and returns its line.
fn write_image(
    arguments: &Arguments,
    bank: Option<&Bank<f32>>,
    painter: Painter,
    scene: &Scene<f32>,
    size: ImageSize,
    index: usize,
) -> Result<String> {
    let path = arguments.out.join(format!("{}.png", stem(index)));
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
    let scene = json.to_scene(bank, &place)?;
    write_atomic(&path, &encode_png(painter.paint(&scene, size)?.view(), BitDepth::Eight)?)?;
    Ok(json.to_line(&place)? + "\n")
}
