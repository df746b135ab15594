//! A picture to its scene, whatever kind of picture it is: the one entry for programs that embed the fit.
//!
//! Two fits share the work. [`dvp_trace`] reads drawings: flat colors with clear edges. [`Fitter`] reads everything else: soft,
//! noisy and coded pictures, and those whose shapes are known. [`fit_picture`] decides which one a picture takes, and cuts the
//! openings out of transparent ones.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`fit_picture`]: the decision between the two fits |
//! | `bank` | pictures whose shapes are known |
//! | `ground` | [`Ground`]: the color that transparent pictures are put over |
//! | `most` | fewer objects than a drawing has |
//! | `openings` | [`cut_openings`]: what shows nothing in a transparent picture |
//!
//! *Units*: scene units, the shorter side of the picture is 1. Works in f32, as images come. Proved by the tests beside it, and by
//! those of the command, which calls it.

mod bank;
mod ground;
mod most;
mod openings;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;
use core::cmp::Ordering;

use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::{EdgeLaw, EdgeProfile, PixelLoss};
use dvp_core::{ImageView, Real as _, Scene};
use dvp_trace::{NoDrawing, PoseCovariance, Traced};

use crate::paint::Canvas;
use crate::prototypes::Decoder;
use crate::tuning::{MISSED_SHARE, NOT_FLAT_SHARE};
use crate::{Ambiguity, Fit, FitError, FitOptions, FitScratch, Fitter, StopReason};

pub use dvp_trace::Known;
pub use ground::Ground;
pub use openings::cut_openings;

use most::at_most;

/// Where two fits are of different kinds, the likelier one is taken, unless it misses the picture by so many times as much as the other one:
/// ringing is read as faces, which come nearer to it but are none, and outlines that are free come nearer than shapes that are known.
const CLEARLY_WORSE: f64 = 2.0;
/// Pictures of more things are no scenes of the paper's renderer, whatever their edges are: segments, which take long for many, are not asked for.
const FEW: usize = 16;
/// Noise of rounding to 8 bits, and as much again.
const ROUNDED: f32 = 0.003;

/// Memory of [`fit_picture`], one per thread, kept between pictures.
#[derive(Debug, Default)]
#[non_exhaustive]
pub struct PictureScratch {
    /// That of the fitter.
    pub fit: FitScratch<f32>,
    /// What scenes are painted on, to be compared with the picture.
    pub canvas: Canvas<f32>,
    /// The shapes that were looked for last, made ready.
    decoder: Option<Decoder<f32>>,
}

/// The scene of a picture, with the openings of a transparent one cut out.
///
/// The picture is taken as a drawing if it is one (flat colors with clear edges), else as segments; where edges leave a doubt as what
/// their profile says. If the options of `fitter` know the shapes, these are laid on it, unless a drawing without them is much nearer; if they
/// say how objects mix, it is taken as segments.
///
/// A transparent picture comes over its matte ([`Ground`]), and [`Known::matte`] says which color that is; of an opaque one it
/// is none.
///
/// Drawings keep all their objects, however many, unless fewer than the default of [`FitOptions::max_objects`] are asked for.
///
/// # Errors
/// [`FitError`] if a pixel is not finite or a scene on the way could not be drawn.
///
/// # Examples
/// ```
/// use dvp_core::{Image, ImageSize};
/// use dvp_fit::picture::{Known, PictureScratch, fit_picture};
/// use dvp_fit::{FitOptions, Fitter};
/// // A dark square on white.
/// let size = ImageSize::new(32, 32)?;
/// let dark = |i: usize| (8..24).contains(&(i % 32)) && (8..24).contains(&(i / 32));
/// let pixels: Vec<f32> = (0..size.pixels()).flat_map(|i| [if dark(i) { 0.1 } else { 1.0 }; 3]).collect();
/// let image = Image::from_interleaved(size, &pixels)?;
/// let fitter = Fitter::new(FitOptions::default())?;
/// let fit = fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default())?;
/// assert_eq!(fit.scene.objects.len(), 1);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn fit_picture(
    fitter: &Fitter<f32>,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    let fit = drawing_or_segments(fitter, image, known, scratch)?;
    let fit = match known.matte {
        Some(matte) => cut_openings(fit, image, matte, &mut scratch.canvas)?,
        None => fit,
    };
    let most = fitter.options().max_objects;
    if most < FitOptions::<f32>::default().max_objects {
        return at_most(fit, most, image, &mut scratch.canvas);
    }
    Ok(fit)
}

/// The nearer of the two fits, openings and all.
fn drawing_or_segments(
    fitter: &Fitter<f32>,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    let options = fitter.options();
    if options.compositing.is_some() {
        return fitter.fit(image, &mut scratch.fit);
    }
    if let Some(bank) = &options.bank {
        return bank::fit(fitter, bank, image, known, scratch);
    }
    let spoiled = || dvp_trace::trace(&image, &known.with_spoiled(true));
    let traced = match dvp_trace::trace(&image, known) {
        Ok(traced) if !leaves_doubt(&traced) => return drawn(traced, image, scratch),
        Ok(traced) if !known.coded => spoiled().or(Ok(traced)),
        // The paper's renderer has edges of its own, and few things.
        Err(NoDrawing::Soft { faces, .. }) if faces <= FEW => {
            let segments = fitter.fit(image, &mut scratch.fit)?;
            if is_of_renderer(&segments) {
                return Ok(segments);
            }
            return match spoiled() {
                Ok(traced) => likeliest(segments, traced, image, scratch),
                Err(_) => Ok(segments),
            };
        }
        Err(_) if !known.coded => spoiled(),
        traced => traced,
    };
    match traced {
        Ok(traced) if traced.scene.objects.len() > FEW => drawn(traced, image, scratch),
        Ok(traced) => {
            let segments = fitter.fit(image, &mut scratch.fit)?;
            if is_of_renderer(&segments) { Ok(segments) } else { likeliest(segments, traced, image, scratch) }
        }
        Err(_) => fitter.fit(image, &mut scratch.fit),
    }
}

