//! The scenes that are made difficult, and pictures of them.

use anyhow::Result;
use dvp_core::{Image, ImageSize, Object, Pose, Real, Scene};
use rand::RngExt;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::Case;
use crate::hard::contrasting;
use dvp_cli::command::options::square;
use dvp_cli::format::{from_rgb8, mdshr_bank, to_rgb8};
use dvp_cli::generate::{Range, SceneSettings, sample_scene};
use dvp_cli::paint::Painter;

/// Side of pictures whose size is no difficulty.
pub(super) const SIDE: usize = 128;

/// Scales of objects whose size is no difficulty.
pub(super) const SCALES: Range = Range::new(0.08, 0.13);

/// No outline of MDS-HR reaches farther from its center, in units of its scale.
pub(super) const REACH: f32 = 1.45;

/// Objects that are apart leave so much between their reaches, and half of it to the border, in pictures of 128 px and of
/// 256: the reference's edges, and some pixels.
pub(super) const GAP: f32 = 0.05;
pub(super) const CROWD_GAP: f32 = 0.02;

/// Places that are tried for an object.
const PLACES: usize = 10_000;

/// Data set number of the scenes of MDS-HR.
const DATA_SET: u64 = 5000;

/// The random numbers of a picture, the same at all levels.
pub(super) fn random(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

/// A scene of MDS-HR.
pub(super) fn mds_hr(seed: u64) -> Result<Scene<f32>> {
    Ok(sample_scene(&SceneSettings::mds_hr(), &mdshr_bank(), square(SIDE)?, DATA_SET, seed))
}

/// Up to `count` objects of the bank's shapes that neither touch one another nor the border; fewer if there is no room.
pub(super) fn apart(rng: &mut ChaCha8Rng, count: usize, scales: Range, gap: f32) -> Scene<f32> {
    let bank = mdshr_bank();
    let mut scene = Scene::empty(rng.random());
    for _ in 0..count {
        let scale = if scales.low < scales.high { rng.random_range(scales.low..scales.high) } else { scales.low };
        let rotation = rng.random_range(0.0..core::f32::consts::TAU);
        let color = contrasting(rng, scene.background);
        let prototype = rng.random_range(0..bank.prototypes.len());
        let border = scale * REACH + gap / 2.0;
        let place = (0..PLACES).map(|_| [0, 1].map(|_| rng.random_range(border..1.0 - border))).find(|place| {
            scene.objects.iter().all(|Object { pose, .. }| {
                let distance = (place[0] - pose.translation[0]).hypot(place[1] - pose.translation[1]);
                distance > (scale + pose.scale) * REACH + gap
            })
        });
        scene.objects.extend(place.map(|translation| {
            let pose = Pose { translation, scale, rotation };
            Object::of_efd(pose, color, 1.0, bank.prototypes[prototype].1.clone(), Some(prototype))
        }));
    }
    scene
}

/// The picture of a scene as files have it: in steps of 1/255.
pub(super) fn eight_bits(scene: &Scene<f32>, size: ImageSize) -> Result<Image<f32>> {
    Ok(from_rgb8(&to_rgb8(Painter::default().paint(scene, size)?.view())?)?)
}

/// A square picture of a scene, of 8 bits.
pub(super) fn case(truth: Scene<f32>, side: usize) -> Result<Case> {
    Ok(Case { image: eight_bits(&truth, square(side)?)?, truth, start: None })
}

/// A level that counts something.
pub(super) fn whole(level: f64) -> usize {
    level.to_count()
}

/// A level as f32.
#[expect(clippy::cast_possible_truncation, reason = "a level, rounded")]
pub(super) fn narrow(level: f64) -> f32 {
    level as f32
}
