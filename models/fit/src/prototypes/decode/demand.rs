//! What pixels demand of an object: to be inside, to be outside, or nothing, where something else may hide it.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

use super::flat::{FlatPicture, Part};
use crate::pose::equations::{Normal, Robustness, SampleLanes};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::segment::EdgeSample;

/// How far inside or outside of the outline the middle of a pixel is wanted, px: first so far that the outline comes between both sides, then
/// hardly more than what rounding of a scene file can move, so that all pixels are right wherever that can be.
const MARGINS_PX: [f64; 2] = [0.12, 0.012];
/// Residual (px) beyond which more of it says no more.
const WIDTH_PX: f64 = 3.0;
/// Pixels that must not be covered count this far (px, along rows and columns) from those that may.
const REACH: usize = 2;

/// What a pixel demands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wish {
    /// To be covered.
    Inside,
    /// Not to be covered.
    Outside,
    /// Nothing.
    Free,
}

/// What all pixels demand of one object.
#[derive(Clone, Debug)]
pub(super) struct Demand<'a> {
    picture: &'a FlatPicture,
    /// Per pixel.
    wishes: Vec<Wish>,
    /// How many are to be covered.
    pub(super) area: f64,
    /// The middle of those, px.
    pub(super) center: [f64; 2],
    /// From the middle to where the object may go on unseen, a unit vector; zero if it does not.
    pub(super) onward: [f64; 2],
    open: bool,
    /// By margins.
    sides: [Sides; 2],
    /// How many samples there are of each.
    counts: [f64; 2],
}

/// Pixels that are to be inside and outside, each with its margin.
#[derive(Clone, Debug)]
struct Sides {
    inside: SampleLanes<f64>,
    outside: SampleLanes<f64>,
}

/// How an object meets a demand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Verdict {
    /// Pixels that are covered and should not be, or the other way round.
    pub(super) wrong: usize,
    /// Pixels that are covered but hidden.
    pub(super) hidden: usize,
}

impl<'a> Demand<'a> {
    /// The pixels `inside` are to be covered, those of the ground are not, others may.
    pub(super) fn new(picture: &'a FlatPicture, inside: &[usize]) -> Self {
        Self::beside(picture, inside, core::iter::empty())
    }

    /// As [`Self::new`], and the pixels `behind`, which show what lies behind the object, must not be covered either.
    pub(super) fn beside(picture: &'a FlatPicture, inside: &[usize], behind: impl Iterator<Item = usize>) -> Self {
        let wish = |&color: &usize| if color == picture.ground { Wish::Outside } else { Wish::Free };
        let mut wishes: Vec<Wish> = picture.color_of.iter().map(wish).collect();
        behind.for_each(|pixel| wishes[pixel] = Wish::Outside);
        inside.iter().for_each(|&pixel| wishes[pixel] = Wish::Inside);
        let area = f64::of_usize(inside.len());
        let mean = |pixels: &[usize]| {
            let sum =
                pixels.iter().map(|&pixel| picture.middle(pixel)).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
            sum.map(|v: f64| v / f64::of_usize(pixels.len().max(1)))
        };
        let center = mean(inside);
        let goes_on = |&&pixel: &&usize| {
            picture.is_at_border(pixel) || picture.around(pixel).any(|neighbor| wishes[neighbor] == Wish::Free)
        };
        let open: Vec<usize> = inside.iter().filter(goes_on).copied().collect();
        let onward = if open.is_empty() {
            [0.0; 2]
        } else {
            let to = mean(&open);
            let step = [to[0] - center[0], to[1] - center[1]];
            let length = num_traits::Float::hypot(step[0], step[1]).max(1e-6);
            step.map(|v| v / length)
        };
        let sample = |pixel: usize, distance| EdgeSample { point: picture.middle(pixel), distance, weight: 1.0 };
        let is_edge = |&&pixel: &&usize| picture.around(pixel).any(|neighbor| wishes[neighbor] != Wish::Inside);
        let within: Part = inside.iter().filter(is_edge).copied().collect();
        let without = near_wished(picture, &wishes);
        let counts = [within.len(), without.len()].map(f64::of_usize);
        let lanes = |pixels: &[usize], distance| {
            let samples: Vec<_> = pixels.iter().map(|&pixel| sample(pixel, distance)).collect();
            SampleLanes::new(&samples, 1, false)
        };
        let sides =
            MARGINS_PX.map(|margin| Sides { inside: lanes(&within, -margin), outside: lanes(&without, margin) });
        Self { picture, wishes, area, center, onward, open: !open.is_empty(), sides, counts }
    }

    /// Whether the object may go on where it is not seen.
    pub(super) fn is_open(&self) -> bool {
        self.open
    }

