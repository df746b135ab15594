//! A picture to its scene, whatever kind of picture it is: the one entry for programs that embed the fit.
//!
//! Two fits share the work. [`dvp_trace`] reads drawings: flat colors with clear edges, and what noise, blur and coders left of such. [`Fitter`]
//! reads everything else: scenes of the paper's renderer, and those whose shapes are known. [`fit_picture`] decides
//! which one a picture takes, and cuts the openings out of transparent ones.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`fit_picture`]: the decision between the two fits |
//! | `bank` | pictures whose shapes are known |
//! | `camera` | noise that grows with the light, and light that is uneven |
//! | `cut` | pictures that are not flat, as regions of one color |
//! | `ground` | [`Ground`]: the color that transparent pictures are put over |
//! | `likelier` | which of two fits the picture is |
//! | `mend` | what a drawing paints wrongly, and what it misses |
//! | `spare` | things of a drawing that it does not need |
//! | `parts` | what changes in a picture where a drawing does |
//! | `most` | fewer objects than a drawing has |
//! | `ramps` | colors that change from place to place, taken out before and put back |
//! | `openings` | [`cut_openings`]: what shows nothing in a transparent picture |
//! | `squares` | pictures that were enlarged by repeating pixels, and sprites |
//! | `wide` | large pictures with wide edges, read by every k-th pixel |
//!
//! *Units*: scene units, the shorter side of the picture is 1. Works in f32, as images come. Proved by the tests beside it, and by
//! those of the command, which calls it.

mod bank;
mod camera;
mod cut;
mod ground;
mod likelier;
mod mend;
mod most;
mod openings;
mod parts;
mod ramps;
mod spare;
mod squares;
#[cfg(test)]
mod tests;
mod wide;

use alloc::vec::Vec;
use core::f64::consts::FRAC_2_SQRT_PI;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::{EdgeLaw, EdgeProfile, PixelLoss};
use dvp_core::{Drawing, Image, ImageView, Real as _, Scene};
use dvp_trace::ramps::are_wide;
use dvp_trace::tuning::{DOUBTFUL_STAINED, WIDE_BLUR};
use dvp_trace::{NoDrawing, PoseCovariance, Traced, noise};

use crate::options::check_values;
use crate::paint::Canvas;
use crate::prototypes::Decoder;
use crate::tuning::{NOT_FLAT_SHARE, UNEXPLAINED_SHARE};
use crate::{Ambiguity, Fit, FitError, FitOptions, FitScratch, Fitter, StopReason};

pub use dvp_trace::Known;
pub use ground::Ground;
pub use openings::cut_openings;

use likelier::{CLEARLY_WORSE, is_likelier, is_of_renderer, likelier, likeliest, shorter};
use mend::Wrong;
use most::at_most;
use ramps::AS_NEAR;
use spare::Spare;
use squares::Squares;

/// [`CLEARLY_WORSE`] in noise, whose own mean is known to half a percent of it at 64 x 64 pixels.
const CLEARLY_WORSE_IN_NOISE: f32 = 1.02;
/// Pictures of more things are no scenes of the paper's renderer, whatever their edges are: segments, which take long for many, are not asked for.
const FEW: usize = 16;
/// Share of a picture of which a drawing that leaves more is none.
const MOSTLY: f64 = 0.5;

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
/// The picture is taken as a drawing if it is one (flat colors with clear edges), or was one before it got noise, a blur, or what coders and
/// filters leave; else as segments; where edges leave a doubt as what their profile says. If the options of `fitter` know the shapes, these are
/// laid on it, unless a drawing without them is much nearer, or shorter where a coder has changed the picture; if they say how objects mix, it is
/// taken as segments. What is no drawing at all, as a photograph, is cut into regions of one color, as many as objects are allowed.
///
/// A transparent picture comes over its matte ([`Ground`]), and [`Known::matte`] says which color that is; of an opaque one it
/// is none.
///
/// What was enlarged by repeating pixels is read at the size that it was drawn: [`Fit::loss`] and all else that the fit says of pixels is of that
/// picture. So is a sprite, whose pixels are squares of one color, with each of them enlarged. Of a large picture with wide edges every k-th pixel is
/// read, as long as the scene misses no more of the whole; [`Fit::loss`] is of the whole, what else the fit says of pixels of those that were read.
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
    check_values(&image)?;
    // Who says how objects mix asks for a scene of the renderer, and no square has its edges.
    let small = if fitter.options().compositing.is_some() { None } else { squares::reduced(&image) };
    let image = small.as_ref().map_or(image, Image::view);
    let mut read = |image: ImageView<'_, f32>| {
        let fit = with_ramps(fitter, image, small.is_some(), known, scratch)?;
        if !may_have_ramps(fitter, known) || known.matte.is_some() {
            return Ok(fit);
        }
        camera::or_in_light(fit, image, scratch, |even, scratch| fit_flat(fitter, even, false, known, scratch))
    };
    // A coder has taken away what noise would tell of the light.
    match noise::evened(&image).filter(|_| !known.coded) {
        Some(evened) => camera::with_noise(read(evened.image.view())?, &evened, image, &mut scratch.canvas),
        None => read(image),
    }
}

