//! `dvp gradients`: where the gradient of images points, and how far Adam comes along it; the paper's two analyses.
//!
//! | file | does |
//! |---|---|
//! | `pairs` | scenes moved a share of the way toward others |
//! | `cosine` | the angle between the gradients of L_x and L_p, aspect by aspect |
//! | `plateau` | the loss before and after 100 steps of Adam |
//! | `published` | the paper's curves |

mod cosine;
mod pairs;
mod plateau;
mod published;

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use dvp_core::ImageSize;
use dvp_core::render::PixelLoss;

use self::cosine::{Aspect, Cosines};
use self::pairs::{Pair, pairs};
use self::published::{ALPHAS, COSINES_MAE, COSINES_MSE, PLATEAUS};
use super::report::{self, Cells};
use dvp_cli::chart::{Chart, Line};
use dvp_cli::command::options::BatchArguments;
use dvp_cli::command::{Console, Outcome};
use dvp_cli::format::write_atomic;

/// Compares gradients of image and parameter losses, and looks for plateaus.
///
/// Scenes of MDS-HR are moved a share alpha of the way toward other scenes. First: the cosine between the gradients of
/// the image loss and of L_p with respect to translation, scale, rotation, color, shape and background, for MAE and MSE.
/// Second: the squared error of the image before and after 100 steps of Adam. Writes cosine.csv, plateau.csv and charts, in
/// which rings are the published values.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp gradients --out gradients\n         \
                         dvp gradients --out gradients --pairs 2048\n         \
                         dvp gradients --out gradients --pairs 2048 --descents 512 --published")]
pub struct Arguments {
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Pairs of scenes that the cosines are means over; the paper has 2048
    #[arg(long, default_value_t = 256, value_name = "N")]
    pairs: usize,
    /// Pairs of scenes that Adam goes down from; 0 leaves the second analysis out
    #[arg(long, default_value_t = 64, value_name = "N")]
    descents: usize,
    /// Side of the images in pixels
    #[arg(long, default_value_t = 128, value_name = "N")]
    side: usize,
    /// Number that the scenes are drawn from
    #[arg(long, default_value_t = 1234)]
    seed: u64,
    /// As the paper's figures were made, as far as they tell: confidences of moved scenes rounded, cosines slot by slot, 0 where
    /// there is no object, and descents on pose and color from the true shapes
    #[arg(long)]
    published: bool,
    #[command(flatten)]
    batch: BatchArguments,
}

/// How both analyses are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Setting {
    /// To the letter of the paper's text.
    Ours,
    /// As its published curves are met.
    Published,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    if arguments.pairs == 0 {
        bail!("--pairs must be at least 1");
    }
    let size = ImageSize::new(arguments.side, arguments.side)?;
    let pairs = pairs(arguments.pairs.max(arguments.descents), size, arguments.seed);
    let losses = [("mae", PixelLoss::Mae, COSINES_MAE), ("mse", PixelLoss::Mse, COSINES_MSE)];
    let mut table = report::header(["loss", "aspect", "alpha", "cosine", "published"]);
    for (name, loss, published) in losses {
        let means = cosines(arguments, &pairs[..arguments.pairs], loss, size)?;
        for ((aspect, own), published) in Aspect::ALL.into_iter().zip(means).zip(published) {
            for ((alpha, cosine), published) in ALPHAS.iter().zip(own).zip(published) {
                let numbers = [format!("{cosine:.4}"), format!("{published:.4}")];
                table.push(
                    [name.to_owned(), aspect.name().to_owned(), alpha.to_string()].into_iter().chain(numbers).collect(),
                );
            }
        }
        let line = |(k, aspect): (usize, Aspect)| Line {
            name: aspect.name().to_owned(),
            points: ALPHAS.iter().copied().zip(means[k]).collect(),
            others: ALPHAS.iter().copied().zip(published[k]).collect(),
        };
        let title = if name == "mae" { "Gradients of MAE and L_p" } else { "Gradients of MSE and L_p" };
        let lines = Aspect::ALL.into_iter().enumerate().map(line).collect();
        let chart = Chart { title, x: "alpha", y: "cosine", lines, log: false };
        chart.write(&arguments.out.join(format!("cosine_{name}.svg")))?;
    }
    arguments.write("cosine.csv", &table, console)?;
    if arguments.descents > 0 {
        let found = plateaus(arguments, &pairs[..arguments.descents], size)?;
        let mut table = report::header(["alpha", "before", "after", "published_before", "published_after"]);
        for ((alpha, [before, after]), [own_before, own_after]) in ALPHAS.iter().zip(&found).zip(PLATEAUS) {
            let errors = [*before, *after, own_before, own_after].map(|error| format!("{error:.3e}"));
            table.push([alpha.to_string()].into_iter().chain(errors).collect());
        }
        arguments.write("plateau.csv", &table, console)?;
        plateau_chart(&found).write(&arguments.out.join("plateau.svg"))?;
    }
    Ok(Outcome::Done)
}

