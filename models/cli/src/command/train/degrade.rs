//! Pictures that are spoiled before a network sees them: noise, blur, JPEG, objects that hide one another.

use anyhow::{Result, anyhow};
use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Image, Scene};
use dvp_net::propose::cleared;
use dvp_net::scene_steps::SceneSteps;
use dvp_net::train::Batch;
use image::RgbImage;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use super::settings::Settings;
use crate::format::{from_rgb8, to_rgb8};
use crate::paint::Painter;
use crate::spoil::{add_noise, blurred, jpeg};

/// Added to the seed of a run, so that what spoils its pictures has nothing to do with what is drawn in them.
const SPOILED: u64 = 0x5b01_1ed0;

/// Levels, from what changes little to what `dvp stability` has at its end: the standard deviation of noise in units of full contrast,
/// that of the blur in pixels, and the quality of JPEG. Drawn evenly on a scale of powers, as each step up costs as much as the last.
const NOISE: [f64; 2] = [0.01, 0.3];
const BLUR: [f64; 2] = [0.7, 8.0];
const QUALITY: [f64; 2] = [4.0, 75.0];

/// How far apart the centers of two objects of which one hides the other are, in sums of their scales.
const APART: [f64; 2] = [0.15, 0.8];

/// What happens to a picture.
#[derive(Clone, Copy)]
enum Kind {
    Noise,
    Blur,
    Jpeg,
    /// It is drawn anew, with hard edges, each object over those before it, and two of them one behind the other.
    Occlusion,
}

/// Spoils a share of the pictures.
pub(super) struct Degradation {
    share: f64,
    seed: u64,
    /// Whether scenes may be drawn anew: pictures of a folder are what they are.
    is_drawn: bool,
}

impl Degradation {
    /// Index of the batch that is never learned from.
    pub(super) const HELD_OUT: u64 = u64::MAX;

    /// That of a run.
    pub(super) fn of(settings: &Settings) -> Self {
        let is_drawn = settings.data.is_none() || settings.preliminary.is_some();
        Self::new(settings.degraded.unwrap_or(0.0), settings.seed.unwrap_or(1), is_drawn)
    }

    /// Of `share` of the pictures, 0 to 1. `is_drawn`: whether they are drawn from their scenes.
    fn new(share: f64, seed: u64, is_drawn: bool) -> Self {
        Self { share, seed: seed.wrapping_add(SPOILED), is_drawn }
    }

    /// Spoils pictures of batch `index`, always in the same way; [`Batch::clean`] has them as they should be seen. Where objects hide one
    /// another, the scene changes with the picture.
    pub(super) fn spoil(&self, batch: &mut Batch<f32>, index: u64, painter: &SceneSteps<f32>) -> Result<()> {
        if self.share <= 0.0 {
            return Ok(());
        }
        batch.clean.clone_from(&batch.images);
        let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
        rng.set_stream(index);
        for k in 0..batch.images.len() {
            if !rng.random_bool(self.share) {
                continue;
            }
            let scene = batch.scenes.get_mut(k).filter(|scene| self.is_drawn && scene.objects.len() > 1);
            let kind = match rng.random_range(0..4) {
                0 => Kind::Blur,
                1 => Kind::Jpeg,
                2 if scene.is_some() => Kind::Occlusion,
                _ => Kind::Noise,
            };
            batch.images[k] = match (kind, scene) {
                (Kind::Occlusion, Some(scene)) => {
                    hide(scene, &mut rng);
                    batch.clean[k] = painter.paint(scene, batch.images[k].size())?;
                    opaque(scene, batch.images[k].size())?
                }
                // As networks are shown pictures of their own.
                (kind, _) => cleared(spoiled(kind, &batch.images[k], &mut rng)?),
            };
        }
        Ok(())
    }
}

/// A picture of 8 bits, spoiled to an extent drawn at random.
fn spoiled(kind: Kind, image: &Image<f32>, rng: &mut ChaCha8Rng) -> Result<Image<f32>> {
    let mut picture = to_rgb8(image.view())?;
    match kind {
        Kind::Noise | Kind::Occlusion => add_noise(&mut picture, power(NOISE, rng), rng.random()),
        Kind::Blur => picture = blurred(&picture, power(BLUR, rng)),
        Kind::Jpeg => picture = compressed(&picture, power(QUALITY, rng))?,
    }
    Ok(from_rgb8(&picture)?)
}

