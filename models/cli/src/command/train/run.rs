//! The steps of a run.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use dvp_core::render::{EdgeProfile, PixelLoss};
use dvp_core::shape::PrototypeBank;
use dvp_core::tensor::{Backend, Host, HostDevice, Parameters};
use dvp_core::{ImageSize, Real};
use dvp_net::error::NetError;
use dvp_net::model::{Model, ModelConfig};
use dvp_net::propose::TRAINED_SIDE;
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::{Batch, Checkpoint, Judge, Mode, Source, Trainer};

use super::course::{Course, Made, Seen, follow};
use super::curves::Curves;
use super::data::{Data, reread};
use super::degrade::Degradation;
use super::features::FeatureCache;
use super::job::{Job, Numbers, fitting, schedule, shapes};
use super::settings::Settings;
use super::store::Store;
use crate::command::sheet::sheet;
use crate::command::{Console, Outcome};
use crate::format::{BitDepth, SceneJson, encode_png, write_atomic};

/// Validation images that are drawn.
const SAMPLES: usize = 8;

/// A run, ready to go.
pub(super) struct Run {
    mode: Mode,
    config: ModelConfig,
    data: Data,
    degradation: Degradation,
    /// The shapes that the model knows, with as many harmonics as it does.
    bank: PrototypeBank<f32>,
    painter: SceneSteps<f32>,
    /// Reads the scenes that images are learned from.
    preliminary: Option<Model<Host>>,
    settings: Settings,
}

impl Run {
    pub(super) fn new(settings: &Settings) -> Result<Self> {
        let (mode, config) = (settings.mode()?, settings.model()?);
        let numbers = Numbers::checked(settings)?;
        if mode.continues() && settings.start.is_none() {
            bail!(
                "mode {mode} goes on from the weights of another run: name them with --start, an early gp for example"
            );
        }
        let (bank, known) = shapes(settings)?;
        let preliminary = settings.preliminary.as_deref().map(model_of).transpose()?;
        // A preliminary model needs no scenes.
        let source = if preliminary.is_some() { Source::Images } else { mode.source() };
        let data = match &settings.data {
            Some(folder) => Data::folder(folder, source, numbers.validation, numbers.seed)?,
            None => {
                let size = ImageSize::new(TRAINED_SIDE, TRAINED_SIDE)?;
                Data::generated(bank, size, numbers.seed, settings.scenes.unwrap_or(0))
            }
        };
        let mut painter = SceneSteps::new(config.objects(), config.harmonics(&known), EdgeProfile::reference())?;
        let weights = painter.weights_mut();
        weights.scale = settings.scale_weight.map_or(weights.scale, f32::of);
        weights.rotation = settings.rotation_weight.map_or(weights.rotation, f32::of);
        let degradation = Degradation::of(settings);
        Ok(Self { mode, config, data, degradation, bank: known, painter, preliminary, settings: settings.clone() })
    }
}

impl Job for Run {
    fn go<B: Backend>(
        &self,
        device: B::Device,
        store: &Store,
        resume: bool,
        console: &mut Console<'_>,
    ) -> Result<Outcome> {
        let numbers = Numbers::of(&self.settings);
        let mut trainer = self.trainer::<B>(&device, numbers.steps)?;
        let mut curves = Curves::of_scenes();
        if resume {
            store.newest(console, Checkpoint::from_bytes)?.resume(&mut trainer, &device)?;
            curves.read(&store.path("losses.csv"), trainer.steps())?;
        } else if let Some(file) = &self.settings.start {
            start_from(&mut trainer, file, &device, console)?;
        }
        let mut held_out = self.data.held_out(numbers.validation, &self.painter)?;
        self.degradation.spoil(&mut held_out, Degradation::HELD_OUT, &self.painter)?;
        let cache = self.feature_cache(&trainer, store)?;
        if self.config.has_frozen_encoder() {
            held_out.features = trainer.features(&held_out.images)?;
        }
        let mut course = SceneCourse { run: self, trainer, held_out: &held_out, cache, store, batch: numbers.batch };
        follow(&mut course, &self.settings, curves, &held_out, "image loss", store, console)
    }
}

/// What is trained, and with what.
struct SceneCourse<'a, B: Backend> {
    run: &'a Run,
    trainer: Trainer<B, f32>,
    held_out: &'a Batch<f32>,
    cache: Option<FeatureCache>,
    store: &'a Store,
    batch: usize,
}

impl<B: Backend> Course for SceneCourse<'_, B> {
    fn steps(&self) -> u64 {
        self.trainer.steps()
    }

    fn numbers(&self) -> usize {
        self.trainer.parameters().value_count()
    }

    fn step(&mut self) -> Result<Made> {
        let Self { run, trainer, cache, .. } = self;
        let mut batch = run.data.batch(trainer.steps(), self.batch, &run.painter)?;
        if let Some(model) = &run.preliminary {
            batch = reread(model, &batch.images, &run.painter)?;
        }
        run.degradation.spoil(&mut batch, trainer.steps(), &run.painter)?;
        if let Some(cache) = cache {
            let items = run.data.numbers(trainer.steps(), self.batch);
            batch.features = cache.features(trainer, &batch.images, &items)?;
        }
        let step = trainer.step(&batch).map_err(|error| run.study(self.store, &batch, trainer, error))?;
        let terms = [step.image, step.parameters];
        Ok(Made { loss: step.loss, terms, gradient: step.gradient, rate: step.rate })
    }

    /// L_x and, where scenes are known, L_p. Samples: the pictures over their reconstructions.
    fn look(&self) -> Result<Seen> {
        let (trainer, held_out) = (&self.trainer, self.held_out);
        let image = trainer.validate(Mode::Ti, held_out)?.image;
        let known = !held_out.scenes.is_empty();
        let parameters = if known { trainer.validate(Mode::Gp, held_out)?.parameters } else { None };
        let some = held_out.part(0, SAMPLES);
        let sheet = sheet(&[some.images.clone(), trainer.reconstruct(&some.images)?])?;
        Ok(Seen { errors: [image, parameters], sheet })
    }

    fn file(&self, resumable: bool, about: &str) -> Result<Vec<u8>> {
        Ok(Checkpoint::of(&self.trainer, resumable, about)?.to_bytes()?)
    }
}

