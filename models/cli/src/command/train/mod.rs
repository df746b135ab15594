//! `dvp train`: a network that reads scenes off images, learned through the renderer.
//!
//! | file | does |
//! |---|---|
//! | `settings` | what a run is made of, on the command line and in a file |
//! | `data` | batches |
//! | `degrade` | pictures that are spoiled before a network sees them |
//! | `course` | the steps of a run, whatever is trained |
//! | `job` | what runs have in common; the backends by name |
//! | `run` | the steps of a network that proposes scenes, on any backend |
//! | `parts_run` | those of one that divides images into parts |
//! | `look_run` | those of a second look at what was found |
//! | `store`, `curves` | what it writes while it runs |

mod course;
mod curves;
mod data;
mod degrade;
mod features;
mod job;
mod look_run;
mod parts_run;
mod run;
mod settings;
mod store;

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use self::job::go_on;
use self::look_run::LookRun;
use self::parts_run::PartsRun;
use self::run::Run;
use self::settings::{ModelName, Settings};
use self::store::Store;
use super::{Console, Outcome};
use crate::format::write_atomic;

/// Trains a network that proposes the scene of an image, a second look at what one found, or MONet or Slot Attention, which divide an image into masks.
///
/// Writes the settings, two checkpoints, the best weights by the image loss on validation images (best.safetensors, for
/// `dvp fit --start` and `dvp evaluate --model`), curves (losses.csv, losses.svg) and sample reconstructions. It may be
/// stopped at any moment: --resume goes on from the last checkpoint, to the same numbers.
#[derive(Debug, Args)]
#[command(args_override_self = true)]
#[command(before_help = "Example: dvp train --out run\n         \
                         dvp train --out run --mode ti+ --start gp/best.safetensors\n         \
                         dvp train --out run --resume\n         \
                         dvp train --out masks --model monet --side 64")]
pub struct Arguments {
    /// Folder to write to
    #[arg(long, short, value_name = "DIR")]
    out: PathBuf,
    /// File of settings, as run.json; options on the command line come before it
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Go on with the run in the folder
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    settings: Settings,
}

pub(super) fn run(arguments: &Arguments, console: &mut Console<'_>) -> Result<Outcome> {
    let store = Store::new(&arguments.out);
    let mut settings = arguments.settings.clone();
    if let Some(file) = &arguments.config {
        settings = settings.or(&Settings::read(file)?)?;
    }
    if arguments.resume {
        settings = settings.or(&Settings::read(&store.path("run.json"))?)?;
    } else {
        store.check_new()?;
    }
    settings.check()?;
    let settings = settings.complete()?;
    let backend = settings.backend.unwrap_or_default();
    let write = || -> Result<()> {
        Ok(write_atomic(&store.path("run.json"), (serde_json::to_string_pretty(&settings)? + "\n").as_bytes())?)
    };
    match settings.model.unwrap_or_default() {
        ModelName::Scene => {
            let run = Run::new(&settings)?;
            write()?;
            go_on(backend, &run, &store, arguments.resume, console)
        }
        ModelName::Monet | ModelName::Slots => {
            let run = PartsRun::new(&settings)?;
            write()?;
            go_on(backend, &run, &store, arguments.resume, console)
        }
        ModelName::Look => {
            let run = LookRun::new(&settings)?;
            write()?;
            go_on(backend, &run, &store, arguments.resume, console)
        }
    }
}
