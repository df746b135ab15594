//! The steps of a run that trains a second look.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use dvp_core::ImageSize;
use dvp_core::render::EdgeProfile;
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::Backend;
use dvp_net::look::LookConfig;
use dvp_net::propose::TRAINED_SIDE;
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::{Batch, LookFile, LookTrainer, Source};

use super::course::{Course, Made, Seen, follow};
use super::curves::Curves;
use super::data::Data;
use super::degrade::Degradation;
use super::job::{Job, Numbers, fitting, schedule, shapes};
use super::settings::Settings;
use super::store::Store;
use crate::command::sheet::sheet;
use crate::command::{Console, Outcome};

/// Validation images that are drawn.
const SAMPLES: usize = 8;

/// A run, ready to go.
pub(super) struct LookRun {
    config: LookConfig,
    data: Data,
    degradation: Degradation,
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
        let degradation = Degradation::of(settings);
        Ok(Self { config, data, degradation, bank: known, painter, settings: settings.clone() })
    }

    fn trainer<B: Backend>(&self, device: &B::Device, steps: u64) -> Result<LookTrainer<B, f32>> {
        let Settings { clip_norm, seed, .. } = &self.settings;
        let (config, bank, seed) = (self.config.clone(), self.bank.clone(), seed.unwrap_or(1));
        let (edge, schedule) = (self.painter.edge(), schedule(&self.settings, steps));
        let mut trainer = LookTrainer::new(config, bank, edge, schedule, seed, device.clone())?;
        trainer.clip_norm = clip_norm.filter(|norm| *norm > 0.0);
        Ok(trainer)
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
        let mut held_out = self.data.held_out(numbers.validation, &self.painter)?;
        self.degradation.spoil(&mut held_out, Degradation::HELD_OUT, &self.painter)?;
        let mut course = LookCourse { run: self, trainer, held_out: &held_out, batch: numbers.batch };
        follow(&mut course, &self.settings, curves, &held_out, "what objects are off by", store, console)
    }
}

/// What is trained, and with what.
struct LookCourse<'a, B: Backend> {
    run: &'a LookRun,
    trainer: LookTrainer<B, f32>,
    held_out: &'a Batch<f32>,
    batch: usize,
}

impl<B: Backend> Course for LookCourse<'_, B> {
    fn steps(&self) -> u64 {
        self.trainer.steps()
    }

    fn numbers(&self) -> usize {
        self.trainer.parameters().value_count()
    }

    fn step(&mut self) -> Result<Made> {
        let mut batch = self.run.data.batch(self.trainer.steps(), self.batch, &self.run.painter)?;
        self.run.degradation.spoil(&mut batch, self.trainer.steps(), &self.run.painter)?;
        let step = self.trainer.step(&batch)?;
        let terms = [Some(step.moves), Some(step.shapes)];
        Ok(Made { loss: step.loss, terms, gradient: step.gradient, rate: step.rate })
    }

    /// By how much objects are off after the look, and the cross entropy of their shapes. Samples: the picture, what was seen, what the
    /// look made of it.
    fn look(&self) -> Result<Seen> {
        let step = self.trainer.validate(self.held_out)?;
        let some = self.held_out.part(0, SAMPLES);
        let [before, after] = self.trainer.corrected(&some)?;
        Ok(Seen { errors: [Some(step.moves), Some(step.shapes)], sheet: sheet(&[some.images, before, after])? })
    }

    fn file(&self, resumable: bool, about: &str) -> Result<Vec<u8>> {
        Ok(LookFile::of(&self.trainer, resumable, about)?.to_bytes()?)
    }
}

/// The weights that a run starts from.
fn read_start(file: &Path) -> Result<LookFile> {
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    LookFile::from_bytes(&bytes).with_context(|| file.display().to_string())
}
