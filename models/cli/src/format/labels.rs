//! Label maps: which object each pixel of a picture belongs to.
//!
//! The map of `STEM.png` is `STEM.labels.png` beside it, a PNG of the same size. Gray of up to 16 bits: 0 is the
//! background, k the pixels where object k is seen. Colors of 8 bits (a palette mostly): black is the background, pixels of
//! one color are one object. Names of labels mean nothing beyond that. Any other lossless file under that name is read
//! as well.

use std::path::{Path, PathBuf};

use dvp_core::ImageSize;
use image::DynamicImage;

use super::error::FormatError;
use super::picture::decode;

/// What the names of label maps end with.
const ENDING: &str = "labels.png";

/// The label map of a picture, if there is one.
#[must_use]
pub fn labels_beside(picture: &Path) -> Option<PathBuf> {
    let path = picture.with_extension(ENDING);
    path.is_file().then_some(path)
}

/// Whether a path names a label map, not a picture.
pub(super) fn is_label_map(path: &Path) -> bool {
    path.file_name().and_then(|name| name.to_str()).is_some_and(|name| name.ends_with(&format!(".{ENDING}")))
}

/// Reads a label map of at most `max_pixels` pixels: one label per pixel, row by row, 0 for the background.
///
/// # Errors
/// As [`read_picture`](super::read_picture), or [`FormatError::Labels`] for pixels that are neither gray nor plain colors.
pub fn read_labels(path: &Path, max_pixels: usize) -> Result<(ImageSize, Vec<u32>), FormatError> {
    let (size, picture) = decode(path, max_pixels)?;
    let labels = match picture {
        DynamicImage::ImageLuma8(gray) => gray.into_raw().into_iter().map(u32::from).collect(),
        DynamicImage::ImageLuma16(gray) => gray.into_raw().into_iter().map(u32::from).collect(),
        DynamicImage::ImageRgb8(colors) => {
            colors.pixels().map(|&image::Rgb([r, g, b])| u32::from_be_bytes([0, r, g, b])).collect()
        }
        other => return Err(FormatError::Labels { path: path.to_path_buf(), found: other.color() }),
    };
    Ok((size, labels))
}
