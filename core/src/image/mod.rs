//! Images, planar: all of red, then green, then blue, each row by row from the top; those with alpha have it as a fourth
//! plane.
//!
//! Planes are what vector units, losses and networks read; [`Image::from_interleaved`] and [`Image::to_interleaved`]
//! convert from and to the r, g, b, r, g, b order of files.
//!
//! | file | holds |
//! |---|---|
//! | `mod.rs` | RGB: [`Image`], [`ImageView`] |
//! | `rgba.rs` | RGBA, premultiplied: [`RgbaImage`], [`RgbaView`] |
//! | `mix.rs` | colors as mixtures of two others: [`mixture`] |

mod mix;
mod rgba;
#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;
use core::fmt;

use crate::dims::ImageSize;
use crate::real::Real;
use crate::simd;

pub use mix::{coverage, distance, misfit, mixture};
pub use rgba::{RGBA_CHANNELS, RgbaImage, RgbaView};

/// Color channels of every image.
pub const CHANNELS: usize = 3;

/// An owned image, RGB unless `N` says otherwise; every value finite, \[0, 1\] by convention.
///
/// There are images of 3 channels, RGB, and of [`RGBA_CHANNELS`], see [`RgbaImage`].
#[derive(Clone, Debug, PartialEq)]
pub struct Image<T, const N: usize = CHANNELS> {
    size: ImageSize,
    data: Vec<T>,
}

impl<T: Real> Image<T> {
    /// An image of zeros (black).
    #[must_use]
    pub fn zeros(size: ImageSize) -> Self {
        Self { size, data: vec![T::zero(); size.pixels() * CHANNELS] }
    }

    /// An image from planar data.
    ///
    /// # Errors
    /// [`ImageError`] if the length is not 3 x pixels or a value is not finite.
    pub fn from_planar(size: ImageSize, data: Vec<T>) -> Result<Self, ImageError> {
        ImageView::new(size, &data)?;
        Ok(Self { size, data })
    }

    /// An image from r, g, b, r, g, b, ... data.
    ///
    /// # Errors
    /// [`ImageError`] if the length is not 3 x pixels or a value is not finite.
    pub fn from_interleaved(size: ImageSize, data: &[T]) -> Result<Self, ImageError> {
        ImageView::new(size, data)?;
        let mut image = Self::zeros(size);
        for (i, pixel) in data.chunks_exact(CHANNELS).enumerate() {
            for (c, &value) in pixel.iter().enumerate() {
                image.data[c * size.pixels() + i] = value;
            }
        }
        Ok(image)
    }

    /// The pixels in r, g, b, r, g, b, ... order.
    #[must_use]
    pub fn to_interleaved(&self) -> Vec<T> {
        let pixels = self.size.pixels();
        (0..pixels).flat_map(|i| (0..CHANNELS).map(move |c| (c, i))).map(|(c, i)| self.data[c * pixels + i]).collect()
    }
}

impl<T: Real, const N: usize> Image<T, N> {
    /// A checked view of the whole image.
    #[must_use]
    pub fn view(&self) -> ImageView<'_, T, N> {
        ImageView { size: self.size, data: &self.data }
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Planar data, channels x height x width.
    #[must_use]
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// Planar data to write to. Values written must be finite; consumers that need certainty check again.
    #[must_use]
    pub fn data_mut(&mut self) -> &mut [T] {
        &mut self.data
    }
}

/// A borrowed image, RGB unless `N` says otherwise, planar, all values finite when made.
#[derive(Clone, Copy, Debug)]
pub struct ImageView<'a, T, const N: usize = CHANNELS> {
    size: ImageSize,
    data: &'a [T],
}

impl<'a, T: Real> ImageView<'a, T> {
    /// A view of planar data, 3 x height x width.
    ///
    /// # Errors
    /// [`ImageError`] if the length is not 3 x pixels or a value is not finite.
    pub fn new(size: ImageSize, data: &'a [T]) -> Result<Self, ImageError> {
        Self::checked(size, data)
    }

    /// The color of the pixel with index row x width + column.
    ///
    /// # Panics
    /// If the index is outside the image.
    #[must_use]
    #[inline]
    pub fn pixel(&self, index: usize) -> [T; 3] {
        let pixels = self.size.pixels();
        [self.data[index], self.data[pixels + index], self.data[2 * pixels + index]]
    }
}

impl<'a, T: Real, const N: usize> ImageView<'a, T, N> {
    fn checked(size: ImageSize, data: &'a [T]) -> Result<Self, ImageError> {
        check(size.pixels() * N, data)?;
        Ok(Self { size, data })
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Planar data, channels x height x width.
    #[must_use]
    pub fn data(&self) -> &'a [T] {
        self.data
    }

    /// One channel (0 red, 1 green, 2 blue, 3 alpha), height x width.
    ///
    /// # Panics
    /// If there is no such channel.
    #[must_use]
    pub fn channel(&self, channel: usize) -> &'a [T] {
        let pixels = self.size.pixels();
        &self.data[channel * pixels..(channel + 1) * pixels]
    }
}

/// Checks length and values of image data.
#[inline(never)]
pub(crate) fn check<T: Real>(expected: usize, data: &[T]) -> Result<(), ImageError> {
    if data.len() != expected {
        return Err(ImageError::Length { expected, len: data.len() });
    }
    // A sum is finite only if all of it are: one pass that vectorizes. One that overflowed is looked through as well.
    if !simd::sum(data).is_finite()
        && let Some(index) = data.iter().position(|v| !v.is_finite())
    {
        return Err(ImageError::NotFinite { index });
    }
    Ok(())
}

/// Why a slice is no image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ImageError {
    /// The slice has the wrong length.
    Length {
        /// Channels x width x height.
        expected: usize,
        /// What came.
        len: usize,
    },
    /// A value is NaN or infinite.
    NotFinite {
        /// Where in the slice.
        index: usize,
    },
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { expected, len } => {
                write!(f, "image data has {len} values, needs {expected} (channels x width x height)")
            }
            Self::NotFinite { index } => {
                write!(f, "image value {index} is NaN or infinite; replace it before the call")
            }
        }
    }
}

impl core::error::Error for ImageError {}