/// The fit of a drawing, with the blur of the picture if that brings it nearer.
fn drawn(traced: Traced, image: ImageView<'_, f32>, scratch: &mut PictureScratch) -> Result<Fit<f32>, FitError> {
    let Traced { scene, covariances, bits, blur, .. } = traced;
    let (covariance, ambiguity) = doubt_of_poses(&covariances);
    let blurred = (blur > 0.0).then(|| {
        // The logistic curve of the same standard deviation, in the doubled frame.
        let sigma = 2.0 * blur * 3.0_f64.sqrt() / core::f64::consts::PI;
        let edge = EdgeProfile::distance(f32::of(sigma) / f32::of_usize(image.size().unit_px()));
        Scene { edge, ..scene.clone() }
    });
    let mut best: Option<Fit<f32>> = None;
    for scene in [Some(scene), blurred].into_iter().flatten() {
        let (painted, drawing) = scratch.canvas.paint(&scene, image.size())?;
        let loss = PixelLoss::Mae.value(ImagePair::new(painted.view(), image)?, &mut ())?;
        if best.as_ref().is_none_or(|best| loss < best.loss) {
            best = Some(Fit { loss, ..Fit::of_painted(scene, &drawing, &image, painted.data()) });
        }
    }
    let best = best.ok_or(FitError::Setting { what: "edge", must: "known" })?;
    Ok(Fit { bits, stop: StopReason::Converged, covariance, ambiguity, ..best })
}

/// Whether segments explain a picture with the edges of the paper's renderer, which no drawing has.
fn is_of_renderer(segments: &Fit<f32>) -> bool {
    segments.scene.edge.law == EdgeLaw::SquaredDistance && segments.unexplained <= NOT_FLAT_SHARE
}

/// Of segments and a drawing the one that the picture is. Segments measure the profile of all edges at once: drawings have that of area coverage, or a
/// blur; the paper's renderer has its own. Ringing hides it, but makes things of its own, and a scene is not more than it needs to be; of as many
/// things the nearer ones.
fn likeliest(
    segments: Fit<f32>,
    traced: Traced,
    image: ImageView<'_, f32>,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    let drawn = drawn(traced, image, scratch)?;
    // What is left of a noisy picture is noise; where next to nothing else is, it says nothing.
    let is_noisy = drawn.noise > ROUNDED;
    let misses = |fit: &Fit<f32>| if is_noisy { fit.unexplained.max(MISSED_SHARE) } else { f64::from(fit.loss) };
    let [of_drawing, of_segments] = [&drawn, &segments].map(misses);
    let fewer = match drawn.scene.objects.len().cmp(&segments.scene.objects.len()) {
        Ordering::Less => true,
        Ordering::Equal => of_drawing <= of_segments,
        Ordering::Greater => false,
    };
    let is_drawing = if segments.scene.edge.law != EdgeLaw::SquaredDistance && fewer {
        of_drawing <= CLEARLY_WORSE * of_segments
    } else {
        CLEARLY_WORSE * of_drawing < of_segments
    };
    Ok(if is_drawing { drawn } else { segments })
}

/// The first of two fits, or the second if that is much nearer.
fn likelier(first: Fit<f32>, second: Fit<f32>) -> Fit<f32> {
    if CLEARLY_WORSE * f64::from(second.loss) < f64::from(first.loss) { second } else { first }
}

/// Whether edges leave a doubt that a picture is a drawing. Stains of either sign: blur and profiles of their own leave too much of the other
/// side beyond edges, filters that sharpen too little.
fn leaves_doubt(traced: &Traced) -> bool {
    traced.stained.abs() > dvp_trace::tuning::DOUBTFUL_STAINED
}

/// What is known of poses as a fit says it: covariances of (x, y, log scale, rotation, log stretch), NaN where nothing is known, and which
/// objects look alike at every angle.
fn doubt_of_poses(known: &[Option<PoseCovariance>]) -> (Vec<[f32; 25]>, Vec<Ambiguity>) {
    if known.iter().all(Option::is_none) {
        return (Vec::new(), Vec::new());
    }
    let mut ambiguity = Vec::new();
    let covariance = known.iter().enumerate().map(|(object, known)| {
        let Some(known) = known else { return [f32::NAN; 25] };
        if known.is_round {
            ambiguity.push(Ambiguity::Symmetry { object, order: 0 });
        }
        core::array::from_fn(|k| f32::of(known.numbers[k / 5][k % 5]))
    });
    let covariance = covariance.collect();
    (covariance, ambiguity)
}
