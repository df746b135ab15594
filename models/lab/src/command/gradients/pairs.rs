//! Scenes moved toward others.

use dvp_core::scene::rotation_from_pair;
use dvp_core::shape::Efd;
use dvp_core::{AnyShape, ImageSize, Object, Scene};

use dvp_cli::format::mdshr_bank;
use dvp_cli::generate::{SceneSettings, sample_scene};

use super::Setting;

/// A scene and another one, slot by slot.
pub(super) struct Pair {
    /// The scene that is looked for.
    pub(super) truth: Scene<f32>,
    other: Scene<f32>,
}

/// Pairs of random scenes of MDS-HR, hidden slots kept.
pub(super) fn pairs(count: usize, size: ImageSize, seed: u64) -> Vec<Pair> {
    let mut settings = SceneSettings::mds_hr();
    settings.keep_hidden = true;
    let bank = mdshr_bank();
    let scene = |index| sample_scene(&settings, &bank, size, seed, index);
    (0..count as u64).map(|k| Pair { truth: scene(2 * k), other: scene(2 * k + 1) }).collect()
}

impl Pair {
    /// The scene a share `alpha` of the way to the other one: every number mixed, rotations as (sin, cos) pairs. In the published
    /// setting confidences are rounded, 1/2 to 0.
    pub(super) fn moved(&self, alpha: f64, setting: Setting) -> Scene<f32> {
        #[expect(clippy::cast_possible_truncation, reason = "a share, rounded")]
        let alpha = alpha as f32;
        let mix = |a: f32, b: f32| (1.0 - alpha) * a + alpha * b;
        let object = |(a, b): (&Object<f32>, &Object<f32>)| {
            let mut object = a.clone();
            let (from, to) = (a.pose, b.pose);
            object.pose.translation = [0, 1].map(|k| mix(from.translation[k], to.translation[k]));
            object.pose.scale = mix(from.scale, to.scale);
            let pair = [mix(from.rotation.sin(), to.rotation.sin()), mix(from.rotation.cos(), to.rotation.cos())];
            object.pose.rotation = rotation_from_pair(pair);
            object.paint = [0, 1, 2].map(|k| mix(a.color()[k], b.color()[k])).into();
            object.confidence = match (setting, mix(a.confidence, b.confidence)) {
                (Setting::Ours, mixed) => mixed,
                (Setting::Published, mixed) if mixed > 0.5 => 1.0,
                (Setting::Published, _) => 0.0,
            };
            let rows = a.efd_rows().iter().zip(b.efd_rows());
            let mixed = Efd::new(rows.map(|(a, b)| [0, 1, 2, 3].map(|k| mix(a[k], b[k]))).collect());
            object.shape = AnyShape::of_efd(mixed, a.prototype());
            object
        };
        Scene {
            background: [0, 1, 2].map(|k| mix(self.truth.background[k], self.other.background[k])),
            objects: self.truth.objects.iter().zip(&self.other.objects).map(object).collect(),
            ..self.truth.clone()
        }
    }
}
