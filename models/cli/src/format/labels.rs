//! Label maps: which object each pixel of a picture belongs to.
//!
//! The map of `STEM.png` is `STEM.labels.png` beside it, a PNG of the same size. Gray of up to 16 bits: 0 is the
//! background, k the pixels where object k is seen. Colors of 8 bits (a palette mostly): black is the background, pixels of
//! one color are one object, numbered from 1 in the order in which they come. Numbers of labels mean nothing beyond that.
//! Any other lossless file under that name is read as well.
//!
//! Other programs write theirs as TIFF, with whole numbers or floats of up to 64 bits: the first page of those is read too.

use alloc::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read as _, Seek as _};
use std::path::{Path, PathBuf};

use dvp_core::ImageSize;
use image::DynamicImage;
use tiff::ColorType as TiffColor;
use tiff::TiffError;
use tiff::decoder::{Decoder, DecodingResult, Limits};

use super::FormatError;
use super::picture::{Decoded, decode};

/// What the names of label maps end with.
const ENDING: &str = "labels.png";
/// What the names of images of whole objects end with.
pub(crate) const WHOLE_ENDING: &str = "whole.png";

/// The label map of a picture, if there is one.
#[must_use]
pub fn labels_beside(picture: &Path) -> Option<PathBuf> {
    let path = picture.with_extension(ENDING);
    path.is_file().then_some(path)
}

/// Whether a path names what is in a picture, not a picture: a label map, or its objects whole.
pub(super) fn is_truth(path: &Path) -> bool {
    let is_one = |name: &str| [ENDING, WHOLE_ENDING].iter().any(|ending| name.ends_with(&format!(".{ending}")));
    path.file_name().and_then(|name| name.to_str()).is_some_and(is_one)
}

/// Reads a label map of at most `max_pixels` pixels: one label per pixel, row by row, 0 for the background. Colors other than black
/// are numbered from 1 in the order in which they come.
///
/// # Errors
/// As [`read_picture`](super::read_picture), [`FormatError::Labels`] for pixels that are neither gray nor plain colors, or
/// [`FormatError::Label`] for one that is no whole number from 0 to 2^32 - 1.
pub fn read_labels(path: &Path, max_pixels: usize) -> Result<(ImageSize, Vec<u32>), FormatError> {
    if let Some(found) = read_gray_tiff(path, max_pixels)? {
        return Ok(found);
    }
    let Decoded { size, picture, .. } = decode(path, max_pixels)?;
    let labels = match picture {
        DynamicImage::ImageLuma8(gray) => gray.into_raw().into_iter().map(u32::from).collect(),
        DynamicImage::ImageLuma16(gray) => gray.into_raw().into_iter().map(u32::from).collect(),
        DynamicImage::ImageRgb8(colors) => {
            let (mut numbers, mut last) = (BTreeMap::from([([0; 3], 0)]), 0);
            let mut number = |color| {
                *numbers.entry(color).or_insert_with(|| {
                    last += 1;
                    last
                })
            };
            colors.pixels().map(|pixel| number(pixel.0)).collect()
        }
        other => return Err(FormatError::Labels { path: path.to_path_buf(), found: format!("{:?}", other.color()) }),
    };
    Ok((size, labels))
}

/// The labels of a TIFF of gray pixels; none for any other file.
fn read_gray_tiff(path: &Path, max_pixels: usize) -> Result<Option<(ImageSize, Vec<u32>)>, FormatError> {
    let unreadable = |source| FormatError::Read { path: path.to_path_buf(), source };
    let undecodable = |source: TiffError| {
        let source = image::error::DecodingError::new(image::ImageFormat::Tiff.into(), source);
        FormatError::Decode { path: path.to_path_buf(), source: image::ImageError::Decoding(source).into() }
    };
    let mut file = BufReader::new(File::open(path).map_err(unreadable)?);
    let mut magic = [0; 4];
    let is_tiff = file.read_exact(&mut magic).is_ok() && matches!(&magic, b"II*\0" | b"MM\0*" | b"II+\0" | b"MM\0+");
    if !is_tiff {
        return Ok(None);
    }
    file.rewind().map_err(unreadable)?;
    let mut limits = Limits::default();
    // Numbers have 8 bytes at most.
    limits.decoding_buffer_size = max_pixels.saturating_mul(8);
    let mut decoder = Decoder::new(file).map_err(undecodable)?.with_limits(limits);
    if !matches!(decoder.colortype().map_err(undecodable)?, TiffColor::Gray(8..)) {
        return Ok(None);
    }
    let (width, height) = decoder.dimensions().map_err(undecodable)?;
    let too_many = FormatError::Pixels { path: path.to_path_buf(), width, height, limit: max_pixels };
    let Ok(size) = ImageSize::new(width as usize, height as usize) else { return Err(too_many) };
    if size.pixels() > max_pixels {
        return Err(too_many);
    }
    let labels: Result<Vec<u32>, f64> = match decoder.read_image().map_err(undecodable)? {
        DecodingResult::U8(labels) => Ok(labels.into_iter().map(u32::from).collect()),
        DecodingResult::U16(labels) => Ok(labels.into_iter().map(u32::from).collect()),
        DecodingResult::U32(labels) => Ok(labels),
        DecodingResult::I8(labels) => labels.into_iter().map(|label| whole(label.into())).collect(),
        DecodingResult::I16(labels) => labels.into_iter().map(|label| whole(label.into())).collect(),
        DecodingResult::I32(labels) => labels.into_iter().map(|label| whole(label.into())).collect(),
        DecodingResult::F32(labels) => labels.into_iter().map(|label| whole(label.into())).collect(),
        DecodingResult::F64(labels) => labels.into_iter().map(whole).collect(),
        // Above 2^53 numbers are rounded, and out of range anyway.
        DecodingResult::U64(labels) => labels.into_iter().map(|label| whole(label as f64)).collect(),
        DecodingResult::I64(labels) => labels.into_iter().map(|label| whole(label as f64)).collect(),
        _ => return Ok(None),
    };
    match labels {
        Ok(labels) => Ok(Some((size, labels))),
        Err(value) => Err(FormatError::Label { path: path.to_path_buf(), value }),
    }
}

/// A label, or the value that is none.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in range")]
fn whole(value: f64) -> Result<u32, f64> {
    if (0.0..=f64::from(u32::MAX)).contains(&value) && value.fract() == 0.0 { Ok(value as u32) } else { Err(value) }
}
