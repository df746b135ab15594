//! Which fitted objects show their shape well enough to learn from.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::contour::contains;
use dvp_core::geometry::Bounds;
use dvp_core::render::Compositing;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, ShapeError};
use dvp_core::{ImageSize, Real, Scene};

use super::form::Form;
use crate::{Ambiguity, Fit};

/// Objects with fewer pixels across (twice the radius of the disk of the same area) show too little of their shape.
pub const MIN_DIAMETER_PX: f64 = 12.0;
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
    /// Index of its image, as the caller counts.
    pub image: usize,
    /// Index in the fitted scene.
    pub object: usize,
}

/// The objects of a fit that show their whole shape: not cropped, not behind or beside a later object where those hide
/// earlier ones (overlaps that mix colors show both outlines), nothing ambiguous but their own symmetry, at least
/// [`MIN_DIAMETER_PX`] across.
///
/// # Errors
/// [`ShapeError`] if an object of the fit is no closed shape.
#[inline(never)]
pub fn members<T: Real>(fit: &Fit<T>, size: ImageSize, image: usize) -> Result<Vec<Member>, ShapeError> {
    let outlines = outlines_px(&fit.scene, size)?;
    let hides = fit.scene.compositing == Compositing::Over;
    let mut found = Vec::new();
    for (object, outline) in outlines.iter().enumerate() {
        let area = dvp_core::contour::signed_area(outline).abs();
        let radius_px = num_traits::Float::sqrt(area / core::f64::consts::PI);
        let open = fit.ambiguity.iter().any(|ambiguity| is_open(ambiguity, object));
        if open || 2.0 * radius_px < MIN_DIAMETER_PX || !is_whole(&outlines, object, hides, size) {
            continue;
        }
        if let Ok(form) = Form::of_polygon(outline) {
            found.push(Member { form, radius_px, image, object });
        }
    }
    Ok(found)
}

/// The outlines of a scene in px.
pub(super) fn outlines_px<T: Real>(scene: &Scene<T>, size: ImageSize) -> Result<Vec<Vec<[f64; 2]>>, ShapeError> {
    let unit = f64::of_usize(size.unit_px());
    let harmonics = scene.harmonic_count();
    let basis = OutlineBasis::<T>::new(REFERENCE_VERTICES, harmonics.max(1))?;
    let outline = |object: &dvp_core::Object<T>| {
        let mut vertices = vec![[T::zero(); 2]; REFERENCE_VERTICES];
        basis.outline(object.shape.descriptors()?.rows(), &mut vertices)?;
        object.pose.transform(&mut vertices);
        Ok(vertices.into_iter().map(|v| v.map(|x| x.as_f64() * unit)).collect())
    };
    scene.objects.iter().map(outline).collect()
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
fn is_whole(outlines: &[Vec<[f64; 2]>], object: usize, hides: bool, size: ImageSize) -> bool {
    let own = &outlines[object];
    let limits = [f64::of_usize(size.width()), f64::of_usize(size.height())];
    let inside = own.iter().all(|v| (0..2).all(|c| v[c] > CLEARANCE_PX && v[c] < limits[c] - CLEARANCE_PX));
    inside && (!hides || outlines[object + 1..].iter().all(|later| are_apart(own, later)))
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
