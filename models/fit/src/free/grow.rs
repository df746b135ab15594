//! As many harmonics as the samples pay for: harmonics are added while the description gets shorter.

use alloc::vec::Vec;

use dvp_core::contour::resample;
use dvp_core::{Efd, Real};

use super::basis::Basis;
use super::outline_fit::{FreeOutline, OutlineScratch, OutlineSettings, refine};
use super::polygon_fit::{PolygonScratch, move_vertices, transform};
use crate::price::{Prices, misfit_bits};
use crate::segment::EdgeSample;
use crate::tuning::{HOLD_WEIGHT, LEAST_FORETOLD_GAIN};

/// Numbers of harmonics that a forecast chooses among, beside all of them.
const FORECAST: [usize; 10] = [2, 3, 4, 6, 8, 10, 12, 16, 20, 24];
/// Numbers of harmonics that are tried before all of them: steps of four, as a square gains at every fourth.
const LADDER: [usize; 7] = [3, 6, 10, 14, 18, 22, 26];
/// After so many in a row that do not pay, no more are tried.
const MOST_FAILURES: usize = 2;
/// Steps of the polygon after the first two.
const POLYGON_STEPS: usize = 3;

/// An outline with what it costs to describe.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grown<T> {
    pub(crate) outline: FreeOutline<T>,
    /// Bits of coefficients plus bits of what the samples miss.
    pub(crate) bits: T,
    pub(crate) steps: usize,
}

/// What of a traced outline may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Freedom {
    /// Vertices along their normals, then coefficients; harmonics that do not pay are dropped.
    Full,
    /// Vertices along their normals.
    Normals,
    /// Nothing: the outline as traced.
    None,
}

/// How [`grow`] finds out how many harmonics pay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Thrift {
    /// By fitting more and more of them.
    Fitted,
    /// By what vertices that stay where they are along the outline would miss: one fit, of more harmonics than are needed. For
    /// comparing outlines: it asks for as many of a whole as of its pieces.
    Foretold,
}

/// Settings of [`grow`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct GrowSettings<T> {
    pub(crate) vertex_count: usize,
    pub(crate) max_harmonics: usize,
    pub(crate) freedom: Freedom,
    pub(crate) thrift: Thrift,
    /// Noise of a pixel value that the weights of the samples refer to.
    pub(crate) noise: T,
    pub(crate) prices: Prices,
}

/// Memory of [`grow`].
#[derive(Clone, Debug, Default)]
pub(crate) struct GrowScratch<T> {
    outline: OutlineScratch<T>,
    polygon: PolygonScratch<T>,
    vertices: Vec<[T; 2]>,
}

