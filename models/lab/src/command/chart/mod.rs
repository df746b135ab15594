//! `dvp chart`: speed against accuracy of methods and of renderers, in one picture each.
//!
//! | file | does |
//! |---|---|
//! | `settings` | which methods run, with which settings |
//! | `methods` | runs them by turns |
//! | `renderers`, `dense` | times and errors of the renderers |
//! | `pareto` | what nothing beats in both |
//! | `published` | what others report |
//! | `report` | rows with their place on the fronts: CSV, JSON, a table, what a budget buys |
//! | `figures` | the charts |
//! | `page` | everything as one HTML page |

mod dense;
mod figures;
mod methods;
mod page;
mod pareto;
mod published;
mod renderers;
mod report;
mod settings;

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use clap::Args;

use self::page::Page;
use self::report::{Report, renderer_cells};
use super::arguments::{ReportArguments, SceneArguments};
use super::{pictures, report as tables};
use dvp_cli::command::{Console, Outcome, generated};
use dvp_cli::format::{DEFAULT_MAX_PIXELS, DataSet, read_npy};
use dvp_cli::method::load_network;
use dvp_cli::paint::RendererName;

/// Most images that renderers are timed on, in a full chart and in a quick one.
const RENDERED: [usize; 2] = [64, 16];

/// Charts accuracy against time per image: methods with their settings, and renderers.
///
/// Runs on one thread. Times are processor time, medians with quartiles; on every image all methods run by turns, so that a
/// busy machine hurts all alike. Images are painted from true scenes in float pixels. Methods that start from a scene
/// near the truth get the truth with errors of 0.02 in position, 10 % in size, 0.2 in angle and 0.05 in color: they have
/// a front of their own. Writes methods.csv, renderers.csv, three charts as SVG and PNG, and index.html with all of it.
#[derive(Debug, Args)]
#[command(before_help = "Example: dvp chart --out chart --quick\n         \
                         dvp chart --out chart --machine '4 cores at 3 GHz, idle'\n         \
                         dvp chart --out chart --data data --json > chart.json")]
pub struct Arguments {
    #[command(flatten)]
    report: ReportArguments,
    #[command(flatten)]
    scenes: SceneArguments<128, 24>,
    /// NumPy file of the float pixels of DATA, instead of painting its scenes
    #[arg(long, value_name = "FILE", requires = "data", conflicts_with = "renderer")]
    npy: Option<PathBuf>,
    /// What paints the images; `triangles` is the reference's, whose seams no other renderer meets
    #[arg(long, value_enum, default_value = "triangles")]
    renderer: RendererName,
    /// Weights of the network, as `dvp train` writes them [default: built in]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let clock = Instant::now();
    let Arguments { report: to, scenes, .. } = arguments;
    let (count, most) = scenes.count()?;
    let data = match &scenes.data {
        Some(folder) => DataSet::open(folder)?,
        None => generated::mds_hr(count, scenes.seed)?,
    };
    let pictures = match &arguments.npy {
        Some(file) => pictures::given(&data, most, read_npy(file, DEFAULT_MAX_PIXELS)?)?,
        None => pictures::painted(&data, most, arguments.renderer)?,
    };
    let network = load_network(arguments.model.as_deref())?;
    let settings = settings::settings(scenes.quick);
    let methods = methods::run(&settings, &pictures, data.bank, network, scenes.seed)?;
    let report = Report::of(methods, pictures::floor(&pictures)?);
    let renderers = renderers::run(&pictures[..RENDERED[usize::from(scenes.quick)].min(pictures.len())])?;

    to.write("methods.csv", &tables::csv(&report.csv_cells())?)?;
    to.write("renderers.csv", &tables::csv(&renderer_cells(&renderers))?)?;
    let charts = [
        ("methods_mae", figures::methods_mae(&report)),
        ("methods_ari", figures::methods_ari(&report)),
        ("renderers", figures::renderers(&renderers)),
    ];
    let mut drawn = Vec::new();
    for (name, chart) in &charts {
        drawn.push(to.write_chart(name, chart)?);
    }
    let page = Page {
        run: to.run(arguments.command(), pictures.len(), clock),
        report: &report,
        renderers: &renderers,
        charts: &drawn,
    };
    to.write("index.html", page.to_html().as_bytes())?;
    if to.json {
        writeln!(console.out, "{}", serde_json::to_string_pretty(&report::json(&report, &renderers))?)?;
    } else {
        writeln!(console.out, "{}\n{}", report.table(), report.budgets().join("\n"))?;
    }
    Ok(if report.failed() == 0 { Outcome::Done } else { Outcome::Partly })
}

impl Arguments {
    /// The command that makes the same chart, but for the folder.
    fn command(&self) -> String {
        let mut text = format!("dvp chart --out DIR{}", self.scenes.words());
        if let Some(file) = &self.npy {
            text += &format!(" --npy {}", file.display());
        }
        if self.renderer != RendererName::Triangles {
            text += &format!(" --renderer {:?}", self.renderer).to_lowercase();
        }
        if let Some(file) = &self.model {
            text += &format!(" --model {}", file.display());
        }
        text
    }
}
