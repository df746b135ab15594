//! A network instead of a folder of predictions: images to scenes while they are scored.

use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use cpu_time::ThreadTime;
use dvp_core::render::Compositing;
use dvp_core::{ImageView, Scene};
use dvp_fit::refine::RefineScratch;
use dvp_net::optimize::OptZ;
use dvp_net::propose::Proposer;

use crate::command::network;

/// What is said of a network on the command line.
#[derive(Debug, Args)]
pub(super) struct NetworkArguments {
    /// Weights of a network, as `dvp train` writes them: it predicts, and DATA alone is named
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Where scenes come from instead of a folder of predictions [default: net]
    #[arg(long, value_enum)]
    method: Option<Method>,
    /// What is done with what the network sees
    #[arg(long, value_enum, default_value_t)]
    then: Then,
    /// Instead of DATA so many scenes of MDS-HR, in float pixels: those of `dvp generate` with the same seed
    #[arg(long, value_name = "N")]
    pub(super) generated: Option<u64>,
    /// Number that generated scenes and random starts are drawn from; better not one that was trained with
    #[arg(long, default_value_t = 1234)]
    pub(super) seed: u64,
}

/// Where scenes come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Method {
    /// A network
    #[default]
    Net,
    /// The paper's Rand-OptP: Adam from a random scene of as many disks as there are objects; no network
    RandOptP,
    /// The paper's Rand-OptZ: Adam from random latents, through the heads of the network
    RandOptZ,
}

/// What is done with what the network sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Then {
    /// Nothing
    #[default]
    None,
    /// The paper's OptP: 100 steps of Adam on pose and color
    OptP,
    /// The paper's OptZ: 100 steps of Adam on the latents
    OptZ,
    /// Levenberg-Marquardt from the objects that are there, as `dvp fit --start net`
    Refine,
}

/// Finds the scenes of images.
#[derive(Debug)]
pub(super) struct Finder {
    network: Option<Proposer>,
    method: Method,
    then: Then,
    seed: u64,
}

/// What was found in an image.
#[derive(Debug)]
pub(super) struct Found {
    /// The scene that is painted: of the paper's methods with every slot, opaque as it is confident.
    pub(super) scene: Scene<f32>,
    /// Its objects of a confidence above 1/2: those that count.
    pub(super) there: Scene<f32>,
    /// Processor time on this thread.
    pub(super) cpu_ms: f64,
}

impl NetworkArguments {
    /// Whether scenes are found rather than read.
    pub(super) fn are_asked(&self) -> bool {
        self.model.is_some() || self.method.is_some() || self.generated.is_some()
    }

    pub(super) fn finder(&self) -> Result<Finder> {
        let method = self.method.unwrap_or_default();
        if method != Method::Net && self.then != Then::None {
            bail!("--then goes on from what a network sees: leave --method away");
        }
        if method == Method::RandOptP && self.model.is_some() {
            bail!("--method rand-opt-p uses no network: leave --model away");
        }
        let network = if method == Method::RandOptP { None } else { Some(network::load(self.model.as_deref())?) };
        Ok(Finder { network, method, then: self.then, seed: self.seed })
    }
}

impl Finder {
    /// The scene of an image; `truth` tells Rand-OptP how many objects there are.
    pub(super) fn find(
        &self,
        image: ImageView<'_, f32>,
        stem: &str,
        truth: Option<&Scene<f32>>,
        scratch: &mut RefineScratch<f32>,
    ) -> Result<Found> {
        let clock = ThreadTime::try_now().context("the system has no thread clock")?;
        let scene = match &self.network {
            None => {
                let truth = truth.context("rand-opt-p must know how many objects there are (scenes.jsonl)")?;
                let start = network::random_start(None, truth.objects.len(), self.seed, stem);
                network::rand_opt_p(image, &start)?.scene
            }
            Some(proposer) if self.method == Method::RandOptZ => {
                proposer.rand_opt_z(image, &OptZ::default(), network::seed_of(stem, self.seed))?.scene
            }
            Some(proposer) => match self.then {
                Then::None => proposer.propose(image)?,
                Then::OptP => network::opt_p(image, &proposer.propose(image)?)?.scene,
                Then::OptZ => proposer.opt_z(image, &OptZ::default())?.scene,
                Then::Refine => {
                    let start = proposer.there(&proposer.propose(image)?);
                    network::refine(image, &start, Compositing::default(), usize::MAX, scratch)?.scene
                }
            },
        };
        let cpu_ms = clock.try_elapsed().context("the system has no thread clock")?.as_secs_f64() * 1e3;
        let mut there = scene.clone();
        there.keep_visible();
        Ok(Found { scene, there, cpu_ms })
    }
}
