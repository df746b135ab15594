//! Text in pixels, by a font of ours: there may be none on the machine.

use ab_glyph::{Font as _, FontRef, Glyph, PxScale, ScaleFont as _, point};
use anyhow::{Context, Result};

/// DejaVu Sans, its printable ASCII.
static BYTES: &[u8] = include_bytes!("../../fonts/DejaVuSans-ascii.ttf");

/// Heights of text in plotters, over what SVG and fonts call its size.
const HEIGHT_PER_EM: f64 = 1.24;

/// A line of text, laid out from (0, 0) to the right, on the baseline.
pub(super) struct Text {
    font: FontRef<'static>,
    glyphs: Vec<Glyph>,
    /// Px.
    pub(super) width: f32,
    /// The size of the font, px.
    pub(super) em: f32,
}

impl Text {
    /// Text of a height as plotters gives it, px.
    pub(super) fn new(text: &str, height: f64) -> Result<Self> {
        let font = FontRef::try_from_slice(BYTES).context("the font of charts")?;
        #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
        let em = (height / HEIGHT_PER_EM) as f32;
        let units = font.units_per_em().context("the font of charts has no size")?;
        let scale = PxScale::from(em * font.height_unscaled() / units);
        let mut glyphs = Vec::with_capacity(text.len());
        let mut width = 0.0;
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            glyphs.push(id.with_scale_and_position(scale, point(width, 0.0)));
            width += font.as_scaled(scale).h_advance(id);
        }
        Ok(Self { font, glyphs, width, em })
    }

    /// Calls `paint` with each pixel that a letter covers, counted from the origin, and the share that it covers.
    pub(super) fn paint(&self, mut paint: impl FnMut(f32, f32, f32)) {
        for glyph in &self.glyphs {
            if let Some(outline) = self.font.outline_glyph(glyph.clone()) {
                let corner = outline.px_bounds().min;
                #[expect(clippy::cast_precision_loss, reason = "pixels of a letter are few")]
                outline.draw(|x, y, share| paint(corner.x + x as f32, corner.y + y as f32, share));
            }
        }
    }
}
