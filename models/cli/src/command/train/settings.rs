//! What a run of training is made of: on the command line and, under the same names, in a file.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Args, ValueEnum};
use dvp_net::model::ModelConfig;
use dvp_net::train::Mode;
use serde::{Deserialize, Serialize};

use crate::format::read_text;

/// The settings of a run. What is not said has the default named with it.
#[derive(Clone, Debug, Default, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct Settings {
    /// What it learns from: ti, gp, gi, tp, ti+ or ti-tp, as in the paper, or gp-gi [gp]
    #[arg(long)]
    pub(super) mode: Option<String>,
    /// What computes [host]
    #[arg(long, value_enum)]
    pub(super) backend: Option<BackendName>,
    /// Size of the model: tiny, small, cells, paper, or a JSON file of sizes [small]
    #[arg(long, value_name = "SIZE")]
    pub(super) size: Option<String>,
    /// Folder of pictures to learn from, with their scenes for gp and gi; else MDS-HR scenes are generated
    #[arg(long, value_name = "DIR")]
    pub(super) data: Option<PathBuf>,
    /// Number of generated scenes, seen again and again; 0: never the same twice [0]
    #[arg(long, value_name = "N")]
    pub(super) scenes: Option<u64>,
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
        self.or(&Self {
            mode: Some("gp".into()),
            backend: Some(BackendName::default()),
            size: Some("small".into()),
            data: None,
            scenes: Some(0),
            preliminary: None,
            bank: Some("mdshr".into()),
            harmonics: Some(16),
            start: None,
            steps: Some(20_000),
            batch: Some(32),
            learning_rate: Some(5e-4),
            warm_up: Some(500),
            cosine: Some(true),
            clip_norm: Some(1.0),
            image_weight: Some(1.0),
            scale_weight: Some(1.0),
            rotation_weight: Some(0.05),
            threads: Some(1),
            seed: Some(1),
            save_every: Some(500),
            validation: Some(128),
        })
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
