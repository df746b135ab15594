//! Levenberg-Marquardt from what a network sees.

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{ImageView, Scene};
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Fit, FitError};

use super::error::MethodError;
use crate::paint::Painter;

/// A mean absolute error below this is that of rounding to 8 bits, a quarter of a step: the edges are right.
const ROUNDING: f32 = 0.3 / 255.0;

/// Rounds in which objects without a marginal gain are taken out.
const ROUNDS: usize = 3;

/// Objects hide one another if that leaves less than this share of what is left if they blend: noise decides nothing.
const HIDE: f32 = 0.97;

/// The scene that Levenberg-Marquardt finds from `start`, with the edges that explain the picture best: those of the
/// reference or, where those do not meet it, area coverage; and, unless `compositing` says how objects mix, blended or, where that does
/// not meet the picture, one over the other. Objects without which the picture would be met better go, and of
/// more than `max_objects` those of the smallest marginal gain.
pub(super) fn refine(
    settings: &Refine,
    image: ImageView<'_, f32>,
    start: &Scene<f32>,
    compositing: Option<Compositing>,
    max_objects: usize,
    scratch: &mut RefineScratch<f32>,
) -> Result<Fit<f32>, MethodError> {
    let mut fit_with = |start: &Scene<f32>, edge| settings.fit(image, &Scene { edge, ..start.clone() }, scratch);
    let mut fit_best = |start: &Scene<f32>| -> Result<Fit<f32>, FitError> {
        let best = fit_with(start, EdgeProfile::reference())?;
        if best.loss <= ROUNDING {
            return Ok(best);
        }
        let other = fit_with(start, EdgeProfile::area())?;
        Ok(if other.loss < best.loss { other } else { best })
    };
    let mut best = fit_best(&Scene { compositing: compositing.unwrap_or_default(), ..start.clone() })?;
    if compositing.is_none()
        && best.loss > ROUNDING
        && let Some(stacked) = stacked(&best.scene, image)?
    {
        let other = fit_best(&stacked)?;
        if other.loss < HIDE * best.loss {
            best = other;
        }
    }
    for _ in 0..ROUNDS {
        // Of a picture fainter than its noise no gain can be told.
        if best.scene.objects.len() <= max_objects && best.marginal_gain.iter().all(|gain| *gain == 0.0) {
            break;
        }
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

/// A scene whose objects hide one another in the order that paints the picture best; none if no two of them may meet.
fn stacked(scene: &Scene<f32>, image: ImageView<'_, f32>) -> Result<Option<Scene<f32>>, MethodError> {
    let painter = Painter::default();
    let off = |scene: &Scene<f32>| -> Result<f32, MethodError> {
        let painted = painter.paint(scene, image.size())?;
        Ok(painted.data().iter().zip(image.data()).map(|(a, b)| (a - b).powi(2)).sum())
    };
    let meet = |a: usize, b: usize| {
        let [a, b] = [a, b].map(|at| scene.objects[at].pose);
        let apart = [0, 1].map(|c| a.translation[c] - b.translation[c]);
        apart[0].hypot(apart[1]) < a.scale + b.scale
    };
    let mut best = Scene { compositing: Compositing::Over, ..scene.clone() };
    let mut least = off(&best)?;
    // Where each object stands from the back to the front.
    let mut places: Vec<usize> = (0..scene.objects.len()).collect();
    let mut some = false;
    for (a, b) in (1..places.len()).flat_map(|b| (0..b).map(move |a| (a, b))).filter(|&(a, b)| meet(a, b)) {
        some = true;
        let mut other = best.clone();
        other.objects.swap(places[a], places[b]);
        let left = off(&other)?;
        if left < least {
            places.swap(a, b);
            (best, least) = (other, left);
        }
    }
    Ok(some.then_some(best))
}

#[cfg(test)]
mod tests {
    use dvp_core::{ImageSize, Object, Pose};

    use super::*;
    use crate::format::mdshr_bank;

    /// A square over a disk-like shape, drawn as drawing programs do.
    fn truth(front_first: bool) -> Scene<f32> {
        let bank = mdshr_bank::<f32>();
        let object = |x: f32, prototype: usize, color| {
            let pose = Pose { translation: [x, 0.5], scale: 0.2, rotation: 0.3 };
            Object::of_efd(pose, color, 1.0, bank.prototypes[prototype].1.clone(), Some(prototype))
        };
        let mut objects = vec![object(0.4, 0, [0.9, 0.2, 0.1]), object(0.6, 1, [0.1, 0.7, 0.9])];
        if front_first {
            objects.reverse();
        }
        let (edge, compositing) = (EdgeProfile::area(), Compositing::Over);
        Scene { objects, edge, compositing, ..Scene::empty([0.2, 0.3, 0.2]) }
    }

    #[test]
    fn objects_that_hide_one_another_are_found_to_do_so() {
        let size = ImageSize::new(128, 128).unwrap();
        for front_first in [false, true] {
            let truth = truth(front_first);
            let image = Painter::default().paint(&truth, size).unwrap();
            // What a network sees knows no order.
            let mut start = Scene { compositing: Compositing::Blend, edge: EdgeProfile::reference(), ..truth.clone() };
            start.objects.sort_by(|a, b| a.pose.translation[0].total_cmp(&b.pose.translation[0]));
            start.objects.iter_mut().for_each(|object| object.pose.translation[1] += 0.01);
            let find = |compositing| {
                let scratch = &mut RefineScratch::default();
                refine(&Refine::default(), image.view(), &start, compositing, 8, scratch).unwrap()
            };
            let found = find(None);
            assert_eq!(found.scene.compositing, Compositing::Over);
            for (a, b) in found.scene.objects.iter().zip(&truth.objects) {
                let off = [0, 1].map(|c| (a.pose.translation[c] - b.pose.translation[c]).abs());
                assert!(off[0].max(off[1]) < 1e-3, "{front_first}: {:?} for {:?}", a.pose, b.pose);
            }
            let asked = find(Some(Compositing::Blend));
            assert_eq!(asked.scene.compositing, Compositing::Blend);
            assert!(found.loss < 0.5 * asked.loss, "{} {}", found.loss, asked.loss);
        }
    }

    #[test]
    fn a_faint_object_in_more_noise_stays() {
        let size = ImageSize::new(64, 64).unwrap();
        let mut scene = truth(false);
        scene.objects.truncate(1);
        scene.objects[0].paint = dvp_core::Paint::Flat([0.25, 0.35, 0.25]);
        let picture = crate::format::to_rgb8(Painter::default().paint(&scene, size).unwrap().view()).unwrap();
        for seed in 0..8 {
            let mut picture = picture.clone();
            crate::spoil::add_noise(&mut picture, 0.2, seed);
            let image = crate::format::from_rgb8(&picture).unwrap();
            let scratch = &mut RefineScratch::default();
            let found = refine(&Refine::default(), image.view(), &scene, None, 8, scratch).unwrap();
            // Its gain is that of the picture or, where noise is all there is, cannot be told.
            let untold = found.marginal_gain.iter().all(|gain| *gain == 0.0);
            assert!(!untold || found.scene.objects.len() == 1, "{seed}: {:?}", found.marginal_gain);
        }
    }
}
