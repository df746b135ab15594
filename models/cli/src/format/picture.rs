//! Pictures: files of the usual formats to RGB, and RGB to PNG.
//!
//! Values are taken as stored (no gamma, no color profile): 8 bits over 255, 16 bits over 65535. Gray becomes three
//! equal channels, palettes their colors, transparency is put over white, the orientation tag of cameras is obeyed, of
//! an animation the first frame is taken.

use std::io::Cursor;
use std::path::Path;

use dvp_core::dims::SizeError;
use dvp_core::{Image, ImageSize, ImageView, Real};
use image::error::{LimitError, LimitErrorKind};
use image::{DynamicImage, ImageDecoder, ImageError, ImageReader, Limits, RgbImage};

use super::error::FormatError;

/// Most pixels of a picture unless the user says otherwise: 2^24, a square of 4096.
pub const DEFAULT_MAX_PIXELS: usize = 1 << 24;

/// Bytes per pixel that a decoder may ask for: four channels of 32 bits, twice (TIFF and WebP keep a copy).
const DECODER_BYTES: u64 = 32;

/// Reads a picture of at most `max_pixels` pixels. The header is checked before memory for pixels is taken.
///
/// # Errors
/// [`FormatError::Read`], [`FormatError::Decode`], [`FormatError::Pixels`], or [`FormatError::Values`] for
/// floating-point files with NaN.
pub fn read_picture<T: Real>(path: &Path, max_pixels: usize) -> Result<Image<T>, FormatError> {
    let (size, picture) = decode(path, max_pixels)?;
    let pixels = interleaved(&picture);
    Image::from_interleaved(size, &pixels).map_err(|source| FormatError::Values { path: path.to_path_buf(), source })
}

/// The pixels as stored, at least one; turned as the orientation tag says.
pub(super) fn decode(path: &Path, max_pixels: usize) -> Result<(ImageSize, DynamicImage), FormatError> {
    let unreadable = |source| FormatError::Read { path: path.to_path_buf(), source };
    let undecodable = |source| FormatError::Decode { path: path.to_path_buf(), source };
    let mut reader = ImageReader::open(path).map_err(unreadable)?.with_guessed_format().map_err(unreadable)?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some((max_pixels as u64).saturating_mul(DECODER_BYTES).saturating_add(1 << 20));
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(undecodable)?;
    let (width, height) = decoder.dimensions();
    let too_many = FormatError::Pixels { path: path.to_path_buf(), width, height, limit: max_pixels };
    if u64::from(width) * u64::from(height) > max_pixels as u64 {
        return Err(too_many);
    }
    let orientation = decoder.orientation().map_err(undecodable)?;
    let mut picture = DynamicImage::from_decoder(decoder).map_err(undecodable)?;
    picture.apply_orientation(orientation);
    match ImageSize::new(picture.width() as usize, picture.height() as usize) {
        Ok(size) => Ok((size, picture)),
        Err(_) => Err(too_many),
    }
}

/// r, g, b, r, g, b, ...; transparency over white.
fn interleaved<T: Real>(picture: &DynamicImage) -> Vec<T> {
    let real = |value: f32| T::of(f64::from(value));
    match picture {
        // The common case, without a detour over f32: value / 255 in T.
        DynamicImage::ImageRgb8(rgb) => rgb.as_raw().iter().map(|&v| T::of(f64::from(v) / 255.0)).collect(),
        _ if picture.color().has_alpha() => picture
            .to_rgba32f()
            .pixels()
            .flat_map(|&image::Rgba([r, g, b, a])| [r, g, b].map(|v| real(v * a + (1.0 - a))))
            .collect(),
        _ => picture.to_rgb32f().into_raw().into_iter().map(real).collect(),
    }
}

/// The bytes of an 8-bit RGB PNG; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// As [`to_rgb8`].
pub fn encode_png<T: Real>(image: ImageView<'_, T>) -> Result<Vec<u8>, FormatError> {
    let mut png = Cursor::new(Vec::new());
    let encoder = image::codecs::png::PngEncoder::new(&mut png);
    to_rgb8(image)?.write_with_encoder(encoder).map_err(|source| FormatError::Encode { source })?;
    Ok(png.into_inner())
}

/// A picture of 8 bits; values are clamped to [0, 1] and rounded to the nearest step.
///
/// # Errors
/// [`FormatError::Encode`] if a side is above 2^32.
pub fn to_rgb8<T: Real>(image: ImageView<'_, T>) -> Result<RgbImage, FormatError> {
    let [width, height] = [image.size().width(), image.size().height()].map(u32::try_from);
    let bytes = (0..image.size().pixels()).flat_map(|i| image.pixel(i).map(byte)).collect();
    let picture = width.ok().zip(height.ok()).and_then(|(width, height)| RgbImage::from_raw(width, height, bytes));
    let too_large = || ImageError::Limits(LimitError::from_kind(LimitErrorKind::DimensionError));
    picture.ok_or_else(|| FormatError::Encode { source: too_large() })
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

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to [0, 255] before")]
fn byte<T: Real>(value: T) -> u8 {
    (value.as_f64().clamp(0.0, 1.0) * 255.0).round() as u8
}