impl Run {
    /// Where features are kept, if the encoder is frozen and images come again as they were.
    fn feature_cache<B: Backend>(&self, trainer: &Trainer<B, f32>, store: &Store) -> Result<Option<FeatureCache>> {
        let comes_again = self.data.is_finite() && self.settings.degraded.unwrap_or(0.0) == 0.0;
        if !self.config.has_frozen_encoder() || !comes_again {
            return Ok(None);
        }
        // What decides which image has which number, and how it is painted again.
        let Settings { data, scenes, seed, validation, bank, preliminary, harmonics, .. } = &self.settings;
        let images = serde_json::to_string(&(data, scenes, seed, validation, bank, preliminary, harmonics))?;
        Ok(Some(FeatureCache::new(store.path("features"), trainer, &images)?))
    }

    fn trainer<B: Backend>(&self, device: &B::Device, steps: u64) -> Result<Trainer<B, f32>> {
        let Settings { clip_norm, threads, seed, .. } = &self.settings;
        let judge = Judge {
            mode: self.mode,
            image_loss: PixelLoss::Mae,
            image_weight: self.settings.image_weight.unwrap_or(1.0),
            steps: self.painter.clone(),
            bank: self.bank.clone(),
        };
        let schedule = schedule(&self.settings, steps);
        let (config, bank, seed) = (self.config.clone(), self.bank.clone(), seed.unwrap_or(1));
        let mut trainer = Trainer::new(config, bank, judge, schedule, seed, device.clone())?;
        trainer.clip_norm = clip_norm.filter(|norm| *norm > 0.0);
        trainer.threads = threads.unwrap_or(1);
        Ok(trainer)
    }

    /// Keeps the batch of a step that failed.
    fn study<B: Backend>(
        &self,
        store: &Store,
        batch: &Batch<f32>,
        trainer: &Trainer<B, f32>,
        error: NetError,
    ) -> anyhow::Error {
        if !matches!(error, NetError::NotFinite { .. }) {
            return error.into();
        }
        let folder = store.path(&format!("failed-{:08}", trainer.steps() + 1));
        match self.write_failed(&folder, batch, trainer) {
            Ok(()) => anyhow::Error::from(error).context(format!("batch and weights are in {}", folder.display())),
            Err(second) => anyhow::Error::from(error).context(format!("and the batch was not written: {second:#}")),
        }
    }

    fn write_failed<B: Backend>(&self, folder: &Path, batch: &Batch<f32>, trainer: &Trainer<B, f32>) -> Result<()> {
        let mut lines = String::new();
        for (k, image) in batch.images.iter().enumerate() {
            let path = folder.join(format!("{k:05}.png"));
            write_atomic(&path, &encode_png(image.view(), BitDepth::Eight)?)?;
            if let Some(scene) = batch.scenes.get(k) {
                let mut json = SceneJson::from_scene(scene, image.size())?;
                json.id = Some(k as u64);
                lines += &(json.to_line(&crate::format::Place::file(&path))? + "\n");
            }
        }
        if !lines.is_empty() {
            write_atomic(&folder.join(crate::format::SCENES_FILE), lines.as_bytes())?;
        }
        let weights = Checkpoint::of(trainer, true, &serde_json::to_string(&self.settings)?)?;
        Ok(write_atomic(&folder.join("weights.safetensors"), &weights.to_bytes()?)?)
    }
}

/// The model of a file of ours.
fn model_of(file: &Path) -> Result<Model<Host>> {
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    let model = Checkpoint::from_bytes(&bytes).and_then(|checkpoint| checkpoint.model(&HostDevice));
    model.with_context(|| file.display().to_string())
}

/// Takes weights of a file of ours, or of published ones for the encoder. Weights of other extents than the model's, as in
/// heads for other shapes, are named and start anew.
fn start_from<B: Backend>(
    trainer: &mut Trainer<B, f32>,
    file: &Path,
    device: &B::Device,
    console: &mut Console<'_>,
) -> Result<()> {
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    let named = || file.display().to_string();
    let weights = match dvp_core::tensor::safetensors_note(&bytes).with_context(named)? {
        Some(_) => Checkpoint::from_bytes(&bytes).with_context(named)?.weights(device)?,
        None => published(&Parameters::from_safetensors(&bytes, device).with_context(named)?)?,
    };
    let fitting = fitting(trainer.parameters(), &weights, file, console)?;
    trainer.set_weights(&fitting).with_context(named)
}

/// Published weights of an encoder, under the path where a model has them.
fn published<B: Backend>(weights: &Parameters<B>) -> Result<Parameters<B>> {
    let mut encoder = Parameters::new();
    for (name, tensor) in weights.iter().filter(|(name, _)| !name.ends_with("mask_token")) {
        encoder.insert(format!("encoder.{name}"), tensor)?;
    }
    Ok(encoder)
}
