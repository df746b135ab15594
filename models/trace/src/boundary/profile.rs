//! Whether the edges of a picture are those of area coverage: a pixel shows of a color what it has of the area.
//!
//! Window sums are right for any profile, but a drawing with clear edges is only what the picture is if they are. Pictures that were blurred, or
//! painted by renderers with a profile of their own, are not. Two signs tell: [`stained`] pixels beyond the reach of area coverage, where edges are
//! wide, and a [`wobble`] of the positions, where they are steeper than a pixel. How wide they are, [`blur`] tells.

use alloc::vec::Vec;
use core::f64::consts::{PI, TAU};

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::Vec2;
use dvp_core::image::coverage;

use super::{Ring, Step};
use crate::partition::Partition;
use crate::sample::Sample;
use crate::tuning;

/// Slope of the boundary against its window up to which it is compared.
const MOST_SLOPE: f64 = 1.0;
/// Residual (pixels) of five positions in a row from a straight line up to which there is no corner between them.
const MOST_BENT: f64 = 0.4;
/// Sum of squared fourth differences of the wave from which on edges tell of it: axis-parallel ones show it always at one place.
const LEAST_WAVE: f64 = 14.0;
/// A wobble of fewer standard errors is none.
const SIGNIFICANT: f64 = 3.0;
/// Slope from which on an edge crosses pixels at all their places, and windows of such edges that are enough to tell.
const SLANTED: f64 = 0.1;
/// See [`SLANTED`].
const ENOUGH_SLANTED: f64 = 16.0;
/// Change of the slope from one window to the next below which a boundary is straight, and below which there is no corner: a bend alone moves what a
/// window shows of a profile by an eighth of that.
const STRAIGHT: f64 = 0.05;
/// See [`STRAIGHT`].
const SMOOTH: f64 = 0.25;
/// Cracks before and behind one among which its neighbors are looked for.
const BESIDE: usize = 2;

/// Share of the pixels just beyond the reach of straight boundaries, and of the lines that were taken out, that still show the color on the other side, less the share of
/// those that show less than none of it (coders of photographs ring to both sides); none if there are no such pixels.
#[must_use]
pub fn stained(partition: &Partition, rings: &[Vec<Ring>]) -> Option<f64> {
    let of_lines = |k: usize| partition.lines.iter().map(|line| line.stained[k]).sum::<i32>();
    let [mut stained, mut count] = [of_lines(0), of_lines(1)];
    for (step, here, slope) in smooth(rings, STRAIGHT) {
        for share in shares_beyond(partition, step, &here, slope) {
            count += 1;
            stained += i32::from(share > tuning::LEAST_STAIN) - i32::from(share < -tuning::LEAST_STAIN);
        }
    }
    (count > 0).then(|| f64::from(stained) / f64::from(count))
}

/// How wide edges are beyond area coverage: standard deviation of a blur, pixels; 0 for area coverage and what is steeper, or where no edge tells.
///
/// *Why*: an edge is the convolution of a step with its profile, and its window the distribution function F of that. The integral of F (1 - F) is the
/// standard deviation over the root of pi for a normal distribution, and next to that for area coverage, which is added in quadrature. Second moments
/// would be exact, but ask most of tails that rounding cuts off.
#[must_use]
pub fn blur(partition: &Partition, rings: &[Vec<Ring>]) -> f64 {
    let [mut total, mut count] = [[0.0; 2]; 2];
    for (step, _, slope) in smooth(rings, SMOOTH) {
        let colors = [step.inner, step.other].map(|face| partition.color(face));
        let noise2 = partition.sigma.powi(2) / (0..3).map(|c| (colors[0][c] - colors[1][c]).powi(2)).sum::<f64>();
        let across = middle(step.crack.sides()[0]) - middle(step.crack.sides()[1]);
        let mut spread = 0.0;
        for (side, [x, y]) in step.crack.sides().into_iter().enumerate() {
            let outward = if side == 0 { across } else { across * -1.0 };
            for k in 0..=tuning::SOFT_REACH as isize {
                let at = [x.wrapping_add_signed(k * outward.x as isize), y.wrapping_add_signed(k * outward.y as isize)];
                if partition.face_at(at) != [step.inner, step.other][side] {
                    break;
                }
                let pixel = at[1] * partition.size[0] + at[0];
                if partition.shares[pixel] == 1.0 {
                    break;
                }
                let share = coverage(partition.pixels[pixel].map(f64::from), colors[side], colors[1 - side]);
                // Noise makes the square of a share larger.
                spread += share * (1.0 - share) + noise2;
            }
        }
        let kind = usize::from(slope.abs() > SLANTED);
        // Along the window a slanted edge is wider.
        total[kind] += spread / (1.0 + slope * slope).sqrt();
        count[kind] += 1.0;
    }
    // What one window shows depends on where in its pixel the edge lies. Slanted edges lie everywhere, so that the mean is right; upright ones lie at
    // one place, which makes the variance wrong by up to a twelfth.
    let kind = usize::from(count[1] >= ENOUGH_SLANTED || count[0] == 0.0);
    if count[kind] == 0.0 {
        return 0.0;
    }
    // Of area coverage alone it is a sixth.
    let variance = PI * ((total[kind] / count[kind]).powi(2) - 1.0 / 36.0);
    variance.max(0.0).sqrt()
}

