//! Pictures that are not flat, such as photographs, as regions of one color each.
//!
//! *Source*: the functional of Mumford and Shah (1989) with constant colors, by merging regions (Koepfler, Lopez and Morel, 1994): of two neighbors those
//! become one first that miss the picture least more by it, per pixel of the boundary that they lose. Neighbors that are each other's best are merged at
//! once, all over the picture, so that a picture of a million pixels takes as many rounds as one of a thousand.

mod merge;
#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::{Image, ImageView};

use merge::Merging;

/// A picture as regions of one color.
#[derive(Clone, Debug)]
pub struct Regions {
    /// The picture in the colors of its regions.
    pub image: Image<f32>,
    /// The region of every pixel, row by row.
    pub labels: Vec<u32>,
    /// How many regions there are.
    pub count: usize,
}

/// At most `most` regions (one at least) of a picture whose noise has the standard deviation `noise`; fewer where more would say what is not seen. None if
/// it is no image, or holds NaN or infinity.
#[must_use]
#[inline(never)]
pub fn regions(image: &ImageView<'_, f32>, most: usize, noise: f64) -> Option<Regions> {
    if !image.data().iter().all(|value| value.is_finite()) {
        return None;
    }
    let mut merging = Merging::of(image);
    merging.run(most.max(1), noise);
    let (labels, colors) = merging.finish();
    let mut data = vec![0.0; image.data().len()];
    for (c, channel) in data.chunks_exact_mut(labels.len()).enumerate() {
        channel.iter_mut().zip(&labels).for_each(|(value, &label)| *value = colors[label as usize][c]);
    }
    Some(Regions { image: Image::from_planar(image.size(), data).ok()?, labels, count: colors.len() })
}
