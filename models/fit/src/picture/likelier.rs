//! Which of two fits the picture is.

use core::cmp::Ordering;

use dvp_core::ImageView;
use dvp_core::render::{Compositing, EdgeLaw};
use dvp_trace::missed::{channels, misfit_bits};
use dvp_trace::tuning::CODED_MIX;

use super::parts::off;
use crate::paint::Canvas;
use crate::tuning::NOT_FLAT_SHARE;
use crate::{Ambiguity, Fit, FitError, scene_bits};

/// Where two fits are of different kinds, the likelier one is taken, unless it misses the picture by so many times as much as the other one:
/// ringing is read as faces, which come nearer to it but are none, and outlines that are free come nearer than shapes that are known.
pub(super) const CLEARLY_WORSE: f32 = 2.0;

/// Of so many objects one that has run together with others makes them many: a pair among six.
const MANY: usize = 3;

/// Whether segments explain a picture as the paper's renderer paints, which no drawing is: by its edges, or by colors that mix.
pub(super) fn is_of_renderer(segments: &Fit<f32>) -> bool {
    let is_like_it = match segments.scene.edge.law {
        EdgeLaw::SquaredDistance => true,
        EdgeLaw::Area => segments.scene.compositing == Compositing::Blend,
        EdgeLaw::Distance => false,
    };
    is_like_it && segments.unexplained <= NOT_FLAT_SHARE
}

/// Of segments and a drawing the one that the picture is. Segments measure the profile of all edges at once: drawings have that of area coverage, or a
/// blur; the paper's renderer has its own. Ringing hides it, but makes things of its own, and a scene is not more than it needs to be; of as many
/// things the nearer ones, `factor` saying what is clearly worse.
#[inline(never)]
pub(super) fn likeliest(segments: Fit<f32>, drawn: Fit<f32>, factor: f32) -> Fit<f32> {
    // Under noise or a blur what follows it is nearer without being right.
    let is_clear = segments.scene.edge.law == EdgeLaw::Area && factor >= CLEARLY_WORSE;
    let as_many = if is_clear { 1.0 } else { factor };
    let is_drawing = if segments.scene.edge.law == EdgeLaw::SquaredDistance {
        // Fewer things that are nearer are better by both.
        let factor = if drawn.scene.objects.len() < segments.scene.objects.len() { 1.0 } else { factor };
        factor * drawn.loss < segments.loss
    } else {
        is_likelier(&drawn, &segments, as_many, factor)
    };
    if is_drawing { drawn } else { segments }
}

/// Which fit has more things. Where many of them have run together, their outlines are one thing of many numbers to one fit and many of few to the
/// other: what has more things then but takes fewer bits is as much.
fn amount(one: &Fit<f32>, other: &Fit<f32>) -> Ordering {
    let things = one.scene.objects.len().cmp(&other.scene.objects.len());
    let more = if things == Ordering::Less { other } else { one };
    let merged = more.ambiguity.iter().filter(|ambiguity| matches!(ambiguity, Ambiguity::Merged { .. })).count();
    let bits = scene_bits(&one.scene, 0).total_cmp(&scene_bits(&other.scene, 0));
    if MANY * merged >= more.scene.objects.len() && bits != things { Ordering::Equal } else { things }
}

/// Whether a fit is likelier than another one: with fewer things unless it is clearly farther from the picture (`factor` times), with more if it is
/// clearly nearer, with as many if it is not farther than `as_many` times.
pub(super) fn is_likelier(one: &Fit<f32>, other: &Fit<f32>, as_many: f32, factor: f32) -> bool {
    match amount(one, other) {
        Ordering::Less => one.loss <= factor * other.loss,
        Ordering::Equal => one.loss <= as_many * other.loss,
        Ordering::Greater => factor * one.loss < other.loss,
    }
}

/// Of two fits of a picture that went through a coder the one that describes it in fewer bits, in itself and in what it misses; the first of two that
/// are alike. What coders leave beside edges costs little then, and a thing that is not there much: on the mean over all pixels it is the other
/// way round.
#[inline(never)]
pub(super) fn shorter(
    first: Fit<f32>,
    second: Fit<f32>,
    image: ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<Fit<f32>, FitError> {
    let all = 0..image.size().pixels();
    let seen = channels(&image, &all);
    let mut bits = |fit: &Fit<f32>| -> Result<f64, FitError> {
        let painted = channels(&canvas.paint(&fit.scene, image.size())?.0.view(), &all);
        let missed = all.clone().map(|i| misfit_bits(off(seen, painted, i), f64::from(CODED_MIX)));
        Ok(missed.sum::<f64>() + scene_bits(&fit.scene, 0))
    };
    let is_second = bits(&second)? < bits(&first)?;
    Ok(if is_second { second } else { first })
}

/// The first of two fits, or the second if that is much nearer.
pub(super) fn likelier(first: Fit<f32>, second: Fit<f32>) -> Fit<f32> {
    if CLEARLY_WORSE * second.loss < first.loss { second } else { first }
}
