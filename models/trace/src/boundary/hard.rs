//! Where no pixel is mixed: sides that are upright for sure.
//!
//! The stairs that a slanted line, or a curve, is there have steps of one pixel in one direction or the other. Where a boundary turns after two pixels or
//! more and goes on for as many it has a corner, and what leads straight from one such corner to the next is a side along the cracks.

use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::Vec2;
use dvp_core::contour::Heading;

use super::Ring;
use crate::partition::{OUTSIDE, Partition};
use crate::sample::Sample;

/// Cracks of one heading from which on a stretch is no step of a slanted line.
const SIDE: usize = 2;

/// Reads the upright sides of a ring in a picture without mixed pixels, exactly.
pub(super) fn read_upright(partition: &Partition, ring: &mut Ring) {
    if !partition.is_hard || partition.reading.regions {
        return;
    }
    let n = ring.steps.len();
    let turns = |k: usize| ring.steps[(k + n - 1) % n].crack.heading != ring.steps[k].crack.heading;
    let corners: Vec<usize> = (0..n).filter(|&k| turns(k)).collect();
    let Some(&first) = corners.first() else { return };
    // Steps count on past the last.
    let ends = corners.iter().skip(1).copied().chain([first + n]);
    let stretches: Vec<Range<usize>> = corners.iter().copied().zip(ends).map(|(start, end)| start..end).collect();
    let is_corner = |before: &Range<usize>, behind: &Range<usize>| {
        let [last, next] = [before.end - 1, behind.start].map(|k| ring.steps[k % n].other);
        before.len() >= SIDE && behind.len() >= SIDE && last == next && last != OUTSIDE
    };
    let count = stretches.len();
    let is_side = |k: usize| {
        let [before, here, behind] = [k + count - 1, k, k + 1].map(|k| &stretches[k % count]);
        is_corner(before, here) && is_corner(here, behind)
    };
    let sides: Vec<usize> = (0..count).filter(|&k| is_side(k)).collect();
    for k in sides.into_iter().flat_map(|k| stretches[k].clone()) {
        let step = &mut ring.steps[k % n];
        let is_level = matches!(step.crack.heading, Heading::PlusX | Heading::MinusX);
        let axis = if is_level { Vec2::new(0.0, 1.0) } else { Vec2::new(1.0, 0.0) };
        let sample = Sample::new(Ring::middle(step.crack), axis, partition.sigma);
        step.sample = (step.other != OUTSIDE).then_some(Sample { is_exact: true, ..sample });
    }
}
