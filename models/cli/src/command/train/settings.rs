//! What a run of training is made of: on the command line and, under the same names, in a file.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::{Args, ValueEnum};
use dvp_net::decompose::DecomposerConfig;
use dvp_net::decompose::monet::MonetConfig;
use dvp_net::decompose::slots::SlotsConfig;
use dvp_net::look::LookConfig;
use dvp_net::model::ModelConfig;
use dvp_net::train::Mode;
use serde::{Deserialize, Serialize};

use crate::format::read_text;

/// The settings of a run. What is not said has the default named with it.
#[derive(Clone, Debug, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Settings {
    /// What is trained [scene]
    #[arg(long, value_enum)]
    pub(super) model: Option<ModelName>,
    /// What it learns from: ti, gp, gi, tp, ti+ or ti-tp, as in the paper, or gp-gi [gp]
    #[arg(long)]
    pub(super) mode: Option<String>,
    /// What computes [host]
    #[arg(long, value_enum)]
    pub(super) backend: Option<BackendName>,
    /// Size of the model: tiny, small, cells, paper (of monet and slots tiny, small, published; of look tiny, small), or a JSON file of sizes [small]
    #[arg(long, value_name = "SIZE")]
    pub(super) size: Option<String>,
    /// Folder of pictures to learn from, with their scenes for gp and gi; else MDS-HR scenes are generated
    #[arg(long, value_name = "DIR")]
    pub(super) data: Option<PathBuf>,
    /// Number of generated scenes, seen again and again; 0: never the same twice [0]
    #[arg(long, value_name = "N")]
    pub(super) scenes: Option<u64>,
    /// Share of the pictures, 0 to 1, that are spoiled before the network sees them: noise, blur, JPEG, objects that hide one
    /// another; what it should see stays clean [0]
    #[arg(long, value_name = "SHARE")]
    pub(super) degraded: Option<f64>,
    /// Preliminary model (safetensors) whose reading of the images stands for their scenes: gp and gi then learn from
    /// pictures alone
    #[arg(long, value_name = "FILE")]
    pub(super) preliminary: Option<PathBuf>,
    /// Shapes that the model knows: mdshr or a bank file [mdshr]
    #[arg(long, value_name = "BANK")]
    pub(super) bank: Option<String>,
    /// Harmonics of the shapes that the model knows [16]
    #[arg(long, value_name = "N")]
    pub(super) harmonics: Option<usize>,
    /// Weights to start from: of another run, or published ones of the encoder (safetensors)
    #[arg(long, value_name = "FILE")]
    pub(super) start: Option<PathBuf>,
    /// Steps [20000]
    #[arg(long, value_name = "N")]
    pub(super) steps: Option<u64>,
    /// Images per step [32]
    #[arg(long, value_name = "N")]
    pub(super) batch: Option<usize>,
    /// Largest learning rate [0.0005]
    #[arg(long, value_name = "RATE")]
    pub(super) learning_rate: Option<f64>,
    /// Steps over which the rate rises [500]
    #[arg(long, value_name = "N")]
    pub(super) warm_up: Option<u64>,
    /// Whether the rate falls to 0 along a cosine by the last step [true]
    #[arg(long, value_name = "BOOL")]
    pub(super) cosine: Option<bool>,
    /// Longest gradient; 0: as long as it is [1]
    #[arg(long, value_name = "LENGTH")]
    pub(super) clip_norm: Option<f64>,
    /// Factor on L_x where L_p is there too [1]
    #[arg(long, value_name = "FACTOR")]
    pub(super) image_weight: Option<f64>,
    /// Weight of scales in L_p [1]
    #[arg(long, value_name = "WEIGHT")]
    pub(super) scale_weight: Option<f64>,
    /// Weight of rotations in L_p [0.05]
    #[arg(long, value_name = "WEIGHT")]
    pub(super) rotation_weight: Option<f64>,
    /// Pixels along a side of the images of monet and slots, which are resampled or generated so: 64 or 128, say [64]
    #[arg(long, value_name = "N")]
    pub(super) side: Option<usize>,
    /// Parts of a batch that are worked on at the same time [1]
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,
    /// Number that weights, scenes and their order are drawn from [1]
    #[arg(long, value_name = "N")]
    pub(super) seed: Option<u64>,
    /// Steps between checkpoints, and between looks at the validation images [500]
    #[arg(long, value_name = "N")]
    pub(super) save_every: Option<u64>,
    /// Validation images: generated, or the last ones of --data [128]
    #[arg(long, value_name = "N")]
    pub(super) validation: Option<usize>,
}

