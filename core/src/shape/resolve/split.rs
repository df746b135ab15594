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
    let (mut cuts, mut active) = (Vec::new(), Vec::new());
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

/// From left to right over the edges, each against those that have not ended.
fn find_cuts(edges: &[Edge], active: &mut Vec<usize>, cuts: &mut Vec<Cut>) {
    active.clear();
    for (i, edge) in edges.iter().enumerate() {
        // An end touches an edge within half a cell of it.
        active.retain(|&other| edges[other].high[0] >= edge.low[0] - 1);
        let [top, bottom] = heights(edge);
        for &other in &*active {
            let [other_top, other_bottom] = heights(&edges[other]);
            let apart = other_top > bottom + 1 || top > other_bottom + 1;
            if !(apart || edge.is_settled && edges[other].is_settled) {
                meet(edges, other, i, cuts);
            }
        }
        active.push(i);
    }
}

/// Least and greatest y.
fn heights(edge: &Edge) -> [i32; 2] {
    [edge.low[1].min(edge.high[1]), edge.low[1].max(edge.high[1])]
}

/// Adds the cuts of two edges.
fn meet(edges: &[Edge], i: usize, j: usize, cuts: &mut Vec<Cut>) {
    let [first, second] = [&edges[i], &edges[j]];
    let sides = [sides(first, second), sides(second, first)];
    let before = cuts.len();
    for (edge, other, of_ends, index) in [(first, second, sides[0], i), (second, first, sides[1], j)] {
        for (end, side) in [other.low, other.high].into_iter().zip(of_ends) {
            if touches(edge, end, side) {
                cuts.push((index, along(edge, end), end));
            }
        }
    }
    let opposite = |[low, high]: [i64; 2]| low != 0 && high != 0 && (low < 0) != (high < 0);
    if cuts.len() > before || !(opposite(sides[0]) && opposite(sides[1])) {
        return;
    }
    let node = crossing(second, sides[0]);
    for (edge, index) in [(first, i), (second, j)] {
        if node != edge.low && node != edge.high {
            cuts.push((index, along(edge, node), node));
        }
    }
}

/// On which side of `edge` the ends of `other` lie.
fn sides(edge: &Edge, other: &Edge) -> [i64; 2] {
    let direction = difference(edge.high, edge.low);
    [other.low, other.high].map(|end| cross(direction, difference(end, edge.low)))
}

/// How far along an edge a node is, times the length of the edge.
fn along(edge: &Edge, node: Node) -> i64 {
    dot(difference(edge.high, edge.low), difference(node, edge.low))
}

/// Whether an edge passes within half a cell of a node (measured along the axis that it runs across), between its own ends.
fn touches(edge: &Edge, node: Node, side: i64) -> bool {
    if node == edge.low || node == edge.high {
        return false;
    }
    let direction = difference(edge.high, edge.low);
    let along = dot(direction, difference(node, edge.low));
    2 * side.abs() <= direction[0].abs().max(direction[1].abs()) && along > 0 && along < dot(direction, direction)
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
