//! Batches to learn from.

use core::ops::Range;
use std::path::Path;

use anyhow::{Context, Result, bail};
use dvp_core::tensor::{Host, HostDevice};
use dvp_core::{Image, ImageSize, Scene};
use dvp_fit::Bank;
use dvp_net::decompose::on_square;
use dvp_net::model::Model;
use dvp_net::scene_steps::{SceneSteps, image_tensor};
use dvp_net::train::{Batch, Source};
use rand::SeedableRng as _;
use rand::seq::SliceRandom as _;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::format::{DEFAULT_MAX_PIXELS, DataSet, read_picture};
use crate::generate::{SceneSettings, sample_scene};

/// Added to the seed of the scenes for those that are held out.
const HELD_OUT: u64 = 0x5eed;

/// Where batches come from. Batch k is always the same, whatever was asked for before.
pub(super) enum Data {
    /// Scenes drawn at random; so many, or as many as there are steps for.
    Generated { settings: SceneSettings, bank: Bank<f32>, size: ImageSize, seed: u64, count: Option<u64> },
    /// A folder, read whole.
    Folder { all: Batch<f32>, held_out: usize, seed: u64 },
}

impl Data {
    /// MDS-HR scenes of `size`.
    pub(super) fn generated(bank: Bank<f32>, size: ImageSize, seed: u64, count: u64) -> Self {
        let count = (count > 0).then_some(count);
        Self::Generated { settings: SceneSettings::mds_hr(), bank, size, seed, count }
    }

    /// The pictures of a folder on squares of `side` pixels, as a network for such squares sees them. Scenes of pictures that are not
    /// square lose their meaning there, and are left away.
    pub(super) fn on_squares(self, side: usize) -> Result<Self> {
        let Self::Folder { mut all, held_out, seed } = self else { return Ok(self) };
        if all.images.first().is_some_and(|image| image.size().width() != image.size().height()) {
            all.scenes.clear();
        }
        for image in &mut all.images {
            *image = on_square(image.view(), side)?;
        }
        Ok(Self::Folder { all, held_out, seed })
    }

    /// The pictures of a folder; all must have one size.
    pub(super) fn folder(folder: &Path, source: Source, held_out: usize, seed: u64) -> Result<Self> {
        let data = DataSet::<f32>::open(folder)?;
        let mut all = Batch::new(Vec::new(), Vec::new());
        for sample in &data.samples {
            let image: Image<f32> = read_picture(&sample.image, DEFAULT_MAX_PIXELS)?.image;
            let first = all.images.first().map_or(image.size(), Image::size);
            if image.size() != first {
                let path = sample.image.display();
                bail!("{path}: pictures of one size are needed; the first is {} x {}", first.width(), first.height());
            }
            all.images.push(image);
            if let Some((json, place)) = &sample.scene {
                all.scenes.push(json.to_scene(Some(&data.bank), place)?);
            }
        }
        if source == Source::Scenes && all.scenes.len() != all.images.len() {
            bail!("{}: this mode learns from scenes, and not every picture has one", folder.display());
        }
        if all.scenes.len() != all.images.len() {
            all.scenes.clear();
        }
        if all.images.len() <= held_out {
            bail!("{}: {} pictures, of which {held_out} are for validation", folder.display(), all.images.len());
        }
        Ok(Self::Folder { all, held_out, seed })
    }

    /// Whether images come again.
    pub(super) fn is_finite(&self) -> bool {
        matches!(self, Self::Folder { .. } | Self::Generated { count: Some(_), .. })
    }

    /// The numbers of the images of batch `index`, of `len`.
    pub(super) fn numbers(&self, index: u64, len: usize) -> Vec<u64> {
        let places = index * len as u64..(index + 1) * len as u64;
        match self {
            Self::Generated { count: None, .. } => places.collect(),
            Self::Generated { count: Some(count), seed, .. } => shuffled(places, *count, *seed),
            Self::Folder { all, held_out, seed } => shuffled(places, (all.images.len() - held_out) as u64, *seed),
        }
    }

    /// Batch `index`, of `len` images.
    pub(super) fn batch(&self, index: u64, len: usize, painter: &SceneSteps<f32>) -> Result<Batch<f32>> {
        let numbers = self.numbers(index, len);
        match self {
            Self::Generated { settings, bank, size, seed, .. } => {
                let scene = |number| sample_scene(settings, bank, *size, *seed, number);
                paint(numbers.into_par_iter().map(scene).collect(), *size, painter)
            }
            Self::Folder { all, .. } => {
                let mut batch = Batch::new(Vec::with_capacity(len), Vec::new());
                for item in numbers.into_iter().filter_map(|item| usize::try_from(item).ok()) {
                    batch.images.push(all.images[item].clone());
                    batch.scenes.extend(all.scenes.get(item).cloned());
                }
                Ok(batch)
            }
        }
    }

    /// Images that are never learned from.
    pub(super) fn held_out(&self, len: usize, painter: &SceneSteps<f32>) -> Result<Batch<f32>> {
        match self {
            Self::Generated { settings, bank, size, seed, .. } => {
                let scene = |place| sample_scene(settings, bank, *size, seed.wrapping_add(HELD_OUT), place);
                paint((0..len as u64).map(scene).collect(), *size, painter)
            }
            Self::Folder { all, held_out, .. } => Ok(all.part(all.images.len() - held_out, len)),
        }
    }
}

/// What a preliminary model sees in images, as scenes, and the images of these scenes.
///
/// *Source*: the paper, section on training: the source of P where no scenes are known.
pub(super) fn reread(model: &Model<Host>, images: &[Image<f32>], painter: &SceneSteps<f32>) -> Result<Batch<f32>> {
    let seen = model.predict::<f32>(&image_tensor(images, &HostDevice)?)?;
    let mut scenes = seen.scenes(painter.edge())?;
    scenes.iter_mut().for_each(Scene::keep_visible);
    let size = images.first().context("no images")?.size();
    paint(scenes, size, painter)
}

fn paint(scenes: Vec<Scene<f32>>, size: ImageSize, painter: &SceneSteps<f32>) -> Result<Batch<f32>> {
    let images = scenes.par_iter().map(|scene| Ok(painter.paint(scene, size)?)).collect::<Result<_>>()?;
    Ok(Batch::new(images, scenes))
}

/// Which of `count` items come at `places`: every item once before any comes again, in another order each time.
fn shuffled(places: Range<u64>, count: u64, seed: u64) -> Vec<u64> {
    let count = count.max(1);
    let mut order: Option<(u64, Vec<u64>)> = None;
    let item = |place: u64| {
        let round = place / count;
        if order.as_ref().is_none_or(|(own, _)| *own != round) {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            rng.set_stream(round);
            let mut items: Vec<u64> = (0..count).collect();
            items.shuffle(&mut rng);
            order = Some((round, items));
        }
        let at = usize::try_from(place % count).unwrap_or(0);
        order.as_ref().and_then(|(_, items)| items.get(at)).copied().unwrap_or(0)
    };
    places.map(item).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_comes_once_before_any_comes_again() {
        let two_rounds = shuffled(0..14, 7, 3);
        for round in two_rounds.chunks(7) {
            let mut sorted = round.to_vec();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..7).collect::<Vec<_>>());
        }
        assert_ne!(two_rounds[..7], two_rounds[7..]);
        assert_eq!(shuffled(5..9, 7, 3), two_rounds[5..9], "whatever was asked for before");
    }
}
