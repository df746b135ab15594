//! The fit of a picture as a drawing, as what it was before it was spoiled, or as segments: the likeliest.

use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::{EdgeLaw, PixelLoss};
use dvp_core::{Drawing, Image, ImageView, Real as _, Scene};
use dvp_trace::ramps::are_wide;
use dvp_trace::tuning::{DOUBTFUL_STAINED, WIDE_BLUR};
use dvp_trace::{Known, NoDrawing, Traced, noise};

use super::PictureScratch;
use super::blurred::{self, blurred};
use super::chance;
use super::doubts;
use super::likelier::{CLEARLY_WORSE, is_likelier, is_of_renderer, likeliest};
use super::mend::Wrong;
use super::spare::Spare;
use crate::scene_refine::SceneRefine;
use crate::tuning::NOT_FLAT_SHARE;
use crate::{Fit, FitError, Fitter, StopReason};

/// [`CLEARLY_WORSE`] in noise, whose own mean is known to half a percent of it at 64 x 64 pixels.
pub(super) const CLEARLY_WORSE_IN_NOISE: f32 = 1.02;
/// Pictures of more things are no scenes of the paper's renderer, whatever their edges are: segments, which take long for many, are not asked for.
const FEW: usize = 16;
/// The same where there is noise: outlines that it hides leave slivers beside them, and segments none.
const FEW_IN_NOISE: usize = 48;
/// Most steps of a refinement: dozens of ellipses take as many.
const MOST_STEPS: usize = 100;
/// Share of a picture of which a drawing that leaves more is none.
const MOSTLY: f64 = 0.5;

/// The picture as it was before it was spoiled; none if a coder has spoiled it, which is known then, or if it was no drawing.
#[inline(never)]
pub(super) fn unspoiled(image: ImageView<'_, f32>, known: &Known) -> Option<Traced> {
    if known.coded { None } else { dvp_trace::trace(&image, &known.with_spoiled(true)).ok() }
}

/// The fit of a drawing, or of segments where edges leave a doubt and those are likelier.
pub(super) fn drawing(
    fitter: &Fitter<f32>,
    traced: Traced,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    // Coders make the edges of colors wide that were clear.
    let is_doubtful = leaves_doubt(&traced) || !(traced.coded || known.coded) && are_wide(&image);
    let is_coded = traced.coded;
    let is_few = traced.scene.objects.len() <= FEW;
    let mut drawn = self::drawn(traced, image, scratch)?;
    let segments = if is_doubtful && is_few { Some(fitter.fit(image, &mut scratch.fit)?) } else { None };
    // What a coder leaves beside edges looks as if they were wide, unless segments explain it with clear ones.
    let is_clear = |fit: &Fit<f32>| fit.scene.edge.law == EdgeLaw::Area && fit.unexplained <= NOT_FLAT_SHARE;
    let may_be_wide = is_doubtful && !(is_coded && segments.as_ref().is_some_and(is_clear));
    if may_be_wide && let Some(again) = unspoiled(image, known) {
        let again = self::drawn(again, image, scratch)?;
        if is_likelier(&again, &drawn, 1.0, CLEARLY_WORSE) {
            drawn = again;
        }
    }
    match segments {
        Some(segments) => Ok(likeliest(segments, drawn, CLEARLY_WORSE)),
        None => settled(fitter, drawn, image, scratch),
    }
}

/// The fit of a picture that is no drawing as it is: of what it was before it was spoiled, or of segments.
pub(super) fn spoiled_or_segments(
    fitter: &Fitter<f32>,
    reason: &NoDrawing,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    // The paper's renderer has edges of its own, and few things.
    let is_few = matches!(reason, NoDrawing::Soft { faces, .. } if *faces <= FEW);
    let mut traced = if is_few { None } else { unspoiled(image, known) };
    let few = |traced: &Traced| if traced.noise > 0.0 { FEW_IN_NOISE } else { FEW };
    if let Some(traced) = traced.take_if(|traced| traced.scene.objects.len() > few(traced)) {
        let drawn = drawn(traced, image, scratch)?;
        return settled(fitter, drawn, image, scratch);
    }
    let segments = fitter.fit(image, &mut scratch.fit)?;
    let is_of_renderer = is_of_renderer(&segments);
    if is_few {
        if is_of_renderer {
            return Ok(segments);
        }
        traced = unspoiled(image, known);
    }
    let Some(traced) = traced else { return Ok(segments) };
    let drawn = drawn(traced, image, scratch)?;
    if drawn.noise <= f32::of(noise::ROUNDED) {
        return Ok(likeliest(segments, drawn, CLEARLY_WORSE));
    }
    // Noise hides the profile of edges: what looks like the paper's renderer is a drawing only if that is clearly nearer without more things. What both
    // leave of a noisy picture is its noise for the most part.
    if is_of_renderer {
        let is_nearer = CLEARLY_WORSE_IN_NOISE * drawn.loss < segments.loss;
        let is_more = drawn.scene.objects.len() > segments.scene.objects.len();
        return Ok(if is_nearer && !is_more { drawn } else { segments });
    }
    Ok(likeliest(segments, drawn, CLEARLY_WORSE_IN_NOISE))
}

