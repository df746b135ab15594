//! What objects that overlap show under `blend`: one color for every set of them.

use dvp_core::render::Compositing;
use dvp_core::{Real, Scene};

use super::drawn::Drawn;
use super::overlap::{Body, MOST_IN_SET, MOST_SETS, shared_regions};

/// Opacity from which on a mixture hides what is below it.
const OPAQUE: f64 = 0.999;

/// The common part of two or more objects.
pub(super) struct Mixture {
    /// Which objects, rising; two at least.
    pub(super) objects: Vec<usize>,
    /// What is seen there.
    pub(super) color: [f64; 3],
}

impl Mixture {
    /// All but the last object.
    pub(super) fn others(&self) -> &[usize] {
        self.objects.split_last().map_or(&[], |(_, others)| others)
    }

    pub(super) fn last(&self) -> usize {
        self.objects.last().copied().unwrap_or(0)
    }
}

/// The common parts of a drawing's objects.
#[derive(Default)]
pub(super) struct Mixtures {
    /// Those of more objects later.
    pub(super) parts: Vec<Mixture>,
    /// What is to be said of parts that were left out.
    pub(super) remark: Option<String>,
}

/// The common parts that are seen in an image of so many pixels.
///
/// On a background each shows one opaque color, however confident its objects are. On a transparent ground only those that hide the
/// ground have a color of their own; elsewhere the objects show one over the other. So do parts beyond the limits of
/// [`shared_regions`], over the mixtures of fewer of their objects.
pub(super) fn mixtures<T: Real>(scene: &Scene<T>, drawn: &[Drawn], [width, height]: [f64; 2]) -> Mixtures {
    let bodies: Vec<&Body> = drawn.iter().map(|object| &object.body).collect();
    let shared = shared_regions(&bodies, width, height);
    let mixed = shared.sets.into_iter().filter_map(|objects| {
        let (mut weights, mut mean, mut clear) = (0.0, [0.0; 3], 1.0);
        for object in objects.iter().filter_map(|&k| drawn.get(k)) {
            let weight = ((object.confidence - 1.0) * Compositing::SHARPNESS).exp();
            weights += weight;
            mean.iter_mut().zip(object.color).for_each(|(sum, value)| *sum += weight * value);
            clear *= 1.0 - object.confidence;
        }
        if scene.transparent && 1.0 - clear < OPAQUE {
            return None;
        }
        let color: [f64; 3] = core::array::from_fn(|i| {
            let background = scene.background[i].as_f64();
            background + (1.0 - clear) * (mean[i] / weights - background)
        });
        Some(Mixture { objects, color })
    });
    let remark = (!shared.is_complete).then(|| {
        format!(
            "Common parts of more than {MOST_IN_SET} objects, or beyond the first {MOST_SETS}, have no mixed color of their own: \
             objects show one over the other there."
        )
    });
    Mixtures { parts: mixed.collect(), remark }
}
