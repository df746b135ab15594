//! Runs methods on images, and counts what their scenes spend.

use alloc::sync::Arc;

use anyhow::Result;
use dvp_core::Image;
use dvp_core::loss::{ImagePair, Loss};
use dvp_core::render::PixelLoss;
use dvp_fit::{Bank, FitOptions, Prices, Unexplained};
use dvp_net::propose::Proposer;
use rayon::prelude::*;

use super::spent::{Law, Spent};
use super::traced::Drawn;
use super::truth::Price;
use crate::agreement::Agreement;
use crate::command::pictures::Picture;
use dvp_cli::command::in_words;
use dvp_cli::command::progress;
use dvp_cli::format::{from_rgb8, to_rgb8};
use dvp_cli::method::{Found, Memory, Method, Runner, Task, Tools, seed_of};
use dvp_cli::paint::Painter;
use dvp_cli::spoil::add_noise;
use dvp_cli::svg::to_svg;

/// The methods that are counted, and what their shapes cost.
const METHODS: [(Method, Law); 6] = [
    (Method::SegmentBank, Law::Bank),
    (Method::SegmentFree, Law::Free),
    (Method::OptP, Law::Bank),
    (Method::OptIter, Law::Free),
    (Method::Net, Law::Bank),
    (Method::NetLm, Law::Bank),
];

/// An object found is a true one if what is seen of the two agrees to this IoU.
const SAME: f64 = 0.5;

/// A price by its name, and what takes it off.
type Off = (&'static str, fn(&mut Prices));

/// Prices that are taken off one at a time.
const WITHOUT: [Off; 5] = [
    ("nothing", |_| ()),
    ("object", |prices| prices.object = 0.0),
    ("mixed", |prices| prices.mixed = false),
    ("harmonic", |prices| prices.harmonic = 0.0),
    ("boundary", |prices| prices.boundary = 0.0),
];

/// An image to be explained.
pub(super) struct Subject {
    pub(super) picture: Picture,
    /// What methods are shown; the image of the picture, or that with noise.
    pub(super) shown: Image<f32>,
    pub(super) price: Price,
    /// What the true scene leaves of what is shown, bits.
    left_bits: f64,
    /// Of the true scene.
    svg: Drawn,
}

/// A method to count.
pub(super) struct Contender {
    pub(super) name: String,
    /// The price that it does without.
    pub(super) without: &'static str,
    pub(super) law: Law,
    runner: Runner,
}

/// What a method spent on an image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Figures {
    pub(super) spent: Spent,
    /// Of the true scene, by the same law.
    pub(super) truth: Spent,
    /// Bits of the true scene if objects share no shapes; by a bank they need not.
    pub(super) own_bits: f64,
    /// Objects that are none of the true ones, and true ones that were not found.
    pub(super) surplus: usize,
    pub(super) missing: usize,
    /// Objects that are painted, also those that do not count for want of confidence.
    pub(super) painted: usize,
    /// What the scene, and the true one, leave of the image, bits.
    pub(super) left_bits: f64,
    pub(super) true_left_bits: f64,
    /// Against the image without noise.
    pub(super) mae: f64,
    pub(super) svg: Drawn,
    pub(super) true_svg: Drawn,
    pub(super) ms: f64,
}

/// What came of an image.
pub(super) type Trial = Result<Figures, String>;

impl Subject {
    /// An image as it is, or with noise of a standard deviation, in 8 bits.
    pub(super) fn new(mut picture: Picture, bank: usize, noise: Option<f64>, seed: u64) -> Result<Self> {
        picture.truth.keep_visible();
        let shown = match noise {
            None => picture.image.clone(),
            Some(sigma) => {
                let mut pixels = to_rgb8(picture.image.view())?;
                add_noise(&mut pixels, sigma, seed_of(&picture.stem, seed));
                from_rgb8(&pixels)?
            }
        };
        let size = shown.size();
        let price = Price::of(&picture.truth, size, bank)?;
        let painted = Painter::default().paint(&picture.truth, size)?;
        let left_bits = Unexplained::of(&shown.view(), painted.data()).bits;
        let svg = Drawn::of(&to_svg(&picture.truth, size, None)?);
        Ok(Self { picture, shown, price, left_bits, svg })
    }
}

