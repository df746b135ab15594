//! Pictures: files of the usual formats to RGB.
//!
//! Values are taken as stored (no gamma, no color profile): 8 bits over 255, 16 bits over 65535. Gray becomes three
//! equal channels, palettes their colors, transparent pixels are put over a color that the picture does not show ([`Ground`](dvp_fit::picture::Ground)), the
//! orientation tag of cameras is obeyed, of an animation the first frame is taken.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

use dvp_core::image::RgbaImage;
use dvp_core::{ImageSize, Real};
use image::{DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader, Limits};

use super::{BitDepth, FormatError, Picture};

/// Most pixels of a picture unless the user says otherwise: 2^24, a square of 4096.
pub const DEFAULT_MAX_PIXELS: usize = 1 << 24;

/// Bytes per pixel that a decoder may ask for: four channels of 32 bits, twice (TIFF and WebP keep a copy).
const DECODER_BYTES: u64 = 32;

/// Reads a picture of at most `max_pixels` pixels. The header is checked before memory for pixels is taken.
///
/// # Errors
/// [`FormatError::Read`], [`FormatError::Decode`], [`FormatError::Pixels`], or [`FormatError::Values`] for
/// floating-point files with NaN.
pub fn read_picture<T: Real>(path: &Path, max_pixels: usize) -> Result<Picture<T>, FormatError> {
    decode(path, max_pixels)?.into_picture(path)
}

/// The picture that the bytes of a file hold; errors call it `name`.
///
/// # Errors
/// As [`read_picture`].
pub fn decode_picture<T: Real>(bytes: &[u8], name: &Path, max_pixels: usize) -> Result<Picture<T>, FormatError> {
    decode_from(&mut Cursor::new(bytes), name, max_pixels)?.into_picture(name)
}

/// Reads a picture of at most `max_pixels` pixels with its alpha; no pixel of an opaque one lets anything through.
///
/// # Errors
/// As [`read_picture`].
pub fn read_picture_rgba<T: Real>(path: &Path, max_pixels: usize) -> Result<RgbaImage<T>, FormatError> {
    decode(path, max_pixels)?.into_rgba(path)
}

/// As [`read_picture_rgba`], from the bytes of a file; errors call it `name`.
///
/// # Errors
/// As [`read_picture`].
pub fn decode_picture_rgba<T: Real>(bytes: &[u8], name: &Path, max_pixels: usize) -> Result<RgbaImage<T>, FormatError> {
    decode_from(&mut Cursor::new(bytes), name, max_pixels)?.into_rgba(name)
}

/// A file's pixels.
pub(super) struct Decoded {
    pub(super) size: ImageSize,
    pub(super) picture: DynamicImage,
    /// Whether it is a JPEG.
    pub(super) coded: bool,
}

impl Decoded {
    fn into_picture<T: Real>(self, path: &Path) -> Result<Picture<T>, FormatError> {
        let Self { size, picture, coded } = self;
        let color = picture.color();
        let result = match (color.bytes_per_pixel() / color.channel_count(), color.has_alpha()) {
            (1, false) => Picture::opaque(size, picture.into_rgb8().as_raw(), BitDepth::Eight),
            (1, true) => Picture::translucent(size, picture.into_rgba8().as_raw(), BitDepth::Eight),
            (2, false) => Picture::opaque(size, picture.into_rgb16().as_raw(), BitDepth::Sixteen),
            (2, true) => Picture::translucent(size, picture.into_rgba16().as_raw(), BitDepth::Sixteen),
            (_, false) => Picture::opaque(size, picture.into_rgb32f().as_raw(), BitDepth::Sixteen),
            (_, true) => Picture::translucent(size, picture.into_rgba32f().as_raw(), BitDepth::Sixteen),
        };
        let values = |source| FormatError::Values { path: path.to_path_buf(), source };
        Ok(result.map_err(values)?.with_coded(coded))
    }

    fn into_rgba<T: Real>(self, path: &Path) -> Result<RgbaImage<T>, FormatError> {
        let Self { size, picture, .. } = self;
        let color = picture.color();
        let values: Vec<T> = match color.bytes_per_pixel() / color.channel_count() {
            1 => picture.into_rgba8().as_raw().iter().map(|&value| T::of(f64::from(value) / 255.0)).collect(),
            2 => picture.into_rgba16().as_raw().iter().map(|&value| T::of(f64::from(value) / 65535.0)).collect(),
            _ => picture.into_rgba32f().as_raw().iter().map(|&value| T::of(f64::from(value))).collect(),
        };
        let refused = |source| FormatError::Values { path: path.to_path_buf(), source };
        RgbaImage::from_straight(size, &values).map_err(refused)
    }
}

/// The pixels of a file as stored, at least one; turned as the orientation tag says.
pub(super) fn decode(path: &Path, max_pixels: usize) -> Result<Decoded, FormatError> {
    let file = File::open(path).map_err(|source| FormatError::Read { path: path.to_path_buf(), source })?;
    decode_from(&mut BufReader::new(file), path, max_pixels)
}

/// What decoders read from: a file, or memory.
trait Source: BufRead + Seek {}

impl<S: BufRead + Seek> Source for S {}

/// The same of what a file holds. All sources are one type, so that the decoders are compiled once.
fn decode_from(file: &mut dyn Source, path: &Path, max_pixels: usize) -> Result<Decoded, FormatError> {
    let unreadable = |source| FormatError::Read { path: path.to_path_buf(), source };
    let undecodable = |source: ImageError| FormatError::Decode { path: path.to_path_buf(), source: source.into() };
    let mut reader = ImageReader::new(file);
    // The contents decide; where they say nothing, the ending.
    if let Ok(format) = ImageFormat::from_path(path) {
        reader.set_format(format);
    }
    let mut reader = reader.with_guessed_format().map_err(unreadable)?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some((max_pixels as u64).saturating_mul(DECODER_BYTES).saturating_add(1 << 20));
    reader.limits(limits);
    let coded = reader.format() == Some(ImageFormat::Jpeg);
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
        Ok(size) => Ok(Decoded { size, picture, coded }),
        Err(_) => Err(too_many),
    }
}
