//! SVG drawn by another program than ours: resvg.

use dvp_core::{Image, ImageSize};
use resvg::{tiny_skia, usvg};

/// The picture that resvg draws of an SVG text, in the size that the text asks for.
///
/// # Errors
/// A sentence, if the text is no SVG or leaves pixels transparent.
pub fn draw_svg(text: &str) -> Result<Image<f64>, String> {
    let tree = usvg::Tree::from_str(text, &usvg::Options::default()).map_err(|error| error.to_string())?;
    let size = tree.size().to_int_size();
    let mut pixmap = tiny_skia::Pixmap::new(size.width(), size.height()).ok_or("an empty picture")?;
    resvg::render(&tree, tiny_skia::Transform::identity(), &mut pixmap.as_mut());
    let mut values = Vec::new();
    for pixel in pixmap.pixels() {
        if pixel.alpha() != u8::MAX {
            return Err("a transparent pixel: the background is missing".to_owned());
        }
        values.extend([pixel.red(), pixel.green(), pixel.blue()].map(|value| f64::from(value) / 255.0));
    }
    let [width, height] = [size.width(), size.height()].map(|side| usize::try_from(side).unwrap_or(0));
    let size = ImageSize::new(width, height).map_err(|error| error.to_string())?;
    Image::from_interleaved(size, &values).map_err(|error| error.to_string())
}