/// The fit of a drawing of many things, or without a doubt; if it leaves most of the picture, which is not flat then,
/// the nearer one of it and of segments.
#[inline(never)]
pub(super) fn settled(
    fitter: &Fitter<f32>,
    drawn: Fit<f32>,
    image: ImageView<'_, f32>,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    if drawn.unexplained <= MOSTLY {
        return Ok(drawn);
    }
    let segments = fitter.fit(image, &mut scratch.fit)?;
    if segments.unexplained > NOT_FLAT_SHARE {
        return Ok(if drawn.loss < segments.loss { drawn } else { segments });
    }
    Ok(likeliest(segments, drawn, CLEARLY_WORSE))
}

/// The fit of a drawing, mended where nothing hides what it misses, or with the blur of the picture if that brings it nearer.
#[inline(never)]
pub(super) fn drawn(
    mut traced: Traced,
    image: ImageView<'_, f32>,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    let (canvas, size) = (&mut scratch.canvas, image.size());
    let (mut painted, mut drawing) = canvas.paint(&traced.scene, size)?;
    let is_clear = traced.blur <= WIDE_BLUR && traced.noise == 0.0;
    if let Some(wrong) = is_clear.then(|| Wrong::of(&traced, &drawing, painted, &image)).flatten() {
        wrong.mend(&mut traced, &drawing, image, canvas)?;
        (painted, drawing) = canvas.paint(&traced.scene, size)?;
    }
    if let Some(spare) = is_clear.then(|| Spare::of(&drawing, painted)).flatten() {
        spare.leave_out(&mut traced, &drawing, &image, canvas)?;
        (painted, drawing) = canvas.paint(&traced.scene, size)?;
    }
    let unit_px = size.unit_px();
    if !is_clear {
        let shown = if traced.blur > 0.0 { blurred(&traced.scene, traced.blur, unit_px) } else { traced.scene.clone() };
        chance::leave_out(&mut traced, &shown, &image, canvas)?;
        (painted, drawing) = canvas.paint(&traced.scene, size)?;
    }
    let mut best = of_painted(&traced.scene, &drawing, painted, image)?;
    let Traced { scene, doubts: left, bits, blur, .. } = traced;
    let (covariance, mut ambiguity) = doubts::of_poses(&left);
    ambiguity.extend(doubts::merged(&drawing, &left));
    if blur > 0.0 {
        let mut scene = blurred::nearest(blurred(&scene, blur, unit_px), image, canvas)?;
        // Windows beside the places where things have run together tell of several; all pixels together tell of each.
        if left.iter().any(|doubt| doubt.heap.is_some()) {
            scene = SceneRefine::default().with_max_steps(MOST_STEPS).fit(image, &scene)?.scene;
        }
        let (painted, drawing) = canvas.paint(&scene, size)?;
        let other = of_painted(&scene, &drawing, painted, image)?;
        if other.loss < best.loss {
            best = other;
        }
    }
    Ok(Fit { bits, stop: StopReason::Converged, covariance, ambiguity, ..best })
}

/// What a scene that is painted leaves of a picture.
#[inline(never)]
pub(super) fn of_painted(
    scene: &Scene<f32>,
    drawing: &Drawing<f32>,
    painted: &Image<f32>,
    image: ImageView<'_, f32>,
) -> Result<Fit<f32>, FitError> {
    let loss = PixelLoss::Mae.value(ImagePair::new(painted.view(), image)?, &mut ())?;
    Ok(Fit { loss, ..Fit::of_painted(scene.clone(), drawing, &image, painted.data()) })
}

/// Whether edges leave a doubt that a picture is a drawing. Stains of either sign: blur and profiles of their own leave too much of the other
/// side beyond edges, filters that sharpen too little.
pub(super) fn leaves_doubt(traced: &Traced) -> bool {
    traced.stained.abs() > DOUBTFUL_STAINED
}
