//! Arguments that several reports share, and what follows from them alone.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Result, bail};
use clap::Args;

use super::report::{self, Run};
use crate::chart::Scatter;
use dvp_cli::format::write_atomic;

/// Where a report goes, and as what.
#[derive(Debug, Args)]
pub(super) struct ReportArguments {
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// What the machine is, for the page
    #[arg(long, value_name = "TEXT")]
    pub(super) machine: Option<String>,
    /// Print the figures as JSON
    #[arg(long)]
    pub(super) json: bool,
}

impl ReportArguments {
    /// Writes a file of the report, whole or not at all.
    pub(super) fn write(&self, name: &str, bytes: &[u8]) -> Result<()> {
        Ok(write_atomic(&self.out.join(name), bytes)?)
    }

    /// Writes a chart as NAME.svg and NAME.png; the SVG, for the page.
    pub(super) fn write_chart(&self, name: &str, chart: &Scatter) -> Result<String> {
        let svg = chart.to_svg()?;
        self.write(&format!("{name}.svg"), svg.as_bytes())?;
        self.write(&format!("{name}.png"), &chart.to_png()?)?;
        Ok(svg)
    }

    /// What the page says of a run of `command` that began at `clock`.
    pub(super) fn run(&self, command: String, images: usize, clock: Instant) -> Run {
        let machine = self.machine.clone().unwrap_or_else(report::machine);
        Run { command, machine, images, seconds: clock.elapsed().as_secs_f64() }
    }
}

/// Which true scenes a report is about: `FULL` of them unless another number is asked for, `QUICK` if in a hurry.
#[derive(Debug, Args)]
pub(super) struct SceneArguments<const FULL: u64, const QUICK: u64> {
    /// Fewer scenes, and for a chart fewer settings: minutes
    #[arg(long)]
    pub(super) quick: bool,
    /// Folder of a data set with scenes.jsonl [default: scenes of MDS-HR, drawn at random]
    #[arg(long, value_name = "DIR")]
    pub(super) data: Option<PathBuf>,
    #[arg(long, value_name = "N", help = format!("Most images with objects [default: {FULL}, with --quick {QUICK}]"))]
    images: Option<u64>,
    /// Number that scenes, starts and noise are drawn from
    #[arg(long, default_value_t = 4321)]
    pub(super) seed: u64,
}

impl<const FULL: u64, const QUICK: u64> SceneArguments<FULL, QUICK> {
    /// How many images, to draw them and to take them from a data set.
    pub(super) fn count(&self) -> Result<(u64, usize)> {
        let count = self.images.unwrap_or(if self.quick { QUICK } else { FULL });
        if count == 0 {
            bail!("--images must be at least 1");
        }
        Ok((count, usize::try_from(count).unwrap_or(usize::MAX)))
    }

    /// The arguments as they were given, each with a blank before it.
    pub(super) fn words(&self) -> String {
        let quick = self.quick.then(|| " --quick".to_owned());
        let data = self.data.as_ref().map(|folder| format!(" --data {}", folder.display()));
        let images = self.images.map(|count| format!(" --images {count}"));
        let seed = Some(format!(" --seed {}", self.seed));
        [quick, data, images, seed].into_iter().flatten().collect()
    }
}
