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

use anyhow::{Result, bail};
use clap::Args;

use self::page::Page;
use self::report::{Report, renderer_cells};
use super::{pictures, report as tables};
use dvp_cli::command::{Console, Outcome, generated};
use dvp_cli::format::{DEFAULT_MAX_PIXELS, DataSet, read_npy, write_atomic};
use dvp_cli::method::load_network;
use dvp_cli::paint::RendererName;

/// Images of a full chart, and of a quick one.
const IMAGES: [u64; 2] = [128, 24];
/// Most images that renderers are timed on.
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
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// Fewer images and settings: minutes
    #[arg(long)]
    quick: bool,
    /// Folder of a data set with scenes.jsonl [default: scenes of MDS-HR, drawn at random]
    #[arg(long, value_name = "DIR")]
    data: Option<PathBuf>,
    /// Most images [default: 128, with --quick 24]
    #[arg(long, value_name = "N")]
    images: Option<u64>,
    /// NumPy file of the float pixels of DATA, instead of painting its scenes
    #[arg(long, value_name = "FILE", requires = "data", conflicts_with = "renderer")]
    npy: Option<PathBuf>,
    /// What paints the images; `triangles` is the reference's, whose seams no other renderer meets
    #[arg(long, value_enum, default_value = "triangles")]
    renderer: RendererName,
    /// Weights of the network, as `dvp train` writes them [default: built in]
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Number that scenes and starts are drawn from
    #[arg(long, default_value_t = 4321)]
    seed: u64,
    /// What the machine is, for the page
    #[arg(long, value_name = "TEXT")]
    machine: Option<String>,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let clock = Instant::now();
    let kind = usize::from(arguments.quick);
    let count = arguments.images.unwrap_or(IMAGES[kind]);
    if count == 0 {
        bail!("--images must be at least 1");
    }
    let data = match &arguments.data {
        Some(folder) => DataSet::open(folder)?,
        None => generated::mds_hr(count, arguments.seed)?,
    };
    let most = usize::try_from(count).unwrap_or(usize::MAX);
    let pictures = match &arguments.npy {
        Some(file) => pictures::given(&data, most, read_npy(file, DEFAULT_MAX_PIXELS)?)?,
        None => pictures::painted(&data, most, arguments.renderer)?,
    };
    let network = load_network(arguments.model.as_deref())?;
    let settings = settings::settings(arguments.quick);
    let methods = methods::run(&settings, &pictures, data.bank, network, arguments.seed)?;
    let report = Report::of(methods, pictures::floor(&pictures)?);
    let renderers = renderers::run(&pictures[..RENDERED[kind].min(pictures.len())])?;

    let file = |name: &str, bytes: &[u8]| write_atomic(&arguments.out.join(name), bytes);
    file("methods.csv", &tables::csv(&report.csv_cells())?)?;
    file("renderers.csv", &tables::csv(&renderer_cells(&renderers))?)?;
    let charts = [
        ("methods_mae", figures::methods_mae(&report)),
        ("methods_ari", figures::methods_ari(&report)),
        ("renderers", figures::renderers(&renderers)),
    ];
    let mut drawn = Vec::new();
    for (name, chart) in &charts {
        let svg = chart.to_svg()?;
        file(&format!("{name}.svg"), svg.as_bytes())?;
        file(&format!("{name}.png"), &chart.to_png()?)?;
        drawn.push(svg);
    }
    let page = Page {
        command: arguments.command(),
        machine: arguments.machine.clone().unwrap_or_else(tables::machine),
        images: pictures.len(),
        seconds: clock.elapsed().as_secs_f64(),
        report: &report,
        renderers: &renderers,
        charts: &drawn,
    };
    file("index.html", page.to_html().as_bytes())?;
    if arguments.json {
        writeln!(console.out, "{}", serde_json::to_string_pretty(&report::json(&report, &renderers))?)?;
    } else {
        writeln!(console.out, "{}\n{}", report.table(), report.budgets().join("\n"))?;
    }
    Ok(if report.failed() == 0 { Outcome::Done } else { Outcome::Partly })
}

impl Arguments {
    /// The command that makes the same chart, but for the folder.
    fn command(&self) -> String {
        let mut text = "dvp chart --out DIR".to_owned();
        if self.quick {
            text += " --quick";
        }
        if let Some(folder) = &self.data {
            text += &format!(" --data {}", folder.display());
        }
        if let Some(file) = &self.npy {
            text += &format!(" --npy {}", file.display());
        }
        if let Some(count) = self.images {
            text += &format!(" --images {count}");
        }
        if self.renderer != RendererName::Triangles {
            text += &format!(" --renderer {:?}", self.renderer).to_lowercase();
        }
        if let Some(file) = &self.model {
            text += &format!(" --model {}", file.display());
        }
        text + &format!(" --seed {}", self.seed)
    }
}
