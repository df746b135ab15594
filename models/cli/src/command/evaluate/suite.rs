//! `dvp evaluate --suite`: predictions beside what the simplest program finds, in the columns of the field's benchmarks.

use std::path::Path;

use anyhow::{Context, Result, bail};
use comfy_table::{Table, presets};
use dvp_core::metric::{Ownership, OwnershipRule};
use dvp_core::render::ContourRenderer;
use dvp_core::{ImageSize, Scene};
use serde::Serialize;

use super::Arguments;
use crate::command::{Console, Outcome, in_words};
use crate::export::whole_coverage;
use crate::format::{DataSet, Place, Sample, read_labels, read_picture, read_scene, to_byte};
use crate::paint::Painter;
use crate::score::{Failure, ObjectScore, ObjectTotals, Parts, connected_components, score_objects};
use crate::suite::{Classes, Suite, read_whole};

/// The name of the first row.
const SIMPLEST: &str = "connected components of equal color";

/// What is told of a suite.
#[derive(Serialize)]
struct Report {
    suite: &'static str,
    rows: Vec<Row>,
    failed: Vec<Failure>,
}

#[derive(Serialize)]
struct Row {
    name: String,
    #[serde(flatten)]
    totals: ObjectTotals,
}

/// What every picture is scored with.
struct Judge<'a> {
    arguments: &'a Arguments,
    predictions: &'a Path,
    data: DataSet<f32>,
    classes: Option<Classes>,
    painter: Painter,
}

/// Scores a folder of predictions on a suite.
pub(super) fn run(arguments: &Arguments, suite: Suite, console: &mut Console<'_>) -> Result<Outcome> {
    let (Some(predictions), Some(data)) = (arguments.predictions.as_deref(), arguments.data.as_deref()) else {
        bail!("--suite scores a folder of predictions: name it, and that of the data set");
    };
    if !predictions.is_dir() {
        bail!("{}: no folder of predictions", predictions.display());
    }
    let judge = Judge {
        arguments,
        predictions,
        data: DataSet::open(data)?,
        classes: Classes::read(data)?,
        painter: arguments.paint.painter(),
    };
    let scores = arguments.batch.each(
        &judge.data.samples,
        |sample| sample.stem.clone(),
        |(): &mut (), _, sample| judge.score(sample),
    )?;
    let mut failed = Vec::new();
    let mut done: Vec<[ObjectScore; 2]> = Vec::new();
    for (sample, score) in judge.data.samples.iter().zip(scores) {
        match score {
            Ok(score) => done.push(score),
            Err(error) => {
                let error = in_words(&error);
                writeln!(console.err, "error: {}: {error}", sample.stem)?;
                failed.push(Failure { stem: sample.stem.clone(), error });
            }
        }
    }
    let name = predictions.file_name().map_or_else(|| "predictions".to_owned(), |name| name.to_string_lossy().into());
    let row = |name, row: usize| -> Result<Row> {
        Ok(Row { name, totals: ObjectTotals::of(done.iter().map(|scores| &scores[row]))? })
    };
    let report = Report { suite: suite.name(), rows: vec![row(SIMPLEST.to_owned(), 0)?, row(name, 1)?], failed };
    let text = if arguments.batch.json { serde_json::to_string_pretty(&report)? } else { table(&report) };
    writeln!(console.out, "{text}")?;
    Ok(if report.failed.is_empty() { Outcome::Done } else { Outcome::Partly })
}

impl Judge<'_> {
    /// The scores of connected components and of the prediction.
    fn score(&self, sample: &Sample) -> Result<[ObjectScore; 2]> {
        let most = self.arguments.batch.max_pixels;
        let image = read_picture::<f32>(&sample.image, most)?.image;
        let truth = self.truth(sample, image.size())?;
        let pixels: Vec<u8> = image.to_interleaved().into_iter().map(to_byte).collect();
        let simplest = connected_components(&pixels, image.size());
        let path = self.predictions.join(format!("{}.json", sample.stem));
        if !path.exists() {
            bail!("no prediction {}", path.display());
        }
        let json = read_scene(&path)?;
        let place = Place::file(&path);
        let own = json.size(&place)?;
        if own.is_some_and(|own| own != image.size()) {
            bail!("{}: predicted for a picture of another size", path.display());
        }
        let found = self.parts(&json.to_scene(Some(&self.data.bank), &place)?, image.size())?;
        let score = |parts| score_objects(image.view(), &truth, parts);
        Ok([score(&simplest)?, score(&found)?])
    }

    /// What is in the picture, from the files beside it or from the scene that it was drawn from.
    fn truth(&self, sample: &Sample, size: ImageSize) -> Result<Parts> {
        let most = self.arguments.batch.max_pixels;
        let mut truth = match &sample.scene {
            Some((json, place)) => self.parts(&json.to_scene(Some(&self.data.bank), place)?, size)?,
            None => Parts::default(),
        };
        if let Some(path) = &sample.labels {
            let (own, labels) = read_labels(path, most)?;
            if own != size {
                bail!("{}: labels for a picture of another size", path.display());
            }
            // Tiles are as many as objects, and one picture's width is at most a row of them.
            let whole = read_whole(&sample.image, size, most)?;
            truth = Parts { labels, ordered: whole.is_some(), whole, classes: Vec::new() };
        } else if sample.scene.is_none() {
            bail!("{}: neither a scene nor a label map tells what is in it", sample.image.display());
        }
        if let Some(classes) = self.classes.as_ref().and_then(|classes| classes.objects.get(&sample.stem)) {
            truth.classes = classes.iter().copied().map(Some).collect();
        }
        Ok(truth)
    }

    /// What a scene shows.
    fn parts(&self, scene: &Scene<f32>, size: ImageSize) -> Result<Parts> {
        let renderer = ContourRenderer::new(scene.edge, scene.compositing);
        let mut owned = Ownership::default();
        let rule = OwnershipRule::Seen(scene.compositing);
        owned.fill_drawing(rule, &renderer, &self.painter.draw(scene, size)?, size, &mut Default::default())?;
        let whole = whole_coverage(scene, size).context("objects cannot be shown whole")?;
        Ok(Parts {
            labels: owned.index().to_vec(),
            whole: Some(whole.into_iter().map(|coverage| coverage >= 0.5).collect()),
            ordered: true,
            classes: scene
                .objects
                .iter()
                .map(|object| object.prototype().and_then(|k| u32::try_from(k).ok()))
                .collect(),
        })
    }
}

/// The columns for people.
fn table(report: &Report) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header([report.suite, "ARI-FG", "ARI", "OCA", "OOA", "IoU", "F1", "classes", "n", "failed"]);
    let figure = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.4}"));
    for Row { name, totals } in &report.rows {
        let ObjectTotals { n, ari_foreground, ari, exact_count, order, iou, f1, class_accuracy } = totals;
        let columns = [ari_foreground, ari, exact_count, order, iou, f1, class_accuracy].map(|value| figure(*value));
        let mut row = vec![name.clone()];
        row.extend(columns);
        row.extend([n.to_string(), report.failed.len().to_string()]);
        table.add_row(row);
    }
    table.trim_fmt()
}
