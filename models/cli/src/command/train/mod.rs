//! `dvp train`: a network that reads scenes off images, learned through the renderer.
//!
//! | file | does |
//! |---|---|
//! | `settings` | what a run is made of, on the command line and in a file |
//! | `data` | batches |
//! | `run` | the steps, on any backend |
//! | `store`, `curves`, `samples` | what it writes while it runs |

mod curves;
mod data;
mod features;
mod run;
mod samples;
mod settings;
mod store;

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use dvp_core::tensor::{Host, HostDevice};

use self::run::Run;
use self::settings::{BackendName, Settings};
use self::store::Store;
use super::{Console, Outcome};
use crate::format::write_atomic;

/// Trains a network that proposes the scene of an image.
///
/// Writes the settings, two checkpoints, the best weights by the image loss on validation images (best.safetensors, for
/// `dvp fit --start` and `dvp evaluate --model`), curves (losses.csv, losses.svg) and sample reconstructions. It may be
/// stopped at any moment: --resume goes on from the last checkpoint, to the same numbers.
#[derive(Debug, Args)]
#[command(args_override_self = true)]
#[command(before_help = "Example: dvp train --out run\n         \
                         dvp train --out run --mode ti+ --start gp/best.safetensors\n         \
                         dvp train --out run --resume")]
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
    let settings = settings.complete()?;
    let run = Run::new(&settings)?;
    write_atomic(&store.path("run.json"), (serde_json::to_string_pretty(&settings)? + "\n").as_bytes())?;
    match settings.backend.unwrap_or_default() {
        BackendName::Host => run.go::<Host>(HostDevice, &store, arguments.resume, console),
        #[cfg(feature = "burn")]
        BackendName::Burn => {
            let device = <dvp_burn::Burn as dvp_core::tensor::Backend>::Device::flex();
            run.go::<dvp_burn::Burn>(device, &store, arguments.resume, console)
        }
        #[cfg(feature = "candle")]
        BackendName::Candle => {
            run.go::<dvp_candle::Candle>(dvp_candle::CandleDevice::CPU, &store, arguments.resume, console)
        }
        #[allow(unreachable_patterns, reason = "no backend is missing if all features are on")]
        other => {
            let name = format!("{other:?}").to_lowercase();
            bail!("this dvp was built without {name}; build it with --features {name}")
        }
    }
}
