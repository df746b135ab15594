//! Closed polygons around the pixels of a mask, or along a level of a field.

use alloc::vec;
use alloc::vec::Vec;

use super::walk::{Heading, walk};
use super::{Connectivity, ContourError};
use crate::dims::ImageSize;
use crate::real::Real;

/// The borders of `mask` (a value per pixel, row by row) along the edges of its pixels: exact, corners only.
///
/// Outer borders have a positive [`signed_area`](super::signed_area), holes a negative one; the sum is the number of pixels. Borders of
/// [`Connectivity::Four`] never cross but may touch at corners.
///
/// # Errors
/// [`ContourError::Length`].
///
/// # Examples
/// ```
/// use dvp_core::{ImageSize, contour::{Connectivity, trace_mask}};
/// let borders = trace_mask::<f32>(&[true, true], ImageSize::new(2, 1)?, Connectivity::Four)?;
/// assert_eq!(borders, [[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]]]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn trace_mask<T: Real>(
    mask: &[bool],
    size: ImageSize,
    connectivity: Connectivity,
) -> Result<Vec<Vec<[T; 2]>>, ContourError> {
    check(mask.len(), size)?;
    let mut loops: Vec<Vec<[T; 2]>> = Vec::new();
    let mut heading = Heading::PlusX;
    walk(
        |index| mask[index],
        size,
        connectivity,
        |crack, begins| {
            if begins {
                // A corner: straight before it would be a crack heading +x, which the scan had met earlier.
                loops.push(vec![crack.start.map(T::of_usize)]);
            } else if crack.heading != heading
                && let Some(vertices) = loops.last_mut()
            {
                vertices.push(crack.start.map(T::of_usize));
            }
            heading = crack.heading;
        },
    );
    Ok(loops)
}

/// The lines where `field` (a value per pixel, at its center, row by row) crosses `level`: marching squares with linear
/// interpolation, so that a soft edge gives the outline to a fraction of a pixel.
///
/// Inside is where the field is at or above the level; NaN is outside. Lines that leave the image are closed along its
/// border. Signs as in [`trace_mask`]; `connectivity` decides the squares with two opposite corners inside.
///
/// # Errors
/// [`ContourError::Length`].
pub fn trace_level<T: Real>(
    field: &[T],
    size: ImageSize,
    level: T,
    connectivity: Connectivity,
) -> Result<Vec<Vec<[T; 2]>>, ContourError> {
    check(field.len(), size)?;
    let half = T::of(0.5);
    let value = |[x, y]: [usize; 2]| {
        if x < size.width() && y < size.height() { Some(field[y * size.width() + x]) } else { None }
    };
    let mut loops: Vec<Vec<[T; 2]>> = Vec::new();
    walk(
        |index| field[index] >= level,
        size,
        connectivity,
        |crack, begins| {
            let [inside, outside] = crack.sides();
            // From the center of the pixel inside to that of the pixel outside; the image ends half way.
            let fraction = match (value(inside), value(outside)) {
                (Some(high), Some(low)) => (high - level) / (high - low),
                _ => half,
            };
            let fraction = if fraction.is_finite() { fraction } else { half };
            let [x, y] = inside.map(|i| T::of_usize(i) + half);
            let point = match crack.heading {
                Heading::PlusX => [x, y - fraction],
                Heading::PlusY => [x + fraction, y],
                Heading::MinusX => [x, y + fraction],
                Heading::MinusY => [x - fraction, y],
            };
            match loops.last_mut() {
                Some(vertices) if !begins => vertices.push(point),
                _ => loops.push(vec![point]),
            }
        },
    );
    Ok(loops)
}

fn check(len: usize, size: ImageSize) -> Result<(), ContourError> {
    let expected = size.pixels();
    if len == expected { Ok(()) } else { Err(ContourError::Length { expected, len }) }
}
