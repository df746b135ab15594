//! Two objects of one unknown shape and color whose outlines have run together.
//!
//! With U the union and M the motion from the first to the second, the first lies in U and in M^-1 U: their
//! intersection is where its outline starts. What both show is then brought together by M^-1 and fitted as one outline.

use alloc::vec::Vec;

use dvp_core::contour::{Connectivity, resample, signed_area, trace_level};
use dvp_core::geometry::Bounds;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::sort;
use dvp_core::{ImageSize, Real};

use super::assign;
use super::motion::{between, search};
use super::overlap::Overlap;
use super::pair::{Pair, PairScratch, Target};
use super::symmetry::PartlyKnown;
use super::{Explanation, Part};
use crate::free::basis::Basis;
use crate::free::foot::{EdgeLanes, foot};
use crate::free::grow::{GrowScratch, GrowSettings, grow};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::pose::search::Prototype;
use crate::segment::EdgeSample;
use crate::tuning::{STANDS_OUT_PX, TWINS_ASTRAY_PX};

/// Motions whose shape is fitted.
const TRIED: usize = 6;
/// Pairs that are handed back.
const MOST_PAIRS: usize = 3;
/// Rounds of fitting the shape and posing it.
const ROUNDS: usize = 2;
/// Steps of both together.
const STEPS: usize = 4;
/// Vertices of the outlines in between.
const START_VERTICES: usize = 96;
/// Rows and columns around the union while the intersection is traced.
const MARGIN: usize = 2;

/// Memory of [`Union::twins`].
#[derive(Clone, Debug, Default)]
pub(crate) struct TwinScratch<T> {
    grow: GrowScratch<T>,
    pair: PairScratch<T>,
    field: Vec<T>,
    samples: Vec<EdgeSample<T>>,
}

/// How many times a known outline (px) with its signed distance repeats itself, turned or mirrored; 1 for one without
/// symmetry.
pub(crate) fn repeats<T: Real>(contour: &[[T; 2]], field: &OutlineField<T>, samples: &[EdgeSample<T>]) -> usize {
    1 + PartlyKnown::new(&closed(contour), field, samples).symmetries(|_, _| true).len()
}

/// Robust mean squared distance error (px^2) of a known outline (px, closed).
pub(crate) fn misfit<T: Real>(outline: &[[T; 2]], samples: &[EdgeSample<T>], lanes: &mut EdgeLanes<T>) -> T {
    lanes.set(outline);
    assign::robust_mean(samples.iter().map(|sample| foot(outline, lanes, sample.point).distance - sample.distance))
}

/// What twins are looked for in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Union<'a, T> {
    /// Traced outline (px).
    pub(crate) contour: &'a [[T; 2]],
    /// Its signed distance.
    pub(crate) field: &'a OutlineField<T>,
    pub(crate) samples: &'a [EdgeSample<T>],
    pub(crate) overlap: Overlap<T>,
    pub(crate) basis: &'a Basis<T>,
    /// How the shape of twins is fitted.
    pub(crate) settings: GrowSettings<T>,
}

