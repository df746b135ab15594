//! One random scene.

use dvp_core::{ImageSize, Object, Pose, Scene};
use dvp_fit::Bank;

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

/// Random numbers, written out so that data sets do not change with a library.
///
/// *Source*: SplitMix64; Steele, Lea and Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
struct Chance(u64);

impl Chance {
    /// Scrambling the seed before the index is added keeps data sets of neighboring seeds apart.
    fn new(seed: u64, index: u64) -> Self {
        let start = Self(seed).next_u64().wrapping_add(index);
        Self(Self(start).next_u64())
    }

    fn next_u64(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}

/// Uniform, on a grid of 2^24 steps.
fn uniform(rng: &mut Chance, range: Range) -> f32 {
    #[expect(clippy::cast_precision_loss, reason = "24 bits fit an f32")]
    let unit = (rng.next_u64() >> 40) as f32 / 16_777_216.0;
    range.low + (range.high - range.low) * unit
}

/// Uniform in 0..count (0 if `count` is 0).
fn below(rng: &mut Chance, count: usize) -> usize {
    (((rng.next_u64() >> 32) * count as u64) >> 32) as usize
}

fn color(rng: &mut Chance, range: Range) -> [f32; 3] {
    [uniform(rng, range), uniform(rng, range), uniform(rng, range)]
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
