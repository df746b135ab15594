//! Float pixels: NumPy files of one image (height, width, 3) or several (number, height, width, 3).
//!
//! *Source*: the NPY format, versions 1 to 3. Read here and not by a crate: three element types in C order are all that
//! images need, and a parser of Python literals would cost a fresh build more than this file.

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use dvp_core::image::CHANNELS;
use dvp_core::{Image, ImageSize, Real};

use super::{FormatError, Place};

/// Longest header that is read; NumPy's own are below 200 bytes.
const MAX_HEADER: u32 = 1 << 16;
/// Bytes before the header in version 1.
const PREAMBLE: usize = 10;

/// An array of bytes as NumPy writes it, in C order: what data sets are kept in (`.npz`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ByteArray {
    /// Extents, the slowest first.
    pub(crate) shape: Vec<usize>,
    /// The numbers, the last extent fastest.
    pub(crate) values: Vec<u8>,
}

impl ByteArray {
    /// Reads an array of unsigned bytes or truth values (`|u1`, `|b1`) of at most `most` numbers.
    ///
    /// # Errors
    /// What is wrong with the file, in words.
    pub(crate) fn read(reader: &mut impl Read, most: usize) -> Result<Self, String> {
        let header = read_header(reader).map_err(|error| format!("cannot be read: {error}"))?;
        let header = header.ok_or("is no NumPy array")?;
        let [descr, order, shape] = ["descr", "fortran_order", "shape"].map(|key| field(&header, key));
        if !matches!(descr.trim_matches(['\'', '"']), "|u1" | "|b1") {
            return Err(format!(
                "holds numbers of type {descr}, must be bytes (|u1): convert it with .astype('uint8')"
            ));
        }
        if order != "False" {
            return Err("is stored column by column, must be in C order: save numpy.ascontiguousarray of it".to_owned());
        }
        let shape = extents(shape).ok_or_else(|| format!("has the shape ({shape}), which is none"))?;
        let count = shape.iter().try_fold(1_usize, |product, &extent| product.checked_mul(extent));
        let count = count.filter(|&count| count <= most);
        let count = count.ok_or_else(|| format!("has more than {most} numbers; keep fewer pictures in a file"))?;
        let mut values = Vec::new();
        reader.take(count as u64).read_to_end(&mut values).map_err(|error| format!("cannot be read: {error}"))?;
        if values.len() < count {
            return Err(format!("ends after {} of {count} numbers; it is truncated", values.len()));
        }
        Ok(Self { shape, values })
    }
}

/// The extents of a Python tuple without its parentheses.
fn extents(tuple: &str) -> Option<Vec<usize>> {
    tuple.split(',').map(str::trim).filter(|n| !n.is_empty()).map(|n| n.parse().ok()).collect()
}

/// Reads the images of a NumPy file of f32, f64 (as they are) or u8 (over 255), little-endian, in C order.
///
/// # Errors
/// [`FormatError`] if the file cannot be read, is no such array, has images above `max_pixels` or holds NaN.
pub fn read_npy<T: Real>(path: &Path, max_pixels: usize) -> Result<Vec<Image<T>>, FormatError> {
    let unreadable = |source| FormatError::Read { path: path.to_path_buf(), source };
    let wrong = |field: &str, problem: String| FormatError::Field {
        place: Place::file(path),
        field: field.to_owned(),
        problem,
    };
    let file = File::open(path).map_err(unreadable)?;
    let bytes = file.metadata().map_err(unreadable)?.len();
    let mut reader = BufReader::new(file);
    let header = read_header(&mut reader).map_err(unreadable)?;
    let header = header.ok_or_else(|| wrong("header", "is not that of a NumPy array".to_owned()))?;
    let [descr, order, shape] = ["descr", "fortran_order", "shape"].map(|key| field(&header, key));
    let (bytes_each, decode): (usize, fn(&[u8]) -> f64) = match descr.trim_matches(['\'', '"']) {
        "<f4" => (4, |b| f64::from(f32::from_le_bytes(array(b)))),
        "<f8" => (8, |b| f64::from_le_bytes(array(b))),
        "|u1" => (1, |b| f64::from(b[0]) / 255.0),
        other => return Err(wrong("descr", format!("is {other}, must be <f4, <f8 or |u1"))),
    };
    let (count, height, width) = match extents(shape).as_deref() {
        Some(&[height, width, CHANNELS]) if order == "False" => (1, height, width),
        Some(&[count, height, width, CHANNELS]) if order == "False" => (count, height, width),
        _ => {
            let must = "(height, width, 3) or (number, height, width, 3) in C order";
            return Err(wrong("shape", format!("is ({shape}), must be {must}")));
        }
    };
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let size = ImageSize::new(width, height).ok().filter(|size| size.pixels() <= max_pixels);
    let size = size.ok_or_else(|| FormatError::Pixels {
        path: path.to_path_buf(),
        width: side(width),
        height: side(height),
        limit: max_pixels,
    })?;
    // A header may promise anything; memory is taken for what the file can hold.
    let image_bytes = size.pixels() * CHANNELS * bytes_each;
    let before = PREAMBLE + header.len();
    if count.checked_mul(image_bytes).is_none_or(|all| all.saturating_add(before) as u64 > bytes) {
        return Err(wrong("shape", format!("is ({shape}), more than the file holds; it is truncated")));
    }
    let mut buffer = vec![0; image_bytes];
    let images = (0..count).map(|_| {
        reader.read_exact(&mut buffer).map_err(unreadable)?;
        let values: Vec<T> = buffer.chunks_exact(bytes_each).map(|value| T::of(decode(value))).collect();
        Image::from_interleaved(size, &values)
            .map_err(|source| FormatError::Values { path: path.to_path_buf(), source })
    });
    images.collect()
}

/// The Python dictionary of the header; none if this is no NumPy file.
fn read_header(reader: &mut impl Read) -> std::io::Result<Option<String>> {
    let mut start = [0; PREAMBLE];
    reader.read_exact(&mut start)?;
    if &start[..6] != b"\x93NUMPY" {
        return Ok(None);
    }
    let mut length = u32::from(u16::from_le_bytes([start[8], start[9]]));
    if start[6] > 1 {
        let mut high = [0; 2];
        reader.read_exact(&mut high)?;
        length |= u32::from(u16::from_le_bytes(high)) << 16;
    }
    let mut header = Vec::new();
    reader.take(u64::from(length.min(MAX_HEADER))).read_to_end(&mut header)?;
    Ok(String::from_utf8(header).ok())
}

/// The value of a key: a word, or what stands between parentheses; empty if there is none.
fn field<'a>(header: &'a str, key: &str) -> &'a str {
    let after = header.split_once(&format!("'{key}':")).map_or("", |(_, after)| after.trim_start());
    match after.strip_prefix('(') {
        Some(tuple) => tuple.split(')').next().unwrap_or(""),
        None => after.split([',', '}']).next().unwrap_or("").trim(),
    }
}

/// The bytes of one number; zeros where there are too few, which [`read_npy`]'s chunks never are.
fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.try_into().unwrap_or([0; N])
}