    /// Normal equations of what is wrong at a pose: squared distances of pixels on the wrong side of the outline.
    fn normal(&self, sides: &Sides, pose: &PosePx<f64>, field: &OutlineField<f64>) -> Normal<f64> {
        let [inside, outside] = both(sides, pose, field, false);
        let mut sum = inside;
        sum.cost = self.total([&inside, &outside]);
        for a in 0..4 {
            sum.gradient[a] += outside.gradient[a];
            for b in 0..4 {
                sum.hessian[a][b] += outside.hessian[a][b];
            }
            // Where nothing is wrong, nothing moves.
            sum.hessian[a][a] += 1e-6;
        }
        sum
    }

    /// The sum of what means count, px^2.
    fn total(&self, normals: [&Normal<f64>; 2]) -> f64 {
        let sums = normals.iter().zip(self.counts);
        sums.map(|(normal, count)| if count > 0.0 { normal.cost * count } else { 0.0 }).sum()
    }

    /// How wrong a pose is, px^2.
    pub(super) fn cost(&self, pose: &PosePx<f64>, field: &OutlineField<f64>) -> f64 {
        let [inside, outside] = both(&self.sides[0], pose, field, true);
        self.total([&inside, &outside])
    }

    /// The pose nearby where least is wrong, and how wrong it is.
    pub(super) fn refined(&self, pose: PosePx<f64>, field: &OutlineField<f64>, steps: usize) -> (PosePx<f64>, f64) {
        let descend = |pose: PosePx<f64>, sides: &Sides| {
            let (pose, cost, _) = pose.descend(steps, 1e-4, |pose| self.normal(sides, pose, field));
            (pose, cost)
        };
        let (wide, cost) = descend(pose, &self.sides[0]);
        if cost <= 0.0 {
            return (wide, cost);
        }
        let (narrow, _) = descend(wide, &self.sides[1]);
        let wrong = |pose: &PosePx<f64>| self.judge(pose, field).wrong;
        if wrong(&narrow) < wrong(&wide) { (narrow, cost) } else { (wide, cost) }
    }

    /// How an outline at a pose meets the demand, pixel by pixel.
    pub(super) fn judge(&self, pose: &PosePx<f64>, field: &OutlineField<f64>) -> Verdict {
        let covered = covered(self.picture, pose, field);
        let mut verdict = Verdict { wrong: 0, hidden: 0 };
        let mut found = 0;
        for &pixel in &covered {
            match self.wishes[pixel] {
                Wish::Inside => found += 1,
                Wish::Outside => verdict.wrong += 1,
                Wish::Free => verdict.hidden += 1,
            }
        }
        let wanted = self.wishes.iter().filter(|&&wish| wish == Wish::Inside).count();
        verdict.wrong += wanted - found;
        verdict
    }
}

/// Normal equations of the pixels that are to be inside, and of those that are to be outside.
fn both(sides: &Sides, pose: &PosePx<f64>, field: &OutlineField<f64>, rough: bool) -> [Normal<f64>; 2] {
    let robustness = Robustness { width_px: WIDTH_PX, rough };
    // What lies on its own side has no say.
    let (wide, none) = (1.0 / (WIDTH_PX * WIDTH_PX), 1e12);
    [
        pose.normal_by(field, &sides.inside, robustness, |r| if r > 0.0 { wide } else { none }),
        pose.normal_by(field, &sides.outside, robustness, |r| if r < 0.0 { wide } else { none }),
    ]
}

/// The pixels whose middles an outline encloses at a pose.
pub(super) fn covered(picture: &FlatPicture, pose: &PosePx<f64>, field: &OutlineField<f64>) -> Vec<usize> {
    let frame = Frame::new(pose);
    let reach = field.radius * frame.scale;
    let sides = [picture.size.width(), picture.size.height()];
    let range = |axis: usize| {
        let (low, high) = (pose.translation[axis] - reach - 1.0, pose.translation[axis] + reach + 1.0);
        let clamp = |v: f64| v.max(0.0).min(f64::of_usize(sides[axis])).to_count();
        clamp(low)..clamp(high)
    };
    let (rows, columns) = (range(1), range(0));
    let pixels = rows.flat_map(|row| columns.clone().map(move |column| row * sides[0] + column));
    pixels.filter(|&pixel| field.distance(frame.to_unit(picture.middle(pixel))).0 < 0.0).collect()
}

/// Pixels that must not be covered, near ones that must or may.
fn near_wished(picture: &FlatPicture, wishes: &[Wish]) -> Vec<usize> {
    let mut near: Vec<bool> = wishes.iter().map(|&wish| wish != Wish::Outside).collect();
    for _ in 0..REACH {
        let mut grown = vec![false; near.len()];
        for (pixel, grown) in grown.iter_mut().enumerate() {
            *grown = near[pixel] || picture.around(pixel).any(|neighbor| near[neighbor]);
        }
        near = grown;
    }
    (0..near.len()).filter(|&pixel| near[pixel] && wishes[pixel] == Wish::Outside).collect()
}
