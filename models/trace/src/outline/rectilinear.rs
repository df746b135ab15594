//! Outlines of upright sides that windows without a mixed pixel tell exactly: of sprites, of bars, of what lies on the grid of the pixels.

use alloc::vec::Vec;

use dvp_core::shape::PathRing;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::track::Track;
use super::{Outline, OutlineShape};
use crate::ruler::Ruler;
use crate::tuning;

/// Samples of one side agree to so much, pixels: windows without a mixed pixel end at cracks, a pixel apart.
const SAME: f64 = 0.01;

/// A side: samples along it, one after the other.
#[derive(Clone, Copy)]
struct Side {
    /// The axis that it is known along: 0 if it is upright, 1 if it is level.
    axis: usize,
    /// The first and the last sample.
    first: usize,
    last: usize,
    /// 1 / variance of its place.
    weight: f64,
}

/// The polygon of upright and level sides through samples, each of which is exact: no outline through these is shorter. None if there is no such
/// polygon, or one of four sides, which is a whole figure.
pub(super) fn fit(track: &Track, ruler: &Ruler) -> Option<Outline> {
    let sides = sides(track)?;
    let count = sides.len();
    if count <= 4 {
        return None;
    }
    let points: Option<Vec<[f64; 2]>> = (0..count).map(|k| corner(track, sides[k], sides[(k + 1) % count])).collect();
    let bits: f64 = sides.iter().map(|side| ruler.number(side.weight.sqrt().recip())).sum();
    let bits = bits + tuning::OUTLINE_PIECE_BITS * (count + 1) as f64;
    Some(Outline { shape: OutlineShape::Path(PathRing::polygon(points?)), bits, misfit: 0.0, covariance: Vec::new() })
}

/// The sides in turn; none if a sample is not exact, or two sides that follow one another are parallel.
fn sides(track: &Track) -> Option<Vec<Side>> {
    let at = |k: usize, axis: usize| track.point(k).to_array()[axis];
    let mut sides: Vec<Side> = Vec::new();
    for (k, sample) in track.samples.iter().enumerate() {
        let axis = usize::from(sample.axis.x.abs() < 0.5);
        if !sample.is_exact {
            return None;
        }
        match sides.last_mut() {
            Some(side) if side.axis == axis && (at(side.first, axis) - at(k, axis)).abs() < SAME => {
                (side.last, side.weight) = (k, side.weight + track.weights[k]);
            }
            _ => sides.push(Side { axis, first: k, last: k, weight: track.weights[k] }),
        }
    }
    // The walk may begin within a side.
    if let [first, .., last] = sides[..]
        && first.axis == last.axis
        && (at(first.first, first.axis) - at(last.first, last.axis)).abs() < SAME
    {
        sides[0] = Side { first: last.first, weight: first.weight + last.weight, ..first };
        sides.pop();
    }
    let turns = |k: usize| sides[k].axis != sides[(k + 1) % sides.len()].axis;
    (0..sides.len()).all(turns).then_some(sides)
}

/// Where two sides meet; none if that is hidden and not ahead of what is seen of both.
fn corner(track: &Track, before: Side, behind: Side) -> Option<[f64; 2]> {
    let (leaves, arrives) = (track.point(before.last).to_array(), track.point(behind.first).to_array());
    let mut corner = leaves;
    corner[before.axis] = track.point(before.first).to_array()[before.axis];
    corner[behind.axis] = arrives[behind.axis];
    if track.is_hidden(before.last, behind.first) {
        let [start, end] = [track.point(before.first), track.point(behind.last)].map(|point| point.to_array());
        let (along, across) = (behind.axis, before.axis);
        let leads = (leaves[along] - start[along]) * (corner[along] - leaves[along]);
        let returns = (end[across] - arrives[across]) * (arrives[across] - corner[across]);
        if leads <= 0.0 || returns <= 0.0 {
            return None;
        }
    }
    Some(corner)
}
