//! Label maps as files.

use dvp_core::ImageSize;

use super::ExportError;
use crate::format::{encode_gray8, encode_gray16};

/// A label map as a gray PNG: of 8 bits if no number is above 255, else of 16.
///
/// # Errors
/// [`ExportError::Number`] if one is above 65535, [`ExportError::Png`] if there are not as many labels as pixels.
pub fn label_map_png(labels: &[u32], size: ImageSize) -> Result<Vec<u8>, ExportError> {
    if let Ok(labels) = labels.iter().map(|&label| u8::try_from(label)).collect::<Result<Vec<_>, _>>() {
        Ok(encode_gray8(&labels, size)?)
    } else if let Ok(labels) = labels.iter().map(|&label| u16::try_from(label)).collect::<Result<Vec<_>, _>>() {
        Ok(encode_gray16(&labels, size)?)
    } else {
        Err(ExportError::Number { number: labels.iter().copied().max().unwrap_or(0) })
    }
}
