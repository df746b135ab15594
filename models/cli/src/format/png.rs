//! Images to PNG, with 8 or 16 bits per channel, and to pixels of 8 bits.

use dvp_core::dims::SizeError;
use dvp_core::image::RgbaImage;
use dvp_core::{Image, ImageSize, ImageView, Real};
use image::codecs::png::PngEncoder;
use image::error::{LimitError, LimitErrorKind, ParameterError, ParameterErrorKind};
use image::{ExtendedColorType, ImageEncoder, ImageError, RgbImage};

use dvp_formats::format::{interleaved_bytes, interleaved_rgba_bytes};

use super::{BitDepth, FormatError};

/// The bytes of an RGB PNG; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// As [`to_rgb8`].
pub fn encode_png<T: Real>(image: ImageView<'_, T>, bits: BitDepth) -> Result<Vec<u8>, FormatError> {
    let color = match bits {
        BitDepth::Eight => ExtendedColorType::Rgb8,
        BitDepth::Sixteen => ExtendedColorType::Rgb16,
    };
    png(&interleaved_bytes(image, bits), image.size(), color)
}

/// The bytes of an RGBA PNG with straight colors; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// As [`to_rgb8`].
pub fn encode_png_rgba<T: Real>(image: &RgbaImage<T>, bits: BitDepth) -> Result<Vec<u8>, FormatError> {
    let color = match bits {
        BitDepth::Eight => ExtendedColorType::Rgba8,
        BitDepth::Sixteen => ExtendedColorType::Rgba16,
    };
    png(&interleaved_rgba_bytes(image, bits), image.size(), color)
}

/// The bytes of a gray PNG of 8 bits: one value per pixel, row by row.
///
/// # Errors
/// [`FormatError::Encode`] if there are not as many values as pixels, or if a side is above 2^32.
pub fn encode_gray8(pixels: &[u8], size: ImageSize) -> Result<Vec<u8>, FormatError> {
    png(pixels, size, ExtendedColorType::L8)
}

/// The bytes of a gray PNG of 16 bits: one value per pixel, row by row.
///
/// # Errors
/// As [`encode_gray8`].
pub fn encode_gray16(pixels: &[u16], size: ImageSize) -> Result<Vec<u8>, FormatError> {
    let bytes: Vec<u8> = pixels.iter().flat_map(|pixel| pixel.to_ne_bytes()).collect();
    png(&bytes, size, ExtendedColorType::L16)
}

fn png(bytes: &[u8], size: ImageSize, color: ExtendedColorType) -> Result<Vec<u8>, FormatError> {
    let [width, height] = sides(size)?;
    // The encoder panics at any other length.
    if Some(bytes.len()) != size.pixels().checked_mul(usize::from(color.bits_per_pixel() / 8)) {
        let source = ImageError::Parameter(ParameterError::from_kind(ParameterErrorKind::DimensionMismatch));
        return Err(FormatError::Encode { source: source.into() });
    }
    let mut png = Vec::new();
    let written = PngEncoder::new(&mut png).write_image(bytes, width, height, color);
    written.map_err(|source| FormatError::Encode { source: source.into() })?;
    Ok(png)
}

/// A picture of 8 bits; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// [`FormatError::Encode`] if a side is above 2^32.
pub fn to_rgb8<T: Real>(image: ImageView<'_, T>) -> Result<RgbImage, FormatError> {
    let [width, height] = sides(image.size())?;
    RgbImage::from_raw(width, height, interleaved_bytes(image, BitDepth::Eight)).ok_or_else(too_large)
}

/// The values of a picture of 8 bits, [0, 1].
///
/// # Errors
/// [`SizeError`] if it has no pixel.
pub fn from_rgb8<T: Real>(picture: &RgbImage) -> Result<Image<T>, SizeError> {
    let size = ImageSize::new(picture.width() as usize, picture.height() as usize)?;
    let mut image = Image::zeros(size);
    let bytes = picture.as_raw().iter().enumerate();
    bytes.for_each(|(i, &byte)| image.data_mut()[i % 3 * size.pixels() + i / 3] = T::of(f64::from(byte) / 255.0));
    Ok(image)
}

fn sides(size: ImageSize) -> Result<[u32; 2], FormatError> {
    let side = |pixels: usize| u32::try_from(pixels).map_err(|_| too_large());
    Ok([side(size.width())?, side(size.height())?])
}

fn too_large() -> FormatError {
    let source = ImageError::Limits(LimitError::from_kind(LimitErrorKind::DimensionError));
    FormatError::Encode { source: source.into() }
}
