//! Scenes to score on that are drawn at random.

use std::path::PathBuf;

use anyhow::{Result, bail};
use dvp_net::propose::TRAINED_SIDE;

use super::options::square;
use crate::format::{DataSet, Place, Sample, SceneJson, mdshr_bank};
use crate::generate::{SceneSettings, sample_scene};

/// `count` scenes of MDS-HR as a data set without pictures.
///
/// # Errors
/// If `count` is 0.
pub fn mds_hr(count: u64, seed: u64) -> Result<DataSet<f32>> {
    if count == 0 {
        bail!("--generated must be at least 1");
    }
    scenes(&SceneSettings::mds_hr(), count, seed)
}

/// `count` scenes of the shapes of MDS-HR as a data set without pictures.
///
/// # Errors
/// If a scene cannot be written down, which the settings of this crate do not bring about.
pub fn scenes(settings: &SceneSettings, count: u64, seed: u64) -> Result<DataSet<f32>> {
    let (bank, size) = (mdshr_bank(), square(TRAINED_SIDE)?);
    let place = Place::file(&PathBuf::from("generated"));
    let sample = |index| {
        let scene = sample_scene(settings, &bank, size, seed, index);
        Ok(Sample {
            stem: format!("{index:05}"),
            image: PathBuf::new(),
            scene: Some((SceneJson::from_scene(&scene, size)?, place.clone())),
            labels: None,
        })
    };
    Ok(DataSet { samples: (0..count).map(sample).collect::<Result<_>>()?, bank })
}