fn compressed(picture: &RgbImage, quality: f64) -> Result<RgbImage> {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "qualities are 4 to 75")]
    let bytes = jpeg(picture, quality.round() as u8).map_err(|error| anyhow!(error))?;
    Ok(image::load_from_memory(&bytes)?.to_rgb8())
}

/// Moves an object towards another one, so that one hides a part of the other.
fn hide(scene: &mut Scene<f32>, rng: &mut ChaCha8Rng) {
    let count = scene.objects.len();
    let moved = rng.random_range(0..count);
    let other = (moved + rng.random_range(1..count)) % count;
    let (from, to) = (scene.objects[moved].pose, scene.objects[other].pose);
    let apart = [0, 1].map(|c| from.translation[c] - to.translation[c]);
    let distance = apart[0].hypot(apart[1]);
    #[expect(clippy::cast_possible_truncation, reason = "places are f32")]
    let asked = (from.scale + to.scale) * rng.random_range(APART[0]..APART[1]) as f32;
    if distance > asked {
        scene.objects[moved].pose.translation = [0, 1].map(|c| to.translation[c] + apart[c] * (asked / distance));
    }
}

/// A scene as drawing programs draw it, in 8 bits.
fn opaque(scene: &Scene<f32>, size: dvp_core::ImageSize) -> Result<Image<f32>> {
    let scene = Scene { edge: EdgeProfile::area(), compositing: Compositing::Over, ..scene.clone() };
    Ok(from_rgb8(&to_rgb8(Painter::default().paint(&scene, size)?.view())?)?)
}

/// A number drawn evenly on a scale of powers.
fn power([low, high]: [f64; 2], rng: &mut ChaCha8Rng) -> f64 {
    rng.random_range(low.ln()..high.ln()).exp()
}

#[cfg(test)]
mod tests {
    use dvp_core::ImageSize;

    use super::*;
    use crate::format::mdshr_bank;
    use crate::generate::{SceneSettings, sample_scene};

    fn painter() -> SceneSteps<f32> {
        SceneSteps::new(1, 16, EdgeProfile::reference()).unwrap()
    }

    fn batch(count: u64) -> Batch<f32> {
        let (size, bank) = (ImageSize::new(32, 32).unwrap(), mdshr_bank());
        let scenes: Vec<_> = (0..count).map(|k| sample_scene(&SceneSettings::mds_hr(), &bank, size, 3, k)).collect();
        Batch::new(scenes.iter().map(|scene| painter().paint(scene, size).unwrap()).collect(), scenes)
    }

    #[test]
    fn so_many_are_spoiled_as_asked_and_always_in_the_same_way() {
        let whole = batch(200);
        let [mut one, mut again, mut other] = [(); 3].map(|()| whole.clone());
        let degradation = Degradation::new(0.5, 1, true);
        degradation.spoil(&mut one, 7, &painter()).unwrap();
        degradation.spoil(&mut again, 7, &painter()).unwrap();
        degradation.spoil(&mut other, 8, &painter()).unwrap();
        assert_eq!(one, again);
        assert_ne!(one, other);
        let changed = one.images.iter().zip(&whole.images).filter(|(a, b)| a != b).count();
        // Four standard deviations of 200 throws of a coin.
        assert!((72..=128).contains(&changed), "{changed}");
        let moved = one.scenes.iter().zip(&whole.scenes).filter(|(a, b)| a != b).count();
        assert!((8..=50).contains(&moved), "an eighth of the scenes is drawn anew: {moved}");
        for (k, scene) in one.scenes.iter().enumerate() {
            let painted = painter().paint(scene, one.images[k].size()).unwrap();
            assert_eq!(one.clean[k], painted, "what should be seen is the scene, clean");
            assert!(one.images[k].data().iter().all(|value| (0.0..=1.0).contains(value)));
        }
    }

    #[test]
    fn pictures_of_a_folder_keep_their_scenes_and_nothing_is_spoiled_unasked() {
        let whole = batch(40);
        let mut some = whole.clone();
        Degradation::new(1.0, 1, false).spoil(&mut some, 0, &painter()).unwrap();
        assert_eq!((&some.scenes, &some.clean), (&whole.scenes, &whole.images));
        assert!(some.images.iter().zip(&whole.images).all(|(a, b)| a != b));
        let mut none = whole.clone();
        Degradation::new(0.0, 1, true).spoil(&mut none, 0, &painter()).unwrap();
        assert_eq!(none, whole);
    }
}
