//! What commands do with a trained network: load it, refine what it proposes, start without it at random.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile};
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, ImageView, Scene};
use dvp_fit::adam::descent::Descent;
use dvp_fit::opt_iter::OptIter;
use dvp_fit::opt_p::OptP;
use dvp_fit::rand_opt_p::{RandOptP, random_scene};
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Bank, Fit};
use dvp_net::propose::{BUILT_IN, Proposer};

/// A mean error below this is that of rounding to 8 bits: the edges are right.
const ROUNDING: f32 = 1.0 / 255.0;

/// The network of a file, or the one that is built in.
pub(super) fn load(file: Option<&Path>) -> Result<Proposer> {
    let Some(file) = file else {
        return Proposer::from_bytes(BUILT_IN).context("the network that is built in");
    };
    let named = || file.display().to_string();
    let bytes = fs::read(file).with_context(|| format!("{} cannot be read", file.display()))?;
    Proposer::from_bytes(&bytes).with_context(named)
}

/// Rounds in which objects that buy nothing are taken out.
const ROUNDS: usize = 3;

/// The scene that Levenberg-Marquardt finds from `start`, with the edges that explain the picture best: those of the
/// reference or, where those do not meet it, area coverage. Objects without which the picture would be met better go, and of
/// more than `max_objects` those that buy least.
pub(super) fn refine(
    image: ImageView<'_, f32>,
    start: &Scene<f32>,
    compositing: Compositing,
    max_objects: usize,
    scratch: &mut RefineScratch<f32>,
) -> Result<Fit<f32>> {
    let mut fit_with = |start: &Scene<f32>, edge| {
        let start = Scene { edge, compositing, ..start.clone() };
        Refine::default().fit(image, &start, scratch)
    };
    let mut best = fit_with(start, EdgeProfile::reference())?;
    if best.loss > ROUNDING {
        let other = fit_with(start, EdgeProfile::area())?;
        if other.loss < best.loss {
            best = other;
        }
    }
    for _ in 0..ROUNDS {
        let ranking = best.ranking().into_iter().take(max_objects);
        let kept: Vec<usize> = ranking.filter(|&index| best.buys[index] > 0.0).collect();
        if kept.len() == best.scene.objects.len() {
            break;
        }
        let mut index = 0..best.scene.objects.len();
        best.scene.objects.retain(|_| index.next().is_some_and(|index| kept.contains(&index)));
        best = fit_with(&best.scene, best.scene.edge)?;
    }
    Ok(best)
}

/// The paper's OptP from `start`.
pub(super) fn opt_p(image: ImageView<'_, f32>, start: &Scene<f32>) -> Result<Fit<f32>> {
    descend(start, |descent| Ok(OptP::default().fit(descent, image, start)?))
}

/// The paper's Rand-OptP from `start`.
pub(super) fn rand_opt_p(image: ImageView<'_, f32>, start: &Scene<f32>) -> Result<Fit<f32>> {
    descend(start, |descent| Ok(RandOptP::default().fit(descent, image, start)?))
}

/// Runs `fit` on a descent that is made for the edges and shapes of `scene`.
pub(super) fn descend(
    scene: &Scene<f32>,
    fit: impl FnOnce(&mut Descent<'_, f32, ContourRenderer<f32>>) -> Result<Fit<f32>>,
) -> Result<Fit<f32>> {
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let harmonics = scene.objects.iter().map(|object| object.efd.harmonic_count()).max().unwrap_or(1);
    let harmonics = harmonics.max(OptIter::default().harmonic_count);
    fit(&mut Descent::new(&renderer, REFERENCE_VERTICES, harmonics)?)
}

/// A scene at random, the same for the same picture and seed on any number of threads: shapes of the bank, or disks.
pub(super) fn random_start(bank: Option<&Bank<f32>>, objects: usize, seed: u64, stem: &str) -> Scene<f32> {
    let circle = [Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]).resized(OptIter::default().harmonic_count)];
    let bank: Option<Vec<_>> = bank.map(|bank| bank.prototypes.iter().map(|(_, efd)| efd.clone()).collect());
    random_scene(objects, bank.as_deref().unwrap_or(&circle), seed_of(stem, seed))
}

/// A seed of its own for every picture, whichever thread takes it.
pub(super) fn seed_of(stem: &str, seed: u64) -> u64 {
    stem.bytes().fold(seed, |seed, byte| seed.wrapping_mul(31).wrapping_add(byte.into()))
}
