//! Whether the edges of a picture are those of area coverage: a pixel shows of a color what it has of the area.
//!
//! Window sums are right for any profile, but a drawing with clear edges is only what the picture is if they are. Pictures that were blurred, or
//! painted by renderers with a profile of their own, are not.

use alloc::vec::Vec;

use dvp_core::Vec2;

use super::{Ring, Step};
use crate::partition::{Partition, coverage};
use crate::sample::Sample;
use crate::tuning;

/// Slope of the boundary against its window up to which it is compared.
const MOST_SLOPE: f64 = 1.0;
/// Cracks before and behind one among which its neighbors are looked for.
const BESIDE: usize = 2;

/// Share of the pixels just beyond the reach of straight boundaries that still show the color on the other side, less the share of
/// those that show less than none of it (coders of photographs ring to both sides); none if there are no such pixels.
#[must_use]
pub fn stained(partition: &Partition, rings: &[Vec<Ring>]) -> Option<f64> {
    let [mut stained, mut count] = [0_i32; 2];
    for ring in rings.iter().flatten() {
        let n = ring.steps.len();
        for k in (0..n).filter(|_| n > 2 * BESIDE) {
            // A slanted boundary has cracks of the other axis between, which have no sample.
            let Some(here) = ring.steps[k].sample else { continue };
            let Some(before) = (1..=BESIDE).find_map(|offset| ring.steps[(k + n - offset) % n].sample) else {
                continue;
            };
            let Some(behind) = (1..=BESIDE).find_map(|offset| ring.steps[(k + offset) % n].sample) else { continue };
            let Some(slope) = slope(&here, &before, &behind) else { continue };
            for share in shares_beyond(partition, &ring.steps[k], &here, slope) {
                count += 1;
                stained += i32::from(share > tuning::LEAST_STAIN) - i32::from(share < -tuning::LEAST_STAIN);
            }
        }
    }
    (count > 0).then(|| f64::from(stained) / f64::from(count))
}

/// Change of the position per pixel along a boundary that is straight over three windows of one axis.
fn slope(here: &Sample, before: &Sample, behind: &Sample) -> Option<f64> {
    let along = here.axis.perp();
    let [back, ahead] = [before, behind].map(|other| (other.axis == here.axis).then_some(other.point - here.point));
    let (back, ahead) = (back?, ahead?);
    let (from, to) = (back.dot(along), ahead.dot(along));
    let slopes = [back.dot(here.axis) / from, ahead.dot(here.axis) / to];
    let is_straight = (slopes[0] - slopes[1]).abs() < 0.05 && from * to < 0.0 && from.abs() < 1.5 && to.abs() < 1.5;
    let slope = 0.5 * (slopes[0] + slopes[1]);
    (is_straight && slope.abs() < MOST_SLOPE).then_some(slope)
}

/// Shares of the other side's color in the pixels next to a crack that a straight line through the sample does not touch.
fn shares_beyond<'a>(
    partition: &'a Partition,
    step: &'a Step,
    sample: &Sample,
    slope: f64,
) -> impl Iterator<Item = f64> + 'a {
    let colors = [step.inner, step.other].map(|face| partition.color(face));
    let [inside, outside] = step.crack.sides();
    let point = sample.point;
    let middle = |at: [usize; 2]| Vec2::new(at[0] as f64 + 0.5, at[1] as f64 + 0.5);
    let inward = middle(inside) - middle(outside);
    let next = |at: [usize; 2], sign: f64| {
        let moved = middle(at) + inward * sign;
        [moved.x as usize, moved.y as usize]
    };
    let four = [next(inside, 1.0), inside, outside, next(outside, -1.0)];
    four.into_iter().filter_map(move |at| {
        let depth = (middle(at) - point).dot(inward);
        let (own, other) = if depth > 0.0 { (0, 1) } else { (1, 0) };
        let beyond = depth.abs() - 0.5 - 0.5 * slope.abs();
        if beyond <= 0.02 || beyond > 1.0 || partition.face_at(at) != [step.inner, step.other][own] {
            return None;
        }
        let pixel = partition.pixels[at[1] * partition.size[0] + at[0]].map(f64::from);
        Some(coverage(pixel, colors[own], colors[other]))
    })
}
