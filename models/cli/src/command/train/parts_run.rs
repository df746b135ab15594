//! The steps of a run that trains a network to divide images into parts.

use std::fs;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use dvp_core::render::EdgeProfile;
use dvp_core::tensor::Backend;
use dvp_core::{Image, ImageSize};
use dvp_net::decompose::DecomposerConfig;
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::{Batch, DecomposerFile, DecomposerTrainer, Source};

use super::curves::{Curves, Entry};
use super::data::Data;
use super::job::{Job, LINE_EVERY, Numbers, Recent, fitting, schedule};
use super::settings::Settings;
use super::store::Store;
use crate::command::sheet::{of_parts, sheet};
use crate::command::{Console, Outcome, progress};
use crate::format::{BitDepth, encode_png, mdshr_bank, write_atomic};
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

    /// Mean absolute error of the reconstructions of the validation images and, where their scenes are known, the adjusted Rand
    /// index of their masks; some are drawn.
    fn look<B: Backend>(
        &self,
        trainer: &DecomposerTrainer<B, f32>,
        held_out: &Batch<f32>,
        store: &Store,
    ) -> Result<[Option<f64>; 2]> {
        let parts = trainer.parts(&held_out.images)?;
        let (mut scratch, painter) = (Scratch::default(), Painter::default());
        let (mut errors, mut indices) = (Vec::new(), Vec::new());
        for (k, (parts, image)) in parts.iter().zip(&held_out.images).enumerate() {
            let known = held_out.scenes.get(k).map(Truth::Scene);
            let (painted, labels) = (parts.reconstruction(), parts.labels());
            let found = (painted.view(), &labels[..]);
            let score = score_pixels(&painter, image.view(), known.as_ref(), found, &mut scratch)?;
            errors.push(score.mae);
            indices.extend(score.masks.map(|masks| masks.ari));
        }
        let rows = parts.iter().zip(&held_out.images).take(SAMPLES).map(|(parts, image)| of_parts(image, parts));
        let sheet = sheet(&rows.collect::<Result<Vec<Vec<Image<f32>>>>>()?)?;
        let path = store.path("samples").join(format!("{:08}.png", trainer.steps()));
        write_atomic(&path, &encode_png(sheet.view(), BitDepth::Eight)?)?;
        Ok([mean(errors.into_iter()), mean(indices.into_iter())])
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
        let (clock, before) = (Instant::now(), curves.seconds());
        let bar = progress::bar(numbers.steps, trainer.steps());
        let mut recent = Recent::default();
        let about = serde_json::to_string(&self.settings)?;
        while trainer.steps() < numbers.steps {
            let batch = self.data.batch(trainer.steps(), numbers.batch, &self.painter)?;
            let step = trainer.step(&batch.images)?;
            recent.add(step.loss);
            let save = step.number.is_multiple_of(numbers.save_every) || step.number == numbers.steps;
            let seen = if save { self.look(&trainer, &held_out, store)? } else { [None; 2] };
            if save || step.number.is_multiple_of(LINE_EVERY) {
                let improved = save && curves.best().is_none_or(|best| seen[0] < Some(best));
                let (loss, seconds) = (recent.take(), before + clock.elapsed().as_secs_f64());
                let terms = [Some(step.terms.pixels), Some(step.terms.latents)];
                let (gradient, rate) = (step.gradient, step.rate);
                curves.push(&Entry { step: step.number, loss, terms, gradient, rate, seconds, seen });
                bar.set_message(format!("loss {loss:.4}"));
                if save {
                    let file = |resumable| Ok(DecomposerFile::of(&trainer, resumable, &about)?.to_bytes()?);
                    store.keep(step.number, &curves, improved, file)?;
                }
            }
            bar.set_position(step.number);
        }
        bar.finish_and_clear();
        let (parameters, seconds) = (trainer.parameters().value_count(), before + clock.elapsed().as_secs_f64());
        writeln!(console.out, "{parameters} numbers, {}", numbers.made(trainer.steps(), seconds))?;
        let best = curves.best().unwrap_or(f64::NAN);
        writeln!(console.out, "mean absolute error on {} validation images: {best:.5}", held_out.images.len())?;
        writeln!(console.out, "{}", store.path("best.safetensors").display())?;
        Ok(Outcome::Done)
    }
}

/// The weights that a run starts from.
fn read_start(file: &Path) -> Result<DecomposerFile> {
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    DecomposerFile::from_bytes(&bytes).with_context(|| file.display().to_string())
}
