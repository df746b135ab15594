//! As many harmonics as the samples pay for: the number with the shortest description.

use alloc::vec::Vec;

use dvp_core::contour::resample;
use dvp_core::{Efd, Real};

use super::basis::Basis;
use super::forecast::{Forecast, foretell};
use super::loops::cut_loops;
use super::outline_fit::{FreeOutline, OutlineScratch, OutlineSettings, Target, refine};
use super::polygon_fit::{PolygonScratch, move_vertices, transform};
use crate::price::{Prices, misfit_bits};
use crate::segment::EdgeSample;
use crate::tuning::HOLD_WEIGHT;

/// How often the number of harmonics is chosen, first near the polygon, then near the outline that the last choice came to.
const ROUNDS: usize = 3;
/// Steps of the ellipse, with each of [`WIDTHS_PX`].
const ELLIPSE_STEPS: usize = 3;
/// Steps of the polygon, likewise.
const POLYGON_STEPS: [usize; 2] = [2, 1];
/// Steps of the outline with the number of harmonics that is foretold to be best.
const STEPS: usize = 3;
/// [`OutlineSettings::width_px`], while far samples count and afterwards.
const WIDTHS_PX: [f64; 2] = [2.0, 0.5];
/// See [`OutlineSettings::smoothness`].
const SMOOTHNESS: f64 = 1e-3;

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

/// Settings of [`grow`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct GrowSettings<T> {
    pub(crate) vertex_count: usize,
    pub(crate) max_harmonics: usize,
    pub(crate) freedom: Freedom,
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
    forecast: Forecast<T>,
}

/// Fits the traced outline with as many harmonics as pay.
///
/// An ellipse is fitted first, then a polygon, which all harmonics together can be. What fewer of them would miss is foretold
/// near it, and the number with the shortest description is fitted.
pub(crate) fn grow<T: Real>(
    contour: &[[T; 2]],
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    settings: GrowSettings<T>,
    scratch: &mut GrowScratch<T>,
) -> Option<Grown<T>> {
    let GrowSettings { vertex_count, max_harmonics, freedom, noise, prices } = settings;
    let GrowScratch { outline: memory, polygon, vertices, forecast } = scratch;
    let bits = |harmonics: usize, cost: T| T::of(prices.equal_bits(harmonics)) + cost * misfit_bits();
    if freedom != Freedom::Full {
        take_vertices(contour, vertex_count, vertices)?;
        let steps = if freedom == Freedom::Normals { 2 } else { 0 };
        let cost = move_vertices(vertices, samples, T::one(), noise, steps, polygon);
        let outline = transform(vertices, basis, max_harmonics);
        return Some(Grown { outline, bits: bits(max_harmonics, cost), steps });
    }
    let [wide, narrow] = WIDTHS_PX.map(T::of);
    let target = |width_px: T, max_steps: usize| {
        let settings = OutlineSettings { width_px, pixel_noise: noise, smoothness: T::of(SMOOTHNESS), max_steps };
        Target { samples, basis, vertex_count, settings }
    };
    let (first, center) = Efd::from_contour(contour, 1).ok()?;
    let mut best = FreeOutline { center, rows: first.rows().to_vec() };
    refine(&mut best, &target(wide, ELLIPSE_STEPS), memory);
    let mut least = refine(&mut best, &target(narrow, ELLIPSE_STEPS), memory);
    let mut steps = 2 * ELLIPSE_STEPS;
    // More harmonics cannot pay for themselves if what is missed costs less than the second one.
    if max_harmonics > 1 && bits(1, least) >= bits(2, T::zero()) {
        take_vertices(contour, vertex_count, vertices)?;
        for (width, count) in [wide, narrow].into_iter().zip(POLYGON_STEPS) {
            for _ in 0..count {
                move_vertices(vertices, samples, width, noise, 1, polygon);
                unfold(vertices, vertex_count)?;
            }
            steps += count;
        }
        let mut near = transform(vertices, basis, max_harmonics);
        for round in 0..ROUNDS {
            let Some(()) = foretell(&near, &target(narrow, 0), memory, forecast) else { break };
            // Of samples with more noise than was thought any number of harmonics would explain some. A polygon from afar tells
            // nothing of it.
            let spread = if round == 0 { T::one() } else { forecast.spread.max(T::one()) };
            let told = |harmonics: usize| bits(harmonics, forecast.costs[harmonics] / spread);
            let most = if round == 0 { near.rows.len() } else { near.rows.len() - 1 };
            let harmonics = (2..=most).fold(1, |a, b| if told(b) < told(a) { b } else { a });
            let before = bits(best.rows.len(), least / spread);
            if told(harmonics) >= before {
                break;
            }
            let foretold = forecast.outline(&near, harmonics, memory);
            near.rows.truncate(harmonics);
            // Far from where it was made, the outline of a forecast may be worse than the one that is only cut.
            let mut cost = |start: &FreeOutline<T>| refine(&mut start.clone(), &target(narrow, 0), memory);
            if cost(&foretold) < cost(&near) {
                near = foretold;
            }
            let cost = refine(&mut near, &target(narrow, STEPS), memory);
            steps += STEPS;
            if bits(harmonics, cost / spread) < before {
                (best, least) = (near.clone(), cost);
            }
        }
    }
    Some(Grown { bits: bits(best.rows.len(), least), outline: best, steps })
}

/// Vertices at equal distances along the contour, the last one the first again.
fn take_vertices<T: Real>(contour: &[[T; 2]], vertex_count: usize, vertices: &mut Vec<[T; 2]>) -> Option<()> {
    vertices.clear();
    vertices.extend(resample(contour, vertex_count - 1));
    vertices.push(*vertices.first()?);
    Some(())
}

/// The same without loops, at equal distances again if there were some.
fn unfold<T: Real>(vertices: &mut Vec<[T; 2]>, vertex_count: usize) -> Option<()> {
    vertices.pop();
    if cut_loops(vertices) {
        *vertices = resample(vertices, vertex_count - 1);
    }
    vertices.push(*vertices.first()?);
    Some(())
}

/// Samples that hold the invisible part of a cropped outline where it was traced, beyond the image border.
pub(crate) fn hold_outside<T: Real>(contour: &[[T; 2]], width: T, height: T, samples: &mut Vec<EdgeSample<T>>) {
    let beyond = |&[x, y]: &[T; 2]| (-x).max(-y).max(x - width).max(y - height) > T::of(0.5);
    let held = resample(contour, 96).into_iter().filter(beyond);
    samples.extend(held.map(|point| EdgeSample { point, distance: T::zero(), weight: T::of(HOLD_WEIGHT) }));
}
