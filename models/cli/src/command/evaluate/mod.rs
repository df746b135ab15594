//! `dvp evaluate`: predictions against a data set, in the paper's columns.

mod finder;
mod report;
mod suite;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use dvp_core::{Image, ImageSize, Scene};
use dvp_net::decompose::Divider;

use self::finder::NetworkArguments;
use super::options::{BatchArguments, PaintArguments};
use super::{Console, Outcome, generated, in_words};
use crate::format::{DataSet, Place, Sample, SceneJson, read_labels, read_npy, read_picture, read_scene, write_atomic};
use crate::method::{Memory, MethodError, Runner, Task, seed_of, timed};
use crate::paint::Painter;
use crate::score::{Row, Score, Scratch, Totals, Truth, score, score_pixels};
use crate::suite::Suite;

/// Scores a folder of predictions (STEM.json, as `dvp fit` writes them), or a network, against a data set.
///
/// A network (--model) predicts from the images that it is compared with. Objects are there if it is sure of them, or in
/// doubt if the image is painted better with them; those of opt-z count if their confidence is above 1/2. Objects are looked at again one
/// by one (--looks, --look), and where they stand and which shape they have is what the last look says.
///
/// MONet (--method monet --model FILE) and Slot Attention (--method slots) divide the picture: their objects own the pixels in which
/// their mask is the largest, the mask with the most pixels is the background, and masks with fewer than two pixels of a thousand belong
/// to it.
///
/// MAE, MSE and SSIM compare images; IoU (pooled over all images), ARI and the share of exact object counts need the
/// true scenes (scenes.jsonl) or, beside a picture STEM.png, a label map STEM.labels.png: gray of 8 or 16 bits, 0 for the
/// background and k where object k is seen, or a palette with black for the background. Against true scenes that blend,
/// objects own what they reach, as in the paper; else the topmost object that covers half a pixel owns it, and objects
/// count that own one. Missing and bad predictions are listed and counted; they are in no mean.
///
/// With --suite the columns are those of the field's benchmarks, and what connected components of equal color come to stands in the first
/// row: ARI-FG (of the pixels of true objects), ARI, OCA (share of exact counts), OOA (order of what overlaps), IoU and F1 of whole objects
/// (from the true scenes, or STEM.whole.png), and the mean accuracy of classes (prototypes of the prediction against those of the true
/// scenes, or classes.json).
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp evaluate out data\n         \
                         dvp evaluate out data --against float --json\n         \
                         dvp evaluate out data --suite tetrominoes\n         \
                         dvp evaluate data --model run/best.safetensors --then refine\n         \
                         dvp evaluate --generated 500 --model run/best.safetensors --then opt-z")]
pub struct Arguments {
    /// Folder of predictions; left away where a network predicts
    #[arg(required_unless_present_any = NETWORK)]
    predictions: Option<PathBuf>,
    /// Folder of a data set: scenes.jsonl and pictures, pictures with label maps, or pictures alone
    #[arg(required_unless_present_any = NETWORK)]
    data: Option<PathBuf>,
    #[command(flatten)]
    network: NetworkArguments,
    /// What reconstructions are compared with
    #[arg(long, value_enum, default_value_t)]
    against: Against,
    /// Score objects against objects, in the columns of this benchmark
    #[arg(long, value_enum, conflicts_with_all = ["model", "look", "looks", "method", "generated", "against", "npy", "csv"])]
    suite: Option<Suite>,
    /// NumPy file of float pixels to compare with; as many images as it holds are scored
    #[arg(long, value_name = "FILE", conflicts_with = "against")]
    npy: Option<PathBuf>,
    #[command(flatten)]
    paint: PaintArguments,
    #[command(flatten)]
    batch: BatchArguments,
    /// Write the figures of every image as CSV
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// What reconstructions are compared with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Against {
    /// The pictures of the data set
    #[default]
    Png,
    /// The true scenes, rendered again without rounding to 8 bits
    Float,
}

