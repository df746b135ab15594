//! Squares that are drawn with a pen: what is seen of one tells how large it is, how wide its sides are, and with these what is hidden.
//!
//! An upright frame has eight sides and four numbers: its middle, and half the size of the square and of its opening. Of the sides that look one
//! way, two of them at most, the outer one lies farther out; where one alone is seen it may be either.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::sort;

use super::complete::Completed;
use crate::elimination::solve;
use crate::outline::{Outline, OutlineShape};
use crate::sample::Sample;

/// Steps of samples to both sides that tell the direction of a boundary.
const BESIDE: usize = 1;
/// Fewest samples of a side.
const FEWEST: usize = 3;
/// Pixels that samples of one side are apart, and sides off the frame.
const STRAIGHT: f64 = 0.25;
/// Least width of a frame, pixels.
const LEAST_WIDTH: f64 = 1.0;
/// Least size of an opening, pixels.
const LEAST_OPENING: f64 = 1.0;

/// A side of a frame: a place on one of the two axes.
#[derive(Clone, Copy)]
struct Side {
    axis: usize,
    place: f64,
    /// Whether it looks to greater places.
    is_after: bool,
    /// Whether it is one of the square, not of the opening.
    is_outer: bool,
}

/// The frames that what is seen of a boundary may be of, run by run in the order of the walk.
pub(super) fn frames(runs: &[&Vec<Sample>]) -> Vec<Completed> {
    let mut ways: Vec<Vec<Side>> = vec![Vec::new()];
    for (axis, is_after) in [(0, false), (0, true), (1, false), (1, true)] {
        let side = |place, is_outer| Side { axis, place, is_after, is_outer };
        let choices: Vec<Vec<Side>> = match places(runs, axis, is_after)[..] {
            [] => continue,
            [one] => [true, false].map(|is_outer| vec![side(one, is_outer)]).into(),
            // What looks to smaller places is the near side of the square, and the far one of the opening.
            [first, second] => vec![vec![side(first, !is_after), side(second, is_after)]],
            _ => return Vec::new(),
        };
        let with = |way: &Vec<Side>, choice: &Vec<Side>| way.iter().chain(choice).copied().collect();
        ways = ways.iter().flat_map(|way| choices.iter().map(move |choice| with(way, choice))).collect();
    }
    ways.iter().filter_map(|sides| frame(sides)).collect()
}

/// Places of the sides along an axis that look one way.
fn places(runs: &[&Vec<Sample>], axis: usize, is_after: bool) -> Vec<f64> {
    let along = |from: Vec2<f64>, to: Vec2<f64>| {
        let step = to - from;
        // The object lies to where +x is turned into +y.
        let [off, outward] = if axis == 0 { [step.x, step.y] } else { [step.y, -step.x] };
        off.abs() < 0.5 * STRAIGHT && (outward > 0.0) == is_after
    };
    let mut all: Vec<f64> = Vec::new();
    for run in runs {
        for k in BESIDE..run.len().saturating_sub(BESIDE) {
            if along(run[k - BESIDE].point, run[k + BESIDE].point) {
                all.push(run[k].point.to_array()[axis]);
            }
        }
    }
    sort::ascending(&mut all, |&place| place);
    let sides = all.chunk_by(|a, b| b - a < STRAIGHT).filter(|side| side.len() >= FEWEST);
    sides.map(|side| side[side.len() / 2]).collect()
}

/// The frame through some sides; none if they do not tell it, or are of none.
fn frame(sides: &[Side]) -> Option<Completed> {
    // Numbers: the middle, half the square, half the opening.
    let row = |side: &Side| {
        let mut row = [0.0; 4];
        row[side.axis] = 1.0;
        // Of the opening the far side looks back.
        row[if side.is_outer { 2 } else { 3 }] = if side.is_after == side.is_outer { 1.0 } else { -1.0 };
        row
    };
    let mut matrix = [[0.0; 4]; 4];
    let mut right = [0.0; 4];
    for side in sides {
        let row = row(side);
        for i in 0..4 {
            right[i] += row[i] * side.place;
            for j in 0..4 {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    let numbers = solve(matrix, right)?;
    let [x, y, square, opening] = numbers;
    let off = |side: &Side| row(side).iter().zip(numbers).map(|(a, b)| a * b).sum::<f64>() - side.place;
    let is_frame = 2.0 * opening > LEAST_OPENING
        && square > opening + LEAST_WIDTH
        && sides.iter().all(|side| off(side).abs() < STRAIGHT);
    let outline = |half: f64| Outline {
        shape: OutlineShape::Rectangle {
            center: Vec2::new(x, y),
            size: [2.0 * half; 2],
            corner_radius: 0.0,
            angle: 0.0,
        },
        bits: 0.0,
        misfit: 0.0,
        covariance: Vec::new(),
    };
    is_frame.then(|| Completed::new([square, opening].map(outline).into(), true))
}
