//! Pictures: files of the usual formats to RGB.
//!
//! Values are taken as stored (no gamma, no color profile): 8 bits over 255, 16 bits over 65535. Gray becomes three
//! equal channels, palettes their colors, transparent pixels are put over a color that the picture does not show ([`Ground`]), the
//! orientation tag of cameras is obeyed, of an animation the first frame is taken.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

use dvp_core::image::{ImageError, RgbaImage};
use dvp_core::{Image, ImageSize, ImageView, Real};
use dvp_fit::picture::Ground;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::error::FormatError;
use super::png::BitDepth;

/// Most pixels of a picture unless the user says otherwise: 2^24, a square of 4096.
pub const DEFAULT_MAX_PIXELS: usize = 1 << 24;

/// Bytes per pixel that a decoder may ask for: four channels of 32 bits, twice (TIFF and WebP keep a copy).
const DECODER_BYTES: u64 = 32;

/// A picture as read from a file.
#[derive(Clone, Debug, PartialEq)]
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
    decode_from(Cursor::new(bytes), name, max_pixels)?.into_picture(name)
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
    decode_from(Cursor::new(bytes), name, max_pixels)?.into_rgba(name)
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
        let eight = |value: u8| f64::from(value) / 255.0;
        let sixteen = |value: u16| f64::from(value) / 65535.0;
        let result = match (color.bytes_per_pixel() / color.channel_count(), color.has_alpha()) {
            (1, false) => Picture::opaque(size, picture.into_rgb8().as_raw(), eight, BitDepth::Eight),
            (1, true) => Picture::translucent(size, picture.into_rgba8().as_raw(), eight, BitDepth::Eight),
            (2, false) => Picture::opaque(size, picture.into_rgb16().as_raw(), sixteen, BitDepth::Sixteen),
            (2, true) => Picture::translucent(size, picture.into_rgba16().as_raw(), sixteen, BitDepth::Sixteen),
            (_, false) => Picture::opaque(size, picture.into_rgb32f().as_raw(), f64::from, BitDepth::Sixteen),
            (_, true) => Picture::translucent(size, picture.into_rgba32f().as_raw(), f64::from, BitDepth::Sixteen),
        };
        let values = |source| FormatError::Values { path: path.to_path_buf(), source };
        Ok(Picture { coded, ..result.map_err(values)? })
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
    decode_from(BufReader::new(file), path, max_pixels)
}

/// The same of what a file holds.
fn decode_from(file: impl BufRead + Seek, path: &Path, max_pixels: usize) -> Result<Decoded, FormatError> {
    let unreadable = |source| FormatError::Read { path: path.to_path_buf(), source };
    let undecodable = |source| FormatError::Decode { path: path.to_path_buf(), source };
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

impl<T: Real> Picture<T> {
    /// A picture of r, g, b, r, g, b, ..., each made a number in [0, 1] by `real`.
    ///
    /// # Errors
    /// [`ImageError`] if there are not three values per pixel or one is not finite.
    pub fn opaque<V: Copy>(
        size: ImageSize,
        values: &[V],
        real: impl Fn(V) -> f64,
        bits: BitDepth,
    ) -> Result<Self, ImageError> {
        check_length(3 * size.pixels(), values.len())?;
        let pixels = values.as_chunks().0.iter().map(|&[r, g, b]| [real(r), real(g), real(b)]);
        Ok(Self { bits, ..planar(size, pixels)?.into() })
    }

    /// A picture of r, g, b, alpha, r, g, b, alpha, ... with straight colors, put over a color that it does not show.
    ///
    /// # Errors
    /// [`ImageError`] if there are not four values per pixel or one is not finite.
    pub fn translucent<V: Copy>(
        size: ImageSize,
        values: &[V],
        real: impl Fn(V) -> f64 + Copy,
        bits: BitDepth,
    ) -> Result<Self, ImageError> {
        check_length(4 * size.pixels(), values.len())?;
        let pixels = values.as_chunks().0.iter().map(|pixel: &[V; 4]| pixel.map(real));
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
