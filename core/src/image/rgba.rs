//! RGBA images: premultiplied, so that what is clear has no color and mixing is linear.

use alloc::vec;
use alloc::vec::Vec;

use super::{CHANNELS, Image, ImageError, ImageView, check};
use crate::dims::ImageSize;
use crate::real::Real;

/// Channels of an RGBA image: red, green, blue, alpha.
pub const RGBA_CHANNELS: usize = 4;

/// An owned RGBA image, planar and premultiplied: the planes are red x alpha, green x alpha, blue x alpha and alpha, which is
/// 0 where the image is clear and 1 where nothing shines through.
///
/// Premultiplied, two images differ by what can be seen of them: the color of a clear pixel is 0, whatever a file says, and
/// a mean over pixels is the mean of what they look like. Files (PNG, WebP) hold straight colors, which are not multiplied:
/// [`Self::from_straight`] and [`Self::to_straight`] convert.
///
/// # Examples
/// ```
/// use dvp_core::image::RgbaImage;
/// use dvp_core::ImageSize;
/// // Half clear red on white is pink.
/// let image = RgbaImage::from_straight(ImageSize::new(1, 1)?, &[1.0_f32, 0.0, 0.0, 0.5])?;
/// assert_eq!(image.data(), [0.5, 0.0, 0.0, 0.5]);
/// assert_eq!(image.on([1.0; 3]).data(), [1.0, 0.5, 0.5]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub type RgbaImage<T> = Image<T, RGBA_CHANNELS>;

/// A borrowed RGBA image, planar and premultiplied as [`RgbaImage`], all values finite when made.
pub type RgbaView<'a, T> = ImageView<'a, T, RGBA_CHANNELS>;

impl<T: Real> RgbaImage<T> {
    /// An image that is clear everywhere.
    #[must_use]
    pub fn transparent(size: ImageSize) -> Self {
        Self { size, data: vec![T::zero(); size.pixels() * RGBA_CHANNELS] }
    }

    /// An image from planar data, premultiplied.
    ///
    /// # Errors
    /// [`ImageError`] if the length is not 4 x pixels or a value is not finite.
    pub fn from_premultiplied(size: ImageSize, data: Vec<T>) -> Result<Self, ImageError> {
        RgbaView::premultiplied(size, &data)?;
        Ok(Self { size, data })
    }

    /// An image from r, g, b, a, r, g, b, a, ... data with straight colors, as files hold them.
    ///
    /// # Errors
    /// [`ImageError`] if the length is not 4 x pixels or a value is not finite.
    pub fn from_straight(size: ImageSize, data: &[T]) -> Result<Self, ImageError> {
        let pixels = size.pixels();
        check(pixels * RGBA_CHANNELS, data)?;
        let mut image = Self::transparent(size);
        for (i, &[red, green, blue, alpha]) in data.as_chunks().0.iter().enumerate() {
            for (c, value) in [red * alpha, green * alpha, blue * alpha, alpha].into_iter().enumerate() {
                image.data[c * pixels + i] = value;
            }
        }
        Ok(image)
    }

    /// The pixels in r, g, b, a, r, g, b, a, ... order with straight colors, as files hold them; black where the image is
    /// clear, for there it has no color.
    #[must_use]
    pub fn to_straight(&self) -> Vec<T> {
        let pixels = self.size.pixels();
        let straight = |i: usize| {
            let alpha = self.data[CHANNELS * pixels + i];
            let color = [0, 1, 2].map(|c| self.data[c * pixels + i]);
            let [red, green, blue] = color.map(|value| if alpha > T::zero() { value / alpha } else { T::zero() });
            [red, green, blue, alpha]
        };
        (0..pixels).flat_map(straight).collect()
    }

    /// The image as it looks on a ground of one color: premultiplied color + (1 - alpha) x ground.
    #[must_use]
    pub fn on(&self, ground: [T; CHANNELS]) -> Image<T> {
        let pixels = self.size.pixels();
        let (colors, alpha) = self.data.split_at(CHANNELS * pixels);
        let values = colors.chunks(pixels).zip(ground).flat_map(|(plane, ground)| {
            plane.iter().zip(alpha).map(move |(&value, &alpha)| value + (T::one() - alpha) * ground)
        });
        Image { size: self.size, data: values.collect() }
    }
}

impl<'a, T: Real> RgbaView<'a, T> {
    /// A view of planar data, premultiplied, 4 x height x width.
    ///
    /// # Errors
    /// [`ImageError`] if the length is not 4 x pixels or a value is not finite.
    pub fn premultiplied(size: ImageSize, data: &'a [T]) -> Result<Self, ImageError> {
        Self::checked(size, data)
    }
}
