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
//! | `blurred` | a drawing with the edges of a blur |
//! | `camera` | noise that grows with the light, and light that is uneven |
//! | `chance` | things of a spoiled drawing that noise, or single pixels, explain as well |
//! | `contrast` | pictures that take a small part of the levels of their file |
//! | `cut` | pictures that are not flat, as regions of one color |
//! | `doubts` | what a drawing leaves open |
//! | `drawing` | a drawing, what was one before it was spoiled, or segments |
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
mod blurred;
mod camera;
mod chance;
mod contrast;
mod cut;
mod doubts;
mod drawing;
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

use dvp_core::render::EdgeLaw;
use dvp_core::{Image, ImageView, Real as _};
use dvp_trace::noise;

use crate::options::check_values;
use crate::paint::Canvas;
use crate::prototypes::Decoder;
use crate::tuning::UNEXPLAINED_SHARE;
use crate::{Fit, FitError, FitOptions, FitScratch, Fitter};

pub use dvp_trace::Known;
pub use ground::Ground;
pub use openings::cut_openings;

use drawing::{drawing, of_painted, spoiled_or_segments};
use likelier::{CLEARLY_WORSE, shorter};
use most::at_most;
use ramps::AS_NEAR;
use squares::Squares;

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
/// Noise that grows with the light, as that of photons does, is made even first, and light that is uneven over the whole picture is taken out: its ground is
/// the first object then, with a ramp. A picture whose values take a small part of [0, 1] in more steps than 256 is read at more contrast.
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
    // Coders, and those who made pixels transparent, knew 8 bits.
    let stretched = if known.coded || known.matte.is_some() { None } else { contrast::stretched(&image) };
    match stretched {
        Some(stretched) => {
            let fit = of_camera(fitter, stretched.image.view(), known, scratch)?;
            Ok(contrast::restored(&stretched, fit))
        }
        None => of_camera(fitter, image, known, scratch),
    }
}

/// The scene of a picture that a camera may have taken.
#[inline(never)]
fn of_camera(
    fitter: &Fitter<f32>,
    image: ImageView<'_, f32>,
    known: &Known,
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
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
    let evened = if known.coded { None } else { noise::evened(&image) };
    match evened {
        Some(evened) => camera::with_noise(read(evened.image.view())?, &evened, image, &mut scratch.canvas),
        None => read(image),
    }
}

/// The scene of a picture, with color ramps if it has such.
#[inline(never)]
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
#[inline(never)]
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
