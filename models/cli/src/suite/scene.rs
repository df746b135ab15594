//! A picture with its truth, and its files.

use std::path::{Path, PathBuf};

use dvp_core::{Image, ImageSize};

use crate::export::{ExportError, label_map_png};
use crate::format::{BitDepth, FormatError, Place, WHOLE_ENDING, encode_gray8, encode_png, read_labels};

/// Half coverage: from here on a pixel belongs to a whole object.
const HALF: u32 = 128;

/// A picture of a benchmark, with what is in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SuiteScene {
    /// Columns and rows.
    pub size: ImageSize,
    /// r, g, b, r, g, b, ..., row by row.
    pub pixels: Vec<u8>,
    /// Which object each pixel shows: 0 for the background, k for object k, from 1.
    pub labels: Vec<u32>,
    /// Coverage of every object, also where others hide it: objects x pixels, in the order of painting; empty if it is not known.
    pub whole: Vec<u8>,
    /// The class of every object; empty if it is not known.
    pub classes: Vec<u32>,
}

/// The file of the whole objects of a picture.
fn whole_beside(picture: &Path) -> PathBuf {
    picture.with_extension(WHOLE_ENDING)
}

impl SuiteScene {
    /// The files of the picture by their endings: `png`, `labels.png` and, if whole objects are known, `whole.png`.
    ///
    /// # Errors
    /// [`ExportError`] if they cannot be encoded.
    pub fn files(&self) -> Result<Vec<(&'static str, Vec<u8>)>, ExportError> {
        let values: Vec<f32> = self.pixels.iter().map(|&value| f32::from(value) / 255.0).collect();
        let image = Image::from_interleaved(self.size, &values);
        let image = image.map_err(|source| FormatError::Encode { source: source.into() })?;
        let picture = encode_png(image.view(), BitDepth::Eight)?;
        let mut files = vec![("png", picture), ("labels.png", label_map_png(&self.labels, self.size)?)];
        if !self.whole.is_empty() {
            let tiles = self.whole.len() / self.size.pixels();
            let all = ImageSize::new(tiles * self.size.width(), self.size.height())?;
            let rows = (0..self.size.height()).flat_map(|row| (0..tiles).map(move |tile| (row, tile)));
            let width = self.size.width();
            let pixels: Vec<u8> = rows
                .flat_map(|(row, tile)| &self.whole[tile * self.size.pixels() + row * width..][..width])
                .copied()
                .collect();
            files.push((WHOLE_ENDING, encode_gray8(&pixels, all)?));
        }
        Ok(files)
    }
}

/// Which pixels every object covers by half at least, also where others hide it, from the file beside a picture: objects x pixels, in
/// the order of painting; none if there is no such file. Objects that cover none are kept.
///
/// # Errors
/// [`FormatError`] if the file cannot be read or its tiles are not of the size of the picture.
pub fn read_whole(picture: &Path, size: ImageSize, max_pixels: usize) -> Result<Option<Vec<bool>>, FormatError> {
    let path = whole_beside(picture);
    if !path.is_file() {
        return Ok(None);
    }
    let (all, values) = read_labels(&path, max_pixels)?;
    let width = size.width();
    if all.height() != size.height() || all.width() % width != 0 {
        let problem = format!(
            "are {} x {}, must be tiles of the picture's {width} x {}, side by side",
            all.width(),
            all.height(),
            size.height()
        );
        return Err(FormatError::Field { place: Place::file(&path), field: "its pixels".to_owned(), problem });
    }
    let tiles = 0..all.width() / width;
    let whole = tiles.flat_map(|tile| (0..size.height()).map(move |row| row * all.width() + tile * width));
    Ok(Some(whole.flat_map(|start| values[start..start + width].iter().map(|&value| value >= HALF)).collect()))
}
