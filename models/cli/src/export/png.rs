//! Gray pixels to PNG.

use std::io::Cursor;

use image::codecs::png::PngEncoder;
use image::{EncodableLayout, ImageBuffer, Luma, PixelWithColorType, Primitive};

use super::error::ExportError;

/// The bytes of a gray PNG of 8 or 16 bits, as the numbers have.
pub(super) fn gray<N>(width: u32, height: u32, pixels: Vec<N>) -> Result<Vec<u8>, ExportError>
where
    N: Primitive,
    Luma<N>: PixelWithColorType + image::Pixel<Subpixel = N>,
    [N]: EncodableLayout,
{
    let mut png = Cursor::new(Vec::new());
    // As many pixels as the size says, or none at all.
    if let Some(image) = ImageBuffer::<Luma<N>, _>::from_raw(width, height, pixels) {
        image.write_with_encoder(PngEncoder::new(&mut png))?;
    }
    Ok(png.into_inner())
}
