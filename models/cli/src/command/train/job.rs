//! What runs of training have in common, whatever is trained.

use std::path::Path;

use anyhow::{Context, Result, bail};
use dvp_core::shape::{Efd, PrototypeBank};
use dvp_core::tensor::{Backend, Host, HostDevice, Parameters};
use dvp_fit::Bank;
use dvp_net::train::Schedule;

use super::settings::{BackendName, Settings};
use super::store::Store;
use crate::command::options::BankChoice;
use crate::command::{Console, Outcome};

#[cfg(feature = "burn")]
type BurnDevice = <dvp_burn::Burn as Backend>::Device;

/// A run, ready to go.
pub(super) trait Job {
    /// Makes all steps that are left.
    fn go<B: Backend>(
        &self,
        device: B::Device,
        store: &Store,
        resume: bool,
        console: &mut Console<'_>,
    ) -> Result<Outcome>;
}

/// Makes all steps that are left, on the backend of that name.
pub(super) fn go_on(
    backend: BackendName,
    job: &impl Job,
    store: &Store,
    resume: bool,
    console: &mut Console<'_>,
) -> Result<Outcome> {
    match backend {
        BackendName::Host => job.go::<Host>(HostDevice, store, resume, console),
        #[cfg(feature = "burn")]
        BackendName::Burn => job.go::<dvp_burn::Burn>(BurnDevice::flex(), store, resume, console),
        #[cfg(feature = "wgpu")]
        BackendName::Wgpu => job.go::<dvp_burn::Burn>(BurnDevice::wgpu(Default::default()), store, resume, console),
        #[cfg(feature = "candle")]
        BackendName::Candle => job.go::<dvp_candle::Candle>(dvp_candle::CandleDevice::CPU, store, resume, console),
        #[allow(unreachable_patterns, reason = "no backend is missing if all features are on")]
        other => {
            let name = format!("{other:?}").to_lowercase();
            bail!("this dvp was built without {name}; build it with --features {name}")
        }
    }
}

/// The weights of `file` that fit a model's `own`. Those of other extents are named: they start anew.
///
/// # Errors
/// If the model has none of a name.
pub(super) fn fitting<B: Backend>(
    own: &Parameters<B>,
    weights: &Parameters<B>,
    file: &Path,
    console: &mut Console<'_>,
) -> Result<Parameters<B>> {
    let mut fitting = Parameters::new();
    for (name, tensor) in weights.iter() {
        let own = own.get(name).with_context(|| file.display().to_string())?.dims();
        if own == tensor.dims() {
            fitting.insert(name, tensor)?;
        } else {
            writeln!(console.err, "{name} is {} in {}, {own} here: starts anew", tensor.dims(), file.display())?;
        }
    }
    Ok(fitting)
}

/// The shapes of a run, as scenes are drawn with them, and with as many harmonics as a network knows.
pub(super) fn shapes(settings: &Settings) -> Result<(Bank<f32>, PrototypeBank<f32>)> {
    let name = settings.bank.as_deref().unwrap_or("mdshr");
    let bank: Bank<f32> = BankChoice::from(name).load()?.context("--bank none: a model needs shapes")?;
    let harmonics = settings.harmonics.unwrap_or(16);
    if harmonics == 0 {
        bail!("--harmonics must be at least 1");
    }
    let cut = |efd: &Efd<f32>| Efd::new(efd.rows().iter().copied().take(harmonics).collect());
    let known = PrototypeBank::new(bank.prototypes.iter().map(|(_, efd)| cut(efd)).collect());
    Ok((bank, known))
}

/// The rates of a run of so many steps.
pub(super) fn schedule(settings: &Settings, steps: u64) -> Schedule {
    let Settings { learning_rate, warm_up, cosine, .. } = settings;
    Schedule::constant(learning_rate.unwrap_or(5e-4))
        .with_warm_up(warm_up.unwrap_or(0))
        .with_end(cosine.unwrap_or(true).then_some(steps))
}

/// Numbers of a run that are set: [`Settings::complete`] leaves none open.
pub(super) struct Numbers {
    pub(super) steps: u64,
    pub(super) batch: usize,
    pub(super) save_every: u64,
    pub(super) validation: usize,
    pub(super) seed: u64,
}

impl Numbers {
    /// Those of `settings`.
    pub(super) fn of(settings: &Settings) -> Self {
        Self {
            steps: settings.steps.unwrap_or(0),
            batch: settings.batch.unwrap_or(0),
            save_every: settings.save_every.unwrap_or(0),
            validation: settings.validation.unwrap_or(0),
            seed: settings.seed.unwrap_or(0),
        }
    }

    /// How much was done, in words.
    pub(super) fn made(&self, steps: u64, seconds: f64) -> String {
        format!("{steps} steps of {} images, {seconds:.0} s", self.batch)
    }

    /// The same, refused where nothing can be done with them.
    pub(super) fn checked(settings: &Settings) -> Result<Self> {
        let numbers = Self::of(settings);
        if numbers.batch == 0 || numbers.save_every == 0 || numbers.steps == 0 || numbers.validation == 0 {
            bail!("--steps, --batch, --save-every and --validation must be at least 1");
        }
        Ok(numbers)
    }
}