impl Arguments {
    fn setting(&self) -> Setting {
        if self.published { Setting::Published } else { Setting::Ours }
    }

    /// Writes a table, whole or not at all, and shows it.
    fn write(&self, name: &str, table: &Cells, console: &mut Console<'_>) -> Result<()> {
        let bytes = report::csv(table)?;
        write_atomic(&self.out.join(name), &bytes)?;
        Ok(console.out.write_all(&bytes)?)
    }
}

/// Mean cosines by aspect and share.
fn cosines(arguments: &Arguments, pairs: &[Pair], loss: PixelLoss, size: ImageSize) -> Result<[[f64; 11]; 6]> {
    let setting = arguments.setting();
    let rows = arguments.batch.each(
        pairs,
        |_| String::new(),
        |cosines: &mut Option<Cosines>, _, pair| {
            let cosines = Cosines::in_place(cosines, loss, size)?;
            let of = |alpha| cosines.of(&pair.truth, &pair.moved(alpha, setting), setting);
            ALPHAS.into_iter().map(of).collect::<Result<Vec<[f64; 6]>>>()
        },
    )?;
    let mut means = [[0.0; 11]; 6];
    for row in rows {
        for (k, cosines) in row?.into_iter().enumerate() {
            means.iter_mut().zip(cosines).for_each(|(mean, cosine)| mean[k] += cosine / pairs.len() as f64);
        }
    }
    Ok(means)
}

/// Mean squared errors before and after, by share.
fn plateaus(arguments: &Arguments, pairs: &[Pair], size: ImageSize) -> Result<Vec<[f64; 2]>> {
    let setting = arguments.setting();
    let rows = arguments.batch.each(
        pairs,
        |_| String::new(),
        |(): &mut (), _, pair| {
            let of = |alpha| plateau::descend(&pair.truth, &pair.moved(alpha, setting), size, setting);
            ALPHAS.into_iter().map(of).collect::<Result<Vec<[f64; 2]>>>()
        },
    )?;
    let mut means = vec![[0.0; 2]; ALPHAS.len()];
    for row in rows {
        for (mean, own) in means.iter_mut().zip(row?) {
            mean.iter_mut().zip(own).for_each(|(mean, own)| *mean += own / pairs.len() as f64);
        }
    }
    Ok(means)
}

fn plateau_chart(found: &[[f64; 2]]) -> Chart {
    let line = |(k, name): (usize, &str)| Line {
        name: name.to_owned(),
        points: ALPHAS.iter().copied().zip(found.iter().map(|pair| pair[k])).collect(),
        others: ALPHAS.iter().copied().zip(PLATEAUS.iter().map(|pair| pair[k])).collect(),
    };
    let lines = ["before", "after 100 steps"].into_iter().enumerate().map(line).collect();
    Chart { title: "Plateaus", x: "alpha", y: "mean squared error", lines, log: true }
}
