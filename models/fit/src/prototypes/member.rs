//! Which fitted objects show their shape well enough to learn from.

use alloc::vec::Vec;

use dvp_core::contour::contains;
use dvp_core::geometry::Bounds;
use dvp_core::render::Compositing;
use dvp_core::shape::{REFERENCE_VERTICES, ShapeError};
use dvp_core::{ImageSize, Real, Scene};

use super::form::Form;
use crate::paint::drawing_of;
use crate::{Ambiguity, Fit};

/// Objects with fewer pixels across (twice the radius of the disk of the same area) show too little of their shape.
pub const MIN_DIAMETER_PX: f64 = 12.0;
/// The same of drawings, whose edges are clear.
pub const MIN_DRAWN_DIAMETER_PX: f64 = 8.0;
/// How far a free outline may be off (root mean square, px): soft edges hide notches, small objects are cut to few
/// harmonics.
const OUTLINE_NOISE_PX: f64 = 0.7;
/// The same of an outline of a drawing.
const DRAWN_NOISE_PX: f64 = 0.4;
/// Outlines closer to another object's, or to the image border, than this (px) may be hidden in part.
const CLEARANCE_PX: f64 = 2.0;

/// An object to learn from.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Member {
    /// Its shape.
    pub form: Form,
    /// Radius of the disk of the same area, px: the uncertainty of the form is about 1 / radius.
    pub radius_px: f64,
    /// How far its outline may be off (root mean square, px).
    pub noise_px: f64,
    /// Index of its image, as the caller counts.
    pub image: usize,
    /// Index in the fitted scene.
    pub object: usize,
}

/// The objects of a fit that show their whole shape: not cropped, not behind or beside a later object where those hide
/// earlier ones (overlaps that mix colors show both outlines), nothing ambiguous but their own symmetry, of one ring, at least
/// [`MIN_DIAMETER_PX`] across, in drawings [`MIN_DRAWN_DIAMETER_PX`].
///
/// # Errors
/// [`ShapeError`] if an object of the fit is no closed shape.
#[inline(never)]
pub fn members<T: Real>(fit: &Fit<T>, size: ImageSize, image: usize) -> Result<Vec<Member>, ShapeError> {
    let outlines = outlines_px(&fit.scene, size)?;
    let hides = fit.scene.compositing == Compositing::Over;
    let drawn = is_drawing(&fit.scene);
    let (least, noise_px) =
        if drawn { (MIN_DRAWN_DIAMETER_PX, DRAWN_NOISE_PX) } else { (MIN_DIAMETER_PX, OUTLINE_NOISE_PX) };
    let mut found = Vec::new();
    for (object, rings) in outlines.iter().enumerate() {
        let [outline] = &rings[..] else { continue };
        let area = dvp_core::contour::signed_area(outline).abs();
        let radius_px = num_traits::Float::sqrt(area / core::f64::consts::PI);
        let open = fit.ambiguity.iter().any(|ambiguity| is_open(ambiguity, object));
        if open || 2.0 * radius_px < least || !is_whole(&outlines, object, hides, size) {
            continue;
        }
        if let Ok(form) = Form::of_polygon(outline) {
            found.push(Member { form, radius_px, noise_px, image, object });
        }
    }
    Ok(found)
}

/// Whether a scene is that of a drawing: its shapes are other than descriptors.
#[must_use]
#[inline(never)]
pub fn is_drawing<T: Real>(scene: &Scene<T>) -> bool {
    scene.objects.iter().any(|object| object.shape.efd().is_none())
}

/// The rings of every object of a scene in px.
fn outlines_px<T: Real>(scene: &Scene<T>, size: ImageSize) -> Result<Vec<Vec<Vec<[f64; 2]>>>, ShapeError> {
    let unit = f64::of_usize(size.unit_px());
    let drawing = drawing_of(scene, size, REFERENCE_VERTICES)?;
    let px = |vertex: &[T; 2]| vertex.map(|x| x.as_f64() * unit);
    let rings = |k| drawing.rings(k).iter().map(|ring| ring.iter().map(px).collect()).collect();
    Ok((0..drawing.object_count()).map(rings).collect())
}

/// Whether more than its symmetry is open about the object.
fn is_open(ambiguity: &Ambiguity, object: usize) -> bool {
    match *ambiguity {
        Ambiguity::Symmetry { .. } => false,
        Ambiguity::Cropped { object: at, .. }
        | Ambiguity::Hidden { object: at, .. }
        | Ambiguity::Merged { object: at, .. }
        | Ambiguity::Twin { object: at, .. } => at == object,
    }
}

/// Whether the outline lies in the image, and apart from all later ones if those hide it.
fn is_whole(outlines: &[Vec<Vec<[f64; 2]>>], object: usize, hides: bool, size: ImageSize) -> bool {
    let own = || outlines[object].iter();
    let limits = [f64::of_usize(size.width()), f64::of_usize(size.height())];
    let inside = |v: &[f64; 2]| (0..2).all(|c| v[c] > CLEARANCE_PX && v[c] < limits[c] - CLEARANCE_PX);
    let mut later = outlines[object + 1..].iter().flatten();
    own().flatten().all(inside) && (!hides || later.all(|later| own().all(|own| are_apart(own, later))))
}

fn are_apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> bool {
    let boxes = Bounds::of_vertices(a).zip(Bounds::of_vertices(b));
    if boxes.is_none_or(|(a, b)| !a.meets(&b, CLEARANCE_PX)) {
        return true;
    }
    let near = |p: &[f64; 2], q: &[f64; 2]| {
        let (x, y) = (p[0] - q[0], p[1] - q[1]);
        x * x + y * y < CLEARANCE_PX * CLEARANCE_PX
    };
    let touch = a.iter().any(|p| b.iter().any(|q| near(p, q)));
    !touch && !a.iter().any(|&p| contains(b, p)) && !b.iter().any(|&q| contains(a, q))
}