impl<T: Real> Union<'_, T> {
    /// Pairs of one simple shape, refined: their start is `part`, that `prototype` was posed as.
    pub(crate) fn twins_from(
        &self,
        parts: [Part<T>; 2],
        prototype: &Prototype<T>,
        scratch: &mut TwinScratch<T>,
    ) -> Option<Explanation<T>> {
        let frame = Frame::new(&parts[0].pose);
        let outline = prototype.outline.iter().map(|&v| frame.to_pixels(v)).collect();
        self.shaped(outline, between(&parts[0].pose, &parts[1].pose), scratch)
    }

    /// Pairs of equal objects, best first.
    pub(crate) fn twins(&self, scratch: &mut TwinScratch<T>) -> Vec<Explanation<T>> {
        let mut pairs = Vec::new();
        for motion in search(self.contour, self.field).into_iter().take(TRIED) {
            let frame = Frame::new(&motion);
            let margin = T::of_usize(MARGIN);
            let both = |point: [T; 2]| {
                let here = self.field.distance(point).0;
                // Far outside it does not matter how far.
                if here > margin { here } else { here.max(self.field.distance(frame.to_pixels(point)).0) }
            };
            let start = traced(self.contour, both, &mut scratch.field);
            pairs.extend(start.and_then(|start| self.shaped(closed(&start), motion, scratch)));
        }
        sort::ascending(&mut pairs, |pair| pair.cost.as_f64());
        pairs.truncate(MOST_PAIRS);
        pairs
    }

    /// The shape that starts as `outline` (px, closed) and is found again by `motion`; none if nothing is left of it.
    fn shaped(
        &self,
        mut outline: Vec<[T; 2]>,
        mut motion: PosePx<T>,
        scratch: &mut TwinScratch<T>,
    ) -> Option<Explanation<T>> {
        let mut best: Option<Explanation<T>> = None;
        for _ in 0..ROUNDS {
            let Some((pair, found)) = self.round(outline, motion, scratch) else { break };
            // What was not found better is not left for worse.
            if best.as_ref().is_some_and(|best| found.cost >= best.cost) {
                break;
            }
            best = Some(found);
            outline = Vec::new();
            pair.outline.write_vertices(self.basis, REFERENCE_VERTICES, &mut outline);
            motion = pair.motion;
        }
        best
    }

    /// Fits the shape to what both places show of it, as far as it is told which of them that is, then both together.
    fn round(
        &self,
        mut outline: Vec<[T; 2]>,
        motion: PosePx<T>,
        scratch: &mut TwinScratch<T>,
    ) -> Option<(Pair<T>, Explanation<T>)> {
        let margin = T::of_usize(MARGIN);
        let field = OutlineField::new(&outline)?;
        let poses = [PosePx::identity(), motion];
        gather(&field, poses, self.samples, &self.overlap, &mut scratch.samples)?;
        let mut known = PartlyKnown::new(&outline, &field, &scratch.samples);
        let frames = poses.map(|pose| Frame::new(&pose));
        let symmetries = known.symmetries(|point, distance| {
            frames.iter().all(|frame| self.field.distance(frame.to_pixels(point)).0 - distance <= T::of(STANDS_OUT_PX))
        });
        let mut carried = Vec::new();
        if !symmetries.is_empty() {
            carried = known.carried(&symmetries);
            let common = |point: [T; 2]| {
                let here = field.distance(point).0;
                let carried = symmetries.iter().map(|map| field.distance(map.point(point.into()).to_array()).0);
                if here > margin { here } else { carried.fold(here, T::max) }
            };
            outline = closed(&traced(&outline, common, &mut scratch.field)?);
            scratch.samples.extend_from_slice(&carried);
        }
        outline.pop();
        let TwinScratch { grow: memory, samples: shared, pair: of_pair, .. } = scratch;
        let grown = grow(&outline, shared, self.basis, self.settings, memory)?;
        let union = Target { samples: self.samples, carried: &carried, overlap: self.overlap, basis: self.basis };
        let pair = Pair { outline: grown.outline, motion }.refined(&union, STEPS, of_pair);
        let found = Explanation {
            shape_bits: self.settings.prices.free_shape_bits(pair.outline.rows.len(), symmetries.len() + 1),
            members: [PosePx::identity(), pair.motion].map(|pose| (pair.outline.clone(), pose)).into(),
            cost: pair.misfit(&union, of_pair),
        };
        Some((pair, found))
    }
}

/// Points at equal distances, the first one repeated.
fn closed<T: Real>(contour: &[[T; 2]]) -> Vec<[T; 2]> {
    let mut points = resample(contour, START_VERTICES);
    points.extend(points.first().copied());
    points
}

/// The largest outline where `distance` is 0, looked for around `contour`.
fn traced<T: Real>(contour: &[[T; 2]], distance: impl Fn([T; 2]) -> T, values: &mut Vec<T>) -> Option<Vec<[T; 2]>> {
    let bounds = Bounds::of_vertices(contour)?;
    let margin = T::of_usize(MARGIN);
    let low = bounds.min.to_array().map(|v| v.floor() - margin);
    let high = bounds.max.to_array();
    let [columns, rows] = [0, 1].map(|c| (high[c] + margin - low[c]).ceil().to_count());
    let half = T::of(0.5);
    values.clear();
    for row in 0..rows {
        for column in 0..columns {
            let point = [low[0] + T::of_usize(column) + half, low[1] + T::of_usize(row) + half];
            values.push(half - distance(point));
        }
    }
    let loops = trace_level(values, ImageSize::new(columns, rows).ok()?, half, Connectivity::Four).ok()?;
    let mut best = loops.into_iter().max_by(|a, b| {
        let (a, b) = (signed_area(a), signed_area(b));
        a.partial_cmp(&b).unwrap_or(core::cmp::Ordering::Equal)
    })?;
    for v in &mut best {
        *v = [v[0] + low[0], v[1] + low[1]];
    }
    (best.len() >= 8).then_some(best)
}

/// Brings the samples of both objects to the shape they share.
fn gather<T: Real>(
    field: &OutlineField<T>,
    poses: [PosePx<T>; 2],
    samples: &[EdgeSample<T>],
    overlap: &Overlap<T>,
    out: &mut Vec<EdgeSample<T>>,
) -> Option<()> {
    let frames = poses.map(|pose| Frame::new(&pose));
    out.clear();
    for sample in samples {
        let back = frames.map(|frame| frame.to_unit(sample.point));
        let distances: [T; 2] = core::array::from_fn(|k| frames[k].scale * field.distance(back[k]).0);
        let own = usize::from(distances[1] < distances[0]);
        let Some((distance, slope)) = overlap.alone(sample.distance, distances[1 - own]) else { continue };
        if (distances[own] - distance).abs() <= T::of(TWINS_ASTRAY_PX) {
            let scale = frames[own].scale;
            out.push(EdgeSample {
                point: back[own],
                distance: distance / scale,
                weight: sample.weight * scale / slope,
            });
        }
    }
    (out.len() >= 8).then_some(())
}
