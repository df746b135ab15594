//! The steps of a run that trains a second look.

use std::fs;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use dvp_core::ImageSize;
use dvp_core::render::EdgeProfile;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::Backend;
use dvp_net::look::LookConfig;
use dvp_net::propose::TRAINED_SIDE;
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::{Batch, LookFile, LookTrainer, Source};

use super::curves::{Curves, Entry};
use super::data::Data;
use super::job::{Job, LINE_EVERY, Numbers, Recent, fitting, schedule, shapes};
use super::settings::Settings;
use super::store::Store;
use crate::command::sheet::sheet;
use crate::command::{Console, Outcome, progress};
use crate::format::{BitDepth, encode_png, write_atomic};

/// Validation images that are drawn.
const SAMPLES: usize = 8;

/// A run, ready to go.
pub(super) struct LookRun {
    config: LookConfig,
    data: Data,
    /// The shapes that it tells apart.
    bank: PrototypeBank<f32>,
    painter: SceneSteps<f32>,
    settings: Settings,
}

impl LookRun {
    pub(super) fn new(settings: &Settings) -> Result<Self> {
        let config = settings.look()?;
        let numbers = Numbers::checked(settings)?;
        let (bank, known) = shapes(settings)?;
        let data = match &settings.data {
            Some(folder) => Data::folder(folder, Source::Scenes, numbers.validation, numbers.seed)?,
            None => {
                let size = ImageSize::new(TRAINED_SIDE, TRAINED_SIDE)?;
                Data::generated(bank, size, numbers.seed, settings.scenes.unwrap_or(0))
            }
        };
        let painter = SceneSteps::new(1, known.harmonic_count(), EdgeProfile::reference())?;
        Ok(Self { config, data, bank: known, painter, settings: settings.clone() })
    }

    fn trainer<B: Backend>(&self, device: &B::Device, steps: u64) -> Result<LookTrainer<B, f32>> {
        let Settings { clip_norm, seed, .. } = &self.settings;
        let (config, bank, seed) = (self.config.clone(), self.bank.clone(), seed.unwrap_or(1));
        let (edge, schedule) = (self.painter.edge(), schedule(&self.settings, steps));
        let mut trainer = LookTrainer::new(config, bank, edge, schedule, seed, device.clone())?;
        trainer.clip_norm = clip_norm.filter(|norm| *norm > 0.0);
        Ok(trainer)
    }

    /// By how much the objects of the validation images are off after the look, and the cross entropy of their shapes; some are drawn: the
    /// picture, what was seen, what the look made of it.
    fn look<B: Backend>(
        &self,
        trainer: &LookTrainer<B, f32>,
        held_out: &Batch<f32>,
        store: &Store,
    ) -> Result<[Option<f64>; 2]> {
        let step = trainer.validate(held_out)?;
        let some = held_out.part(0, SAMPLES);
        let [before, after] = trainer.corrected(&some)?;
        let grid = sheet(&[some.images, before, after])?;
        let path = store.path("samples").join(format!("{:08}.png", trainer.steps()));
        write_atomic(&path, &encode_png(grid.view(), BitDepth::Eight)?)?;
        Ok([Some(step.moves), Some(step.shapes)])
    }
}

impl Job for LookRun {
    fn go<B: Backend>(
        &self,
        device: B::Device,
        store: &Store,
        resume: bool,
        console: &mut Console<'_>,
    ) -> Result<Outcome> {
        let numbers = Numbers::of(&self.settings);
        let mut trainer = self.trainer::<B>(&device, numbers.steps)?;
        let mut curves = Curves::of_looks();
        if resume {
            store.newest(console, LookFile::from_bytes)?.resume(&mut trainer, &device)?;
            curves.read(&store.path("losses.csv"), trainer.steps())?;
        } else if let Some(file) = &self.settings.start {
            let weights = read_start(file)?.weights(&device)?;
            trainer.set_weights(&fitting(trainer.parameters(), &weights, file, console)?)?;
        }
        let held_out = self.data.held_out(numbers.validation, &self.painter)?;
        let (clock, before) = (Instant::now(), curves.seconds());
        let bar = progress::bar(numbers.steps, trainer.steps());
        let mut recent = Recent::default();
        let about = serde_json::to_string(&self.settings)?;
        while trainer.steps() < numbers.steps {
            let batch = self.data.batch(trainer.steps(), numbers.batch, &self.painter)?;
            let step = trainer.step(&batch)?;
            recent.add(step.loss);
            let save = step.number.is_multiple_of(numbers.save_every) || step.number == numbers.steps;
            let seen = if save { self.look(&trainer, &held_out, store)? } else { [None; 2] };
            if save || step.number.is_multiple_of(LINE_EVERY) {
                let improved = save && curves.best().is_none_or(|best| seen[0] < Some(best));
                let (loss, seconds) = (recent.take(), before + clock.elapsed().as_secs_f64());
                let terms = [Some(step.moves), Some(step.shapes)];
                let (gradient, rate) = (step.gradient, step.rate);
                curves.push(&Entry { step: step.number, loss, terms, gradient, rate, seconds, seen });
                bar.set_message(format!("loss {loss:.4}"));
                if save {
                    let file = |resumable| Ok(LookFile::of(&trainer, resumable, &about)?.to_bytes()?);
                    store.keep(step.number, &curves, improved, file)?;
                }
            }
            bar.set_position(step.number);
        }
        bar.finish_and_clear();
        let (parameters, seconds) = (trainer.parameters().value_count(), before + clock.elapsed().as_secs_f64());
        writeln!(console.out, "{parameters} numbers, {}", numbers.made(trainer.steps(), seconds))?;
        let best = curves.best().unwrap_or(f64::NAN);
        writeln!(console.out, "objects of {} validation images are off by {best:.5}", held_out.images.len())?;
        writeln!(console.out, "{}", store.path("best.safetensors").display())?;
        Ok(Outcome::Done)
    }
}

/// The weights that a run starts from.
fn read_start(file: &Path) -> Result<LookFile> {
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    LookFile::from_bytes(&bytes).with_context(|| file.display().to_string())
}
