//! Corners that are none: bends so tight that their center lines alone do not tell them from corners, but their outer sides do.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::Segment;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::border::Border;
use super::draw::{Drawing, Foot, Line};
use crate::tuning;

/// Least turn of a corner that is looked at, radians.
const LEAST_TURN: f64 = 0.35;
/// Fewest marks around a corner that tell how round it is.
const LEAST_MARKS: usize = 2;

/// The drawing with those corners between straight pieces rounded past which the outer side of the boundary cuts; none if there are
/// no such.
pub(super) fn round_corners(drawing: &Drawing, border: &Border) -> Option<Drawing> {
    let mut drawing = drawing.clone();
    let mut is_changed = false;
    let mut gaps: Vec<Vec<Vec<f64>>> =
        drawing.lines.iter().map(|line| alloc::vec![Vec::new(); line.ring.points.len()]).collect();
    for mark in &border.marks {
        let Some((line, reading)) = drawing.reading(mark.point) else { continue };
        if let Foot::Body { piece, t } = reading.foot
            && (t <= 0.0 || t >= 1.0)
        {
            let count = drawing.lines[line].ring.points.len();
            gaps[line][(piece + usize::from(t > 0.5)) % count].push(reading.gap);
        }
    }
    for (line, gaps) in drawing.lines.iter_mut().zip(&mut gaps) {
        // From the end, so that the numbers of the corners to come stay.
        for corner in (0..gaps.len()).rev() {
            let gaps = &mut gaps[corner];
            let least = gaps.iter().copied().min_by(f64::total_cmp);
            let Some(gap) = least.filter(|_| gaps.len() >= LEAST_MARKS) else { continue };
            if let Some(rounded) = (-gap > 2.0 * tuning::STROKE_OFFSET).then(|| rounded(line, corner, -gap)).flatten() {
                *line = rounded;
                is_changed = true;
            }
        }
    }
    is_changed.then_some(drawing)
}

/// The line with an arc instead of a corner between straight pieces that passes it at a distance of `past`.
fn rounded(line: &Line, corner: usize, past: f64) -> Option<Line> {
    let count = line.ring.points.len();
    let before = if corner > 0 { corner - 1 } else { line.ring.is_closed().then(|| count - 1)? };
    let mut ring = line.ring.clone();
    if !matches!((ring.segments.get(before)?, ring.segments.get(corner)?), (Segment::Line, Segment::Line)) {
        return None;
    }
    let place = |k: usize| Vec2::from(line.ring.points[k % count]);
    let [arrive, leave] = [place(corner) - place(before), place(corner + 1) - place(corner)];
    let turn = arrive.cross(leave).atan2(arrive.dot(leave));
    // A circle between two tangents passes their corner at radius (1 / cos(turn / 2) - 1).
    let radius = past / (1.0 / (0.5 * turn).cos() - 1.0);
    let cut = radius * (0.5 * turn).tan().abs();
    if turn.abs() < LEAST_TURN || cut >= arrive.length().min(leave.length()) {
        return None;
    }
    let [start, end] = [place(corner) - arrive.normalized()? * cut, place(corner) + leave.normalized()? * cut];
    ring.points[corner] = end.to_array();
    ring.points.insert(corner, start.to_array());
    ring.segments.insert(corner, Segment::Arc { bulge: (0.25 * turn).tan() });
    line.with_ring(ring)
}
