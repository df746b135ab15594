//! Pictures of squares: what was enlarged by repeating pixels, and sprites, whose pixels are what was drawn.
//!
//! A picture in which every pixel is repeated k x k times holds no more than the small one, which is read in its place ([`reduced`]): a mixed
//! pixel is the edge of something there, and no square. Scene units do not change with the size of a picture.
//!
//! Of a sprite every pixel is a square of one color. Read as a picture of outlines that pass between pixels, it is blurred, or loses what is one
//! pixel wide. Its squares are read with each pixel repeated ([`enlarged`]), where their sides are edges like others. Which of the two a picture is, the
//! length of its description decides ([`Squares`]).

#[cfg(test)]
mod tests;

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::shape::gcd;
use dvp_core::{Image, ImageSize, ImageView, Real as _};
use dvp_trace::tuning::SQUARE;

use crate::tuning::VISIBLE_ERROR;

/// A reduced picture has so many pixels on its shorter side, at least: fewer say less of what was drawn than a scene of a few rectangles needs.
const LEAST_SIDE: usize = 16;
/// Pixels on the longer side of the largest sprite: larger pictures without mixed pixels are drawings without smooth edges.
const MOST_SIDE: usize = 128;
/// Patches of one color of the richest sprite: a photograph of 128 x 128 pixels in 16 colors has 3,500, in black and white 4,700. As many take up to
/// five seconds.
const MOST_PATCHES: usize = 5000;
/// Colors of the largest palette of a sprite, as consoles and editors of pixel art have them. Smooth edges and blurs have many more.
const MOST_COLORS: usize = 64;
/// A pixel off by more, as a share of the scale, is wrong: less is a share of an edge, where edges are smooth.
const WRONG: f32 = 0.25;
/// Bits of a color of 8 bits per channel.
const COLOR_BITS: f64 = 24.0;

/// The picture that was enlarged by repeating every pixel; none if this one was not.
pub(super) fn reduced(image: &ImageView<'_, f32>) -> Option<Image<f32>> {
    let size = image.size();
    let shorter = size.width().min(size.height());
    let common = repetition(image);
    let times = (2..=common).rev().find(|k| common.is_multiple_of(*k) && shorter / k >= LEAST_SIDE)?;
    resampled(image, [size.width() / times, size.height() / times], |at| at * times)
}

/// The picture with every pixel repeated; none if there is no such size.
pub(super) fn enlarged(image: &ImageView<'_, f32>) -> Option<Image<f32>> {
    let size = image.size();
    resampled(image, [SQUARE * size.width(), SQUARE * size.height()], |at| at / SQUARE)
}

/// Whether a picture is small enough for a sprite.
pub(super) fn may_be(size: ImageSize) -> bool {
    size.width().max(size.height()) <= MOST_SIDE
}

/// What a picture takes as squares of one color, and what a scene misses of it.
pub(super) struct Squares {
    /// Colors of the palette.
    pub(super) colors: usize,
    /// Bits of the squares: a step straight on, to the left or to the right for every side between two colors, the color of every patch, and the palette.
    pub(super) bits: f64,
    /// Bits of the pixels that the scene gets wrong: where they are, and their colors.
    pub(super) wrong_bits: f64,
}

impl Squares {
    /// Of a picture and of its scene, painted; where pixels are repeated, what is visibly off is wrong. None if nothing is visibly missed, or of more
    /// patches or colors than sprites have.
    pub(super) fn of(image: &ImageView<'_, f32>, painted: &ImageView<'_, f32>, are_repeated: bool) -> Option<Self> {
        let (pixels, width) = (image.size().pixels(), image.size().width());
        let mut palette: Vec<[u32; 3]> = (0..pixels).map(|i| image.pixel(i).map(f32::to_bits)).collect();
        let (mut sides, mut patches) = (0_usize, 1_usize);
        for i in 1..pixels {
            let differs = |there: bool, from: usize| there && palette[i] != palette[from];
            let (left, up) = (differs(i % width > 0, i - 1), differs(i >= width, i.wrapping_sub(width)));
            sides += usize::from(left) + usize::from(up);
            // Where a patch starts: nothing of its color is to the left of it or above.
            patches += usize::from((left || i % width == 0) && (up || i < width));
        }
        palette.sort_unstable();
        palette.dedup();
        let is_off = |i: usize, by: f32| {
            let (there, shown) = (image.pixel(i), painted.pixel(i));
            (0..3).any(|c| (there[c] - shown[c]).abs() > by)
        };
        let colors = palette.len();
        let visible = f32::of(VISIBLE_ERROR);
        let is_exact = !(0..pixels).any(|i| is_off(i, visible));
        if is_exact || patches > MOST_PATCHES || colors > MOST_COLORS {
            return None;
        }
        let color_bits = f64::of_usize(colors).log2();
        let bits = f64::of_usize(sides) * 3.0_f64.log2()
            + f64::of_usize(patches) * color_bits
            + f64::of_usize(colors) * COLOR_BITS;
        let most_off = if are_repeated { visible } else { WRONG };
        let wrong = (0..pixels).filter(|&i| is_off(i, most_off)).count();
        let wrong_bits = f64::of_usize(wrong) * (f64::of_usize(pixels).log2() + color_bits);
        Some(Self { colors, bits, wrong_bits })
    }
}

/// The largest number of pixels, both ways, that every square of one color in the picture is a multiple of.
fn repetition(image: &ImageView<'_, f32>) -> usize {
    let (width, height) = (image.size().width(), image.size().height());
    let mut common = gcd(width, height);
    for y in 0..height {
        let rows = (0..3).map(|c| &image.channel(c)[y * width..][..width]);
        let above = (0..3).map(|c| &image.channel(c)[y.saturating_sub(1) * width..][..width]);
        let is_new = rows.clone().zip(above).any(|(row, above)| row != above);
        if is_new {
            common = gcd(common, y);
        }
        if is_new || y == 0 {
            for row in rows {
                for (before, pair) in row.windows(2).enumerate() {
                    if pair[0].to_bits() != pair[1].to_bits() {
                        common = gcd(common, before + 1);
                    }
                }
            }
        }
        if common == 1 {
            break;
        }
    }
    common
}

/// A picture of `size` (columns, rows) whose pixels are those at `from` (column or row).
fn resampled(image: &ImageView<'_, f32>, size: [usize; 2], from: impl Fn(usize) -> usize) -> Option<Image<f32>> {
    let width = image.size().width();
    let pixel = |channel: &[f32], i: usize| channel[from(i / size[0]) * width + from(i % size[0])];
    let size = ImageSize::new(size[0], size[1]).ok()?;
    let data = (0..3).flat_map(|c| {
        let channel = image.channel(c);
        (0..size.pixels()).map(move |i| pixel(channel, i))
    });
    Image::from_planar(size, data.collect()).ok()
}
