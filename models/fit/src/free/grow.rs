//! As many harmonics as the samples pay for: harmonics are added while the description gets shorter.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::contour::resample;

use super::basis::Basis;
use super::choose::{ChooseScratch, choose};
use super::outline::FreeOutline;
use super::outline_fit::{OutlineScratch, OutlineSettings, refine};
use super::polygon_fit::{PolygonScratch, move_vertices, transform};
use crate::price::{Prices, misfit_bits};
use crate::segment::EdgeSample;
use crate::tuning::HOLD_WEIGHT;

/// Harmonics of the outline from which it is seen how many pay: a traced outline of all of them ripples and folds as it is fitted.
const COARSE_HARMONICS: usize = 10;

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
    choose: ChooseScratch<T>,
    polygon: PolygonScratch<T>,
    vertices: Vec<[T; 2]>,
}

/// Fits the traced outline with as many harmonics as pay.
///
/// An ellipse is tried first. If it does not explain the samples, a few harmonics are fitted, and from there as many as pay.
pub(crate) fn grow<T: Real>(
    contour: &[[T; 2]],
    samples: &[EdgeSample<T>],
    basis: &Basis<T>,
    settings: GrowSettings<T>,
    scratch: &mut GrowScratch<T>,
) -> Option<Grown<T>> {
    let GrowSettings { vertex_count, max_harmonics, freedom, noise, prices } = settings;
    let price = |harmonics| T::of(prices.equal_bits(harmonics));
    let GrowScratch { outline: outline_scratch, choose: choose_scratch, polygon, vertices } = scratch;
    take_vertices(contour, vertex_count, vertices)?;
    if freedom != Freedom::Full {
        let steps = if freedom == Freedom::Normals { 2 } else { 0 };
        let cost = move_vertices(vertices, samples, T::one(), noise, steps, polygon);
        let outline = transform(vertices, basis, max_harmonics).aligned();
        return Some(Grown { outline, bits: price(max_harmonics) + cost * misfit_bits(), steps });
    }
    let mut steps = 0;
    let mut fit = |mut outline: FreeOutline<T>, passes: &[OutlineSettings<T>], scratch: &mut OutlineScratch<T>| {
        let mut cost = T::zero();
        for pass in passes {
            cost = refine(&mut outline, samples, basis, vertex_count, pass, scratch);
            steps += pass.max_steps;
        }
        Grown { bits: price(outline.rows.len()) + cost * misfit_bits(), outline, steps: 0 }
    };
    let [rough, settled] = [OutlineSettings::rough(noise), OutlineSettings::settled(noise)];
    let traced = transform(vertices, basis, max_harmonics).aligned();
    let mut best = fit(traced.cut(1), &[rough, settled], outline_scratch);
    // More harmonics cannot pay for themselves if what is missed costs less than the second one.
    if max_harmonics > 1 && best.bits >= price(2) {
        let mut coarse = fit(traced.cut(COARSE_HARMONICS.min(max_harmonics)), &[rough], outline_scratch);
        let misses_all = |grown: &Grown<T>| grown.bits - price(grown.outline.rows.len()) > price(max_harmonics);
        if misses_all(&coarse) {
            coarse = fit(coarse.outline, &[settled], outline_scratch);
        }
        // Where a few miss more than all of them cost, what was traced is nearer: a cog is no circle.
        let mut all = if misses_all(&coarse) { traced } else { coarse.outline.clone() };
        all.rows.resize(max_harmonics, [T::zero(); 4]);
        if coarse.bits < best.bits {
            best = coarse;
        }
        let memory = (&mut *outline_scratch, choose_scratch);
        if let Some(chosen) = choose(&all, samples, basis, vertex_count, &settled, price, memory) {
            let tried = fit(chosen.outline, &[settled], outline_scratch);
            if tried.bits < best.bits {
                best = tried;
            }
        }
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

/// Samples that hold the invisible part of a cropped outline where it was traced, beyond the image border.
pub(crate) fn hold_outside<T: Real>(contour: &[[T; 2]], width: T, height: T, samples: &mut Vec<EdgeSample<T>>) {
    let beyond = |&[x, y]: &[T; 2]| (-x).max(-y).max(x - width).max(y - height) > T::of(0.5);
    let held = resample(contour, 96).into_iter().filter(beyond);
    samples.extend(held.map(|point| EdgeSample { point, distance: T::zero(), weight: T::of(HOLD_WEIGHT) }));
}
