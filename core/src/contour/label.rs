//! Connected components, by one pass that joins provisional labels and one that numbers them.

use alloc::vec;
use alloc::vec::Vec;

use super::{Connectivity, ContourError};
use crate::dims::ImageSize;
use crate::geometry::DisjointSets;

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
    Ok(label_by(size, connectivity, |i| mask[i], |_, _| true))
}

/// Labels the connected components of the pixels that are `inside`, where neighbors are in one piece only if they are
/// `alike`; both are told the indices of pixels, row by row.
#[must_use]
pub fn label_by(
    size: ImageSize,
    connectivity: Connectivity,
    inside: impl Fn(usize) -> bool,
    alike: impl Fn(usize, usize) -> bool,
) -> Components {
    let (width, len) = (size.width(), size.pixels());
    let eight = connectivity == Connectivity::Eight;
    // The number of a pixel's set, from 1; 0 is the outside.
    let mut labels = vec![0_u32; len];
    let mut sets = DisjointSets::default();
    sets.reset(1);
    for index in (0..len).filter(|&index| inside(index)) {
        let (column, below_first) = (index % width, index >= width);
        let before = [
            (column > 0).then(|| index - 1),
            below_first.then(|| index - width),
            (below_first && eight && column > 0).then(|| index - width - 1),
            (below_first && eight && column + 1 < width).then(|| index - width + 1),
        ];
        let mut set = 0;
        for neighbor in before.into_iter().flatten().filter(|&neighbor| labels[neighbor] > 0 && alike(index, neighbor))
        {
            set = if set == 0 { sets.root(labels[neighbor]) } else { sets.unite(set, labels[neighbor]) };
        }
        labels[index] = if set == 0 { sets.push() } else { set };
    }
    // Roots are the lowest of their set, so that a root is numbered before the others.
    let mut sizes = Vec::new();
    let mut numbers = vec![0_u32; sets.len()];
    for k in (1_u32..).take(sets.len() - 1) {
        let root = sets.root(k);
        if root == k {
            sizes.push(0);
            numbers[k as usize] = u32::try_from(sizes.len()).unwrap_or(u32::MAX);
        } else {
            numbers[k as usize] = numbers[root as usize];
        }
    }
    for label in labels.iter_mut().filter(|label| **label > 0) {
        *label = numbers[*label as usize];
        sizes[*label as usize - 1] += 1;
    }
    Components { labels, sizes }
}
