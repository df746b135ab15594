//! Pictures of few colors without mixed pixels, but for the few that an outline passes through the middle of.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::{ImageSize, ImageView, Real};
use dvp_trace::tuning::MOST_HARD;

/// More colors than this are those of mixed pixels or of noise.
const MOST_COLORS: usize = 24;

/// Colors of more pixels are those of something.
const MOST_MIXED: usize = 2;
/// How far a mixture may be off: by the rounding of three colors to 8 bits.
const ROUNDING: f64 = 1.5 / 255.0;

/// Bands of one color in soft edges are at most this wide, px.
const WIDEST_BAND_PX: usize = 7;

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
    /// The colors of a picture; none if there are many, or more of its pixels at edges are mixed than those of hard edges are.
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
        let mut picture = Self { size, colors, color_of, ground };
        if picture.is_soft() {
            return None;
        }
        let edges = picture.edge_count();
        let rare = (0..counts.len()).filter(|&color| counts[color] <= MOST_MIXED);
        let mixed: usize = rare.map(|color| picture.unmix(color)).sum();
        (f64::of_usize(mixed) <= MOST_HARD * f64::of_usize(edges)).then_some(picture)
    }

    /// Whether most steps from color to color are those of soft edges: from and to colors that are nowhere wide and mix two that are. Where an
    /// object hardly differs from what is around it, its edge has few colors however soft it is.
    fn is_soft(&self) -> bool {
        let count = self.colors.len();
        let widths = self.widths();
        let wide: Vec<usize> = (0..count).filter(|&color| widths[color] > WIDEST_BAND_PX).collect();
        let pairs = || wide.iter().flat_map(|&a| wide.iter().map(move |&b| (a, b)));
        let is_band =
            |color: usize| widths[color] <= WIDEST_BAND_PX && pairs().any(|(a, b)| self.share(color, a, b).is_some());
        let bands: Vec<bool> = (0..count).map(is_band).collect();
        let (mut of_bands, mut steps) = (0_usize, 0_usize);
        let width = self.size.width();
        for (pixel, &color) in self.color_of.iter().enumerate() {
            let [left, above] = [(pixel % width > 0).then(|| pixel - 1), pixel.checked_sub(width)];
            for other in [left, above].into_iter().flatten().map(|other| self.color_of[other]) {
                steps += usize::from(other != color);
                of_bands += usize::from(other != color && (bands[color] || bands[other]));
            }
        }
        2 * of_bands > steps
    }

    /// The side of the largest square of each color, px.
    fn widths(&self) -> Vec<usize> {
        let width = self.size.width();
        let mut widths = vec![0; self.colors.len()];
        // Of the squares that end at the pixels of one row, each in the column behind its own.
        let (mut above, mut row) = (vec![0; width + 1], vec![0; width + 1]);
        for (pixel, &color) in self.color_of.iter().enumerate() {
            let x = pixel % width;
            let of_color = |other: Option<usize>| other.is_some_and(|other| self.color_of[other] == color);
            let is_inside = x > 0
                && of_color(Some(pixel - 1))
                && of_color(pixel.checked_sub(width))
                && of_color(pixel.checked_sub(width + 1));
            row[x + 1] = if is_inside { 1 + above[x].min(above[x + 1]).min(row[x]) } else { 1 };
            widths[color] = widths[color].max(row[x + 1]);
            if x + 1 == width {
                core::mem::swap(&mut above, &mut row);
            }
        }
        widths
    }

    /// Pixels beside or above one of another color.
    fn edge_count(&self) -> usize {
        let width = self.size.width();
        let differs = |pixel: usize, other: usize| self.color_of[pixel] != self.color_of[other];
        let is_edge = |&pixel: &usize| {
            pixel % width > 0 && differs(pixel, pixel - 1) || pixel >= width && differs(pixel, pixel - width)
        };
        (0..self.color_of.len()).filter(is_edge).count()
    }

    /// Gives the pixels of a rare color the nearer of two colors beside them, if it is a mixture of those: the outline passes through the middle
    /// of the pixel as exactly as no edge is sharp. How many there were.
    fn unmix(&mut self, color: usize) -> usize {
        let mut count = 0;
        for pixel in self.pixels_of(color) {
            let beside: Vec<usize> =
                self.around(pixel).map(|neighbor| self.color_of[neighbor]).filter(|&other| other != color).collect();
            let pairs = beside.iter().flat_map(|&a| beside.iter().map(move |&b| (a, b)));
            let mixed = pairs.filter_map(|(a, b)| Some((a, self.share(color, a, b)?)));
            let nearest = mixed.min_by(|(_, a), (_, b)| a.total_cmp(b));
            if let Some((own, _)) = nearest {
                self.color_of[pixel] = own;
                count += 1;
            }
        }
        count
    }

    /// The share of color `b` in a mixture of `a` and `b`; none if `color` is no such mixture.
    fn share(&self, color: usize, a: usize, b: usize) -> Option<f64> {
        let [color, a, b] = [color, a, b].map(|index| self.colors[index].map(f64::from));
        let step: [f64; 3] = core::array::from_fn(|c| b[c] - a[c]);
        let length: f64 = step.iter().map(|v| v * v).sum();
        let share = (0..3).map(|c| (color[c] - a[c]) * step[c]).sum::<f64>() / length.max(1e-12);
        let off = (0..3).map(|c| (color[c] - a[c] - share * step[c]).abs()).fold(0.0, f64::max);
        (length > 0.0 && (0.0..=1.0).contains(&share) && off <= ROUNDING).then_some(share)
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

    /// The middles (px) of pixels on either side of the outline of some, and whether they are among them.
    pub(super) fn sides_of(&self, pixels: &[usize]) -> Vec<([f64; 2], bool)> {
        let mut is_own = vec![false; self.color_of.len()];
        pixels.iter().for_each(|&pixel| is_own[pixel] = true);
        let is_beside = |pixel: usize, other: bool| self.around(pixel).any(|neighbor| is_own[neighbor] == other);
        let pixels = (0..is_own.len()).filter(|&pixel| is_beside(pixel, !is_own[pixel]));
        pixels.map(|pixel| (self.middle(pixel), is_own[pixel])).collect()
    }

    /// Whether a pixel lies at the border of the picture.
    pub(super) fn is_at_border(&self, pixel: usize) -> bool {
        let (width, height) = (self.size.width(), self.size.height());
        let (column, row) = (pixel % width, pixel / width);
        column == 0 || row == 0 || column + 1 == width || row + 1 == height
    }
}
