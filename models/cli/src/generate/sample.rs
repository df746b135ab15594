//! One random scene.

use dvp_core::{ImageSize, Object, Pose, Scene};
use dvp_fit::Bank;

use super::chance::{Chance, below, color, uniform};
use super::settings::{Range, SceneSettings};

/// Scene number `index` of the data set `seed`; each image stands for itself.
///
/// Objects have the shapes of `bank`, which must not be empty (an empty one gives scenes without objects).
#[must_use]
pub fn sample_scene(settings: &SceneSettings, bank: &Bank<f32>, size: ImageSize, seed: u64, index: u64) -> Scene<f32> {
    let mut rng = Chance::new(seed, index);
    let visible = settings.fewest + below(&mut rng, settings.most - settings.fewest + 1);
    let positions = positions(&mut rng, settings, size);
    let mut objects = Vec::new();
    for (slot, translation) in positions.into_iter().enumerate() {
        let scale = uniform(&mut rng, settings.scale);
        let rotation = angle(&mut rng);
        let color = color(&mut rng, settings.color);
        let prototype = below(&mut rng, bank.prototypes.len());
        let confidence = if slot < visible { 1.0 } else { 0.0 };
        if slot < visible || settings.keep_hidden {
            let pose = Pose { translation, scale, rotation };
            let shape = bank.prototypes.get(prototype);
            objects.extend(shape.map(|(_, efd)| Object::of_efd(pose, color, confidence, efd.clone(), Some(prototype))));
        }
    }
    Scene {
        background: color(&mut rng, settings.background),
        transparent: false,
        objects,
        edge: settings.edge,
        compositing: settings.compositing,
    }
}

/// The direction of a point in the square [-1, 1] x [-1, 1], read as (sine, cosine).
fn angle(rng: &mut Chance) -> f32 {
    let square = Range::new(-1.0, 1.0);
    let [sine, cosine] = [uniform(rng, square), uniform(rng, square)];
    sine.atan2(cosine)
}

/// The draw of all slots' positions, of several, whose two closest ones are farthest apart.
fn positions(rng: &mut Chance, settings: &SceneSettings, size: ImageSize) -> Vec<[f32; 2]> {
    let mut best = (f32::NEG_INFINITY, Vec::new());
    let range = Range::new(settings.margin, 1.0 - settings.margin);
    #[expect(clippy::cast_precision_loss, reason = "image sides are small")]
    let sides = [size.width(), size.height()].map(|side| side as f32 / size.unit_px() as f32);
    for _ in 0..settings.placements {
        let draw: Vec<[f32; 2]> =
            (0..settings.slots).map(|_| [uniform(rng, range) * sides[0], uniform(rng, range) * sides[1]]).collect();
        let closest = closest_distance(&draw);
        if closest > best.0 {
            best = (closest, draw);
        }
    }
    best.1
}

/// Infinite for fewer than two points.
pub(super) fn closest_distance(points: &[[f32; 2]]) -> f32 {
    let pairs = points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| (a, b)));
    pairs.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(f32::INFINITY, f32::min)
}
