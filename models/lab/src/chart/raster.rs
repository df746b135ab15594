//! A drawing as PNG, by resvg, with a font that comes along: there may be none on the machine.

use alloc::sync::Arc;

use anyhow::{Context, Result};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Options, Tree};
use ttf_parser::Face;

/// DejaVu Sans, its printable ASCII.
static FONT: &[u8] = include_bytes!("../../fonts/DejaVuSans-ascii.ttf");

/// Its name.
const FAMILY: &str = "DejaVu Sans";

/// The PNG of an SVG, `zoom` pixels per unit. Text of any family is set in the font that comes along.
///
/// # Errors
/// If the text is no SVG, or so large that it has no room in memory.
pub(super) fn png(svg: &str, zoom: u8) -> Result<Vec<u8>> {
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let options = Options { font_family: FAMILY.to_owned(), fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).context("the SVG of a chart")?;
    let zoom = f32::from(zoom);
    let size = tree.size().to_int_size().scale_by(zoom).context("the size of a chart")?;
    let mut pixels = Pixmap::new(size.width(), size.height()).context("the size of a chart")?;
    resvg::render(&tree, Transform::from_scale(zoom, zoom), &mut pixels.as_mut());
    pixels.encode_png().context("the PNG of a chart")
}

/// Width of a line of text in that font, in units of the size of the font.
///
/// # Errors
/// If the font that comes along cannot be read.
pub(super) fn width(text: &str) -> Result<f64> {
    let face = Face::parse(FONT, 0).context("the font of charts")?;
    let advance = |letter| face.glyph_index(letter).and_then(|glyph| face.glyph_hor_advance(glyph)).unwrap_or(0);
    let units: u32 = text.chars().map(|letter| u32::from(advance(letter))).sum();
    Ok(f64::from(units) / f64::from(face.units_per_em()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_as_wide_as_its_letters() {
        // Of DejaVu Sans: i is 569 of 2048 units wide, m 1995.
        assert!((width("im").unwrap() - (569.0 + 1995.0) / 2048.0).abs() < 1e-12);
        assert!(width("").unwrap().abs() < 1e-12);
    }
}
