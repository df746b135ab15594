//! Straight things of the picture, one of which stretches of a boundary may be again.
//!
//! The sides of a thing without a corner inward have each a direction of their own: that of the boundary tells which side is seen, and two sides tell
//! where the thing is.

use alloc::rc::Rc;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::signed_area;
use dvp_core::geometry::{Bounds, LineSegment, Similarity};
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::super::complete::Completed;
use super::super::join::Group;
use crate::elimination::solve;
use crate::outline::{Outline, OutlineShape};
use crate::ruler::Ruler;
use crate::sample::Sample;
use crate::tuning;

/// Most sides of a model.
const MOST_SIDES: usize = 8;
/// Shortest side of a model, pixels: between its corners three windows tell its direction.
const SHORTEST_SIDE: f64 = 5.0;
/// Most models, those of which there are most things.
const MOST_MODELS: usize = 4;
/// Things whose sizes differ by less (pixels) are of one model.
const ALIKE: f64 = 0.2;
/// Sine of the angle between a side and a boundary that may be of it: three windows tell it to a few degrees.
const ALONG: f64 = 0.1;
/// Share of all that sides tell of a place that the less known direction has at least, of 1/4 where both are known alike.
const TOLD: f64 = 0.01;
/// Steps in which a model comes to lie.
const STEPS: usize = 3;

/// Straight things that are seen whole.
pub(super) struct Models(Vec<Model>);

/// A straight thing.
struct Model {
    outline: Outline,
    /// Its sides, the thing on the right of each.
    sides: Vec<LineSegment<f64>>,
    /// How many things are like it.
    count: usize,
}

impl Models {
    /// The models of what is painted.
    pub(super) fn of(groups: &[Group]) -> Self {
        let mut models: Vec<Model> = Vec::new();
        for model in groups.iter().filter_map(|group| Model::of(&group.completed)) {
            match models.iter_mut().find(|other| other.is_like(&model)) {
                Some(other) => other.count += 1,
                None => models.push(model),
            }
        }
        sort::descending(&mut models, |model| model.count as f64);
        models.truncate(MOST_MODELS);
        Self(models)
    }

    /// The shortest description of stretches as a model in some place.
    pub(super) fn explain(&self, runs: &[Vec<Sample>], ruler: &Ruler) -> Option<Outline> {
        let choice = (self.0.len() as f64).log2() + tuning::OUTLINE_PIECE_BITS;
        let placed = self.0.iter().filter_map(|model| model.placed(runs, ruler));
        let placed = placed.map(|outline| Outline { bits: outline.bits + choice, ..outline });
        placed.min_by(|a, b| (a.bits + a.misfit).total_cmp(&(b.bits + b.misfit)))
    }
}

impl Model {
    /// A thing of few straight sides without a corner inward.
    fn of(completed: &Rc<Completed>) -> Option<Self> {
        let [outline] = &completed.outlines[..] else { return None };
        let is_round = matches!(outline.shape, OutlineShape::Circle { .. } | OutlineShape::Ellipse { .. });
        let mut corners: Vec<[f64; 2]> = completed.sides().iter().map(|side| side.from.to_array()).collect();
        if signed_area(&corners) < 0.0 {
            corners.reverse();
        }
        let sides: Vec<LineSegment<f64>> = LineSegment::closed(&corners).collect();
        let next = sides.iter().cycle().skip(1);
        let is_outward = sides.iter().zip(next).all(|(side, next)| side.along.cross(next.along) > 0.0);
        let are_told = sides.len() <= MOST_SIDES && sides.iter().all(|side| side.along.length() >= SHORTEST_SIDE);
        (completed.agrees && !is_round && is_outward && are_told).then(|| Self {
            outline: outline.clone(),
            sides,
            count: 1,
        })
    }

    /// Whether another one is the same but for its place.
    fn is_like(&self, other: &Self) -> bool {
        let size = |model: &Self| Bounds::of(model.sides.iter().map(|side| side.from)).map(|bounds| bounds.size());
        let are_near = |(one, other): (Vec2<f64>, Vec2<f64>)| (one - other).length() < ALIKE;
        self.sides.len() == other.sides.len() && size(self).zip(size(other)).is_some_and(are_near)
    }

