//! `dvp prototypes`: pictures to the few shapes that their objects share.

mod drawn;
mod report;

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Args;
use dvp_core::ImageView;
use dvp_fit::picture::{Known, PictureScratch, fit_picture};
use dvp_fit::prototypes::{Learned, Member, Pool, PrototypeOptions, is_drawing, learn, members};
use dvp_fit::{Bank, FitOptions, Fitter};

use self::report::Report;
use super::options::BatchArguments;
use super::{Console, Outcome, in_words};
use crate::chart::{Chart, Line, check_name};
use crate::format::{bank_to_json, pictures_of, read_picture, write_atomic};

/// Learns the shapes that the objects of pictures share, and writes them as a bank.
///
/// Objects are fitted with free outlines, grouped by shape whatever their pose, and averaged; the number of shapes is the
/// one with the best silhouette. `dvp fit --bank` and `dvp generate --bank` read the file.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp prototypes pictures/ -o bank.json\n         \
                         dvp prototypes pictures/ -o bank.json --chart silhouettes.svg")]
pub struct Arguments {
    /// Folders of pictures
    #[arg(required = true, value_name = "FOLDERS")]
    folders: Vec<PathBuf>,
    /// Bank file to write
    #[arg(long, short, value_name = "FILE")]
    out: PathBuf,
    /// Most shapes that are looked for
    #[arg(long, default_value_t = 24, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=64))]
    max_shapes: u16,
    /// A shape must be seen at least this often
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    min_members: u16,
    /// Count mirror images as one shape
    #[arg(long)]
    mirror: bool,
    /// Objects are never turned: a turned shape is another shape, and the bank holds each as it stands
    #[arg(long)]
    upright: bool,
    /// Passes: after the first, all objects of a shape together make its outline better
    #[arg(long, default_value_t = 3, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=10))]
    passes: u8,
    /// Draw the silhouette of each number of shapes (.svg)
    #[arg(long, value_name = "FILE")]
    chart: Option<PathBuf>,
    #[command(flatten)]
    batch: BatchArguments,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let clock = Instant::now();
    if let Some(file) = &arguments.chart {
        check_name(file)?;
    }
    let mut paths = Vec::new();
    for folder in &arguments.folders {
        let found = pictures_of(folder)?;
        if found.is_empty() {
            bail!("{}: no picture in this folder", folder.display());
        }
        paths.extend(found);
    }
    let mut options = PrototypeOptions::default();
    options.max_shapes = arguments.max_shapes.into();
    options.min_members = arguments.min_members.into();
    options.mirror = arguments.mirror;
    options.upright = arguments.upright;
    let (found, bank, failures) = learn_from(arguments, &paths, &options)?;
    for failure in &failures {
        writeln!(console.err, "error: {failure}")?;
    }
    write_atomic(&arguments.out, bank_to_json(&bank).as_bytes())?;
    if let Some(file) = &arguments.chart {
        silhouette_chart(&found.learned).write(file)?;
    }
    let report = Report::new(&found, &bank, paths.len(), clock.elapsed());
    let text = if arguments.batch.json { report.json()? } else { report.table() };
    writeln!(console.out, "{text}")?;
    Ok(if failures.is_empty() { Outcome::Done } else { Outcome::Partly })
}

/// What the first pass found.
struct Found {
    members: Vec<Member>,
    learned: Learned,
    /// Objects of all fits.
    objects: usize,
}

fn learn_from(
    arguments: &Arguments,
    paths: &[PathBuf],
    options: &PrototypeOptions,
) -> Result<(Found, Bank<f32>, Vec<String>)> {
    let mut failures = Vec::new();
    let free = Fitter::new(FitOptions::default())?;
    let fitted = each(arguments, paths, |image, index, scratch| {
        let fit = fit_picture(&free, image, &Known::default().with_loose(true), scratch)?;
        Ok((fit.scene.objects.len(), is_drawing(&fit.scene), members(&fit, image.size(), index)?))
    })?;
    let mut found = Vec::new();
    let (mut drawn, mut soft) = (Vec::new(), Vec::new());
    let mut objects = 0;
    for (path, result) in paths.iter().zip(fitted) {
        match result {
            Ok((count, is_drawing, members)) => {
                objects += count;
                found.extend(members);
                if is_drawing { &mut drawn } else { &mut soft }.push(path.clone());
            }
            Err(error) => failures.push(format!("{}: {}", path.display(), in_words(&error))),
        }
    }
    let learned = learn(&found, options)?;
    let mut bank = learned.bank();
    if !drawn.is_empty() {
        bank = drawn::better_bank(arguments, &drawn, bank)?;
    }
    for _ in (1..arguments.passes).take_while(|_| !soft.is_empty()) {
        bank = better_bank(arguments, &soft, bank)?;
    }
    Ok((Found { members: found, learned, objects }, bank, failures))
}

/// Fits with the bank and lays its outlines on what all posed objects show.
fn better_bank(arguments: &Arguments, paths: &[PathBuf], bank: Bank<f32>) -> Result<Bank<f32>> {
    let fitter = Fitter::new(FitOptions::default().with_bank(Some(bank.clone())))?;
    let empty = Pool::new(&bank)?;
    let parts = each(arguments, paths, |image, _, scratch| {
        let fit = fitter.fit(image, &mut scratch.fit)?;
        let mut pool = empty.clone();
        pool.add(&fit, image.size(), &scratch.fit);
        Ok(pool)
    })?;
    let mut pool = empty.clone();
    // In the order of the pictures, whichever thread fitted them; those that failed were told of in the first pass.
    parts.into_iter().flatten().for_each(|part| pool.merge(part));
    Ok(pool.bank()?)
}

/// Reads every picture and does something with it.
fn each<R: Send>(
    arguments: &Arguments,
    paths: &[PathBuf],
    work: impl Fn(ImageView<'_, f32>, usize, &mut PictureScratch) -> Result<R> + Sync,
) -> Result<Vec<Result<R>>> {
    arguments.batch.each(
        paths,
        |path| path.display().to_string(),
        |scratch, index, path| {
            let picture = read_picture(path, arguments.batch.max_pixels).context("not read")?;
            work(picture.image.view(), index, scratch)
        },
    )
}

/// Silhouette over the number of shapes.
fn silhouette_chart(learned: &Learned) -> Chart {
    let points = (2_u32..).map(f64::from).zip(learned.silhouettes.iter().map(|value| value.mean)).collect();
    let lines = vec![Line { name: "mean silhouette".to_owned(), points, ..Line::default() }];
    Chart { title: "Silhouette", x: "shapes", y: "mean silhouette", lines, log: false }
}
