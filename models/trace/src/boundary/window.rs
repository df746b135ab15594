//! Reads where a boundary passes: coverage summed over a window across it, from pure pixels to pure pixels.
//!
//! Windows lie along columns where the boundary is flat and along rows where it is steep, one per pixel of its length.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::Heading;

use super::{Ring, Step};
use crate::partition::{OUTSIDE, Partition};
use crate::sample::{Sample, straightened};
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
        // What goes along a crack is flat there, or steep, whatever is beside it.
        ring.steps[k].is_across = is_flat != is_column;
        ring.steps[k].sample =
            sample(partition, &ring.steps[k]).filter(|sample| is_flat == is_column || sample.is_exact);
        let ([x, y], [gone_x, gone_y]) =
            (unit(&ring.steps[(k + AROUND + 1) % n]), unit(&ring.steps[(k + n - AROUND) % n]));
        along = [along[0] + x - gone_x, along[1] + y - gone_y];
    }
    doubt_stairs(ring);
    straighten(partition, ring);
    unblur(partition, ring);
}

/// Where a boundary turns again and again by one pixel, it is slanted and without mixtures: its windows tell no more than cracks do.
fn doubt_stairs(ring: &mut Ring) {
    let n = ring.steps.len();
    let is_stair = |k: usize| {
        let [before, here, behind] = [k + n - 1, k, k + 1].map(|k| ring.steps[k % n].crack.heading);
        before == behind && before != here && ring.steps[k].sample.is_some_and(|sample| sample.is_exact)
    };
    let stairs: Vec<usize> = (0..n).filter(|&k| is_stair(k)).collect();
    // So many in a row, and how far it is from the first of them to the last, all around.
    let most = tuning::MOST_STAIRS;
    for (first, &start) in stairs.iter().enumerate() {
        let last = first + most;
        let end = stairs[last % stairs.len()] + if last < stairs.len() { 0 } else { n };
        if last - first >= stairs.len() || end - start > tuning::STAIRS_APART * most {
            continue;
        }
        let apart = tuning::STAIRS_APART;
        for k in start + n - apart.min(n)..end + n + apart {
            let step = &mut ring.steps[k % n];
            if let Some(sample) = step.sample.take_if(|sample| sample.is_exact)
                && !step.is_across
            {
                step.sample = Some(Sample::new(sample.point, sample.axis, tuning::CRACK_SIGMA));
            }
        }
    }
}

/// The mean position of the boundary across one crack; none where a third color shows in the window, or the border is met.
pub(super) fn sample(partition: &Partition, step: &Step) -> Option<Sample> {
    if step.other == OUTSIDE {
        return None;
    }
    if let Some(sample) = partition.sliver_sample(step.crack) {
        return sample;
    }
    let [inner, outer] = [step.inner, step.other].map(|face| partition.color(face));
    let contrast2: f64 = (0..3).map(|c| (inner[c] - outer[c]).powi(2)).sum();
    if contrast2 <= 0.0 {
        return None;
    }
    let rounding = partition.sigma / contrast2.sqrt();
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
    let mixed = missing.1 + surplus.1;
    // Of squares nothing is rounded, however alike their colors are.
    let rounding = if partition.reading.squares { partition.sigma } else { rounding };
    let variance = (mixed + 1) as f64 * rounding * rounding;
    let is_exact = mixed == 0 && rounding <= tuning::RENDERER_SIGMA && partition.has_exact_edges();
    Some(Sample { point, axis, sigma: variance.sqrt(), is_exact })
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
    let reach = if partition.reading.soft { tuning::SOFT_REACH } else { REACH };
    for count in 0..=reach {
        if partition.face_at(at) != face {
            return None;
        }
        let pixel = partition.pixels[at[1] * partition.size[0] + at[0]].map(f64::from);
        let share = dvp_core::image::coverage(pixel, colors[1], colors[0]);
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

/// The mean over a window is not the position in its middle where the boundary is bent: the windows beside it tell by how much.
///
/// Up to the fourth differences the position is the mean less a 24th of the second and plus 3/640 of the fourth difference. Where columns give
/// way to rows the windows beyond are read for this alone.
fn straighten(partition: &Partition, ring: &mut Ring) {
    let raw: Vec<Option<Sample>> = ring.steps.iter().map(|step| step.sample).collect();
    let read = |k: usize| raw[k].or_else(|| sample(partition, &ring.steps[k]));
    let mut corrected = Vec::new();
    for (k, here) in raw.iter().enumerate().filter_map(|(k, here)| Some((k, (*here)?))) {
        let at =
            |neighbor: Option<usize>| neighbor.and_then(&read).map(|other| (other.point - here.point).dot(here.axis));
        let sides = [false, true].map(|ahead| beside(ring, k, ahead));
        let [Some(before), Some(behind)] = sides.map(at) else {
            continue;
        };
        let beyond = [0, 1].map(|side| sides[side].and_then(|k| at(beside(ring, k, side == 1))));
        let beyond = if let [Some(first), Some(last)] = beyond { Some([first, last]) } else { None };
        if let Some(moved) = straightened([before, behind], beyond) {
            corrected.push((k, Sample { point: here.point + here.axis * moved, ..here }));
        }
    }
    for (k, sample) in corrected {
        ring.steps[k].sample = Some(sample);
    }
}

/// A blur moves a boundary that is bent inward: by half its variance times the change of the slope, which windows further along tell.
fn unblur(partition: &Partition, ring: &mut Ring) {
    // What a coder leaves beside edges looks like blur.
    if partition.blur <= 0.0 || partition.reading.coded {
        return;
    }
    // Far enough that what noise makes of the change of the slope is not more than the blur does.
    let apart = (2.0 * partition.blur).ceil() as usize;
    let far = |k: usize, ahead: bool| (0..apart).try_fold(k, |k, _| beside(ring, k, ahead));
    let moved = |k: usize| {
        let here = ring.steps[k].sample?;
        // Where columns give way to rows the windows beyond are read for this alone.
        let read = |k: usize| ring.steps[k].sample.or_else(|| sample(partition, &ring.steps[k]));
        let at = |k: usize| Some((read(k)?.point - here.point).dot(here.axis));
        let bend = at(far(k, false)?)? + at(far(k, true)?)?;
        // At corners a boundary is not bent: it ends.
        let bend = if bend.abs() < tuning::MOST_BEND * apart as f64 { bend } else { 0.0 };
        let by = -0.5 * (partition.blur / apart as f64).powi(2) * bend;
        Some(Sample { point: here.point + here.axis * by, ..here })
    };
    let moved: Vec<_> = (0..ring.steps.len()).map(moved).collect();
    for (step, moved) in ring.steps.iter_mut().zip(moved) {
        step.sample = moved;
    }
}

/// The next crack, ahead or back, with the same heading; none if the boundary leads too far across before.
pub(super) fn beside(ring: &Ring, k: usize, ahead: bool) -> Option<usize> {
    let n = ring.steps.len();
    let heading = ring.steps[k].crack.heading;
    let step = |k: usize| if ahead { (k + 1) % n } else { (k + n - 1) % n };
    let mut at = step(k);
    for _ in 0..=REACH {
        let other = ring.steps[at].crack.heading;
        if other == heading {
            return Some(at);
        }
        // A boundary that turns back has no window beside this one.
        let is_across =
            matches!(heading, Heading::PlusX | Heading::MinusX) != matches!(other, Heading::PlusX | Heading::MinusX);
        if !is_across {
            return None;
        }
        at = step(at);
    }
    None
}