/// Steps with their samples where the slope of the boundary changes by less than `most`, and that slope: how much it moves per pixel along it.
fn smooth(rings: &[Vec<Ring>], most: f64) -> impl Iterator<Item = (&Step, Sample, f64)> {
    rings.iter().flatten().filter(|ring| ring.steps.len() > 2 * BESIDE).flat_map(move |ring| {
        let n = ring.steps.len();
        (0..n).filter_map(move |k| {
            // A slanted boundary has cracks of the other axis between, which have no sample.
            let here = ring.steps[k].sample?;
            let before = (1..=BESIDE).find_map(|offset| ring.steps[(k + n - offset) % n].sample)?;
            let behind = (1..=BESIDE).find_map(|offset| ring.steps[(k + offset) % n].sample)?;
            Some((&ring.steps[k], here, slope(&here, &before, &behind, most)?))
        })
    })
}

/// The middle of a pixel.
fn middle([x, y]: [usize; 2]) -> Vec2<f64> {
    Vec2::new(x as f64 + 0.5, y as f64 + 0.5)
}

/// By how much the positions along slanted edges wobble with the place of the edge between pixel centers: 0 for area coverage (and what was scaled
/// down or blurred after it), down to about -1 for pixels that show what is at their center; none if no edge tells.
///
/// *Why*: a window sum is the convolution of the edge with its profile, sampled once per pixel. Area coverage is a box of one pixel, whose
/// spectrum is zero at one wave per pixel, so its sums move evenly with the edge. A steeper profile leaves a part of that wave. Fourth differences of
/// the positions, which neither slopes nor bends show in, are compared with those of the wave at full strength.
#[must_use]
pub fn wobble(rings: &[Vec<Ring>]) -> Option<f64> {
    let [mut product, mut square] = [0.0; 2];
    let mut pairs = Vec::new();
    // The rings of both sides of a boundary tell the same.
    let is_first = |step: &&Step| step.inner < step.other;
    for ring in rings.iter().flatten() {
        let samples: Vec<Sample> = ring.steps.iter().filter(is_first).filter_map(|step| step.sample).collect();
        for five in samples.windows(5) {
            let Some(at) = places(five) else { continue };
            let wave = at.map(|at| (TAU * at).sin() / PI);
            let (seen, full) = (fourth_difference(at), fourth_difference(wave));
            product += full * seen;
            square += full * full;
            pairs.push((full, seen));
        }
    }
    if square < LEAST_WAVE {
        return None;
    }
    let wobble = product / square;
    let doubt = pairs.iter().map(|(full, seen)| (full * (seen - wobble * full)).powi(2)).sum::<f64>().sqrt() / square;
    (wobble.abs() > SIGNIFICANT * doubt).then_some(wobble)
}

/// Positions across five windows side by side; none if they are not, or the boundary has a corner there.
fn places(five: &[Sample]) -> Option<[f64; 5]> {
    let middle = five[2];
    let along = middle.axis.perp();
    let at: [f64; 5] = core::array::from_fn(|k| five[k].point.dot(middle.axis));
    let step = (five[3].point - middle.point).dot(along);
    let is_beside = |(k, other): (usize, &Sample)| {
        other.axis == middle.axis && ((other.point - middle.point).dot(along) - (k as f64 - 2.0) * step).abs() < 0.01
    };
    let slope = 0.1 * (at[3] - at[1] + 2.0 * (at[4] - at[0]));
    let mean = at.iter().sum::<f64>() / 5.0;
    let is_straight = (0..5).all(|k| (at[k] - mean - slope * (k as f64 - 2.0)).abs() < MOST_BENT);
    let is_row = (step.abs() - 1.0).abs() < 0.01 && five.iter().enumerate().all(is_beside);
    (is_row && is_straight && slope.abs() <= MOST_SLOPE).then_some(at)
}

pub(super) fn fourth_difference(at: [f64; 5]) -> f64 {
    at[0] - 4.0 * at[1] + 6.0 * at[2] - 4.0 * at[3] + at[4]
}

/// Change of the position per pixel along a boundary whose slope changes by less than `most` over three windows of one axis.
fn slope(here: &Sample, before: &Sample, behind: &Sample, most: f64) -> Option<f64> {
    let along = here.axis.perp();
    let [back, ahead] = [before, behind].map(|other| (other.axis == here.axis).then_some(other.point - here.point));
    let (back, ahead) = (back?, ahead?);
    let (from, to) = (back.dot(along), ahead.dot(along));
    let slopes = [back.dot(here.axis) / from, ahead.dot(here.axis) / to];
    let is_smooth = (slopes[0] - slopes[1]).abs() < most && from * to < 0.0 && from.abs() < 1.5 && to.abs() < 1.5;
    let slope = 0.5 * (slopes[0] + slopes[1]);
    (is_smooth && slope.abs() < MOST_SLOPE).then_some(slope)
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