/// Models that can be trained.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum ModelName {
    /// The paper's: proposes the scene of an image, through the renderer
    #[default]
    Scene,
    /// MONet: divides an image into masks and what they show; learns from images alone
    Monet,
    /// Slot Attention: parts compete for the places of an image; learns from images alone
    Slots,
    /// A second look: puts objects right that were found, one by one; learns from scenes that are shaken
    Look,
}

/// Frameworks to compute with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum BackendName {
    /// Our own, always there
    #[default]
    Host,
    /// burn, if built with --features burn
    Burn,
    /// candle, if built with --features candle
    Candle,
    /// burn on a graphics card by Vulkan, Metal or DirectX, if built with --features wgpu
    Wgpu,
}

impl Settings {
    /// Reads a file of settings.
    pub(super) fn read(path: &Path) -> Result<Self> {
        let text = read_text(path)?;
        serde_json::from_slice(&text).with_context(|| format!("{}: no settings of a run", path.display()))
    }

    /// These where they are said, else `others`.
    pub(super) fn or(&self, others: &Self) -> Result<Self> {
        let (own, others) = (serde_json::to_value(self)?, serde_json::to_value(others)?);
        let (serde_json::Value::Object(own), serde_json::Value::Object(mut all)) = (own, others) else {
            return Ok(self.clone());
        };
        all.extend(own.into_iter().filter(|(_, value)| !value.is_null()));
        Ok(serde_json::from_value(serde_json::Value::Object(all))?)
    }

    /// These where they are said, else the defaults: nothing is left open but files.
    pub(super) fn complete(&self) -> Result<Self> {
        let both = Self {
            model: Some(self.model.unwrap_or_default()),
            backend: Some(BackendName::default()),
            size: Some("small".into()),
            scenes: Some(0),
            steps: Some(20_000),
            batch: Some(32),
            learning_rate: Some(5e-4),
            warm_up: Some(500),
            cosine: Some(true),
            clip_norm: Some(1.0),
            seed: Some(1),
            save_every: Some(500),
            validation: Some(128),
            ..Self::default()
        };
        self.or(&match self.model.unwrap_or_default() {
            ModelName::Scene => Self {
                mode: Some("gp".into()),
                degraded: Some(0.0),
                bank: Some("mdshr".into()),
                harmonics: Some(16),
                image_weight: Some(1.0),
                scale_weight: Some(1.0),
                rotation_weight: Some(0.05),
                threads: Some(1),
                ..both
            },
            ModelName::Monet | ModelName::Slots => Self { side: Some(64), ..both },
            ModelName::Look => Self { bank: Some("mdshr".into()), harmonics: Some(16), degraded: Some(0.0), ..both },
        })
    }

