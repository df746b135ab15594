//! Reads where a boundary passes: coverage summed over a window across it, from pure pixels to pure pixels.
//!
//! Windows lie along columns where the boundary is flat and along rows where it is steep, one per pixel of its length.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::Vec2;
use dvp_core::contour::Heading;

use super::{Ring, Step};
use crate::partition::{OUTSIDE, Partition};
use crate::sample::Sample;
use crate::tuning;

/// Cracks before and behind one that tell which way the boundary goes there.
const AROUND: usize = 4;
/// Most mixed pixels on either side of a crack: an edge of area coverage has one or two, one that a picture was scaled with three.
const REACH: usize = 4;

/// Fills in the samples of a ring.
pub(super) fn read(partition: &Partition, ring: &mut Ring) {
    let n = ring.steps.len();
    if n < 2 * AROUND {
        return;
    }
    let unit = |step: &Step| match step.crack.heading {
        Heading::PlusX => [1, 0],
        Heading::PlusY => [0, 1],
        Heading::MinusX => [-1, 0],
        Heading::MinusY => [0, -1_i32],
    };
    let mut along = [0_i32; 2];
    for k in 0..=2 * AROUND {
        let [x, y] = unit(&ring.steps[(k + n - AROUND) % n]);
        along = [along[0] + x, along[1] + y];
    }
    for k in 0..n {
        let is_flat = along[0].abs() >= along[1].abs();
        let is_column = matches!(ring.steps[k].crack.heading, Heading::PlusX | Heading::MinusX);
        if is_flat == is_column {
            ring.steps[k].sample = sample(partition, &ring.steps[k]);
        }
        let ([x, y], [gone_x, gone_y]) = (unit(&ring.steps[(k + AROUND + 1) % n]), unit(&ring.steps[(k + n - AROUND) % n]));
        along = [along[0] + x - gone_x, along[1] + y - gone_y];
    }
    straighten(ring);
}

/// The mean position of the boundary across one crack; none where a third color shows in the window, or the border is met.
fn sample(partition: &Partition, step: &Step) -> Option<Sample> {
    if step.other == OUTSIDE {
        return None;
    }
    let [inner, outer] = [step.inner, step.other].map(|face| partition.color(face));
    let contrast2: f64 = (0..3).map(|c| (inner[c] - outer[c]).powi(2)).sum();
    if contrast2 <= 0.0 {
        return None;
    }
    let rounding = tuning::ROUNDING / contrast2.sqrt();
    let [inner_at, outer_at] = step.crack.sides();
    // From the crack inward: missing coverage moves the boundary inward. Outward: coverage moves it outward.
    let missing = sum(partition, [inner_at, outer_at], step.inner, [outer, inner], rounding)?;
    let surplus = sum(partition, [outer_at, inner_at], step.other, [inner, outer], rounding)?;
    let inward = missing.0 - surplus.0;
    let [x, y] = Ring::middle(step.crack).to_array();
    let (point, axis) = match step.crack.heading {
        Heading::PlusX => (Vec2::new(x, y + inward), Vec2::new(0.0, 1.0)),
        Heading::MinusX => (Vec2::new(x, y - inward), Vec2::new(0.0, 1.0)),
        Heading::PlusY => (Vec2::new(x - inward, y), Vec2::new(1.0, 0.0)),
        Heading::MinusY => (Vec2::new(x + inward, y), Vec2::new(1.0, 0.0)),
    };
    let variance = (missing.1 + surplus.1 + 1) as f64 * rounding * rounding;
    Some(Sample { point, axis, sigma: (variance + tuning::RENDERER_SIGMA * tuning::RENDERER_SIGMA).sqrt() })
}

/// Coverage by the other side, summed from the pixel `at` (the one opposite is `from`) to the first pure pixel of `face`, and how many
/// pixels that takes. `colors`: the other side's and the own one.
fn sum(
    partition: &Partition,
    [at, from]: [[usize; 2]; 2],
    face: u32,
    colors: [[f64; 3]; 2],
    rounding: f64,
) -> Option<(f64, usize)> {
    let mut total = 0.0;
    let mut at = at;
    let step = [at[0].wrapping_sub(from[0]), at[1].wrapping_sub(from[1])];
    for count in 0..=REACH {
        if partition.face_at(at) != face {
            return None;
        }
        let pixel = partition.pixels[at[1] * partition.size[0] + at[0]].map(f64::from);
        let share = crate::partition::coverage(pixel, colors[1], colors[0]);
        if share.abs() <= 2.0 * rounding {
            return Some((total, count));
        }
        let misfit = (0..3).map(|c| (pixel[c] - colors[1][c] - share * (colors[0][c] - colors[1][c])).abs());
        if misfit.fold(0.0, f64::max) > partition.mix_noise {
            return None;
        }
        total += share;
        at = [at[0].wrapping_add(step[0]), at[1].wrapping_add(step[1])];
    }
    None
}

/// The mean over a window is not the position in its middle where the boundary is bent: it is off by a 24th of the second
/// derivative, which the windows beside it tell.
fn straighten(ring: &mut Ring) {
    let n = ring.steps.len();
    let samples: alloc::vec::Vec<(usize, Sample)> =
        ring.steps.iter().enumerate().filter_map(|(k, step)| Some((k, step.sample?))).collect();
    let m = samples.len();
    if m < 3 || n < 3 {
        return;
    }
    for j in 0..m {
        let [(_, before), (k, here), (_, behind)] = [samples[(j + m - 1) % m], samples[j], samples[(j + 1) % m]];
        let position = |sample: &Sample| sample.point.dot(here.axis);
        let across = here.axis.perp();
        let steps = [before, behind].map(|other| (other.point - here.point).dot(across));
        let are_neighbors = before.axis == here.axis && behind.axis == here.axis;
        if !are_neighbors || (steps[0].abs() - 1.0).abs() > 1e-6 || (steps[0] + steps[1]).abs() > 1e-6 {
            continue;
        }
        let bend = position(&before) + position(&behind) - 2.0 * position(&here);
        if bend.abs() < tuning::MOST_BEND
            && let Some(sample) = &mut ring.steps[k].sample
        {
            sample.point = here.point - here.axis * (bend / 24.0);
        }
    }
}
