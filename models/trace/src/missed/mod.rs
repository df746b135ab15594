//! What a drawing misses: what is seen in the picture and not painted, traced from what is left of it.
//!
//! Letters of a few pixels' height, and lines that meet or cross in ways that nobody foresaw, have hardly a pixel of their own: what reads faces and
//! lines leaves such out. When the drawing is painted they stand out of it. What stands out in one color is a thing: its coverage, pixel by pixel, is
//! the share of the way from what is painted there to that color, and its outline is one that covers as much of every pixel.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Painted`]: what stands out, and in which color |
//! | `pixels` | pixels that differ, and which of them touch |
//! | `level` | the outlines of what covers pixels in part |

mod level;
mod pixels;
#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::image::{distance, mixture};
use dvp_core::{ImageSize, ImageView, Object, Paint, Real as _, Scene, Vec2};

use crate::layers::{Form, Layer};
use crate::partition::Color;
use crate::ruler::Ruler;
use crate::scene;
use crate::table::Table;
use crate::tuning;
use level::Level;
pub use pixels::{channels, differing, touching};

/// Largest window that is searched for one thing, pixels: the finer grid takes 128 bytes for each.
const MOST_PIXELS: usize = 1 << 18;

/// How wide a line is, pixels, that has a color of its own: what is thinner shows half of it nowhere.
const LEAST_WIDTH: f64 = 0.5;

/// A picture beside what a drawing of it paints.
#[derive(Debug)]
pub struct Painted<'a> {
    /// The drawing.
    pub scene: &'a Scene<f32>,
    /// The picture.
    pub image: ImageView<'a, f32>,
    /// The drawing, painted.
    pub painted: ImageView<'a, f32>,
    /// Differences of a channel up to this are none.
    pub step: f64,
}

/// A thing that the picture shows and the drawing does not.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Missed {
    /// The thing.
    pub object: Object<f32>,
    /// Description length of its outline, bits.
    pub bits: f64,
}

/// What is painted around a pixel that differs.
#[derive(Clone, Copy)]
struct Mark {
    /// Whether no mixture of that, and of the background, explains the pixel: else an edge may be off by a pixel, or an opening filled.
    is_new: bool,
    /// Whether it is of one color.
    is_flat: bool,
}

/// The pixels of a thing.
struct Seen {
    color: Color,
    pixels: Vec<usize>,
    /// How many of them nothing that is painted beside them explains.
    count: usize,
    /// Bits that those cost now, wherever they lie.
    missed: f64,
}

