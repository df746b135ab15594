//! Float pixels: NumPy files of one image (height, width, 3) or several (number, height, width, 3).

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use dvp_core::image::CHANNELS;
use dvp_core::{Image, ImageSize, Real};
use npyz::{DType, NpyFile, Order};

use super::error::{FormatError, Place};

/// Reads the images of a NumPy file of f32, f64 (as they are) or u8 (over 255) in C order.
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
    let npy = NpyFile::new(BufReader::new(file)).map_err(unreadable)?;
    let shape = npy.shape().to_vec();
    let ([height, width, channels] | [_, height, width, channels]) = shape[..] else {
        return Err(wrong("shape", format!("is {shape:?}, must be (height, width, 3) or (number, height, width, 3)")));
    };
    if channels != CHANNELS as u64 || npy.order() != Order::C {
        return Err(wrong("shape", format!("is {shape:?}, must end in 3 channels, in C order")));
    }
    let side = |n: u64| u32::try_from(n).unwrap_or(u32::MAX);
    let limits = || FormatError::Pixels {
        path: path.to_path_buf(),
        width: side(width),
        height: side(height),
        limit: max_pixels,
    };
    let sides = usize::try_from(width).ok().zip(usize::try_from(height).ok());
    let size = sides.and_then(|(width, height)| ImageSize::new(width, height).ok()).ok_or_else(limits)?;
    // A header may promise anything; the file has at least a byte per value.
    if size.pixels() > max_pixels || shape.iter().try_fold(1u64, |n, &m| n.checked_mul(m)).is_none_or(|n| n > bytes) {
        return Err(limits());
    }
    let values: Vec<T> = match npy.dtype() {
        DType::Plain(kind) => match kind.to_string().trim_start_matches(['<', '>', '|', '=']) {
            "f4" => npy.into_vec::<f32>().map_err(unreadable)?.into_iter().map(|v| T::of(f64::from(v))).collect(),
            "f8" => npy.into_vec::<f64>().map_err(unreadable)?.into_iter().map(T::of).collect(),
            "u1" => {
                npy.into_vec::<u8>().map_err(unreadable)?.into_iter().map(|v| T::of(f64::from(v) / 255.0)).collect()
            }
            other => return Err(wrong("dtype", format!("is {other}, must be f4, f8 or u1"))),
        },
        _ => return Err(wrong("dtype", "is a record, must be f4, f8 or u1".to_owned())),
    };
    let bad = |source| FormatError::Values { path: path.to_path_buf(), source };
    values.chunks(size.pixels() * CHANNELS).map(|image| Image::from_interleaved(size, image).map_err(bad)).collect()
}
