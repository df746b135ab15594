//! What shows nothing in a transparent picture.
//!
//! A fit sees a transparent picture over its matte, a color that the picture does not show. An object of that color is none: it is an
//! opening, and cut out of what is painted before it. Where the fit has taken another color for the background, that is an
//! object as large as the picture.

use alloc::vec::Vec;

use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::PixelLoss;
use dvp_core::scene::Region;
use dvp_core::shape::{Rectangle, ShapeError};
use dvp_core::{ImageSize, ImageView, Object, Pose, Real as _, Scene};

use crate::paint::Canvas;
use crate::tuning::OPENING_COLOR;
use crate::{Fit, FitError};

/// How closely the polygons of what is cut follow its curves, pixels.
const TOLERANCE_PX: f64 = 1.0 / 128.0;
/// What rounding leaves where edges coincide has less area, square pixels.
const LEAST_AREA_PX: f64 = 1e-2;

/// The fit of a transparent picture, without objects that show nothing; its scene is transparent.
///
/// `image` is the picture over `matte`, RGB, [0, 1]. Where something is cut, what the fit knows of the numbers of its objects is
/// lost: they are others. Its description length stays, openings counted as the objects that they were.
///
/// # Errors
/// [`FitError`] if what is left could not be drawn.
pub fn cut_openings(
    mut fit: Fit<f32>,
    image: ImageView<'_, f32>,
    matte: [f32; 3],
    canvas: &mut Canvas<f32>,
) -> Result<Fit<f32>, FitError> {
    let is_matte = |color: [f32; 3]| color.iter().zip(matte).all(|(a, b)| f64::from((a - b).abs()) < OPENING_COLOR);
    let scene = &fit.scene;
    if is_matte(scene.background) && !scene.objects.iter().any(|object| is_matte(object.color())) {
        fit.scene.transparent = true;
        return Ok(fit);
    }
    let size = image.size();
    let mut whole = scene.cast::<f64>();
    if !is_matte(scene.background) {
        whole.objects.insert(0, sheet(whole.background, size));
    }
    whole.background = matte.map(f64::from);
    whole.objects = without_openings(whole.objects, size, |object| is_matte(object.color().map(f32::of)))?;
    let scene: Scene<f32> = whole.cast();
    let (painted, drawing) = canvas.paint(&scene, size)?;
    let loss = PixelLoss::Mae.value(ImagePair::new(painted.view(), image)?, &mut ())?;
    let cut = Fit::of_painted(scene, &drawing, &image, painted.data());
    // An opening is described by the outline that it had as an object.
    let mut cut = Fit { loss, stop: fit.stop, steps: fit.steps, noise: fit.noise, bits: fit.bits, ..cut };
    cut.scene.transparent = true;
    Ok(cut)
}

/// A rectangle as large as the picture.
pub(super) fn sheet(color: [f64; 3], size: ImageSize) -> Object<f64> {
    let unit = f64::of_usize(size.unit_px());
    let sides = [size.width(), size.height()].map(|side| f64::of_usize(side) / unit);
    let pose = Pose { translation: sides.map(|side| 0.5 * side), ..Pose::identity() };
    Object { shape: Rectangle { size: sides, corner_radius: 0.0 }.into(), pose, paint: color.into(), confidence: 1.0 }
}

/// The objects that are no openings, with those that come after them cut out.
fn without_openings(
    objects: Vec<Object<f64>>,
    size: ImageSize,
    is_opening: impl Fn(&Object<f64>) -> bool,
) -> Result<Vec<Object<f64>>, ShapeError> {
    let px = f64::of_usize(size.unit_px()).recip();
    let region = |object: &Object<f64>| Region::of(&(object.shape.clone(), object.pose), TOLERANCE_PX * px);
    // Each with what is left of it, if something was cut.
    let mut kept: Vec<(Object<f64>, Option<Region>)> = Vec::new();
    for object in objects {
        if !is_opening(&object) {
            kept.push((object, None));
            continue;
        }
        let opening = region(&object)?;
        for (under, left) in &mut kept {
            let own = match &left {
                Some(left) => left.clone(),
                None => region(under)?,
            };
            if own.bounds().zip(opening.bounds()).is_some_and(|(a, b)| a.meets(&b, 0.0)) {
                *left = Some(own.difference(&opening)?);
            }
        }
    }
    let mut objects = Vec::new();
    for (mut object, left) in kept {
        if let Some(left) = left {
            let Some((shape, pose)) = left.to_placed(LEAST_AREA_PX * px * px)? else { continue };
            (object.shape, object.pose) = (shape, pose);
        }
        objects.push(object);
    }
    Ok(objects)
}
