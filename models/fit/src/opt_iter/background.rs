//! The color that the background starts with.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::image::CHANNELS;
use dvp_core::{ImageView, Real};

/// How the color is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BackgroundStart {
    /// The median of each channel, as in the published evaluation. Where objects cover more than half of the image it is
    /// a color that nothing has, and the true background is taken for an object.
    Median,
    /// The most frequent color.
    Mode,
}

impl BackgroundStart {
    pub(crate) fn color<T: Real>(self, image: ImageView<'_, T>) -> [T; CHANNELS] {
        match self {
            Self::Median => median(image),
            Self::Mode => mode(image),
        }
    }
}

/// The median of each channel; of two middle values the lower.
fn median<T: Real>(image: ImageView<'_, T>) -> [T; CHANNELS] {
    let mut values = Vec::new();
    core::array::from_fn(|channel| {
        values.clear();
        values.extend_from_slice(image.channel(channel));
        let middle = (values.len() - 1) / 2;
        *values.select_nth_unstable_by(middle, |a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal)).1
    })
}

/// The mean color in the fullest of 16 x 16 x 16 bins.
fn mode<T: Real>(image: ImageView<'_, T>) -> [T; CHANNELS] {
    const SIDE: usize = 16;
    let mut bins = vec![(0_usize, [T::zero(); CHANNELS]); SIDE.pow(3)];
    for color in (0..image.size().pixels()).map(|i| image.pixel(i)) {
        let index = color
            .iter()
            .fold(0, |index, &value| index * SIDE + (value * T::of_usize(SIDE)).to_usize().unwrap_or(0).min(SIDE - 1));
        let (count, sums) = &mut bins[index];
        *count += 1;
        sums.iter_mut().zip(color).for_each(|(sum, value)| *sum += value);
    }
    let fullest = bins.into_iter().max_by_key(|&(count, _)| count);
    fullest.map_or([T::zero(); CHANNELS], |(count, sums)| sums.map(|sum| sum / T::of_usize(count)))
}
