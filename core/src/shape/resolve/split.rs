//! Edges cut where they meet, until they meet at their ends only.

use alloc::vec::Vec;

use num_traits::Float;

use super::grid::{Edge, Node, cross, difference, dot};

/// Most passes over all edges. Cutting bends edges by up to a cell, so that they may meet others anew; two or three passes
/// are the rule, and after the last one a crossing that is left costs a wrong winding within a cell of it.
const MOST_PASSES: usize = 32;

/// An edge, how far along it, and where it is cut.
type Cut = (usize, i64, Node);

/// Cuts edges where they cross and where they touch the end of another.
pub(super) fn split(edges: &mut Vec<Edge>) {
    let (mut cuts, mut active) = (Vec::new(), [Vec::new(), Vec::new()]);
    for _ in 0..MOST_PASSES {
        edges.sort_unstable_by_key(|edge| (edge.low, edge.high, edge.source));
        find_cuts(edges, &mut active, &mut cuts);
        if cuts.is_empty() {
            return;
        }
        cuts.sort_unstable();
        cuts.dedup();
        apply(edges, &cuts);
        cuts.clear();
    }
}

/// An edge that the sweep has reached and not passed: its number, where it ends, and its least and greatest y.
#[derive(Clone, Copy)]
struct Active {
    index: usize,
    end: i32,
    heights: [i32; 2],
}

/// From left to right over the edges, each against those that have not ended; two that are settled are not compared, so
/// that settled and others are in lists of their own.
fn find_cuts(edges: &[Edge], active: &mut [Vec<Active>; 2], cuts: &mut Vec<Cut>) {
    active.iter_mut().for_each(Vec::clear);
    for (i, edge) in edges.iter().enumerate() {
        let [top, bottom] = heights(edge);
        let (unsettled, settled) = active.split_at_mut(1);
        meet_all(edges, i, [top, bottom], &mut unsettled[0], cuts);
        if !edge.is_settled {
            meet_all(edges, i, [top, bottom], &mut settled[0], cuts);
        }
        active[usize::from(edge.is_settled)].push(Active { index: i, end: edge.high[0], heights: [top, bottom] });
    }
}

/// An edge against those of a list, from which those are taken out that ended before it.
fn meet_all(edges: &[Edge], i: usize, [top, bottom]: [i32; 2], active: &mut Vec<Active>, cuts: &mut Vec<Cut>) {
    let mut k = 0;
    while let Some(&Active { index, end, heights: [other_top, other_bottom] }) = active.get(k) {
        // An end touches an edge within half a cell of it.
        if end < edges[i].low[0] - 1 {
            active.swap_remove(k);
            continue;
        }
        if other_top <= bottom + 1 && top <= other_bottom + 1 {
            meet(edges, index, i, cuts);
        }
        k += 1;
    }
}

/// Least and greatest y.
fn heights(edge: &Edge) -> [i32; 2] {
    [edge.low[1].min(edge.high[1]), edge.low[1].max(edge.high[1])]
}

/// Adds the cuts of two edges.
fn meet(edges: &[Edge], i: usize, j: usize, cuts: &mut Vec<Cut>) {
    let [first, second] = [&edges[i], &edges[j]];
    let of_second = Sides::new(first, second);
    if of_second.are_apart() {
        return;
    }
    let of_first = Sides::new(second, first);
    if of_first.are_apart() {
        return;
    }
    let before = cuts.len();
    for (edge, other, sides, index) in [(first, second, &of_second, i), (second, first, &of_first, j)] {
        for (end, is_near) in [other.low, other.high].into_iter().zip(sides.is_near) {
            if is_near && is_between(edge, end) {
                cuts.push((index, along(edge, end), end));
            }
        }
    }
    if cuts.len() > before || !(of_second.are_opposite() && of_first.are_opposite()) {
        return;
    }
    let node = crossing(second, of_second.sides);
    for (edge, index) in [(first, i), (second, j)] {
        if node != edge.low && node != edge.high {
            cuts.push((index, along(edge, node), node));
        }
    }
}

/// On which sides of an edge the ends of another lie.
struct Sides {
    /// Positive on the side to which the edge turns from +x to +y; the distance times the length of the edge.
    sides: [i64; 2],
    /// Whether the line through the edge passes within half a cell, measured along the axis that it runs across.
    is_near: [bool; 2],
}

impl Sides {
    fn new(edge: &Edge, other: &Edge) -> Self {
        let direction = difference(edge.high, edge.low);
        let sides = [other.low, other.high].map(|end| cross(direction, difference(end, edge.low)));
        let reach = direction[0].abs().max(direction[1].abs());
        Self { sides, is_near: sides.map(|side| 2 * side.abs() <= reach) }
    }

    /// Whether both ends are off the line, on the same side.
    fn are_apart(&self) -> bool {
        !self.is_near[0] && !self.is_near[1] && (self.sides[0] < 0) == (self.sides[1] < 0)
    }

    /// Whether the line passes between the ends.
    fn are_opposite(&self) -> bool {
        self.sides[0] != 0 && self.sides[1] != 0 && (self.sides[0] < 0) != (self.sides[1] < 0)
    }
}

/// How far along an edge a node is, times the length of the edge.
fn along(edge: &Edge, node: Node) -> i64 {
    dot(difference(edge.high, edge.low), difference(node, edge.low))
}

/// Whether a node that is near an edge lies between its ends.
fn is_between(edge: &Edge, node: Node) -> bool {
    let direction = difference(edge.high, edge.low);
    let along = dot(direction, difference(node, edge.low));
    node != edge.low && node != edge.high && along > 0 && along < dot(direction, direction)
}

/// Where `edge` crosses another, given the sides of that one on which its ends lie.
#[expect(clippy::cast_possible_truncation, clippy::cast_precision_loss, reason = "a node between two nodes")]
fn crossing(edge: &Edge, [low, high]: [i64; 2]) -> Node {
    let share = low as f64 / (low as f64 - high as f64);
    [0, 1].map(|axis| {
        let (from, to) = (f64::from(edge.low[axis]), f64::from(edge.high[axis]));
        Float::round(from + share * (to - from)) as i32
    })
}

/// Replaces every edge that is cut by its parts.
fn apply(edges: &mut Vec<Edge>, cuts: &[Cut]) {
    let count = edges.len();
    edges.iter_mut().for_each(|edge| edge.is_settled = true);
    for group in cuts.chunk_by(|a, b| a.0 == b.0) {
        let index = group[0].0;
        let whole = edges[index];
        let stops = group.iter().map(|&(_, _, node)| node).chain(core::iter::once(whole.high));
        let mut from = whole.low;
        let mut is_first = true;
        for to in stops.filter(|&node| node != whole.low) {
            // Rounding may turn a part of a steep edge around.
            let (low, high, sign) = if from < to { (from, to, 1) } else { (to, from, -1) };
            if low != high {
                let part = Edge { low, high, count: sign * whole.count, is_settled: false, ..whole };
                if is_first {
                    edges[index] = part;
                    is_first = false;
                } else {
                    edges.push(part);
                }
            }
            from = to;
        }
    }
    debug_assert!(edges.len() >= count, "parts were lost");
}