/// Options that ask for a network.
const NETWORK: [&str; 5] = ["model", "look", "looks", "method", "generated"];

/// What every image is scored with.
struct Judge<'a> {
    arguments: &'a Arguments,
    data: DataSet<f32>,
    stack: Option<Vec<Image<f32>>>,
    painter: Painter,
    predictions: Predictions<'a>,
}

/// Where predicted scenes come from.
enum Predictions<'a> {
    Folder(&'a Path),
    Network(Box<Runner>),
    Divided(Box<Divider>),
}

impl Arguments {
    /// What is scored, against what.
    fn sides(&self) -> Result<(Predictions<'_>, DataSet<f32>)> {
        match (self.predictions.as_deref(), self.data.as_deref(), self.network.generated) {
            (Some(predictions), Some(data), None) if !self.network.are_asked() => {
                if !predictions.is_dir() {
                    bail!("{}: no folder of predictions", predictions.display());
                }
                Ok((Predictions::Folder(predictions), DataSet::open(data)?))
            }
            (Some(data), None, None) => Ok((self.asked()?, DataSet::open(data)?)),
            (None, None, Some(count)) => {
                let data = generated::mds_hr(count, self.network.seed)?;
                Ok((self.asked()?, data))
            }
            _ => bail!("a network is scored on one thing: the folder of a data set, or --generated N"),
        }
    }

    /// What predicts while it is scored.
    fn asked(&self) -> Result<Predictions<'_>> {
        Ok(match self.network.divider()? {
            Some(divider) => Predictions::Divided(Box::new(divider)),
            None => Predictions::Network(Box::new(self.network.runner()?)),
        })
    }
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    if let Some(suite) = arguments.suite {
        return suite::run(arguments, suite, console);
    }
    let (predictions, mut data) = arguments.sides()?;
    let stack = arguments.npy.as_ref().map(|path| read_npy(path, arguments.batch.max_pixels)).transpose()?;
    if let Some(stack) = &stack {
        data.samples.truncate(stack.len());
    }
    let judge = Judge { arguments, data, stack, painter: arguments.paint.painter(), predictions };
    let rows: Vec<Row> = arguments.batch.each(
        &judge.data.samples,
        |sample| sample.stem.clone(),
        |memory: &mut (Scratch, Memory), index, sample| {
            let result = judge.score(index, sample, memory);
            Row { stem: sample.stem.clone(), result: result.map_err(|error| in_words(&error)) }
        },
    )?;
    for row in &rows {
        if let Err(error) = &row.result {
            writeln!(console.err, "error: {}: {error}", row.stem)?;
        }
    }
    if let Some(path) = &arguments.csv {
        write_atomic(path, report::csv(&rows).as_bytes())?;
    }
    let totals = Totals::of(&rows);
    if arguments.batch.json {
        writeln!(console.out, "{}", serde_json::to_string_pretty(&totals)?)?;
    } else {
        writeln!(console.out, "{}", report::table(&totals))?;
    }
    Ok(if totals.failed.is_empty() { Outcome::Done } else { Outcome::Partly })
}