impl Painted<'_> {
    /// What is missed, where telling it is shorter than telling its pixels one by one. `off`: the pixels that differ.
    #[must_use]
    #[inline(never)]
    pub fn missed(&self, off: &[usize]) -> Vec<Missed> {
        let parts = touching(off, self.image.size().width());
        let mut pixels: Vec<Vec<usize>> =
            vec![Vec::new(); parts.iter().map(|&part| part as usize + 1).max().unwrap_or(0)];
        off.iter().zip(parts).for_each(|(&i, part)| pixels[part as usize].push(i));
        let colors = self.colors();
        let mut found = Vec::new();
        let mut known = Known::default();
        for pixels in pixels {
            let mut marked: Vec<(usize, Mark)> = pixels.into_iter().map(|i| (i, self.mark(i))).collect();
            while let Some(seen) = self.seen(&marked, &colors) {
                marked.retain(|(i, _)| seen.pixels.binary_search(i).is_err());
                found.extend(self.traced(seen, &mut known));
            }
        }
        found
    }

    /// Whether enough of the pixels that differ show something new for anything to be missed.
    #[must_use]
    pub fn may_miss(&self, off: &[usize]) -> bool {
        off.iter().filter(|&&i| self.mark(i).is_new).count() >= least_seen()
    }

    /// The pixels that differ, of those `within`, ascending.
    #[must_use]
    pub fn off(&self, within: &Range<usize>) -> Vec<usize> {
        let [image, painted] = [&self.image, &self.painted].map(|image| channels(image, within));
        differing(image, painted, f32::of(self.step), within.start)
    }

    /// The colors of the drawing's things; what has that of the background is left to what lies around it.
    fn colors(&self) -> Vec<Color> {
        let background = self.scene.background.map(f64::from);
        let mut colors: Vec<Color> = Vec::new();
        for object in &self.scene.objects {
            let Paint::Flat(color) = object.paint else { continue };
            let color = color.map(f64::from);
            if distance(color, background) > self.step && !colors.contains(&color) {
                colors.push(color);
            }
        }
        colors
    }

    /// Of pixels that touch, those that one color explains, where they are more than telling it as a thing costs.
    #[inline(never)]
    fn seen(&self, pixels: &[(usize, Mark)], colors: &[Color]) -> Option<Seen> {
        let least = least_seen();
        if pixels.iter().filter(|(_, mark)| mark.is_new).count() < least {
            return None;
        }
        // What lies along an edge is a sliver of something that is seen elsewhere; what lies on one color may have its own.
        let is_own = pixels.iter().any(|(_, mark)| mark.is_new && mark.is_flat);
        let least = if is_own { least } else { tuning::LEAST_SEAM };
        let new = pixels.iter().filter(|(_, mark)| mark.is_new && mark.is_flat == is_own).map(|&(i, _)| i);
        let extreme = new.max_by(|&i, &j| self.distance(i).total_cmp(&self.distance(j)))?;
        let of_color = |ink: Color| self.of_color(ink, pixels, is_own);
        let own = is_own.then(|| of_color(color(&self.image, extreme)).0);
        // A color of the drawing explains as much, and one that is nowhere half seen on another one is none.
        let fewest = own.as_ref().map_or(least, |own| own.count - own.count / 10);
        let known = colors.iter().filter(|&&ink| self.share(extreme, ink).is_some()).map(|&ink| of_color(ink));
        let known = known.filter(|(seen, most)| seen.count >= fewest && (*most >= LEAST_WIDTH || !is_own));
        let best = known.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(seen, _)| seen).or(own)?;
        (best.count >= least).then_some(best)
    }

    /// Of pixels that touch, those that show things of one color which are half a pixel wide at least, and the most that is seen of it in one of them.
    ///
    /// *Why*: a thin line of a lighter color shows as much as one of this color that is thinner still, and what lies across it would take all of it for
    /// its own.
    #[inline(never)]
    fn of_color(&self, ink: Color, pixels: &[(usize, Mark)], is_own: bool) -> (Seen, f64) {
        let [width, height] = [self.image.size().width(), self.image.size().height()];
        let shares: Vec<(usize, f64)> = pixels.iter().filter_map(|&(i, _)| Some((i, self.share(i, ink)?))).collect();
        let share = |i: usize| shares.binary_search_by_key(&i, |&(i, _)| i).map_or(0.0, |at| shares[at].1);
        // What lies at the border of the picture goes on beyond it.
        let around = |i: usize| {
            let [x, y] = [i % width, i / width];
            let near = |at: usize, k: usize, side: usize| (at + k).saturating_sub(1).min(side - 1);
            (0..9).map(move |k| near(y, k / 3, height) * width + near(x, k % 3, width))
        };
        // Wherever such a line runs, it covers as much of three times three pixels; the end of one, and a dot, cover a pixel by half.
        let is_wide =
            |&(i, own): &(usize, f64)| own >= LEAST_WIDTH || around(i).map(share).sum::<f64>() >= 3.0 * LEAST_WIDTH;
        let wide: Vec<usize> = shares.iter().copied().filter(is_wide).map(|(i, _)| i).collect();
        let mut seen = Seen { color: ink, pixels: Vec::new(), count: 0, missed: 0.0 };
        let mut most: f64 = 0.0;
        for &(i, mark) in pixels {
            let share = share(i);
            if share > 0.0 && around(i).any(|i| wide.binary_search(&i).is_ok()) {
                seen.pixels.push(i);
                seen.count += usize::from(mark.is_new && mark.is_flat >= is_own);
                seen.missed += if mark.is_new { misfit_bits(self.distance(i), self.step) } else { 0.0 };
                most = most.max(share);
            }
        }
        (seen, most)
    }

    /// What is painted around a pixel tells of it.
    #[inline(never)]
    fn mark(&self, i: usize) -> Mark {
        let [width, height] = [self.image.size().width(), self.image.size().height()];
        let (x, y) = (i % width, i / width);
        let (pixel, under) = (color(&self.image, i), color(&self.painted, i));
        let mut is_flat = true;
        // The background, and nine at most.
        let mut near = [self.scene.background.map(f64::from); 10];
        let mut count = 1;
        for row in y.saturating_sub(1)..(y + 2).min(height) {
            for column in x.saturating_sub(1)..(x + 2).min(width) {
                let color = color(&self.painted, row * width + column);
                is_flat &= distance(color, under) <= self.step;
                if !near[..count].contains(&color) {
                    near[count] = color;
                    count += 1;
                }
            }
        }
        let mut pairs = (0..count).flat_map(|k| (0..=k).map(move |l| (k, l)));
        Mark { is_new: pairs.all(|(k, l)| mixture(pixel, near[k], near[l]).1 > self.step), is_flat }
    }

    /// By how much a channel of a pixel differs at most.
    fn distance(&self, i: usize) -> f64 {
        distance(color(&self.image, i), color(&self.painted, i))
    }

    /// How much of a color is seen in a pixel over what is painted there; none if it is not that color, or if it is painted already.
    #[inline(never)]
    fn share(&self, i: usize, ink: Color) -> Option<f64> {
        let (pixel, under) = (color(&self.image, i), color(&self.painted, i));
        let (share, misfit) = mixture(pixel, under, ink);
        (misfit <= 0.5 * self.step && distance(under, ink) > self.step).then_some(share)
    }

    /// A thing, as strokes of a pen or in outlines, if it costs less than its pixels; else nothing.
    #[inline(never)]
    fn traced(&self, Seen { color, pixels, count, missed }: Seen, known: &mut Known) -> Option<Missed> {
        // What its pixels cost now, or if each new one of them were told as it is.
        let worth = missed.max(count as f64 * tuning::PIXEL_BITS);
        let [width, height] = [self.image.size().width(), self.image.size().height()];
        // Two pixels more on every side; what lies at the border of the picture goes on beyond it.
        let reach = |of: &dyn Fn(usize) -> usize| {
            let [low, high] = pixels.iter().map(|&i| of(i)).fold([usize::MAX, 0], |[a, b], at| [a.min(at), b.max(at)]);
            low..high + 5
        };
        let [columns, rows] = [reach(&|i| i % width), reach(&|i| i / width)];
        let window = ImageSize::new(columns.len(), rows.len()).ok().filter(|window| window.pixels() <= MOST_PIXELS)?;
        let corner = Vec2::new(columns.start as f64 - 2.0, rows.start as f64 - 2.0);
        // What lies beside shows a little of it, too.
        let is_own = |x: usize, y: usize| x < width && y < height && pixels.binary_search(&(y * width + x)).is_ok();
        let touches =
            |x: usize, y: usize| (0..9).any(|k| is_own((x + k % 3).wrapping_sub(1), (y + k / 3).wrapping_sub(1)));
        let share = |(x, y): (usize, usize)| {
            let [x, y] = [x.saturating_sub(2).min(width - 1), y.saturating_sub(2).min(height - 1)];
            if touches(x, y) { self.share(y * width + x, color).unwrap_or(0.0) } else { 0.0 }
        };
        let field: Vec<f64> = rows.flat_map(|y| columns.clone().map(move |x| share((x, y)))).collect();
        let ruler = Ruler { extent: width.max(height) as f64 };
        let key = core::iter::once(columns.len() as u64).chain(field.iter().map(|share| share.to_bits())).collect();
        let (first, covering) = known.get(key, || (corner, covering(&field, window, corner, &ruler)));
        let (form, bits) = covering.clone()?;
        if bits + tuning::THING_BITS > worth {
            return None;
        }
        let layer = Layer { color, form, faces: Vec::new(), heap: None, bits };
        let unit = self.image.size().unit_px() as f64;
        let mut object = scene::object(&layer, unit)?;
        for (at, by) in object.pose.translation.iter_mut().zip((corner - *first).to_array()) {
            *at += f32::of(by / unit);
        }
        Some(Missed { object, bits })
    }
}