    /// The model where stretches are of it; none if they do not tell where that is.
    fn placed(&self, runs: &[Vec<Sample>], ruler: &Ruler) -> Option<Outline> {
        let directed = runs.iter().flat_map(|run| run.iter().zip(directions(run)));
        let on: Vec<(&Sample, &LineSegment<f64>)> =
            directed.filter_map(|(sample, direction)| Some((sample, self.side_along(direction)?))).collect();
        let mut shift = moved(&on, None)?;
        let nearest = |sample: &Sample, shift: Vec2<f64>| {
            let off = |side: &&LineSegment<f64>| side.nearest(sample.point - shift).offset.length_squared();
            self.sides.iter().min_by(|a, b| off(a).total_cmp(&off(b)))
        };
        for _ in 0..STEPS {
            let on: Vec<(&Sample, &LineSegment<f64>)> =
                runs.iter().flatten().filter_map(|sample| Some((sample, nearest(sample, shift)?))).collect();
            shift = moved(&on, Some(shift))?;
        }
        let chi2 = |sample: &Sample| {
            let side = nearest(sample, shift)?;
            let off = side.nearest(sample.point - shift).offset.length() / sigma(sample, side);
            // What the end of a stretch shows of something else is off by as much as it likes.
            Some(off * off.min(tuning::OUTLINE_HUBER))
        };
        let misfit = ruler.misfit(runs.iter().flatten().filter_map(chi2).sum());
        let map = Similarity { translation: shift, ..Similarity::identity() };
        let bits = 2.0 * ruler.number(tuning::RENDERER_SIGMA);
        Some(Outline { shape: self.outline.shape.moved(&map), bits, misfit, covariance: Vec::new() })
    }

    /// The side that has a direction.
    fn side_along(&self, direction: Vec2<f64>) -> Option<&LineSegment<f64>> {
        let has_it = |along: Vec2<f64>| along.dot(direction) > 0.0 && along.cross(direction).abs() < ALONG;
        self.sides.iter().find(|side| side.along.normalized().is_some_and(has_it))
    }
}

/// The directions of a stretch at its samples.
fn directions(run: &[Sample]) -> impl Iterator<Item = Vec2<f64>> {
    (0..run.len()).map(|k| {
        let along = run[(k + 1).min(run.len() - 1)].point - run[k.saturating_sub(1)].point;
        along.normalized().unwrap_or_default()
    })
}

/// Deviation (pixels) of the distance of a sample from a side.
fn sigma(sample: &Sample, side: &LineSegment<f64>) -> f64 {
    let normal = side.along.normalized().unwrap_or_default().perp();
    (sample.sigma * normal.dot(sample.axis).abs()).hypot(tuning::RENDERER_SIGMA)
}

/// The shift that brings sides to samples, by all alike or, from a shift on, by those that are near; none if the sides are about parallel.
fn moved(on: &[(&Sample, &LineSegment<f64>)], from: Option<Vec2<f64>>) -> Option<Vec2<f64>> {
    let (mut matrix, mut right) = ([[0.0; 2]; 2], [0.0; 2]);
    let shift = from.unwrap_or_default();
    for (sample, side) in on {
        let normal = side.along.normalized()?.perp();
        let sigma = sigma(sample, side);
        let off = normal.dot(sample.point - side.from - shift);
        let sigmas = if from.is_some() { off.abs() / sigma } else { 0.0 };
        let weight = tuning::OUTLINE_HUBER / sigmas.max(tuning::OUTLINE_HUBER) / (sigma * sigma);
        let normal = normal.to_array();
        for i in 0..2 {
            right[i] += weight * normal[i] * off;
            for j in 0..2 {
                matrix[i][j] += weight * normal[i] * normal[j];
            }
        }
    }
    let [[a, b], [_, c]] = matrix;
    let is_told = a * c - b * b > TOLD * (a + c) * (a + c);
    is_told.then(|| solve(matrix, right)).flatten().map(|step| shift + Vec2::from(step))
}
