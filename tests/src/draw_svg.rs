//! SVG drawn by another program than ours: resvg.

use dvp_core::image::RgbaImage;
use dvp_core::{Image, ImageSize, Real};
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

/// The picture that resvg draws of an SVG text as wide as `width` pixels, clear where nothing is.
///
/// # Errors
/// A sentence, if the text is no SVG or the picture is too large.
pub fn draw_svg_rgba(text: &str, width: usize) -> Result<RgbaImage<f64>, String> {
    let tree = usvg::Tree::from_str(text, &usvg::Options::default()).map_err(|error| error.to_string())?;
    let scale = f32::of_usize(width) / tree.size().width();
    let height = (tree.size().height() * scale).round().to_count().max(1);
    let size = ImageSize::new(width, height).map_err(|error| error.to_string())?;
    let (columns, rows) = u32::try_from(width).ok().zip(u32::try_from(height).ok()).ok_or("too large a picture")?;
    let mut pixmap = tiny_skia::Pixmap::new(columns, rows).ok_or("too large a picture")?;
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    let mut data = vec![0.0; 4 * size.pixels()];
    for (i, pixel) in pixmap.pixels().iter().enumerate() {
        let values = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()];
        for (channel, value) in values.into_iter().enumerate() {
            data[channel * size.pixels() + i] = f64::from(value) / 255.0;
        }
    }
    RgbaImage::from_premultiplied(size, data).map_err(|error| error.to_string())
}

/// A drawing whose pixels are means of 8 x 8 that resvg drew. It measures coverage on a lattice, 4 rows per pixel: of that, means
/// leave a sixty-fourth.
#[derive(Debug)]
pub struct FineDrawing {
    /// The means.
    pub image: RgbaImage<f64>,
    /// Whether an edge touches the pixel: whether its 8 x 8 are not all alike.
    pub edges: Vec<bool>,
}

/// Side of the square that becomes a pixel.
const FINE: usize = 8;

impl FineDrawing {
    /// Draws an SVG text whose user unit becomes `scale` pixels.
    ///
    /// # Errors
    /// A sentence, if the text is no SVG or the picture is too large.
    pub fn new(text: &str, scale: f32, size: ImageSize) -> Result<Self, String> {
        let tree = usvg::Tree::from_str(text, &usvg::Options::default()).map_err(|error| error.to_string())?;
        let [columns, rows] = [size.width(), size.height()].map(|side| u32::try_from(FINE * side));
        let (columns, rows) = columns.ok().zip(rows.ok()).ok_or("too large a picture")?;
        let mut pixmap = tiny_skia::Pixmap::new(columns, rows).ok_or("too large a picture")?;
        let scale = scale * f32::of_usize(FINE);
        resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
        let mut image = RgbaImage::transparent(size);
        let mut edges = vec![false; size.pixels()];
        let mut first: Vec<Option<[u8; 4]>> = vec![None; size.pixels()];
        let share = 1.0 / f64::of_usize(255 * FINE * FINE);
        for (i, pixel) in pixmap.pixels().iter().enumerate() {
            let (x, y) = (i % (FINE * size.width()) / FINE, i / (FINE * size.width()) / FINE);
            let place = y * size.width() + x;
            let values = [pixel.red(), pixel.green(), pixel.blue(), pixel.alpha()];
            for (channel, value) in values.iter().enumerate() {
                image.data_mut()[channel * size.pixels() + place] += f64::from(*value) * share;
            }
            edges[place] |= *first[place].get_or_insert(values) != values;
        }
        Ok(Self { image, edges })
    }

    /// The mean absolute difference of the four channels over the pixels that edges touch, and the largest over the others.
    #[must_use]
    pub fn difference(&self, image: &RgbaImage<f64>) -> Difference {
        let pixels = self.edges.len();
        let (mut sum, mut count, mut flat) = (0.0, 0, 0.0_f64);
        for (i, (a, b)) in self.image.data().iter().zip(image.data()).enumerate() {
            if self.edges[i % pixels] {
                sum += (a - b).abs();
                count += 1;
            } else {
                flat = flat.max((a - b).abs());
            }
        }
        Difference { edges: sum / f64::of_usize(count.max(1)), flat, touched: count / 4 }
    }
}

/// How far two drawings are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Mean over pixels that edges touch.
    pub edges: f64,
    /// Largest over the others.
    pub flat: f64,
    /// How many pixels edges touch.
    pub touched: usize,
}
