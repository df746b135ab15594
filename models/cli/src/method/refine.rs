//! Levenberg-Marquardt from what a network sees.

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{ImageView, Scene};
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Fit, FitError};

/// A mean error below this is that of rounding to 8 bits: the edges are right.
const ROUNDING: f32 = 1.0 / 255.0;

/// Rounds in which objects without a marginal gain are taken out.
const ROUNDS: usize = 3;

/// The scene that Levenberg-Marquardt finds from `start`, with the edges that explain the picture best: those of the
/// reference or, where those do not meet it, area coverage. Objects without which the picture would be met better go, and of
/// more than `max_objects` those of the smallest marginal gain.
pub(super) fn refine(
    settings: &Refine,
    image: ImageView<'_, f32>,
    start: &Scene<f32>,
    compositing: Compositing,
    max_objects: usize,
    scratch: &mut RefineScratch<f32>,
) -> Result<Fit<f32>, FitError> {
    let mut fit_with = |start: &Scene<f32>, edge| {
        let start = Scene { edge, compositing, ..start.clone() };
        settings.fit(image, &start, scratch)
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
        let kept: Vec<usize> = ranking.filter(|&index| best.marginal_gain[index] > 0.0).collect();
        if kept.len() == best.scene.objects.len() {
            break;
        }
        let mut index = 0..best.scene.objects.len();
        best.scene.objects.retain(|_| index.next().is_some_and(|index| kept.contains(&index)));
        best = fit_with(&best.scene, best.scene.edge)?;
    }
    Ok(best)
}
