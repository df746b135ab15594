//! What the paper's descents of pixels need: a descent, and the random scenes that some of them start from.

use dvp_core::render::ContourRenderer;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, Real, Scene};
use dvp_fit::Bank;
use dvp_fit::adam::descent::Descent;
use dvp_fit::opt_iter::OptIter;
use dvp_fit::rand_opt_p::random_scene;

use super::error::MethodError;

/// Runs `fit` on a descent that is made for the edges and shapes of `scene`.
pub(super) fn descend<T: Real, R>(
    scene: &Scene<T>,
    fit: impl FnOnce(&mut Descent<'_, T, ContourRenderer<T>>) -> Result<R, MethodError>,
) -> Result<R, MethodError> {
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let harmonics = scene.harmonic_count().max(OptIter::default().harmonic_count);
    fit(&mut Descent::new(&renderer, REFERENCE_VERTICES, harmonics)?)
}

/// A scene at random, always the same for a seed: shapes of the bank, or disks, of as many harmonics as Opt-Iter has.
pub(super) fn random_start(bank: Option<&Bank<f32>>, objects: usize, seed: u64) -> Scene<f32> {
    let circle = Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]);
    let harmonics = OptIter::default().harmonic_count;
    let shapes: Vec<Efd<f32>> = match bank {
        None => vec![circle.resized(harmonics)],
        Some(bank) => bank.prototypes.iter().map(|(_, efd)| efd.resized(harmonics)).collect(),
    };
    random_scene(objects, &shapes, seed)
}

/// A seed of its own for every picture, whichever thread takes it.
#[must_use]
pub fn seed_of(stem: &str, seed: u64) -> u64 {
    stem.bytes().fold(seed, |seed, byte| seed.wrapping_mul(31).wrapping_add(byte.into()))
}
