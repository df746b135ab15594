//! The steps of a run that trains a network to divide images into parts.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use dvp_core::render::EdgeProfile;
use dvp_core::tensor::Backend;
use dvp_core::{Image, ImageSize};
use dvp_net::decompose::DecomposerConfig;
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::{Batch, DecomposerFile, DecomposerTrainer, Source};

use super::course::{Course, Made, Seen, follow};
use super::curves::Curves;
use super::data::Data;
use super::job::{Job, Numbers, fitting, schedule};
use super::settings::Settings;
use super::store::Store;
use crate::command::sheet::{of_parts, sheet};
use crate::command::{Console, Outcome};
use crate::format::mdshr_bank;
use crate::paint::Painter;
use crate::score::{Scratch, Truth, score_pixels};
use crate::statistics::mean;

/// Validation images that are drawn.
const SAMPLES: usize = 8;
/// Harmonics of the shapes of generated images.
const HARMONICS: usize = 16;

/// A run, ready to go.
pub(super) struct PartsRun {
    config: DecomposerConfig,
    data: Data,
    painter: SceneSteps<f32>,
    settings: Settings,
}

impl PartsRun {
    pub(super) fn new(settings: &Settings) -> Result<Self> {
        let config = settings.decomposer()?;
        let numbers = Numbers::checked(settings)?;
        let side = config.side();
        let data = match &settings.data {
            Some(folder) => Data::folder(folder, Source::Images, numbers.validation, numbers.seed)?.on_squares(side)?,
            None => {
                let size = ImageSize::new(side, side)?;
                Data::generated(mdshr_bank(), size, numbers.seed, settings.scenes.unwrap_or(0))
            }
        };
        let painter = SceneSteps::new(1, HARMONICS, EdgeProfile::reference())?;
        Ok(Self { config, data, painter, settings: settings.clone() })
    }

    fn trainer<B: Backend>(&self, device: &B::Device, steps: u64) -> Result<DecomposerTrainer<B, f32>> {
        let Settings { clip_norm, seed, .. } = &self.settings;
        let schedule = schedule(&self.settings, steps);
        let mut trainer = DecomposerTrainer::new(self.config.clone(), schedule, seed.unwrap_or(1), device.clone())?;
        trainer.clip_norm = clip_norm.filter(|norm| *norm > 0.0);
        Ok(trainer)
    }
}

impl Job for PartsRun {
    fn go<B: Backend>(
        &self,
        device: B::Device,
        store: &Store,
        resume: bool,
        console: &mut Console<'_>,
    ) -> Result<Outcome> {
        let numbers = Numbers::of(&self.settings);
        let mut trainer = self.trainer::<B>(&device, numbers.steps)?;
        let mut curves = Curves::of_parts();
        if resume {
            store.newest(console, DecomposerFile::from_bytes)?.resume(&mut trainer, &device)?;
            curves.read(&store.path("losses.csv"), trainer.steps())?;
        } else if let Some(file) = &self.settings.start {
            let weights = read_start(file)?.weights(&device)?;
            trainer.set_weights(&fitting(trainer.parameters(), &weights, file, console)?)?;
        }
        let held_out = self.data.held_out(numbers.validation, &self.painter)?;
        let mut course = PartsCourse { run: self, trainer, held_out: &held_out, batch: numbers.batch };
        follow(&mut course, &self.settings, curves, &held_out, "mean absolute error", store, console)
    }
}

/// What is trained, and with what.
struct PartsCourse<'a, B: Backend> {
    run: &'a PartsRun,
    trainer: DecomposerTrainer<B, f32>,
    held_out: &'a Batch<f32>,
    batch: usize,
}

impl<B: Backend> Course for PartsCourse<'_, B> {
    fn steps(&self) -> u64 {
        self.trainer.steps()
    }

    fn numbers(&self) -> usize {
        self.trainer.parameters().value_count()
    }

    fn step(&mut self) -> Result<Made> {
        let batch = self.run.data.batch(self.trainer.steps(), self.batch, &self.run.painter)?;
        let step = self.trainer.step(&batch.images)?;
        let terms = [Some(step.terms.pixels), Some(step.terms.latents)];
        Ok(Made { loss: step.loss, terms, gradient: step.gradient, rate: step.rate })
    }

    /// Mean absolute error of the reconstructions and, where scenes are known, the adjusted Rand index of the masks.
    fn look(&self) -> Result<Seen> {
        let parts = self.trainer.parts(&self.held_out.images)?;
        let (mut scratch, painter) = (Scratch::default(), Painter::default());
        let (mut errors, mut indices) = (Vec::new(), Vec::new());
        for (k, (parts, image)) in parts.iter().zip(&self.held_out.images).enumerate() {
            let known = self.held_out.scenes.get(k).map(Truth::Scene);
            let (painted, labels) = (parts.reconstruction(), parts.labels());
            let found = (painted.view(), &labels[..]);
            let score = score_pixels(&painter, image.view(), known.as_ref(), found, &mut scratch)?;
            errors.push(score.mae);
            indices.extend(score.masks.map(|masks| masks.ari));
        }
        let rows = parts.iter().zip(&self.held_out.images).take(SAMPLES).map(|(parts, image)| of_parts(image, parts));
        let sheet = sheet(&rows.collect::<Result<Vec<Vec<Image<f32>>>>>()?)?;
        Ok(Seen { errors: [mean(errors.into_iter()), mean(indices.into_iter())], sheet })
    }

    fn file(&self, resumable: bool, about: &str) -> Result<Vec<u8>> {
        Ok(DecomposerFile::of(&self.trainer, resumable, about)?.to_bytes()?)
    }
}

/// The weights that a run starts from.
fn read_start(file: &Path) -> Result<DecomposerFile> {
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    DecomposerFile::from_bytes(&bytes).with_context(|| file.display().to_string())
}