/// What covers pixels in part, by the columns of its window and the shares of its pixels: of things that are drawn alike, as letters are, the first is
/// traced. The corner of its window, and what covers it, with its description length, bits; none of a window that is empty.
type Known = Table<(Vec2<f64>, Option<(Form, f64)>)>;

/// What covers as much of every pixel of a window as `field` says, and its description length, bits.
fn covering(field: &[f64], window: ImageSize, corner: Vec2<f64>, ruler: &Ruler) -> Option<(Form, f64)> {
    let level = Level::of(field, window, corner)?;
    let outlines = level.outlines(ruler);
    let bits = outlines.iter().map(|outline| outline.bits + outline.misfit).sum();
    // Lines with ends of two kinds would be two things.
    let pen = level.pen(ruler).filter(|pen| pen.strokes.len() == 1 && pen.bits + pen.misfit < bits);
    let stroke = pen.and_then(|pen| Some((pen.bits + pen.misfit, pen.strokes.into_iter().next()?)));
    Some(match stroke {
        Some((bits, stroke)) => (Form::Stroked(stroke), bits),
        None => (Form::Filled(outlines), bits),
    })
}

/// Bits that a pixel costs a channel of which is `off` by so much: off by `step` it is off by one sigma, and it is told as it is if that is less.
#[must_use]
pub fn misfit_bits(off: f64, step: f64) -> f64 {
    (0.5 * core::f64::consts::LOG2_E * (off / step).powi(2)).min(tuning::PIXEL_BITS)
}

/// Fewest pixels that show something new for it to be a thing: fewer cost less than that there is one.
fn least_seen() -> usize {
    (tuning::THING_BITS / tuning::PIXEL_BITS).ceil() as usize
}

/// The color of a pixel.
fn color(image: &ImageView<'_, f32>, i: usize) -> Color {
    image.pixel(i).map(f64::from)
}
