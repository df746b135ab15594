//! MONet and Slot Attention on every backend: 50 steps from the same weights on the same images, and its gradients.

use dvp_core::real::DType;
use dvp_core::tensor::{Host, Parameters, Tensor};
use dvp_core::{Image, ImageSize, Real};
use dvp_net::decompose::monet::MonetConfig;
use dvp_net::decompose::slots::SlotsConfig;
use dvp_net::decompose::{DecomposerConfig, PartsOf};
use dvp_net::error::NetError;
use dvp_net::train::{DecomposerFile, DecomposerTrainer, Schedule};

use crate::check::{close, gradients_agree, losses_agree};
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

/// Steps of a run.
const STEPS: usize = 50;

/// Four images of 16 x 16: a square of one color on another.
fn images<T: Real>() -> Vec<Image<T>> {
    let size = ImageSize::new(16, 16).unwrap();
    let image = |k: usize| {
        let inside = |place: usize, from: usize| (from..from + 6).contains(&place);
        let value = |at: usize| {
            let (channel, x, y) = (at / 256, at % 16, at / 16 % 16);
            let is_square = inside(x, 1 + 2 * k) && inside(y, 8 - 2 * k);
            T::of(if is_square { 0.9 - 0.3 * channel as f64 } else { 0.1 + 0.2 * ((channel + k) % 3) as f64 })
        };
        Image::from_planar(size, (0..768).map(value).collect()).unwrap()
    };
    (0..4).map(image).collect()
}

/// Sizes for tests, how many weights there are, and the share of the loss that 50 steps leave at the most.
fn all() -> [(DecomposerConfig, usize, f64); 2] {
    let (monet, slots) = (MonetConfig::tiny(16), SlotsConfig::tiny(16));
    [(DecomposerConfig::Monet(monet), 21, 0.7), (DecomposerConfig::Slots(slots), 33, 0.7)]
}

fn trainer<B: Tested, T: Real>(config: &DecomposerConfig) -> Result<DecomposerTrainer<B, T>, NetError> {
    DecomposerTrainer::new(config.clone(), Schedule::constant(5e-3), 3, B::place())
}

fn losses<B: Tested, T: Real>(config: &DecomposerConfig) -> Vec<f64> {
    let (mut trainer, images) = (trainer::<B, T>(config).unwrap(), images::<T>());
    (0..STEPS).map(|_| trainer.step(&images).unwrap().loss).collect()
}

fn fifty_steps<B: Tested>(tally: &Tally) -> Outcome {
    for (config, _, most) in all() {
        let pairs = [
            (DType::F64, losses::<B, f64>(&config), losses::<Host, f64>(&config)),
            (DType::F32, losses::<B, f32>(&config), losses::<Host, f32>(&config)),
        ];
        for (dtype, own, host) in &pairs {
            losses_agree(tally, *dtype, own, host, STEPS)?;
            // Latents, or what slots start from, are drawn anew in every step: the losses of single steps scatter.
            let mean = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64;
            let [first, last] = [mean(&own[..10]), mean(&own[STEPS - 10..])];
            tally.check(last < most * first, || format!("no progress: {own:?}"))?;
        }
    }
    Ok(())
}

/// The gradient of every weight, as the host has it (which its own tests hold against central differences).
fn gradients<B: Tested>(tally: &Tally) -> Outcome {
    fn of<B: Tested>(config: &DecomposerConfig) -> Result<Vec<(String, Vec<f64>)>, NetError> {
        let parameters: Parameters<B> = trainer::<B, f64>(config)?.parameters().clone();
        let decomposer = config.load(&dvp_net::weights::Weights::new(&parameters))?;
        let values: Vec<f64> = images::<f64>().iter().flat_map(|image| image.data().to_vec()).collect();
        let verdict = decomposer.judge(&Tensor::new(values, &[4, 3, 16, 16], &B::place())?, 9)?;
        let gradients = parameters.gradients(&verdict.loss.backward()?);
        gradients.into_iter().map(|(name, tensor)| Ok((name, tensor.to_f64()?))).collect()
    }
    for (config, count, _) in all() {
        gradients_agree(tally, &of::<B>(&config).unwrap(), &of::<Host>(&config).unwrap(), count)?;
    }
    Ok(())
}

/// A file written on one backend is read on another: the host sees the same parts.
fn files<B: Tested>(tally: &Tally) -> Outcome {
    for (config, ..) in all() {
        let (mut trainer, images) = (trainer::<B, f32>(&config).unwrap(), images::<f32>());
        trainer.step(&images).unwrap();
        let bytes = DecomposerFile::of(&trainer, true, "words").unwrap().to_bytes().unwrap();
        let file = DecomposerFile::from_bytes(&bytes).unwrap();
        let mut host = self::trainer::<Host, f32>(&config).unwrap();
        file.resume(&mut host, &Host::place()).unwrap();
        tally.check(host.steps() == 1 && file.about() == "words", || format!("{} steps", host.steps()))?;
        let [own, host] = [trainer.parts(&images).unwrap(), host.parts(&images).unwrap()];
        for (own, host) in own.iter().zip(&host) {
            let values = |parts: &PartsOf| parts.masks().flatten().map(|&m| f64::from(m)).collect::<Vec<_>>();
            close(tally, "masks", &values(own), &values(host), 1e-5)?;
        }
    }
    Ok(())
}

#[test]
fn fifty_steps_everywhere() {
    on_every_backend!(fifty_steps);
}

#[test]
fn gradients_everywhere() {
    on_every_backend!(gradients);
}

#[test]
fn files_everywhere() {
    on_every_backend!(files);
}
