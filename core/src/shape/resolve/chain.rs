//! Directed edges joined to rings.

use alloc::vec;

use super::grid::{Grid, cross, difference, dot};
use super::winding::Kept;
use super::{Origin, Resolved};
use crate::geometry::Vec2;
use crate::real::Real;

/// Joins edges, sorted by where they start, to rings; `next` is the input vertex after each.
pub(super) fn chain<T: Real>(edges: &[Kept], next: &[u32], grid: &Grid, vertices: &[[T; 2]]) -> Resolved<T> {
    let mut resolved = Resolved::default();
    let mut is_used = vec![false; edges.len()];
    for start in 0..edges.len() {
        if is_used[start] {
            continue;
        }
        let first = resolved.origins.len();
        let mut current = start;
        loop {
            is_used[current] = true;
            let following = follow(edges, &is_used, start, current);
            // Without a successor (a crossing that was left) the ring is closed straight.
            let after = following.unwrap_or(start);
            resolved.origins.extend(origin(edges[current], edges[after], next, grid, vertices));
            if after == start {
                break;
            }
            current = after;
        }
        if resolved.origins.len() < first + 3 {
            resolved.origins.truncate(first);
            continue;
        }
        if grid.is_transposed {
            // What turns from +x to +y there turns from +y to +x here.
            resolved.origins[first..].reverse();
        }
        if first > 0 {
            resolved.breaks.push(first);
        }
    }
    resolved
}

/// The edge that goes on where `current` ends: of those that start there, the one that bounds the same part of the inside. That
/// is the first one met on a turn from `current`, seen backward, through the inside.
fn follow(edges: &[Kept], is_used: &[bool], start: usize, current: usize) -> Option<usize> {
    let Kept { from, to, .. } = edges[current];
    let back = difference(from, to);
    let begin = edges.partition_point(|edge| edge.from < to);
    let candidates = (begin..edges.len()).take_while(|&i| edges[i].from == to);
    candidates.filter(|&i| i == start || !is_used[i]).min_by(|&i, &j| {
        let [a, b] = [i, j].map(|k| difference(edges[k].to, to));
        // From +y to +x less than half a turn away, half a turn, more, a whole one.
        let rank = |direction| match cross(back, direction) {
            0 if dot(back, direction) < 0 => 1,
            0 => 3,
            turn if turn < 0 => 0,
            _ => 2,
        };
        rank(a).cmp(&rank(b)).then(cross(a, b).cmp(&0))
    })
}

/// Where the vertex between two edges comes from; none if it lies within one input edge.
fn origin<T: Real>(before: Kept, after: Kept, next: &[u32], grid: &Grid, vertices: &[[T; 2]]) -> Option<Origin<T>> {
    if before.source == after.source {
        return None;
    }
    let node = before.to;
    let [first, second] = [before.source, after.source].map(|source| [source as usize, next[source as usize] as usize]);
    let is_here = |vertex: &&usize| grid.node(vertices[**vertex]) == node;
    // A vertex of both if there is one.
    let shared = first.iter().filter(|vertex| second.contains(vertex)).find(is_here);
    if let Some(&vertex) = shared.or_else(|| first.iter().chain(&second).find(is_here)) {
        return Some(Origin::Vertex(vertex));
    }
    let crossing = Origin::Crossing([first, second]);
    let [x, y] = grid.point(node);
    let point = Vec2::new(T::of(x), T::of(y));
    if (crossing.place(vertices) - point).length() <= reach([first, second], point, grid, vertices) {
        return Some(crossing);
    }
    // Nearly parallel edges that meet somewhere within the grid's precision: the place on one of them stands.
    let [from, to] = first.map(|vertex| Vec2::from(vertices[vertex]));
    let share = (point - from).dot(to - from) / (to - from).length_squared();
    Some(Origin::Along { edge: first, share: share.max(T::zero()).min(T::one()) })
}

/// How far the crossing of two input edges may lie from the node that stands for it.
fn reach<T: Real>(edges: [[usize; 2]; 2], node: Vec2<T>, grid: &Grid, vertices: &[[T; 2]]) -> T {
    let [first, second] = edges.map(|[from, to]| Vec2::from(vertices[to]) - Vec2::from(vertices[from]));
    let sine = (first.cross(second) / (first.length() * second.length())).abs();
    let rounding = (node.x.abs() + node.y.abs()) * T::epsilon();
    (T::of(grid.cell()) + rounding) * T::of(BENT) / sine.max(T::of(LEAST_SINE))
}

/// How many cells the two edges at a crossing may have been bent, added up; the crossing moves by that over the sine of the
/// angle between them.
const BENT: f64 = 4.0;

/// Sine of the angle below which two edges count as parallel: their crossing may be anywhere, and where it is hardly matters
/// to what they enclose.
const LEAST_SINE: f64 = 1e-3;