    /// Refuses what is said that is out of range or means nothing to the model.
    pub(super) fn check(&self) -> Result<()> {
        if let Some(share) = self.degraded.filter(|share| !(0.0..=1.0).contains(share)) {
            bail!("--degraded {share}: a share of the pictures is 0 to 1");
        }
        let model = self.model.unwrap_or_default();
        let of_scenes = [
            ("--mode", self.mode.is_some()),
            ("--preliminary", self.preliminary.is_some()),
            ("--image-weight", self.image_weight.is_some()),
            ("--scale-weight", self.scale_weight.is_some()),
            ("--rotation-weight", self.rotation_weight.is_some()),
            ("--threads", self.threads.is_some()),
        ];
        let of_looks = [
            ("--bank", self.bank.is_some()),
            ("--harmonics", self.harmonics.is_some()),
            ("--degraded", self.degraded.is_some()),
        ];
        let of_decomposers = [("--side", self.side.is_some())];
        let foreign: Vec<(&str, bool)> = match model {
            ModelName::Scene => of_decomposers.to_vec(),
            ModelName::Monet | ModelName::Slots => [&of_scenes[..], &of_looks].concat(),
            ModelName::Look => [&of_scenes[..], &of_decomposers].concat(),
        };
        match foreign.into_iter().find(|(_, is)| *is) {
            Some((option, _)) if model == ModelName::Scene => bail!("{option} is for --model monet and slots"),
            Some((option, _)) if model == ModelName::Look => {
                bail!("--model look learns from scenes that are shaken, whatever found them: leave {option} away")
            }
            Some((option, _)) => {
                let name = if model == ModelName::Slots { "slots" } else { "monet" };
                bail!("--model {name} learns from images alone, as they are, and knows no shapes: leave {option} away")
            }
            None => Ok(()),
        }
    }

    /// The sizes of a second look.
    pub(super) fn look(&self) -> Result<LookConfig> {
        let name = self.size.as_deref().unwrap_or("small");
        let config = match name {
            "tiny" => LookConfig::tiny(),
            "small" => LookConfig::small(),
            file => {
                let text = fs::read(file).with_context(|| format!("--size {file}: no tiny, small, nor a file"))?;
                serde_json::from_slice(&text).with_context(|| format!("{file}: no sizes of a second look"))?
            }
        };
        config.validate().with_context(|| format!("--size {name}"))?;
        Ok(config)
    }

    /// The sizes of MONet or Slot Attention.
    pub(super) fn decomposer(&self) -> Result<DecomposerConfig> {
        let side = self.side.unwrap_or(64);
        let name = self.size.as_deref().unwrap_or("small");
        let (slots, monet) = (DecomposerConfig::Slots, DecomposerConfig::Monet);
        let config = match (name, self.model == Some(ModelName::Slots)) {
            ("tiny", true) => slots(SlotsConfig::tiny(side)),
            ("tiny", false) => monet(MonetConfig::tiny(side)),
            ("small", true) => slots(SlotsConfig::small(side)),
            ("small", false) => monet(MonetConfig::small(side)),
            ("published", true) => slots(SlotsConfig::published(side)),
            ("published", false) => monet(MonetConfig::published(side)),
            (file, is_slots) => {
                let text =
                    fs::read(file).with_context(|| format!("--size {file}: no tiny, small, published, nor a file"))?;
                let config: DecomposerConfig =
                    serde_json::from_slice(&text).with_context(|| format!("{file}: no sizes of a decomposer"))?;
                let model = if is_slots { "slots" } else { "monet" };
                if config.kind() != model {
                    bail!("{file}: sizes of {}, with --model {model}", config.kind());
                }
                config
            }
        };
        if config.side() != side {
            bail!("--side is {side}, {name} is for images of {} pixels along a side", config.side());
        }
        config.validate().with_context(|| format!("--size {name}"))?;
        Ok(config)
    }

    pub(super) fn mode(&self) -> Result<Mode> {
        self.mode.as_deref().unwrap_or("gp").parse().map_err(anyhow::Error::msg)
    }

    pub(super) fn model(&self) -> Result<ModelConfig> {
        Ok(match self.size.as_deref().unwrap_or("small") {
            "tiny" => ModelConfig::tiny(),
            "small" => ModelConfig::small(),
            "cells" => ModelConfig::cells(),
            "paper" => ModelConfig::paper(),
            file => {
                let text = fs::read(file)
                    .with_context(|| format!("--size {file}: no tiny, small, cells, paper, nor a file"))?;
                serde_json::from_slice(&text).with_context(|| format!("{file}: no sizes of a model"))?
            }
        })
    }
}
