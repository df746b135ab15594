//! Pictures of few colors without a mixed pixel.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::{ImageSize, ImageView, Real};

/// More colors than this are those of mixed pixels or of noise.
const MOST_COLORS: usize = 24;

/// A picture whose pixels each show one of few colors.
#[derive(Clone, Debug)]
pub(super) struct FlatPicture {
    pub(super) size: ImageSize,
    /// The colors, in the order in which they come.
    pub(super) colors: Vec<[f32; 3]>,
    /// Per pixel, the index of its color.
    pub(super) color_of: Vec<usize>,
    /// The color of most pixels.
    pub(super) ground: usize,
}

/// Pixels of one color that hang together, beside or across corners.
pub(super) type Part = Vec<usize>;

impl FlatPicture {
    /// The colors of a picture; none if there are many.
    pub(super) fn of<T: Real>(image: &ImageView<'_, T>) -> Option<Self> {
        let size = image.size();
        let (mut colors, mut counts): (Vec<[f32; 3]>, Vec<usize>) = (Vec::new(), Vec::new());
        let mut color_of = Vec::with_capacity(size.pixels());
        let mut last = 0;
        for pixel in 0..size.pixels() {
            let color = image.pixel(pixel).map(Real::as_f32);
            let is_same = |other: &[f32; 3]| (0..3).all(|c| other[c].to_bits() == color[c].to_bits());
            if colors.get(last).is_none_or(|other| !is_same(other)) {
                last = colors.iter().position(is_same).unwrap_or(colors.len());
                if last == colors.len() {
                    if last == MOST_COLORS {
                        return None;
                    }
                    colors.push(color);
                    counts.push(0);
                }
            }
            counts[last] += 1;
            color_of.push(last);
        }
        let ground = (0..colors.len()).max_by_key(|&color| counts[color])?;
        Some(Self { size, colors, color_of, ground })
    }

    /// The pixels of a color.
    pub(super) fn pixels_of(&self, color: usize) -> Part {
        (0..self.color_of.len()).filter(|&pixel| self.color_of[pixel] == color).collect()
    }

    /// The parts that pixels fall into.
    pub(super) fn parts_of(&self, pixels: &[usize]) -> Vec<Part> {
        let mut open = vec![false; self.color_of.len()];
        pixels.iter().for_each(|&pixel| open[pixel] = true);
        let mut parts = Vec::new();
        for &start in pixels {
            if !core::mem::take(&mut open[start]) {
                continue;
            }
            let mut part = vec![start];
            let mut next = 0;
            while let Some(&pixel) = part.get(next) {
                for neighbor in self.around(pixel) {
                    if core::mem::take(&mut open[neighbor]) {
                        part.push(neighbor);
                    }
                }
                next += 1;
            }
            parts.push(part);
        }
        parts
    }

    /// The pixels beside one and across its corners.
    pub(super) fn around(&self, pixel: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.size.width(), self.size.height());
        let (column, row) = (pixel % width, pixel / width);
        let rows = row.saturating_sub(1)..(row + 2).min(height);
        let columns = column.saturating_sub(1)..(column + 2).min(width);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
            .filter(move |&neighbor| neighbor != pixel)
    }

    /// The middle of a pixel, px.
    pub(super) fn middle(&self, pixel: usize) -> [f64; 2] {
        let width = self.size.width();
        [f64::of_usize(pixel % width) + 0.5, f64::of_usize(pixel / width) + 0.5]
    }

    /// Whether a pixel lies at the border of the picture.
    pub(super) fn is_at_border(&self, pixel: usize) -> bool {
        let (width, height) = (self.size.width(), self.size.height());
        let (column, row) = (pixel % width, pixel / width);
        column == 0 || row == 0 || column + 1 == width || row + 1 == height
    }
}
