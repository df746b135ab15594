//! Connected components, by one pass that joins provisional labels and one that numbers them.

use alloc::vec;
use alloc::vec::Vec;

use super::{Connectivity, ContourError};
use crate::dims::ImageSize;

/// The connected components of a mask.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Components {
    /// Per pixel, row by row: 0 outside the mask, else the number of its component, from 1 in the order of first pixels.
    pub labels: Vec<u32>,
    /// Pixels of the components; `sizes[k - 1]` belongs to the label k.
    pub sizes: Vec<usize>,
}

/// Labels the connected components of `mask`, which holds a value per pixel, row by row.
///
/// # Errors
/// [`ContourError::Length`].
///
/// # Examples
/// ```
/// use dvp_core::{ImageSize, contour::{Connectivity, label}};
/// // X X .
/// // . . X
/// let mask = [true, true, false, false, false, true];
/// let size = ImageSize::new(3, 2)?;
/// assert_eq!(label(&mask, size, Connectivity::Four)?.labels, [1, 1, 0, 0, 0, 2]);
/// assert_eq!(label(&mask, size, Connectivity::Eight)?.sizes, [3]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub fn label(mask: &[bool], size: ImageSize, connectivity: Connectivity) -> Result<Components, ContourError> {
    let (expected, len) = (size.pixels(), mask.len());
    if len != expected {
        return Err(ContourError::Length { expected, len });
    }
    let width = size.width();
    let mut labels = vec![0_u32; len];
    // Provisional label k has the parent parents[k], itself if it is a root; 0 is the outside.
    let mut parents = vec![0_u32];
    for (index, _) in mask.iter().enumerate().filter(|(_, inside)| **inside) {
        let (row, column) = (index / width, index % width);
        let (first_row, first, last) = (row == 0, column == 0, column + 1 == width);
        let eight = connectivity == Connectivity::Eight;
        let neighbors = [
            if first { 0 } else { labels[index - 1] },
            if first_row { 0 } else { labels[index - width] },
            if first_row || first || !eight { 0 } else { labels[index - width - 1] },
            if first_row || last || !eight { 0 } else { labels[index - width + 1] },
        ];
        let mut joined = 0;
        for neighbor in neighbors.into_iter().filter(|&neighbor| neighbor > 0) {
            joined = if joined == 0 { find(&mut parents, neighbor) } else { join(&mut parents, joined, neighbor) };
        }
        if joined == 0 {
            // At most MAX_PIXELS = 2^28 labels.
            joined = u32::try_from(parents.len()).unwrap_or(u32::MAX);
            parents.push(joined);
        }
        labels[index] = joined;
    }
    // Roots are the smallest of their set, so that a parent is numbered before its children.
    let mut sizes = Vec::new();
    let mut numbers = vec![0_u32; parents.len()];
    for k in 1..parents.len() {
        let parent = parents[k] as usize;
        if parent == k {
            sizes.push(0);
            numbers[k] = u32::try_from(sizes.len()).unwrap_or(u32::MAX);
        } else {
            numbers[k] = numbers[parent];
        }
    }
    for label in labels.iter_mut().filter(|label| **label > 0) {
        *label = numbers[*label as usize];
        sizes[*label as usize - 1] += 1;
    }
    Ok(Components { labels, sizes })
}

/// The root of a label; halves the path to it.
fn find(parents: &mut [u32], mut label: u32) -> u32 {
    while parents[label as usize] != label {
        let grandparent = parents[parents[label as usize] as usize];
        parents[label as usize] = grandparent;
        label = grandparent;
    }
    label
}

/// Joins two sets; the smaller root stays and comes out.
fn join(parents: &mut [u32], a: u32, b: u32) -> u32 {
    let (a, b) = (find(parents, a), find(parents, b));
    let (low, high) = (a.min(b), a.max(b));
    parents[high as usize] = low;
    low
}
