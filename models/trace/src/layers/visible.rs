//! What is seen of a layer's boundary.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::Heading;

use crate::boundary::{Ring, Step};
use crate::partition::OUTSIDE;
use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// How a step of a boundary is hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hidden {
    /// The outline may go anywhere there.
    Free,
    /// It lies somewhere under a stroke whose middle is `shift` pixels outward.
    Under {
        /// Pixels, negative inward.
        shift: f64,
    },
    /// It goes along what hides it, a little way under it: edges that lie exactly on one another let through what is behind both.
    Tucked,
}

/// What is known of a step of a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Known {
    /// What a window reads; nothing where none does.
    Read,
    /// That, or the crack itself.
    Filled,
    /// The crack: what was read is not believed.
    Crack,
}

/// The samples of a ring; where `hidden` says so of a step, the boundary is not the layer's own.
///
/// Stretches that no window could read (thin things, crowded junctions) are known from the cracks themselves, to a third of a pixel.
pub(super) fn samples(ring: &Ring, hidden: &[Option<Hidden>], known: &[Known]) -> RingSamples {
    let is_free = |k: usize| hidden[k] == Some(Hidden::Free);
    let n = ring.steps.len();
    // Begin behind a hidden step, so that no run is cut in two.
    let Some(start) = (0..n).find(|&k| is_free(k)) else {
        let run = read(ring, 0, n, true, hidden, known);
        return RingSamples { runs: alloc::vec![run], closed: true };
    };
    let mut runs = Vec::new();
    let mut k = 0;
    while k < n {
        let at = |k: usize| (start + k) % n;
        if is_free(at(k)) {
            k += 1;
            continue;
        }
        let length = (k..n).take_while(|&j| !is_free(at(j))).count();
        let run = read(ring, at(k), length, false, hidden, known);
        if !run.is_empty() {
            runs.push(run);
        }
        k += length;
    }
    RingSamples { runs, closed: false }
}

/// The samples of `length` steps from `start` on.
fn read(
    ring: &Ring,
    start: usize,
    length: usize,
    closed: bool,
    hidden: &[Option<Hidden>],
    known: &[Known],
) -> Vec<Sample> {
    let n = ring.steps.len();
    let mut run: Vec<Sample> = Vec::new();
    let mut unread = 0;
    for k in 0..length {
        let at = (start + k) % n;
        let step = &ring.steps[at];
        // Where a boundary is flat half of the steps have samples, at 45 degrees; else more. A longer stretch without is unread.
        unread = if step.sample.is_some() { 0 } else { unread + 1 };
        match step.sample {
            _ if known.get(at) == Some(&Known::Crack) => push(&mut run, of_crack(step, tuning::CRACK_SIGMA)),
            Some(sample) => push(&mut run, moved(sample, step, hidden[at])),
            None if known.get(at) == Some(&Known::Filled) => push(&mut run, of_crack(step, tuning::CRACK_SIGMA)),
            None if step.other == OUTSIDE => push(&mut run, of_crack(step, tuning::BORDER_SIGMA)),
            None if unread > tuning::MOST_UNREAD => push(&mut run, of_crack(step, tuning::CRACK_SIGMA)),
            None => (),
        }
    }
    if closed && run.len() < 8 {
        run = (0..length).map(|k| of_crack(&ring.steps[(start + k) % n], tuning::CRACK_SIGMA)).collect();
    }
    run
}

/// How far (pixels) an outline goes under what hides it: beyond the pixels that its edge mixes.
const TUCK: f64 = 1.0;

/// The sample of a step that is hidden under a stroke: it is the stroke's middle that the outline is near, give or take a quarter of its width.
/// Under anything else it lies beyond the edge, give or take half of that.
fn moved(sample: Sample, step: &Step, hidden: Option<Hidden>) -> Sample {
    let shift = match hidden {
        Some(Hidden::Under { shift }) => shift,
        Some(Hidden::Tucked) => TUCK,
        _ => return sample,
    };
    // The face is on the right hand: outward is to the left.
    let outward = match step.crack.heading {
        Heading::PlusX => Vec2::new(0.0, -1.0),
        Heading::PlusY => Vec2::new(1.0, 0.0),
        Heading::MinusX => Vec2::new(0.0, 1.0),
        Heading::MinusY => Vec2::new(-1.0, 0.0),
    };
    Sample::new(sample.point + outward * shift, sample.axis, sample.sigma.max(0.5 * shift.abs()))
}

/// Leaves out a sample that does not lead on: where columns give way to rows, two windows read the same stretch.
fn push(run: &mut Vec<Sample>, sample: Sample) {
    if let [.., before, last] = run[..] {
        let along = last.point - before.point;
        if (sample.point - last.point).dot(along) <= 0.2 * along.length() && (sample.point - last.point).length() < 1.0
        {
            return;
        }
    }
    run.push(sample);
}

/// A boundary known from a crack alone.
fn of_crack(step: &Step, sigma: f64) -> Sample {
    let [from, to] = [step.crack.start, step.crack.end()];
    let axis = if from[0] == to[0] { Vec2::new(1.0, 0.0) } else { Vec2::new(0.0, 1.0) };
    Sample::new(Ring::middle(step.crack), axis, sigma)
}