impl Contender {
    /// The methods with their usual settings.
    pub(super) fn methods(bank: &Bank<f32>, network: Proposer) -> Result<Vec<Self>> {
        let options = FitOptions::default().with_bank(Some(bank.clone()));
        let tools = Tools { options, network: Some(Arc::new(network)) };
        METHODS.iter().map(|&which| Self::new(which, "", &tools)).collect()
    }

    /// Segment-and-fit at all prices, and without each of those that `noisy` pictures or others know.
    pub(super) fn ablations(bank: &Bank<f32>, noisy: bool) -> Result<Vec<Self>> {
        let mut all = Vec::new();
        for &(method, law) in &METHODS[..2] {
            let applies = |without: &str| match without {
                "harmonic" => law == Law::Free,
                "boundary" => noisy,
                _ => true,
            };
            for &(without, change) in WITHOUT.iter().filter(|(without, _)| applies(without)) {
                let mut options = FitOptions::default().with_bank(Some(bank.clone()));
                change(&mut options.prices);
                all.push(Self::new((method, law), without, &Tools { options, network: None })?);
            }
        }
        Ok(all)
    }

    fn new((method, law): (Method, Law), without: &'static str, tools: &Tools) -> Result<Self> {
        let runner = Runner::new(method, method.default_setting(), tools)?;
        Ok(Self { name: method.name(), without, law, runner })
    }

    fn try_one(&self, subject: &Subject, bank: usize, seed: u64, memory: &mut Memory) -> Result<Figures> {
        let Subject { picture, shown, price, left_bits, svg } = subject;
        let seed = seed_of(&picture.stem, seed);
        let task = Task { truth: Some(&picture.truth), seed, ..Task::of(shown.view()) };
        let Found { fit, there, cpu, .. } = self.runner.run(&task, memory)?;
        let painted = fit.scene;
        let size = shown.size();
        let image = Painter::default().paint(&painted, size)?;
        let agreement = Agreement::of(&picture.truth, &there, size)?;
        let met = agreement.matches.iter().flatten().filter(|pair| pair.iou >= SAME).count();
        let own_bits = if self.law == Law::Free { price.own_bits } else { price.by(Law::Bank).bits };
        Ok(Figures {
            spent: Spent::of(&there, bank),
            truth: price.by(self.law),
            own_bits,
            surplus: there.objects.len() - met,
            missing: agreement.expected().saturating_sub(met),
            painted: painted.objects.len(),
            left_bits: Unexplained::of(&shown.view(), image.data()).bits,
            true_left_bits: *left_bits,
            mae: f64::from(PixelLoss::Mae.value(ImagePair::new(image.view(), picture.image.view())?, &mut ())?),
            svg: Drawn::of(&to_svg(&there, size, None)?),
            true_svg: *svg,
            ms: cpu.as_secs_f64() * 1e3,
        })
    }
}

/// Every contender on every image, on all threads; a row of trials per contender.
pub(super) fn run(contenders: &[Contender], subjects: &[Subject], bank: usize, seed: u64) -> Vec<Vec<Trial>> {
    let bar = progress::bar(subjects.len() as u64, 0);
    let one = |memory: &mut Memory, subject: &Subject| {
        let trial =
            |contender: &Contender| contender.try_one(subject, bank, seed, memory).map_err(|error| in_words(&error));
        let trials: Vec<Trial> = contenders.iter().map(trial).collect();
        bar.inc(1);
        trials
    };
    let by_image: Vec<Vec<Trial>> = subjects.par_iter().map_init(Memory::default, one).collect();
    bar.finish_and_clear();
    (0..contenders.len()).map(|k| by_image.iter().map(|trials| trials[k].clone()).collect()).collect()
}
