//! What happens to pictures on their way.

use anyhow::{Result, anyhow};
use image::RgbImage;

use super::Case;
use super::base::{SIDE, mds_hr, whole};
use dvp_cli::command::options::square;
use dvp_cli::format::{from_rgb8, to_rgb8};
use dvp_cli::paint::Painter;
use dvp_cli::spoil;

/// Gaussian noise of standard deviation `level`.
pub(super) fn noisy(level: f64, seed: u64) -> Result<Case> {
    spoiled(seed, |mut picture| {
        spoil::add_noise(&mut picture, level, seed);
        Ok(picture)
    })
}

/// JPEG of quality `level`.
pub(super) fn compressed(level: f64, seed: u64) -> Result<Case> {
    spoiled(seed, |picture| {
        let bytes = spoil::jpeg(&picture, u8::try_from(whole(level))?).map_err(|error| anyhow!(error))?;
        Ok(image::load_from_memory(&bytes)?.to_rgb8())
    })
}

/// A Gaussian blur of standard deviation `level` px.
pub(super) fn blurred(level: f64, seed: u64) -> Result<Case> {
    spoiled(seed, |picture| Ok(if level > 0.0 { spoil::blurred(&picture, level) } else { picture }))
}

fn spoiled(seed: u64, spoil: impl FnOnce(RgbImage) -> Result<RgbImage>) -> Result<Case> {
    let truth = mds_hr(seed)?;
    let picture = to_rgb8(Painter::default().paint(&truth, square(SIDE)?)?.view())?;
    Ok(Case { image: from_rgb8(&spoil(picture)?)?, truth, start: None })
}
