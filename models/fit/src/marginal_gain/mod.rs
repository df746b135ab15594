//! Marginal gain of each object: the error that the picture would have in addition if this object alone were left out.
//!
//! In: a drawing and its picture. Out: per object the sum of squared errors that it takes away, counted over pixels whose
//! centers it covers. Rows are cut where outlines cross them; between two cuts the same objects cover every pixel, so a sum
//! over the pixels is all it takes, and no rendering. `tests` holds it against renderings with and without each object.

#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::render::Compositing;
use dvp_core::scene::{ColorRamp, DrawnRamp, Layer};
use dvp_core::{Drawing, ImageSize, ImageView, Real, simd, sort};

/// Pixels of a row over which a ramp is taken as its color in the middle.
const RAMP_PIECE: usize = 8;

/// Where a row enters or leaves an object: its first pixel with a center beyond the crossing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Cut {
    row: usize,
    column: usize,
    object: usize,
}

/// Per object, the share of the picture's variance (`total`, a sum of squares) that would be unexplained in addition without it.
pub(crate) fn marginal_gains<T: Real>(
    drawing: &Drawing<T>,
    image: &ImageView<'_, T>,
    compositing: Compositing,
    total: f64,
) -> Vec<f64> {
    let mut out = squared_errors(drawing, image, compositing);
    out.iter_mut().for_each(|value| *value = if total > 0.0 { *value / total } else { 0.0 });
    out
}

/// Sum of squared errors over all channels that each object takes away, given the others. An object that makes things worse
/// has a negative one.
pub(crate) fn squared_errors<T: Real>(
    drawing: &Drawing<T>,
    image: &ImageView<'_, T>,
    compositing: Compositing,
) -> Vec<f64> {
    let size = image.size();
    let mut out = vec![0.0; drawing.object_count()];
    let mut cuts = Vec::new();
    for object in 0..out.len() {
        drawing.rings(object).iter().for_each(|ring| cut(ring, object, size, &mut cuts));
    }
    cuts.sort_unstable();
    let mut active = Vec::new();
    let mut mixture = Mixture::new(drawing, compositing);
    for cuts in cuts.chunk_by(|a, b| a.row == b.row) {
        active.clear();
        for (i, cut) in cuts.iter().enumerate() {
            // An object is left where it was entered.
            match active.binary_search(&cut.object) {
                Ok(at) => {
                    active.remove(at);
                }
                Err(at) => active.insert(at, cut.object),
            }
            let end = cuts.get(i + 1).map_or(size.width(), |next| next.column);
            if active.is_empty() || end <= cut.column {
                continue;
            }
            let line = cut.row * size.width();
            // Where ramps are painted, colors change on the way.
            let piece = if mixture.have_ramp(&active) { RAMP_PIECE } else { end - cut.column };
            for first in (cut.column..end).step_by(piece) {
                let last = (first + piece).min(end);
                mixture.move_to(&active, [0.5 * f64::of_usize(first + last), f64::of_usize(cut.row) + 0.5], size);
                let pixels = line + first..line + last;
                let sums = [0, 1, 2].map(|c| simd::sum(&image.channel(c)[pixels.clone()]).as_f64());
                let n = f64::of_usize(pixels.len());
                let shown = mixture.color(&active, None);
                for &object in &active {
                    let without = mixture.color(&active, Some(object));
                    // (x - without)^2 - (x - shown)^2, summed.
                    out[object] += (0..3)
                        .map(|c| (shown[c] - without[c]) * (2.0 * sums[c] - n * (shown[c] + without[c])))
                        .sum::<f64>();
                }
            }
        }
    }
    out
}

/// Indices by falling value.
pub(crate) fn ranking(values: &[f64]) -> Vec<usize> {
    let mut ranked: Vec<usize> = (0..values.len()).collect();
    sort::descending(&mut ranked, |&k| values[k]);
    ranked
}

/// Adds the crossings of a closed outline (scene units) with the middles of rows; an even number in each row.
fn cut<T: Real>(outline: &[[T; 2]], object: usize, size: ImageSize, cuts: &mut Vec<Cut>) {
    let (unit, half) = (T::of_usize(size.unit_px()), T::of(0.5));
    let ends = outline.iter().skip(1).chain(outline.first());
    for (&[px, py], &[qx, qy]) in outline.iter().zip(ends) {
        let (low, high) = (py.min(qy), py.max(qy));
        let last = (high * unit + half).ceil().to_count().min(size.height());
        for row in (low * unit - half).floor().to_count()..last {
            let middle = (T::of_usize(row) + half) / unit;
            if low <= middle && middle < high {
                let x = (px + (middle - py) / (qy - py) * (qx - px)) * unit;
                let column = (x - half).ceil().max(T::zero()).min(T::of_usize(size.width())).to_count();
                cuts.push(Cut { row, column, object });
            }
        }
    }
}

/// Colors of pixels that objects cover in whole.
struct Mixture<T> {
    background: [f64; 3],
    compositing: Compositing,
    /// Every object of the drawing, in full coverage.
    objects: Vec<Layer<f64>>,
    /// What paints those that have no one color.
    ramps: Vec<(usize, ColorRamp<T>)>,
    layers: Vec<Layer<f64>>,
    shares: Vec<f64>,
}

impl<T: Real> Mixture<T> {
    fn new(drawing: &Drawing<T>, compositing: Compositing) -> Self {
        let objects = drawing.colors.iter().zip(&drawing.confidences);
        let ramp = |drawn: &DrawnRamp<T>| {
            let stops = drawing.stops[drawn.stops.clone()].to_vec();
            (drawn.object, ColorRamp { kind: drawn.kind, stops })
        };
        Self {
            background: drawing.background.map(T::as_f64),
            compositing,
            objects: objects.map(|(color, f)| Layer::new(color.map(T::as_f64), 1.0, f.as_f64())).collect(),
            ramps: drawing.ramps.iter().map(ramp).collect(),
            layers: Vec::new(),
            shares: Vec::new(),
        }
    }

    /// Whether one of some objects has a ramp.
    fn have_ramp(&self, objects: &[usize]) -> bool {
        self.ramps.iter().any(|(object, _)| objects.contains(object))
    }

    /// Gives those of some objects that have ramps the colors that these have at a point, px.
    fn move_to(&mut self, objects: &[usize], point: [f64; 2], size: ImageSize) {
        let unit = f64::of_usize(size.unit_px());
        for (object, ramp) in self.ramps.iter().filter(|(object, _)| objects.contains(object)) {
            let offset = ramp.kind.offset(point.map(|at| T::of(at / unit)));
            self.objects[*object].color = ramp.color_at(offset).map(T::as_f64);
        }
    }

    /// What a pixel shows that the objects (ascending) cover, except for one of them.
    fn color(&mut self, objects: &[usize], except: Option<usize>) -> [f64; 3] {
        self.layers.clear();
        self.layers.extend(objects.iter().filter(|&&k| Some(k) != except).map(|&k| self.objects[k]));
        self.shares.resize(self.layers.len(), 0.0);
        let clear = self.compositing.shares(&self.layers, &mut self.shares);
        let start = self.background.map(|value| value * clear);
        self.layers.iter().zip(&self.shares).fold(start, |mut sum, (layer, share)| {
            sum.iter_mut().zip(layer.color).for_each(|(sum, value)| *sum += share * value);
            sum
        })
    }
}
