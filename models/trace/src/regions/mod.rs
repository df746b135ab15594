//! Pictures that are not flat, such as photographs, as regions of one color each.
//!
//! *Source*: the functional of Mumford and Shah (1989) with constant colors, by merging regions (Koepfler, Lopez and Morel, 1994): of two neighbors those
//! become one first that miss the picture least more by it, per pixel of the boundary that they lose. Neighbors that are each other's best are merged at
//! once, all over the picture, so that a picture of a million pixels takes as many rounds as one of a thousand.

mod merge;
#[cfg(test)]
mod tests;

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

/// At most `most` regions (one at least) of a picture whose noise has the standard deviation `noise`; fewer where more would say what is not seen.
#[must_use]
#[inline(never)]
pub fn regions(image: &ImageView<'_, f32>, most: usize, noise: f64) -> Regions {
    let mut merging = Merging::of(image);
    merging.run(most.max(1), noise);
    let (labels, colors) = merging.finish();
    let mut flat = Image::zeros(image.size());
    for (c, channel) in flat.data_mut().chunks_exact_mut(labels.len()).enumerate() {
        channel.iter_mut().zip(&labels).for_each(|(value, &label)| *value = colors[label as usize][c]);
    }
    Regions { image: flat, labels, count: colors.len() }
}
