//! `dvp stability`: where methods fail, how, and whether they say so.
//!
//! | file | does |
//! |---|---|
//! | `sweep` | the difficulties: pictures for every level |
//! | `trial` | runs every method on every level |
//! | `watch` | stops waiting for a run that does not end |
//! | `judge` | success, error, the way of failing, the result's own doubt |
//! | `calibration` | failures against doubts, true poses against stated uncertainties |
//! | `summary` | means by level, break points |
//! | `table` | CSV, text |
//! | `draw` | a chart per difficulty |
//! | `page` | all of it as one HTML page |

mod calibration;
mod draw;
mod judge;
mod page;
mod summary;
mod sweep;
mod table;
#[cfg(test)]
mod tests;
mod trial;
mod watch;

use alloc::sync::Arc;
use core::time::Duration;
use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use clap::builder::PossibleValuesParser;
use dvp_fit::FitOptions;

use self::summary::SweepSummary;
use self::sweep::{SWEEPS, Sweep};
use self::trial::{Contender, Effort};
use super::arguments::ReportArguments;
use super::report;
use dvp_cli::command::options::with_threads;
use dvp_cli::command::{Console, Outcome, progress};
use dvp_cli::format::mdshr_bank;
use dvp_cli::method::{Method, Tools, load_looking};

/// Pictures per level.
const PICTURES: u64 = 24;
const QUICK_PICTURES: u64 = 4;
/// Seconds that a run may take.
const LIMIT: u64 = 180;
const QUICK_LIMIT: u64 = 60;

/// Methods that are tried unless others are asked for.
const METHODS: [Method; 9] = [
    Method::SegmentBank,
    Method::SegmentFree,
    Method::Lm,
    Method::LmContinuation,
    Method::OptP,
    Method::OptIter,
    Method::RandOptP,
    Method::Net,
    Method::NetLm,
];

/// Makes pictures harder and harder, one difficulty at a time, and shows where each method fails, how, and whether its
/// result said so.
///
/// A run succeeds if the number of objects is right and each agrees with the true one to an IoU of 0.9 (what is seen of it).
/// Writes index.html (all in one page), a chart per difficulty, levels.csv, calibration.csv, and runs.csv with every run.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp stability --quick --out stability\n         \
                         dvp stability --out stability --sweep noise twins --method segment-bank segment-free\n         \
                         dvp stability --out start --sweep noise jpeg --method segment-bank net-lm --model best.safetensors")]
pub struct Arguments {
    #[command(flatten)]
    report: ReportArguments,
    /// Every second level and few pictures: minutes instead of an hour
    #[arg(long)]
    quick: bool,
    /// Difficulties [default: all]
    #[arg(long, value_name = "NAME", num_args = 1.., value_parser = PossibleValuesParser::new(SWEEPS.iter().map(|s| s.name)))]
    sweep: Vec<String>,
    /// Methods [default: those of the report]
    #[arg(long, value_enum, value_name = "NAME", num_args = 1..)]
    method: Vec<Method>,
    /// Weights of the network, as `dvp train` writes them [default: those that come with the program]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Weights of its second looks, as `dvp train --model look` writes them [default: those that come with the program]
    #[arg(long, value_name = "FILE")]
    look: Option<PathBuf>,
    /// Pictures per level [default: 24, with --quick 4]; a quarter of them where pictures are large
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pictures: Option<u64>,
    /// Number of the first picture
    #[arg(long, default_value_t = 1, value_name = "N")]
    seed: u64,
    /// Seconds after which a run counts as endless [default: 180, with --quick 60]
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(1..))]
    limit: Option<u64>,
    /// Threads; 0 means one per core
    #[arg(long, default_value_t = 0, value_name = "N")]
    threads: usize,
}

impl Arguments {
    fn effort(&self) -> Effort {
        let (pictures, limit) = if self.quick { (QUICK_PICTURES, QUICK_LIMIT) } else { (PICTURES, LIMIT) };
        Effort {
            quick: self.quick,
            pictures: self.pictures.unwrap_or(pictures),
            seed: self.seed,
            limit: Duration::from_secs(self.limit.unwrap_or(limit)),
        }
    }
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let to = &arguments.report;
    let methods = if arguments.method.is_empty() { &METHODS[..] } else { &arguments.method };
    let needs_network = methods.iter().any(|method| method.needs_network());
    if !needs_network && (arguments.model.is_some() || arguments.look.is_some()) {
        bail!("none of the methods asks a network: leave --model and --look away, or name net or net-lm with --method");
    }
    let load = || load_looking(arguments.model.as_deref(), arguments.look.as_deref(), None);
    let network = needs_network.then(load).transpose()?;
    let tools = Tools { options: FitOptions::default().with_bank(Some(mdshr_bank())), network: network.map(Arc::new) };
    let is_asked = |sweep: &&Sweep| arguments.sweep.is_empty() || arguments.sweep.iter().any(|name| name == sweep.name);
    let mut lists = Vec::new();
    for sweep in SWEEPS.iter().filter(is_asked) {
        let contenders = Contender::of(sweep, methods, &tools)?;
        if !contenders.is_empty() {
            lists.push((sweep, contenders));
        }
    }
    if lists.is_empty() {
        bail!("none of the methods takes part in these difficulties: name others with --method or --sweep");
    }
    let effort = arguments.effort();
    let runs = |(sweep, contenders): &(&Sweep, Vec<Contender>)| {
        (sweep.chosen(effort.quick).len() * contenders.len()) as u64 * effort.pictures_of(sweep)
    };
    let bar = progress::bar(lists.iter().map(runs).sum(), 0);
    let (mut summaries, mut table) = (Vec::new(), table::runs_head());
    for (sweep, contenders) in &lists {
        bar.set_message(sweep.name);
        let trials = with_threads(arguments.threads, || trial::run(sweep, contenders, effort, &bar))??;
        let summary = SweepSummary::of(sweep, contenders, &trials, effort.quick);
        to.write(&format!("{}.svg", sweep.name), draw::svg(&summary)?.as_bytes())?;
        table.extend(table::runs(sweep, contenders, &trials));
        summaries.push(summary);
    }
    bar.finish_and_clear();
    to.write("runs.csv", &report::csv(&table)?)?;
    to.write("levels.csv", &report::csv(&table::levels(&summaries))?)?;
    to.write("calibration.csv", &report::csv(&table::calibration(&summaries))?)?;
    to.write("index.html", page::page(&summaries, to.machine.as_deref(), effort)?.as_bytes())?;
    if to.json {
        writeln!(console.out, "{}", serde_json::to_string_pretty(&summaries)?)?;
    } else {
        writeln!(console.out, "{}", table::breaks(&summaries))?;
    }
    Ok(Outcome::Done)
}