/// The scene of a picture, with color ramps if it has such.
fn with_ramps(
    fitter: &Fitter<f32>,
    image: ImageView<'_, f32>,
    are_repeated: bool,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    let Some(leveled) = may_have_ramps(fitter, known).then(|| dvp_trace::ramps::level(&image)).flatten() else {
        return fit_flat(fitter, image, are_repeated, known, scratch);
    };
    let fit = fit_flat(fitter, leveled.image.view(), are_repeated, known, scratch)?;
    // A blur makes edges look like ramps.
    if fit.scene.edge.law != EdgeLaw::Area {
        return fit_flat(fitter, image, are_repeated, known, scratch);
    }
    let fit = ramps::with_ramps(fit, &leveled, image, &mut scratch.canvas)?;
    if fit.loss <= AS_NEAR && leveled.ramps.iter().any(|ramp| ramp.is_exact) {
        return Ok(fit);
    }
    // What ramps leave unexplained, a coder may have left, or several that lie on one another.
    let flat = fit_flat(fitter, image, are_repeated, known, scratch)?;
    Ok(ramps::better(fit, flat))
}

/// Whether a picture may have colors that change from place to place: not where shapes are known, or how objects mix.
fn may_have_ramps(fitter: &Fitter<f32>, known: &Known) -> bool {
    let options = fitter.options();
    !known.flat && options.bank.is_none() && options.compositing.is_none() && !known.coded
}

/// The scene of a picture without color ramps, `are_repeated` if it was enlarged by repeating pixels.
fn fit_flat(
    fitter: &Fitter<f32>,
    image: ImageView<'_, f32>,
    are_repeated: bool,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    let fit = match wide::fit(fitter, image, known, scratch)? {
        Some(fit) => fit,
        None => drawing_or_segments(fitter, image, known, scratch)?,
    };
    let mut enlarged = None;
    let (fit, image) = or_squares(fit, image, are_repeated, &mut enlarged, (fitter, known), scratch)?;
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

/// The fit of a picture, or of its squares, which are put into `enlarged`, with what it is a fit of: if the scene that was found misses more than it
/// should, and squares are shorter than it is with what it misses. Of pixels that somebody repeated (`are_repeated`) it should miss none, and as few
/// things are enough. What noise leaves does not count; and shapes that are known are no squares.
#[inline(never)]
fn or_squares<'a>(
    fit: Fit<f32>,
    image: ImageView<'a, f32>,
    are_repeated: bool,
    enlarged: &'a mut Option<Image<f32>>,
    (fitter, known): (&Fitter<f32>, &Known),
    scratch: &mut PictureScratch,
) -> Result<(Fit<f32>, ImageView<'a, f32>), FitError> {
    let options = fitter.options();
    let is_explained = !are_repeated && fit.unexplained <= UNEXPLAINED_SHARE && fit.noise <= f32::of(noise::ROUNDED);
    let is_known = options.bank.is_some() || options.compositing.is_some();
    if is_explained || is_known || !squares::may_be(image.size()) {
        return Ok((fit, image));
    }
    let painted = scratch.canvas.paint(&fit.scene, image.size())?.0.view();
    let Some(squares) = Squares::of(&image, &painted, are_repeated) else { return Ok((fit, image)) };
    let (things, are_shorter) = (fit.scene.objects.len(), squares.bits < fit.bits + squares.wrong_bits);
    // Every color but the background's is one thing at least.
    let may_be_as_few = are_repeated && squares.colors <= things + 1;
    if !(are_shorter || may_be_as_few) {
        return Ok((fit, image));
    }
    let Some(large) = squares::enlarged(&image) else { return Ok((fit, image)) };
    let large = enlarged.insert(large).view();
    let of_squares = drawing_or_segments(fitter, large, &known.with_squares(true), scratch)?;
    let is_better = of_squares.loss < fit.loss;
    let is_taken = is_better && (are_shorter || of_squares.scene.objects.len() <= things);
    Ok(if is_taken { (of_squares, large) } else { (fit, image) })
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
    let fit = match dvp_trace::trace(&image, known) {
        Ok(traced) => drawing(fitter, traced, image, known, scratch)?,
        Err(reason) => spoiled_or_segments(fitter, &reason, image, known, scratch)?,
    };
    cut::or_regions(fit, image, (options.max_objects, known.coded), scratch)
}

/// The picture as it was before it was spoiled; none if a coder has spoiled it, which is known then, or if it was no drawing.
#[inline(never)]
fn unspoiled(image: ImageView<'_, f32>, known: &Known) -> Option<Traced> {
    if known.coded { None } else { dvp_trace::trace(&image, &known.with_spoiled(true)).ok() }
}

/// The fit of a drawing, or of segments where edges leave a doubt and those are likelier.
fn drawing(
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
fn spoiled_or_segments(
    fitter: &Fitter<f32>,
    reason: &NoDrawing,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    // The paper's renderer has edges of its own, and few things.
    let is_few = matches!(reason, NoDrawing::Soft { faces, .. } if *faces <= FEW);
    let mut traced = if is_few { None } else { unspoiled(image, known) };
    if let Some(traced) = traced.take_if(|traced| traced.scene.objects.len() > FEW) {
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
fn settled(
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
fn drawn(mut traced: Traced, image: ImageView<'_, f32>, scratch: &mut PictureScratch) -> Result<Fit<f32>, FitError> {
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
    let mut best = of_painted(&traced.scene, &drawing, painted, image)?;
    let Traced { scene, covariances, bits, blur, .. } = traced;
    let (covariance, ambiguity) = doubt_of_poses(&covariances);
    // Such a profile has the pixel's area in it. The integral of F (1 - F), F the profile, is half the softness of the logistic curve, and the
    // deviation of a blur over the root of pi.
    let blurred = (blur > 0.0).then(|| {
        let softness = FRAC_2_SQRT_PI * (blur * blur + 1.0 / 12.0).sqrt();
        let edge = EdgeProfile::distance(f32::of(softness) / f32::of_usize(image.size().unit_px()));
        Scene { edge, ..scene }
    });
    if let Some(scene) = blurred {
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
fn of_painted(
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
fn leaves_doubt(traced: &Traced) -> bool {
    traced.stained.abs() > DOUBTFUL_STAINED
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
