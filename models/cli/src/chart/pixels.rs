//! A drawing as PNG.

use anyhow::{Context, Result};
use dvp_core::{Image, ImageSize};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, DrawingErrorKind};

use super::text::Text;
use crate::format::{BitDepth, encode_png};

/// The PNG of what `paint` draws on `width` x `height` pixels.
pub(super) fn png(
    (width, height): (u32, u32),
    paint: impl FnOnce(&DrawingArea<&mut Pixels, Shift>) -> Result<()>,
) -> Result<Vec<u8>> {
    let size = ImageSize::new(width as usize, height as usize).context("size of a chart")?;
    let mut pixels = Pixels { size: (width, height), values: vec![1.0; 3 * size.pixels()] };
    paint(&(&mut pixels).into_drawing_area())?;
    Ok(encode_png(Image::from_interleaved(size, &pixels.values)?.view(), BitDepth::Eight)?)
}

/// What plotters paints on. That of plotters itself has no text without a font of the machine.
pub(super) struct Pixels {
    size: (u32, u32),
    /// r, g, b, r, g, b, ... in [0, 1].
    values: Vec<f32>,
}

type Painted = Result<(), DrawingErrorKind<NoFont>>;

/// The font that comes with the program cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{0:#}")]
pub(super) struct NoFont(anyhow::Error);

fn lay_out(text: &str, height: f64) -> Result<Text, DrawingErrorKind<NoFont>> {
    Text::new(text, height).map_err(|error| DrawingErrorKind::DrawingError(NoFont(error)))
}

impl Pixels {
    /// Puts a color over a pixel, as opaque as it is; what lies outside is left out.
    fn mix(&mut self, (x, y): BackendCoord, color: BackendColor) {
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return };
        if x >= self.size.0 || y >= self.size.1 {
            return;
        }
        let at = 3 * (y as usize * self.size.0 as usize + x as usize);
        #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
        let alpha = color.alpha as f32;
        let (red, green, blue) = color.rgb;
        for (value, channel) in self.values[at..at + 3].iter_mut().zip([red, green, blue]) {
            *value += alpha * (f32::from(channel) / 255.0 - *value);
        }
    }
}

impl DrawingBackend for &mut Pixels {
    type ErrorType = NoFont;

    fn get_size(&self) -> (u32, u32) {
        self.size
    }

    fn ensure_prepared(&mut self) -> Painted {
        Ok(())
    }

    fn present(&mut self) -> Painted {
        Ok(())
    }

    fn draw_pixel(&mut self, at: BackendCoord, color: BackendColor) -> Painted {
        self.mix(at, color);
        Ok(())
    }

    /// Where the SVG of plotters has it.
    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, at: BackendCoord) -> Painted {
        let text = lay_out(text, style.size())?;
        let anchor = style.anchor();
        let left = match anchor.h_pos {
            HPos::Left => 0.0,
            HPos::Center => -0.5 * text.width,
            HPos::Right => -text.width,
        };
        // An x is about half an em high.
        let down = text.em
            * match anchor.v_pos {
                VPos::Top => 0.76,
                VPos::Center => 0.27,
                VPos::Bottom => -0.27,
            };
        let (color, transform) = (style.color(), style.transform());
        text.paint(|x, y, share| {
            #[expect(clippy::cast_possible_truncation, reason = "rounding to a pixel")]
            let (x, y) = transform.transform((x + left).round() as i32, (y + down).round() as i32);
            self.mix((at.0 + x, at.1 + y), color.mix(f64::from(share)));
        });
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<NoFont>> {
        let text = lay_out(text, style.size())?;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "above 0, and few")]
        let size = [text.width, text.em].map(|length| length.ceil() as u32);
        Ok((size[0], size[1]))
    }
}
