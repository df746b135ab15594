//! What pixels demand of an object: to be inside, to be outside, or nothing, where something else may hide it.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

use super::flat::FlatPicture;
use crate::pose::equations::{Normal, Robustness, SampleLanes};
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::segment::EdgeSample;

/// How far inside or outside of the outline the middle of a pixel is wanted, px: a little more than what rounding of a scene file can move.
const MARGIN_PX: f64 = 0.12;
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
    inside: SampleLanes<f64>,
    outside: SampleLanes<f64>,
    /// How many samples there are of each.
    counts: [f64; 2],
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
        let wish = |&color: &usize| if color == picture.ground { Wish::Outside } else { Wish::Free };
        let mut wishes: Vec<Wish> = picture.color_of.iter().map(wish).collect();
        inside.iter().for_each(|&pixel| wishes[pixel] = Wish::Inside);
        let area = f64::of_usize(inside.len());
        let mean = |pixels: &[usize]| {
            let sum = pixels.iter().map(|&pixel| picture.middle(pixel)).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]]);
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
        let within: Vec<_> = inside.iter().filter(is_edge).map(|&pixel| sample(pixel, -MARGIN_PX)).collect();
        let near = near_wished(picture, &wishes);
        let without: Vec<_> = near.into_iter().map(|pixel| sample(pixel, MARGIN_PX)).collect();
        let counts = [within.len(), without.len()].map(f64::of_usize);
        let [inside, outside] = [within, without].map(|samples| SampleLanes::new(&samples, 1, false));
        Self { picture, wishes, area, center, onward, inside, outside, counts }
    }

    /// Whether the object may go on where it is not seen.
    pub(super) fn is_open(&self) -> bool {
        self.onward != [0.0; 2]
    }

    /// Normal equations of what is wrong at a pose: squared distances of pixels on the wrong side of the outline.
    fn normal(&self, pose: &PosePx<f64>, field: &OutlineField<f64>) -> Normal<f64> {
        let robustness = Robustness { width_px: WIDTH_PX, rough: false };
        let wide = 1.0 / (WIDTH_PX * WIDTH_PX);
        // What lies on its own side has no say.
        let none = 1e12;
        let inside = pose.normal_by(field, &self.inside, robustness, |r| if r > 0.0 { wide } else { none });
        let outside = pose.normal_by(field, &self.outside, robustness, |r| if r < 0.0 { wide } else { none });
        let mut sum = inside;
        let cost = |normal: &Normal<f64>, count: f64| if count > 0.0 { normal.cost * count } else { 0.0 };
        sum.cost = cost(&inside, self.counts[0]) + cost(&outside, self.counts[1]);
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

    /// How wrong a pose is, px^2.
    pub(super) fn cost(&self, pose: &PosePx<f64>, field: &OutlineField<f64>) -> f64 {
        let robustness = Robustness { width_px: WIDTH_PX, rough: true };
        let wide = 1.0 / (WIDTH_PX * WIDTH_PX);
        let inside = pose.normal_by(field, &self.inside, robustness, |r| if r > 0.0 { wide } else { 1e12 }).cost;
        let outside = pose.normal_by(field, &self.outside, robustness, |r| if r < 0.0 { wide } else { 1e12 }).cost;
        let sum = |cost: f64, count: f64| if count > 0.0 { cost * count } else { 0.0 };
        sum(inside, self.counts[0]) + sum(outside, self.counts[1])
    }

    /// The pose nearby where least is wrong, and how wrong it is.
    pub(super) fn refined(&self, pose: PosePx<f64>, field: &OutlineField<f64>, steps: usize) -> (PosePx<f64>, f64) {
        let (pose, cost, _) = pose.descend(steps, 1e-4, |pose| self.normal(pose, field));
        (pose, cost)
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
