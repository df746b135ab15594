//! A network instead of a folder of predictions: images to scenes while they are scored.

use alloc::sync::Arc;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use dvp_net::decompose::Divider;

use crate::method::{Method, Runner, Tools, load_divider, load_looking};

/// What is said of a network on the command line.
#[derive(Debug, Args)]
pub(super) struct NetworkArguments {
    /// Weights of a network, as `dvp train` writes them: it predicts, and DATA alone is named
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
    /// Weights of second looks, as `dvp train --model look` writes them [default: those that come with the program]
    #[arg(long, value_name = "FILE")]
    look: Option<PathBuf>,
    /// How often the network looks again at the objects that it found; 0: never [default: 3]
    #[arg(long, value_name = "N")]
    looks: Option<usize>,
    /// Where scenes come from instead of a folder of predictions [default: net]
    #[arg(long, value_enum)]
    method: Option<Source>,
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
enum Source {
    /// A network
    #[default]
    Net,
    /// The paper's Opt-Iter with our settings; no network
    OptIter,
    /// The paper's Opt-Iter to the letter; no network
    OptIterPublished,
    /// LIVE with our settings; no network
    Live,
    /// LIVE with its published settings; no network
    LivePublished,
    /// The paper's Rand-OptP: Adam from a random scene of as many disks as there are objects; no network
    RandOptP,
    /// The paper's Rand-OptZ: Adam from random latents, through the heads of the network
    RandOptZ,
    /// MONet of --model: masks and what they show, no scene
    Monet,
    /// Slot Attention of --model: masks and what they show, no scene
    Slots,
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

impl NetworkArguments {
    /// Whether scenes are found rather than read.
    pub(super) fn are_asked(&self) -> bool {
        let again = self.look.is_some() || self.looks.is_some();
        again || self.model.is_some() || self.method.is_some() || self.generated.is_some()
    }

    /// The network that divides pictures instead of finding their scenes, if one is asked.
    pub(super) fn divider(&self) -> Result<Option<Divider>> {
        let kind = match self.method {
            Some(Source::Monet) => "monet",
            Some(Source::Slots) => "slots",
            _ => return Ok(None),
        };
        if self.then != Then::None {
            bail!("--then goes on from scenes, and --method {kind} finds none");
        }
        let file = self
            .model
            .as_deref()
            .with_context(|| format!("--method {kind} needs the weights of a run: --model FILE"))?;
        let divider = load_divider(file)?;
        let found = divider.config().kind();
        if found != kind {
            bail!("{}: weights of --method {found}, not {kind}", file.display());
        }
        Ok(Some(divider))
    }

    /// What finds the scenes, made ready.
    pub(super) fn runner(&self) -> Result<Runner> {
        let source = self.method.unwrap_or_default();
        if source != Source::Net && self.then != Then::None {
            bail!("--then goes on from what a network sees: leave --method away");
        }
        let method = match (source, self.then) {
            (Source::OptIter, _) => Method::OptIter,
            (Source::OptIterPublished, _) => Method::OptIterPublished,
            (Source::Live, _) => Method::Live,
            (Source::LivePublished, _) => Method::LivePublished,
            (Source::RandOptP, _) => Method::RandOptP,
            (Source::RandOptZ, _) => Method::RandOptZ,
            (Source::Monet | Source::Slots, _) => bail!("--method monet and slots find no scenes"),
            (Source::Net, Then::None) => Method::Net,
            (Source::Net, Then::OptP) => Method::NetOptP,
            (Source::Net, Then::OptZ) => Method::OptZ,
            (Source::Net, Then::Refine) => Method::NetLm,
        };
        if !method.needs_network() && self.model.is_some() {
            bail!("--method {} uses no network: leave --model away", method.name());
        }
        if !method.needs_network() && (self.look.is_some() || self.looks.is_some()) {
            bail!("--method {} uses no network: leave --look and --looks away", method.name());
        }
        let load = || load_looking(self.model.as_deref(), self.look.as_deref(), self.looks);
        let network = method.needs_network().then(load).transpose()?;
        let tools = Tools { network: network.map(Arc::new), ..Tools::default() };
        Ok(Runner::new(method, method.default_setting(), &tools)?)
    }
}
