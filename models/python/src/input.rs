//! Pictures, label maps and banks as Python hands them over.

use core::fmt;
use std::path::{Path, PathBuf};

use dvp::format::{
    BitDepth, ChannelValue, FormatError, Picture, decode_picture, decode_picture_rgba, mdshr_bank, parse_bank,
    read_bank, read_labels, read_npy, read_picture, read_picture_rgba,
};
use dvp_core::ImageSize;
use dvp_core::image::{ImageError, RgbaImage};
use dvp_fit::Bank;
use numpy::{PyReadonlyArray2, PyReadonlyArray3};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// What errors call pictures that came as bytes.
const BYTES: &str = "bytes";

/// A picture as Python hands it over: arrays are in C order, height x width x 3 or 4.
#[derive(FromPyObject)]
pub(crate) enum PySource<'py> {
    Bytes(Bound<'py, PyBytes>),
    Eight(PyReadonlyArray3<'py, u8>),
    Float(PyReadonlyArray3<'py, f32>),
    Path(PathBuf),
}

/// The same, of its own.
pub(crate) enum Source {
    Bytes(Vec<u8>),
    Eight([usize; 3], Vec<u8>),
    Float([usize; 3], Vec<f32>),
    Path(PathBuf),
}

/// Why a picture was not read.
#[derive(Debug, thiserror::Error)]
pub(crate) enum InputError {
    #[error(transparent)]
    Format(#[from] FormatError),
    #[error(transparent)]
    Image(#[from] ImageError),
    #[error("an array of {height} x {width} pixels, must be 1 to {limit}; scale it down or raise max_pixels")]
    Pixels { width: usize, height: usize, limit: usize },
    #[error("a picture of {} x {} pixels for a scene of {} x {}", found.width(), found.height(), scene.width(), scene.height())]
    Size { found: ImageSize, scene: ImageSize },
    #[error("an array of {channels} channels, must have 3 or 4")]
    Channels { channels: usize },
    #[error("{path}: holds {count} images, must be 1; load it with numpy and give them to fit_many", path = path.display())]
    Stack { path: PathBuf, count: usize },
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Source")
    }
}

impl PySource<'_> {
    /// A copy that lives without the interpreter's lock.
    pub(crate) fn to_owned(&self) -> Source {
        match self {
            Self::Bytes(bytes) => Source::Bytes(bytes.as_bytes().to_vec()),
            Self::Eight(array) => {
                let (extents, values) = parts(array.as_array());
                Source::Eight(extents, values)
            }
            Self::Float(array) => {
                let (extents, values) = parts(array.as_array());
                Source::Float(extents, values)
            }
            Self::Path(path) => Source::Path(path.clone()),
        }
    }
}

fn parts<T: Copy>(array: numpy::ndarray::ArrayView3<'_, T>) -> ([usize; 3], Vec<T>) {
    let (height, width, channels) = array.dim();
    ([height, width, channels], array.iter().copied().collect())
}

impl Source {
    /// The picture, of at most `max_pixels` pixels. `coded`: whether pixels of an array have gone through a JPEG.
    pub(crate) fn picture(&self, max_pixels: usize, coded: bool) -> Result<Picture<f32>, InputError> {
        let picture = match self {
            Self::Bytes(bytes) => return Ok(decode_picture(bytes, Path::new(BYTES), max_pixels)?),
            Self::Path(path) if path.extension().is_some_and(|ending| ending == "npy") => {
                let mut images = read_npy(path, max_pixels)?;
                let count = images.len();
                let image = images.pop().filter(|_| count == 1);
                image.ok_or_else(|| InputError::Stack { path: path.clone(), count })?.into()
            }
            Self::Path(path) => return Ok(read_picture(path, max_pixels)?),
            Self::Eight(extents, values) => of_pixels(*extents, values, BitDepth::Eight, max_pixels)?,
            Self::Float(extents, values) => of_pixels(*extents, values, BitDepth::Sixteen, max_pixels)?,
        };
        Ok(picture.with_coded(coded))
    }

    /// The picture's own pixels with their alpha.
    pub(crate) fn rgba(&self, max_pixels: usize) -> Result<RgbaImage<f32>, InputError> {
        match self {
            Self::Bytes(bytes) => Ok(decode_picture_rgba(bytes, Path::new(BYTES), max_pixels)?),
            Self::Path(path) => Ok(read_picture_rgba(path, max_pixels)?),
            Self::Eight(extents, values) => {
                let straight: Vec<f32> = values.iter().map(|&value| f32::from(value) / 255.0).collect();
                rgba_of_pixels(*extents, &straight, max_pixels)
            }
            Self::Float(extents, values) => rgba_of_pixels(*extents, values, max_pixels),
        }
    }
}

fn size_of([height, width, _]: [usize; 3], limit: usize) -> Result<ImageSize, InputError> {
    let size = ImageSize::new(width, height).ok().filter(|size| size.pixels() <= limit);
    size.ok_or(InputError::Pixels { width, height, limit })
}

fn of_pixels<V: ChannelValue>(
    extents: [usize; 3],
    values: &[V],
    bits: BitDepth,
    max_pixels: usize,
) -> Result<Picture<f32>, InputError> {
    let size = size_of(extents, max_pixels)?;
    match extents[2] {
        3 => Ok(Picture::opaque(size, values, bits)?),
        4 => Ok(Picture::translucent(size, values, bits)?),
        channels => Err(InputError::Channels { channels }),
    }
}

fn rgba_of_pixels(extents: [usize; 3], values: &[f32], max_pixels: usize) -> Result<RgbaImage<f32>, InputError> {
    let size = size_of(extents, max_pixels)?;
    match extents[2] {
        3 => {
            let opaque: Vec<f32> = values.as_chunks().0.iter().flat_map(|&[r, g, b]| [r, g, b, 1.0]).collect();
            Ok(RgbaImage::from_straight(size, &opaque)?)
        }
        4 => Ok(RgbaImage::from_straight(size, values)?),
        channels => Err(InputError::Channels { channels }),
    }
}

/// A label map as Python hands it over: the path of a file, or labels in C order, height x width.
#[derive(FromPyObject)]
pub(crate) enum PyLabels<'py> {
    Array(PyReadonlyArray2<'py, u32>),
    Path(PathBuf),
}

/// The same, of its own.
pub(crate) enum Labels {
    Array([usize; 2], Vec<u32>),
    Path(PathBuf),
}

impl PyLabels<'_> {
    pub(crate) fn to_owned(&self) -> Labels {
        match self {
            Self::Array(array) => {
                let (height, width) = array.as_array().dim();
                Labels::Array([height, width], array.as_array().iter().copied().collect())
            }
            Self::Path(path) => Labels::Path(path.clone()),
        }
    }
}

impl Labels {
    /// The size, and one label per pixel, row by row.
    pub(crate) fn read(self, max_pixels: usize) -> Result<(ImageSize, Vec<u32>), InputError> {
        match self {
            Self::Array([height, width], labels) => Ok((size_of([height, width, 1], max_pixels)?, labels)),
            Self::Path(path) => Ok(read_labels(&path, max_pixels)?),
        }
    }
}

/// A bank by name (`none`, `mdshr`), as JSON (a text that begins with a brace) or from a file.
pub(crate) fn bank(text: &str) -> Result<Option<Bank<f32>>, FormatError> {
    Ok(match text {
        "none" => None,
        "mdshr" => Some(mdshr_bank()),
        json if json.starts_with('{') => Some(parse_bank(json.as_bytes(), Path::new("bank"))?),
        path => Some(read_bank(Path::new(path))?),
    })
}
