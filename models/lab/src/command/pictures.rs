//! Images painted from true scenes, for reports to run methods on.

use anyhow::{Context, Result};
use dvp_core::{Image, ImageSize, Scene};
use dvp_net::propose::TRAINED_SIDE;

use crate::hard;
use dvp_cli::command::options::square;
use dvp_cli::format::{DataSet, Sample};
use dvp_cli::paint::{Painter, RendererName};
use dvp_cli::statistics::mean;

/// An image and the scene that it was painted from.
#[derive(Clone)]
pub(super) struct Picture {
    pub(super) stem: String,
    pub(super) truth: Scene<f32>,
    pub(super) image: Image<f32>,
}

/// The first `count` scenes of a data set, painted in float pixels: as the reference's evaluation does, which does not
/// take the 8-bit files either. Scenes without a size get the square that networks are trained on.
pub(super) fn painted(data: &DataSet<f32>, count: usize, renderer: RendererName) -> Result<Vec<Picture>> {
    let painter = Painter::from(renderer);
    let picture = |sample: &Sample| {
        let (truth, size) = scene(data, sample)?;
        let size = size.map_or_else(|| square(TRAINED_SIDE), Ok)?;
        Ok(Picture { stem: sample.stem.clone(), image: painter.paint(&truth, size)?, truth })
    };
    data.samples.iter().take(count).map(picture).collect()
}

/// Pairs of objects of one prototype and color whose centers are `gap` apart.
pub(super) fn twins(gap: f32, count: u64) -> Result<Vec<Picture>> {
    let (painter, size) = (Painter::from(RendererName::Triangles), square(TRAINED_SIDE)?);
    let picture = |index| {
        let truth = hard::twins(gap, index);
        Ok(Picture { stem: format!("twins-{index:05}"), image: painter.paint(&truth, size)?, truth })
    };
    (0..count).map(picture).collect()
}

/// The first `count` scenes of a data set with these images.
pub(super) fn given(data: &DataSet<f32>, count: usize, images: Vec<Image<f32>>) -> Result<Vec<Picture>> {
    let picture = |(sample, image): (&Sample, Image<f32>)| {
        Ok(Picture { stem: sample.stem.clone(), image, truth: scene(data, sample)?.0 })
    };
    data.samples.iter().zip(images).take(count).map(picture).collect()
}

fn scene(data: &DataSet<f32>, sample: &Sample) -> Result<(Scene<f32>, Option<ImageSize>)> {
    let (json, place) = sample.scene.as_ref().context("no true scene: a data set needs scenes.jsonl here")?;
    Ok((json.to_scene(Some(&data.bank), place)?, json.size(place)?))
}

/// Mean absolute error of the true scenes, painted as methods paint theirs: what is left of the images that no scene
/// explains.
pub(super) fn floor(pictures: &[Picture]) -> Result<f64> {
    let mut errors = Vec::with_capacity(pictures.len());
    for Picture { truth, image, .. } in pictures {
        let painted = Painter::default().paint(truth, image.size())?;
        let apart = painted.data().iter().zip(image.data()).map(|(a, b)| f64::from((a - b).abs()));
        errors.extend(mean(apart));
    }
    Ok(mean(errors.into_iter()).unwrap_or(f64::NAN))
}
