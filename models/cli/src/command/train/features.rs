//! What a frozen encoder makes of images, on disk: computed when an image first comes, read when it comes again.
//!
//! A file per image, named by its number. Files of other weights or other images have another name; a file that cannot be
//! read is made anew.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use dvp_core::tensor::{Backend, Host, HostDevice, Parameters, Tensor};
use dvp_core::{Image, Real};
use dvp_net::train::{Features, Trainer};

use crate::format::write_atomic;

/// The one array of a file: channels x rows x columns.
const NAME: &str = "features";

/// A folder of features.
#[derive(Debug)]
pub(super) struct FeatureCache {
    folder: PathBuf,
    /// Stands for the weights of the encoder and for which image has which number.
    key: u32,
}

impl FeatureCache {
    /// Features in `folder`, by the encoder of `trainer`; `images` says what decides which image has which number.
    pub(super) fn new<B: Backend>(folder: PathBuf, trainer: &Trainer<B, f32>, images: &str) -> Result<Self> {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(images.as_bytes());
        hasher.update(serde_json::to_string(&trainer.config().encoder)?.as_bytes());
        for (name, weight) in trainer.parameters().iter().filter(|(name, _)| name.starts_with("encoder.")) {
            hasher.update(name.as_bytes());
            weight.to_f64()?.iter().for_each(|value| hasher.update(&value.to_le_bytes()));
        }
        fs::create_dir_all(&folder).with_context(|| format!("{} cannot be made", folder.display()))?;
        Ok(Self { folder, key: hasher.finalize() })
    }

    /// The features of `images`, which have the numbers `items`.
    pub(super) fn features<B: Backend>(
        &self,
        trainer: &Trainer<B, f32>,
        images: &[Image<f32>],
        items: &[u64],
    ) -> Result<Vec<Features<f32>>> {
        let paths: Vec<PathBuf> =
            items.iter().map(|item| self.folder.join(format!("{:08x}-{item:08}.safetensors", self.key))).collect();
        let mut found: Vec<Option<Features<f32>>> = paths.iter().map(|path| read(path)).collect();
        let missing: Vec<usize> = (0..images.len()).filter(|&k| found[k].is_none()).collect();
        let new: Vec<Image<f32>> = missing.iter().map(|&k| images[k].clone()).collect();
        for (&k, features) in missing.iter().zip(trainer.features(&new)?) {
            write(&paths[k], &features)?;
            found[k] = Some(features);
        }
        found.into_iter().collect::<Option<_>>().context("an image has no features")
    }
}

/// The features in a file; none if there is no such file, or it is damaged.
fn read(path: &Path) -> Option<Features<f32>> {
    let file = Parameters::<Host>::from_safetensors(&fs::read(path).ok()?, &HostDevice).ok()?;
    let tensor = file.get(NAME).ok()?;
    let extents = tensor.dims().extents().try_into().ok()?;
    // Files are of f32: exact.
    Some(Features { extents, values: tensor.to_f64().ok()?.into_iter().map(f32::of).collect() })
}

fn write(path: &Path, features: &Features<f32>) -> Result<()> {
    let mut file = Parameters::<Host>::new();
    file.insert(NAME, &Tensor::new(features.values.clone(), &features.extents, &HostDevice)?)?;
    Ok(write_atomic(path, &file.to_safetensors()?)?)
}
