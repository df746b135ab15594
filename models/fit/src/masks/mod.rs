//! From masks of other programs to smooth outlines.
//!
//! In: a label map (0 for the background, equal numbers for the pixels of one object). Out: a shape per label. A mask tells of
//! every pixel whether its center is inside: the outline runs between the centers on both sides of a crack, within half a
//! pixel of it, and anywhere there is as likely. `ring` takes the simplest outline that does so everywhere, in the middle of the
//! room it has (`between`); `smooth` makes a polygon where no outline of 64 vertices follows the mask.
//!
//! Proved by `tests.rs` in this folder; `tests/interop/mask_accuracy.py` compares with the contours of scikit-image.

mod between;
mod ring;
mod smooth;
#[cfg(test)]
mod tests;

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use dvp_core::contour::{Connectivity, trace_mask};
use dvp_core::shape::{AnyShape, Polygon, Rectangle};
use dvp_core::{ImageSize, Pose, Real};

use self::ring::{Ring, RingFitter};

/// The outline of a label.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LabelOutline<T> {
    /// The label.
    pub label: u32,
    /// Its outline. Pixels in one piece without holes: a rectangle if that is what they are, else descriptors if an outline of 64
    /// vertices follows them. Everything else is a polygon, of several rings for several pieces and holes.
    pub shape: AnyShape<T>,
    /// Where it stands, scene units.
    pub pose: Pose<T>,
}

/// Why a label map was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LabelMapError {
    /// Not one label per pixel.
    Length {
        /// Width x height.
        expected: usize,
        /// What came.
        len: usize,
    },
}

impl fmt::Display for LabelMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { expected, len } => write!(f, "{len} labels, needs {expected} (width x height)"),
        }
    }
}

impl core::error::Error for LabelMapError {}

/// The outlines of all labels above 0, in rising order.
///
/// Pixels of a label are in one piece if they share edges; it may have several pieces, and holes. Where an object touches
/// the border of the image its outline follows the border.
///
/// # Errors
/// [`LabelMapError::Length`] if there is not one label per pixel.
#[inline(never)]
pub fn outlines_of_labels<T: Real>(labels: &[u32], size: ImageSize) -> Result<Vec<LabelOutline<T>>, LabelMapError> {
    let (expected, len) = (size.pixels(), labels.len());
    if len != expected {
        return Err(LabelMapError::Length { expected, len });
    }
    let fitter = RingFitter::new();
    let unit_px = T::of_usize(size.unit_px());
    let windows = windows(labels, size.width());
    Ok(windows
        .into_iter()
        .filter_map(|(label, window)| outline_of(label, window, labels, size, &fitter, unit_px))
        .collect())
}

/// Columns and rows that hold a label: first ones, last ones + 1.
#[derive(Clone, Copy)]
struct Window {
    low: [usize; 2],
    high: [usize; 2],
}

fn windows(labels: &[u32], width: usize) -> BTreeMap<u32, Window> {
    let mut windows = BTreeMap::new();
    for (y, row) in labels.chunks_exact(width).enumerate() {
        let mut x = 0;
        for run in row.chunk_by(|a, b| a == b) {
            let end = x + run.len();
            if let Some(&label) = run.first().filter(|&&label| label > 0) {
                let window = windows.entry(label).or_insert(Window { low: [x, y], high: [end, y + 1] });
                window.low[0] = window.low[0].min(x);
                window.high = [window.high[0].max(end), y + 1];
            }
            x = end;
        }
    }
    windows
}

fn outline_of<T: Real>(
    label: u32,
    Window { low, high }: Window,
    labels: &[u32],
    size: ImageSize,
    fitter: &RingFitter<T>,
    unit_px: T,
) -> Option<LabelOutline<T>> {
    let (columns, rows) = (high[0] - low[0], high[1] - low[1]);
    let mut mask = vec![false; columns * rows];
    for (line, y) in mask.chunks_exact_mut(columns).zip(low[1]..) {
        let row = &labels[y * size.width()..][low[0]..high[0]];
        line.iter_mut().zip(row).for_each(|(inside, &other)| *inside = other == label);
    }
    // A window of the image is an image, and there is a value per pixel.
    let window = ImageSize::new(columns, rows).ok()?;
    let mut borders = trace_mask::<T>(&mask, window, Connectivity::Four).ok()?;
    let shift = low.map(T::of_usize);
    borders.iter_mut().flatten().for_each(|vertex| *vertex = [vertex[0] + shift[0], vertex[1] + shift[1]]);
    let mut rings: Vec<Ring<T>> = borders.iter().map(|border| fitter.fit(border)).collect();
    if let ([ring], [border]) = (&mut *rings, &*borders)
        && let Some((shape, pose)) = shape_of(ring, border, unit_px)
    {
        return Some(LabelOutline { label, shape, pose });
    }
    let polygon = |(ring, border): (Ring<T>, Vec<[T; 2]>)| match ring {
        Ring::Upright => border,
        Ring::Smooth(_, vertices) | Ring::Winding(vertices) => vertices,
    };
    let mut polygons: Vec<Vec<[T; 2]>> = rings.into_iter().zip(borders).map(polygon).collect();
    polygons.iter_mut().flatten().for_each(|vertex| *vertex = vertex.map(|v| v / unit_px));
    let polygon = Polygon::new(polygons).ok()?;
    Some(LabelOutline { label, shape: polygon.into(), pose: Pose::identity() })
}

/// The shape of a label of one ring, if it has a kind of its own, and where it stands.
fn shape_of<T: Real>(ring: &mut Ring<T>, border: &[[T; 2]], unit_px: T) -> Option<(AnyShape<T>, Pose<T>)> {
    match (ring, border) {
        // Opposite corners: the sides of borders are upright.
        (Ring::Upright, &[[left, top], _, [right, bottom], _]) => {
            let half = T::of(0.5);
            let translation = [(left + right) * half / unit_px, (top + bottom) * half / unit_px];
            let size = [(right - left).abs() / unit_px, (bottom - top).abs() / unit_px];
            let rectangle = Rectangle::new(size, T::zero()).ok()?;
            Some((rectangle.into(), Pose { translation, ..Pose::identity() }))
        }
        (Ring::Smooth(outline, _), _) => outline.normal_form(unit_px).map(|(efd, pose)| (efd.into(), pose)),
        _ => None,
    }
}
