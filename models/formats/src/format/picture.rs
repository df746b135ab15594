//! Pictures as decoders leave them.
//!
//! Values are taken as stored (no gamma, no color profile). Transparent pixels are put over a color that the picture does not show
//! ([`Ground`]).

use dvp_core::image::ImageError;
use dvp_core::{Image, ImageSize, ImageView, Real};
use dvp_fit::picture::Ground;

/// Bits of a channel of a picture file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BitDepth {
    /// 256 steps
    #[default]
    Eight,
    /// 65536 steps, or floating point
    Sixteen,
}

/// A value of a channel as files store it.
pub trait ChannelValue: Copy {
    /// The value: of whole numbers a share of the largest one, of floating point as it stands.
    fn value(self) -> f64;
}

impl ChannelValue for u8 {
    fn value(self) -> f64 {
        f64::from(self) / 255.0
    }
}

impl ChannelValue for u16 {
    fn value(self) -> f64 {
        f64::from(self) / 65535.0
    }
}

impl ChannelValue for f32 {
    fn value(self) -> f64 {
        f64::from(self)
    }
}

/// A picture as read from a file.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture<T> {
    /// Its colors. Where it is transparent, they are mixed with one color that stands for whatever is behind, far from all that
    /// the picture shows.
    pub image: Image<T>,
    /// Whether some pixel lets through what is behind: the background of its scene is no color of the picture then.
    pub transparent: bool,
    /// That one color; white for opaque pictures.
    pub matte: [T; 3],
    /// Whether any pixel shows something; if not, the image is white.
    pub visible: bool,
    /// Bits of a channel in the file.
    pub bits: BitDepth,
    /// Whether a coder of photographs has changed its pixels: it is a JPEG.
    pub coded: bool,
}

impl<T: Real> From<Image<T>> for Picture<T> {
    /// An opaque picture of float pixels.
    fn from(image: Image<T>) -> Self {
        Self { image, transparent: false, matte: [T::one(); 3], visible: true, bits: BitDepth::Sixteen, coded: false }
    }
}

impl<T: Real> Picture<T> {
    /// The same with [`Self::coded`].
    #[must_use]
    pub fn with_coded(self, coded: bool) -> Self {
        Self { coded, ..self }
    }

    /// The same with [`Self::bits`].
    #[must_use]
    pub fn with_bits(self, bits: BitDepth) -> Self {
        Self { bits, ..self }
    }

    /// A picture of r, g, b, r, g, b, ....
    ///
    /// # Errors
    /// [`ImageError`] if there are not three values per pixel or one is not finite.
    #[inline(never)]
    pub fn opaque<V: ChannelValue>(size: ImageSize, values: &[V], bits: BitDepth) -> Result<Self, ImageError> {
        check_length(3 * size.pixels(), values.len())?;
        let pixels = values.as_chunks().0.iter().map(|pixel: &[V; 3]| pixel.map(V::value));
        Ok(Self { bits, ..planar(size, pixels)?.into() })
    }

    /// A picture of r, g, b, alpha, r, g, b, alpha, ... with straight colors, put over a color that it does not show.
    ///
    /// # Errors
    /// [`ImageError`] if there are not four values per pixel or one is not finite.
    #[inline(never)]
    pub fn translucent<V: ChannelValue>(size: ImageSize, values: &[V], bits: BitDepth) -> Result<Self, ImageError> {
        check_length(4 * size.pixels(), values.len())?;
        let pixels = values.as_chunks().0.iter().map(|pixel: &[V; 4]| pixel.map(V::value));
        let ground = Ground::of(pixels.clone());
        let image = planar(size, pixels.map(|pixel| ground.under(pixel)))?;
        let matte = ground.under([0.0; 4]).map(T::of);
        Ok(Self {
            image,
            transparent: ground != Ground::Opaque,
            matte,
            visible: ground != Ground::Invisible,
            bits,
            coded: false,
        })
    }
}

fn check_length(expected: usize, len: usize) -> Result<(), ImageError> {
    if len == expected { Ok(()) } else { Err(ImageError::Length { expected, len }) }
}

fn planar<T: Real>(size: ImageSize, pixels: impl Iterator<Item = [f64; 3]>) -> Result<Image<T>, ImageError> {
    let mut image = Image::zeros(size);
    let (red, rest) = image.data_mut().split_at_mut(size.pixels());
    let (green, blue) = rest.split_at_mut(size.pixels());
    for (((red, green), blue), [r, g, b]) in red.iter_mut().zip(green).zip(blue).zip(pixels) {
        (*red, *green, *blue) = (T::of(r), T::of(g), T::of(b));
    }
    ImageView::new(size, image.data())?;
    Ok(image)
}

/// The nearest of the 256 steps of a value, which is clamped to [0, 1].
pub fn to_byte<T: Real>(value: T) -> u8 {
    to_step(value, 255.0).to_le_bytes()[0]
}

/// The nearest of the steps 0 to `most` (at most 65535) of a value, which is clamped to [0, 1].
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "at most 65535.5, and meant to be cut down")]
pub fn to_step<T: Real>(value: T, most: f64) -> i32 {
    (value.as_f64().clamp(0.0, 1.0) * most + 0.5) as i32
}