/// Fits the traced outline with as many harmonics as pay.
///
/// An ellipse is tried first. If it does not explain the samples, a polygon is fitted, which all harmonics together can
/// be. Then more and more of its harmonics are fitted, as long as they pay; all of them if they still may. What more harmonics
/// gain is foretold from how far they move the vertices of the polygon across its outline. That is more or less the most they gain:
/// vertices that slide along the outline save harmonics, so only a fit tells.
pub(crate) fn grow<T: Real>(
    contour: &[[T; 2]],
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    settings: GrowSettings<T>,
    scratch: &mut GrowScratch<T>,
) -> Option<Grown<T>> {
    let GrowSettings { vertex_count, max_harmonics, freedom, thrift, noise, prices } = settings;
    let price = |harmonics| T::of(prices.equal_bits(harmonics));
    if freedom != Freedom::Full {
        let GrowScratch { polygon, vertices, .. } = scratch;
        take_vertices(contour, vertex_count, vertices)?;
        let steps = if freedom == Freedom::Normals { 2 } else { 0 };
        let cost = move_vertices(vertices, samples, T::one(), noise, steps, polygon);
        let outline = transform(vertices, basis, max_harmonics);
        return Some(Grown { outline, bits: price(max_harmonics) + cost * misfit_bits(), steps });
    }
    let mut steps = 0;
    let mut fit = |start: &FreeOutline<T>, harmonics: usize, widths: &[f64], scratch: &mut OutlineScratch<T>| {
        let mut outline = FreeOutline { center: start.center, rows: start.rows[..harmonics].to_vec() };
        let mut cost = T::zero();
        for &width in widths {
            let settings =
                OutlineSettings { width_px: T::of(width), pixel_noise: noise, smoothness: T::of(1e-3), max_steps: 3 };
            cost = refine(&mut outline, samples, basis, vertex_count, &settings, scratch);
            steps += settings.max_steps;
        }
        Grown { outline, bits: price(harmonics) + cost * misfit_bits(), steps: 0 }
    };
    let (first, center) = Efd::from_contour(contour, 1).ok()?;
    let start = FreeOutline { center, rows: first.rows().to_vec() };
    let mut best = fit(&start, 1, &[2.0, 0.5], &mut scratch.outline);
    // More harmonics cannot pay for themselves if what is missed costs less than the second one.
    if max_harmonics > 1 && best.bits >= price(2) {
        let GrowScratch { outline: outline_scratch, polygon, vertices } = scratch;
        take_vertices(contour, vertex_count, vertices)?;
        move_vertices(vertices, samples, T::of(2.0), noise, 2, polygon);
        move_vertices(vertices, samples, T::of(0.5), noise, POLYGON_STEPS, polygon);
        let outline = transform(vertices, basis, max_harmonics);
        let missed = cut_bits(&outline, samples, basis, &settings);
        if thrift == Thrift::Foretold {
            let numbers = FORECAST.into_iter().filter(|&harmonics| harmonics < max_harmonics);
            let foretold = |harmonics: usize| price(harmonics) + missed[harmonics];
            let cut = numbers.fold(max_harmonics, |a, b| if foretold(b) < foretold(a) { b } else { a });
            let tried = fit(&outline, cut, &[0.5], outline_scratch);
            if tried.bits < best.bits {
                best = tried;
            }
            best.steps = steps + 2 + POLYGON_STEPS;
            return Some(best);
        }
        let (mut last, mut failures) = (1, 0);
        for harmonics in LADDER.into_iter().filter(|&harmonics| harmonics < max_harmonics) {
            let gain = missed[last] - missed[harmonics];
            if gain < price(harmonics - last) || gain < T::of(LEAST_FORETOLD_GAIN) * missed[last] {
                continue;
            }
            last = harmonics;
            let tried = fit(&outline, harmonics, &[0.5], outline_scratch);
            let is_enough = tried.bits < price(harmonics + 2);
            failures += 1;
            if tried.bits < best.bits {
                (best, failures) = (tried, 0);
            }
            if is_enough || failures == MOST_FAILURES {
                break;
            }
        }
        if best.bits - price(best.outline.rows.len()) > price(max_harmonics) {
            let tried = fit(&outline, max_harmonics, &[0.5], outline_scratch);
            if tried.bits < best.bits {
                best = tried;
            }
        }
        steps += 2 + POLYGON_STEPS;
    }
    best.steps = steps;
    Some(best)
}

/// Vertices at equal distances along the contour, the last one the first again.
fn take_vertices<T: Real>(contour: &[[T; 2]], vertex_count: usize, vertices: &mut Vec<[T; 2]>) -> Option<()> {
    vertices.clear();
    vertices.extend(resample(contour, vertex_count - 1));
    vertices.push(*vertices.first()?);
    Some(())
}

/// By number of harmonics: bits of what is missed without those above, if vertices stay where they are along the outline.
fn cut_bits<T: Real>(
    outline: &FreeOutline<T>,
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    &GrowSettings { vertex_count, noise, .. }: &GrowSettings<T>,
) -> Vec<T> {
    let rows = &outline.rows;
    let precision = T::one() / (noise * noise);
    let weights = samples.iter().map(|sample| sample.weight * sample.weight * precision).sum::<T>();
    let mut vertices = Vec::new();
    outline.write_vertices(basis, vertex_count, &mut vertices);
    let edges = vertex_count - 1;
    let mut missed = vertices.clone();
    missed.iter_mut().for_each(|v| *v = [T::zero(); 2]);
    let mut bits = alloc::vec![T::zero(); rows.len() + 1];
    for harmonics in (1..rows.len()).rev() {
        // Displacement of each vertex by all harmonics above, taken across the outline.
        let [a, b, c, d] = rows[harmonics];
        let mut across = T::zero();
        for i in 0..edges {
            let pair = &basis.row(i, harmonics + 1)[1 + 2 * harmonics..];
            missed[i][0] += a * pair[0] + b * pair[1];
            missed[i][1] += c * pair[0] + d * pair[1];
            let (before, after) = (vertices[(i + edges - 1) % edges], vertices[i + 1]);
            let (x, y) = (after[0] - before[0], after[1] - before[1]);
            let normal = missed[i][0] * y - missed[i][1] * x;
            across += normal * normal / (x * x + y * y).max(T::of(1e-9));
        }
        bits[harmonics] = weights * across / T::of_usize(edges) * misfit_bits();
    }
    bits
}

/// Samples that hold the invisible part of a cropped outline where it was traced, beyond the image border.
pub(crate) fn hold_outside<T: Real>(contour: &[[T; 2]], width: T, height: T, samples: &mut Vec<EdgeSample<T>>) {
    let beyond = |&[x, y]: &[T; 2]| (-x).max(-y).max(x - width).max(y - height) > T::of(0.5);
    let held = resample(contour, 96).into_iter().filter(beyond);
    samples.extend(held.map(|point| EdgeSample { point, distance: T::zero(), weight: T::of(HOLD_WEIGHT) }));
}
