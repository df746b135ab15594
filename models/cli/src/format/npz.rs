//! Archives of NumPy arrays (`.npz`), as `numpy.savez` and `numpy.savez_compressed` write them.
//!
//! *Source*: a zip archive with one `NAME.npy` per array, stored or deflated.

use std::fs;
use std::io::Read;
use std::path::Path;

use flate2::bufread::DeflateDecoder;
use rawzip::{CompressionMethod, ZipArchive};

use super::npy::ByteArray;
use super::{FormatError, Place};

/// Most numbers of one array: 10,000 pictures of 128 x 128 pixels with 5 masks.
const MOST_NUMBERS: usize = 1 << 30;

/// The arrays of bytes of an archive, by name. Only those whose name is in `wanted` are read.
///
/// # Errors
/// [`FormatError::Read`], or [`FormatError::Field`] for what is no archive of such arrays.
pub(crate) fn read_npz(path: &Path, wanted: &[&str]) -> Result<Vec<(String, ByteArray)>, FormatError> {
    let bytes = fs::read(path).map_err(|source| FormatError::Read { path: path.to_path_buf(), source })?;
    let wrong = |field: &str, problem: String| FormatError::Field {
        place: Place::file(path),
        field: field.to_owned(),
        problem,
    };
    let damaged = |error: rawzip::Error| wrong("archive", format!("is no readable .npz file: {error}"));
    let archive = ZipArchive::from_slice(&bytes).map_err(damaged)?;
    let mut entries = archive.entries();
    let mut arrays = Vec::new();
    while let Some(header) = entries.next_entry().map_err(damaged)? {
        let name = header.file_path();
        let name = core::str::from_utf8(name.as_ref()).unwrap_or_default().trim_end_matches(".npy").to_owned();
        if !wanted.contains(&name.as_str()) {
            continue;
        }
        let method = header.compression_method();
        let entry = archive.get_entry(header.wayfinder()).map_err(damaged)?;
        let decoder: Box<dyn Read> = match method {
            CompressionMethod::STORE => Box::new(entry.data()),
            CompressionMethod::DEFLATE => Box::new(DeflateDecoder::new(entry.data())),
            _ => return Err(wrong(&name, "is packed by a method other than stored or deflated".to_owned())),
        };
        let mut reader = entry.verifying_reader(decoder);
        let array = ByteArray::read(&mut reader, MOST_NUMBERS).map_err(|problem| wrong(&name, problem))?;
        arrays.push((name, array));
    }
    Ok(arrays)
}