impl Judge<'_> {
    fn score(&self, index: usize, sample: &Sample, memory: &mut (Scratch, Memory)) -> Result<Score> {
        let (scratch, memory) = memory;
        let truth = match &sample.scene {
            Some((json, place)) => Some(json.to_scene(Some(&self.data.bank), place)?),
            None => None,
        };
        match &self.predictions {
            Predictions::Folder(folder) => {
                let path = folder.join(format!("{}.json", sample.stem));
                let (predicted, found) = self.prediction(&path)?;
                let size = predicted.size(&Place::file(&path))?;
                let image = self.true_image(index, sample, truth.as_ref(), size)?;
                if let Some(own) = size
                    && own != image.size()
                {
                    let [own, other] = [own, image.size()].map(|size| format!("{} x {}", size.width(), size.height()));
                    bail!("predicted {own} pixels for {other}");
                }
                self.compare(sample, truth.as_ref(), &image, [&found; 2], scratch)
            }
            Predictions::Network(runner) => {
                let image = self.true_image(index, sample, truth.as_ref(), None)?;
                let seed = seed_of(&sample.stem, self.arguments.network.seed);
                let task = Task { truth: truth.as_ref(), seed, ..Task::of(image.view()) };
                let found = runner.run(&task, memory)?;
                let score = self.compare(sample, truth.as_ref(), &image, [&found.fit.scene, &found.there], scratch)?;
                Ok(Score { cpu_ms: Some(found.cpu.as_secs_f64() * 1e3), ..score })
            }
            Predictions::Divided(divider) => {
                let image = self.true_image(index, sample, truth.as_ref(), None)?;
                let (parts, cpu) = timed(|| Ok::<_, MethodError>(divider.divide(image.view())?))?;
                let labels = sample.labels.as_ref().map(|path| self.labels(path, image.size())).transpose()?;
                let known = labels.as_deref().map(Truth::Labels).or_else(|| truth.as_ref().map(Truth::Scene));
                let found = (parts.reconstruction(), parts.labels());
                let found = (found.0.view(), &found.1[..]);
                let score = score_pixels(&self.painter, image.view(), known.as_ref(), found, scratch)?;
                Ok(Score { cpu_ms: Some(cpu.as_secs_f64() * 1e3), ..score })
            }
        }
    }

    /// Scores the scene that is painted, and that of the objects that count.
    fn compare(
        &self,
        sample: &Sample,
        truth: Option<&Scene<f32>>,
        image: &Image<f32>,
        scenes: [&Scene<f32>; 2],
        scratch: &mut Scratch,
    ) -> Result<Score> {
        let labels = sample.labels.as_ref().map(|path| self.labels(path, image.size())).transpose()?;
        let known = labels.as_deref().map(Truth::Labels).or_else(|| truth.map(Truth::Scene));
        Ok(score(&self.painter, image.view(), known.as_ref(), scenes, scratch)?)
    }

    fn labels(&self, path: &Path, size: ImageSize) -> Result<Vec<u32>> {
        let (own, labels) = read_labels(path, self.arguments.batch.max_pixels)?;
        if own != size {
            let [own, other] = [own, size].map(|size| format!("{} x {}", size.width(), size.height()));
            bail!("{}: {own} labels for {other} pixels", path.display());
        }
        Ok(labels)
    }

    fn prediction(&self, path: &Path) -> Result<(SceneJson, Scene<f32>)> {
        if !path.exists() {
            bail!("no prediction {}", path.display());
        }
        let json = read_scene(path)?;
        let scene = json.to_scene(Some(&self.data.bank), &Place::file(path))?;
        Ok((json, scene))
    }

    /// The image to compare with. A scene without a size of its own takes that of its picture, or the prediction's.
    fn true_image(
        &self,
        index: usize,
        sample: &Sample,
        truth: Option<&Scene<f32>>,
        predicted: Option<ImageSize>,
    ) -> Result<Image<f32>> {
        if let Some(stack) = &self.stack {
            return stack.get(index).cloned().context("the NumPy file holds no such image");
        }
        let picture = || read_picture(&sample.image, self.arguments.batch.max_pixels).map(|picture| picture.image);
        let generated = self.arguments.network.generated.is_some();
        if self.arguments.against == Against::Png && !generated {
            return Ok(picture()?);
        }
        let scene = truth.context("--against float needs the true scenes (scenes.jsonl)")?;
        let own = sample.scene.as_ref().and_then(|(json, place)| json.size(place).transpose()).transpose()?;
        let size = match own {
            Some(size) => size,
            None if sample.image.exists() => picture()?.size(),
            None => predicted.context("neither the true scene nor the prediction says its size")?,
        };
        Ok(self.painter.paint(scene, size)?)
    }
}
