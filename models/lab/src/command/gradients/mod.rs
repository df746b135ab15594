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
/// Second: the squared error of the image before and after 100 steps of Adam. Writes cosine.csv and plateau.csv, means
/// with their standard errors, and charts, in which rings are the published values.
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
    let mut table = report::header(["loss", "aspect", "alpha", "cosine", "error", "published"]);
    for (name, loss, published) in losses {
        let means = cosines(arguments, &pairs[..arguments.pairs], loss, size)?;
        for ((aspect, own), published) in Aspect::ALL.into_iter().zip(means).zip(published) {
            for ((alpha, cosine), published) in ALPHAS.iter().zip(own).zip(published) {
                let numbers = [cosine.mean, cosine.error(), published].map(|number| format!("{number:.4}"));
                table.push(
                    [name.to_owned(), aspect.name().to_owned(), alpha.to_string()].into_iter().chain(numbers).collect(),
                );
            }
        }
        let line = |(k, aspect): (usize, Aspect)| Line {
            name: aspect.name().to_owned(),
            points: ALPHAS.iter().copied().zip(means[k].map(|cosine| cosine.mean)).collect(),
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
        let columns = ["before", "before_error", "published_before", "after", "after_error", "published_after"];
        let mut table = report::header(["alpha"].into_iter().chain(columns));
        for (k, alpha) in ALPHAS.iter().enumerate() {
            let [before, after] = found.map(|means| means[k]);
            let [published_before, published_after] = PLATEAUS[k];
            let of = |mean: Mean, published| [mean.mean, mean.error(), published];
            let errors = [of(before, published_before), of(after, published_after)].concat();
            let errors = errors.iter().map(|error| format!("{error:.3e}"));
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

/// A mean over the pairs, and its standard error.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    count: f64,
    mean: f64,
    /// Sum of the squares of what the pairs differ from it.
    squares: f64,
}

impl Mean {
    /// Takes one more pair in (Welford, Technometrics 4(3), 1962).
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        let difference = value - self.mean;
        self.mean += difference / self.count;
        self.squares += difference * (value - self.mean);
    }

    fn error(self) -> f64 {
        (self.squares / (self.count * (self.count - 1.0)).max(1.0)).sqrt()
    }
}

/// Means of what `of` says of each pair at each share, by kind and share.
fn means<S: Default, const N: usize>(
    arguments: &Arguments,
    pairs: &[Pair],
    of: impl Fn(&mut S, &Pair, f64) -> Result<[f64; N]> + Sync,
) -> Result<[[Mean; 11]; N]> {
    let of_pair = |scratch: &mut S, _, pair: &Pair| {
        ALPHAS.into_iter().map(|alpha| of(scratch, pair, alpha)).collect::<Result<Vec<[f64; N]>>>()
    };
    let mut means = [[Mean::default(); 11]; N];
    for row in arguments.batch.each(pairs, |_| String::new(), of_pair)? {
        for (k, values) in row?.into_iter().enumerate() {
            means.iter_mut().zip(values).for_each(|(mean, value)| mean[k].add(value));
        }
    }
    Ok(means)
}

/// Mean cosines by aspect and share.
fn cosines(arguments: &Arguments, pairs: &[Pair], loss: PixelLoss, size: ImageSize) -> Result<[[Mean; 11]; 6]> {
    let setting = arguments.setting();
    means(arguments, pairs, |cosines: &mut Option<Cosines>, pair, alpha| {
        Cosines::in_place(cosines, loss, size)?.of(&pair.truth, &pair.moved(alpha, setting), setting)
    })
}

/// Mean squared errors before and after, by share.
fn plateaus(arguments: &Arguments, pairs: &[Pair], size: ImageSize) -> Result<[[Mean; 11]; 2]> {
    let setting = arguments.setting();
    means(arguments, pairs, |(): &mut (), pair, alpha| {
        plateau::descend(&pair.truth, &pair.moved(alpha, setting), size, setting)
    })
}

fn plateau_chart(found: &[[Mean; 11]; 2]) -> Chart {
    let line = |(k, name): (usize, &str)| Line {
        name: name.to_owned(),
        points: ALPHAS.iter().copied().zip(found[k].map(|error| error.mean)).collect(),
        others: ALPHAS.iter().copied().zip(PLATEAUS.iter().map(|pair| pair[k])).collect(),
    };
    let lines = ["before", "after 100 steps"].into_iter().enumerate().map(line).collect();
    Chart { title: "Plateaus", x: "alpha", y: "mean squared error", lines, log: true }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_and_its_error_by_hand() {
        let mut mean = Mean::default();
        [1.0, 2.0, 4.0].into_iter().for_each(|value| mean.add(value));
        assert!((mean.mean - 7.0 / 3.0).abs() < 1e-12);
        // Variance of a value: (16 + 1 + 25) / 9 / 2.
        assert!((mean.error() - (7.0_f64 / 9.0).sqrt()).abs() < 1e-12);
    }
}
