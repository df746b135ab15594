//! The outlines of what covers pixels in part.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::contour::{Connectivity, perimeter, resample, signed_area, trace_level};
use dvp_core::shape::PathRing;
use dvp_core::{ImageSize, Real as _, Vec2};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::layers::polygon;
use crate::outline::{Outline, OutlineShape, fit_closed};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};
use crate::stroke::{StrokeFit, fit_strokes};
use crate::tuning;

/// Places of the finer grid along the side of a pixel.
const FINE: usize = 4;
/// How often what the finer grid is off by is added to it.
const BACK_STEPS: usize = 12;
/// Share of what it is off by that is added: all of it would go too far and back.
const CAUTION: f64 = 0.4;
/// How steep its edges are, per pixel of the picture.
const STEEP: f64 = 4.0;
/// By how much an outline may be larger or smaller than the line that it follows, per area.
const MOST_OFF: f64 = 0.2;
/// How far apart samples of outlines are, pixels.
const SPACING: f64 = 0.3;

/// Most closed lines of what a pen is asked for: as a grid of eight by eight has. The time that strokes take grows with the square of that.
const MOST_OF_PEN: usize = 64;

/// Closed lines around what covers pixels in part, as samples.
pub(super) struct Level {
    lines: Vec<RingSamples>,
}

impl Level {
    /// Around what covers as much of every pixel of a window as `coverage` says, [0, 1], row by row; `corner` is where the window begins. None if the
    /// window is empty.
    #[inline(never)]
    pub(super) fn of(coverage: &[f64], window: ImageSize, corner: Vec2<f64>) -> Option<Self> {
        let (field, fine) = sharpened(coverage, window)?;
        let loops = trace_level(&field, fine, 0.5, Connectivity::Four).ok()?;
        Some(Self { lines: loops.iter().map(|points| samples(points, corner)).collect() })
    }

    /// The outlines along them.
    pub(super) fn outlines(&self, ruler: &Ruler) -> Vec<Outline> {
        self.lines.iter().filter_map(|line| outline(line, ruler)).collect()
    }

    /// The strokes of a pen that drew what is between them, if that is how it was drawn.
    pub(super) fn pen(&self, ruler: &Ruler) -> Option<StrokeFit> {
        if self.lines.len() <= MOST_OF_PEN { fit_strokes(&self.lines, ruler) } else { None }
    }
}

/// Samples along a closed line of the finer grid.
fn samples(points: &[[f32; 2]], corner: Vec2<f64>) -> RingSamples {
    let fine = FINE as f64;
    let points = resample(points, (f64::from(perimeter(points)) / (fine * SPACING)).ceil().max(4.0) as usize);
    let n = points.len();
    let at = |k: usize| Vec2::from(points[k % n].map(f64::from)) * fine.recip() + corner;
    let sample = |k: usize| {
        let axis = (at(k + 1) - at(k + n - 1)).perp().normalized().unwrap_or(Vec2::new(1.0, 0.0));
        Sample::new(at(k), axis, tuning::LEVEL_SIGMA)
    };
    RingSamples { runs: vec![(0..n).map(sample).collect()], closed: true }
}

/// The outline along a closed line: of few numbers, or, where that is far off, the line itself.
fn outline(line: &RingSamples, ruler: &Ruler) -> Option<Outline> {
    let points: Vec<[f64; 2]> = line.runs.iter().flatten().map(|sample| sample.point.to_array()).collect();
    let area = signed_area(&points).abs();
    let is_as_large = |outline: &Outline| {
        polygon(outline).is_some_and(|points| (signed_area(&points).abs() - area).abs() <= MOST_OFF * area)
    };
    fit_closed(line, ruler).map(|fitted| {
        if is_as_large(&fitted) {
            return fitted;
        }
        let points = resample(&points, (points.len() as f64 * SPACING).ceil().max(4.0) as usize);
        let bits = 2.0 * points.len() as f64 * ruler.number(tuning::LEVEL_SIGMA);
        let shape = OutlineShape::Path(PathRing::polygon(points));
        Outline { shape, bits, misfit: 0.0, covariance: Vec::new() }
    })
}

/// A field of coverage on a finer grid, where it is 0 or 1 nearly everywhere and whose means over pixels are the coverage: what it is off by there is
/// added to it again and again (iterative back-projection).
#[inline(never)]
fn sharpened(coverage: &[f64], size: ImageSize) -> Option<(Vec<f32>, ImageSize)> {
    let [width, height] = [size.width(), size.height()];
    let fine = ImageSize::new(FINE * width, FINE * height).ok()?;
    let mut field = vec![0.0; fine.pixels()];
    let mut left = coverage.to_vec();
    // Of the pixels at the border of the window nothing is covered.
    let inner = (1..height.saturating_sub(1)).flat_map(|y| (1..width.saturating_sub(1)).map(move |x| (x, y)));
    let around = |(x, y): (usize, usize)| (0..9).map(move |k| (y + k / 3 - 1) * width + x + k % 3 - 1);
    let active: Vec<(usize, usize)> = inner.filter(|&at| around(at).any(|i| coverage[i] > 0.0)).collect();
    // Where a place of the finer grid lies between the middles of two pixels: the first of both, from the one before its own on, and the share of the
    // second.
    let between: [(usize, f64); FINE] = core::array::from_fn(|k| {
        let at = (k as f64 + 0.5) / FINE as f64 + 0.5;
        if at < 1.0 { (0, at) } else { (1, at - 1.0) }
    });
    let cells = |(x, y): (usize, usize)| {
        (0..FINE * FINE).map(move |k| (k % FINE, k / FINE, (y * FINE + k / FINE) * fine.width() + x * FINE + k % FINE))
    };
    for _ in 0..BACK_STEPS {
        for &(x, y) in &active {
            for (column, row, i) in cells((x, y)) {
                let ((dx, u), (dy, v)) = (between[column], between[row]);
                let first = (y + dy - 1) * width + x + dx - 1;
                let mixed = |first: usize| (1.0 - u) * left[first] + u * left[first + 1];
                field[i] += CAUTION * ((1.0 - v) * mixed(first) + v * mixed(first + width));
            }
        }
        for &(x, y) in &active {
            let covered: f64 = cells((x, y)).map(|(_, _, i)| (STEEP * (field[i] - 0.5) + 0.5).clamp(0.0, 1.0)).sum();
            left[y * width + x] = coverage[y * width + x] - covered / (FINE * FINE) as f64;
        }
    }
    Some((field.into_iter().map(f32::of).collect(), fine))
}
