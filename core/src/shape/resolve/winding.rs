//! Which edges bound the inside.

use alloc::vec::Vec;

use super::FillRule;
use super::grid::{Edge, Node, cross};

/// An edge with the inside on the side to which its direction turns from +x to +y.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kept {
    pub(super) from: Node,
    pub(super) to: Node,
    pub(super) source: u32,
}

/// The edges with the inside on one side only, one of each set of coincident ones, sorted by where they start.
pub(super) fn keep(mut edges: Vec<Edge>, rule: FillRule) -> Vec<Kept> {
    edges.sort_unstable_by_key(|edge| (edge.low, edge.high, edge.source));
    edges.dedup_by(|next, kept| {
        let same = (next.low, next.high) == (kept.low, kept.high);
        if same {
            kept.count += next.count;
        }
        same
    });
    edges.retain(|edge| edge.count != 0);
    let mut kept = Vec::with_capacity(edges.len());
    for (edge, below) in edges.iter().zip(windings_below(&edges)) {
        let [inside_below, inside_above] = [below, below + edge.count].map(|winding| rule.is_inside(winding));
        if inside_below != inside_above {
            let (from, to) = if inside_above { (edge.low, edge.high) } else { (edge.high, edge.low) };
            kept.push(Kept { from, to, source: edge.source });
        }
    }
    kept.sort_unstable_by_key(|edge| (edge.from, edge.to));
    kept
}

/// The winding number beside each edge on the side of smaller y (of a vertical edge, of greater x): the sum over the
/// edges that a ray from its middle to smaller y crosses. `edges` are sorted by their low ends.
///
/// The ray leans to greater x by less than any number, so that it meets no vertex: an edge is in its way if the middle
/// comes after its low and before its high end in the order of x, then y.
fn windings_below(edges: &[Edge]) -> Vec<i32> {
    let mut order: Vec<(Node2, usize)> = edges.iter().map(middle).zip(0..).collect();
    order.sort_unstable();
    let mut windings = alloc::vec![0; edges.len()];
    let mut active: Vec<Active> = Vec::new();
    let mut coming = edges.iter().zip(0..).peekable();
    for (point, i) in order {
        while let Some((edge, index)) = coming.next_if(|(edge, _)| double(edge.low) <= point) {
            let [low, high] = [edge.low, edge.high].map(double);
            active.push(Active { low, high, index, count: edge.count });
        }
        let mut k = 0;
        while let Some(edge) = active.get(k) {
            if edge.high <= point {
                active.swap_remove(k);
                continue;
            }
            if edge.index != i && edge.is_below(point) {
                windings[i] += edge.count;
            }
            k += 1;
        }
    }
    windings
}

/// A point in doubled coordinates.
type Node2 = [i64; 2];

fn double(node: Node) -> Node2 {
    node.map(|value| 2 * i64::from(value))
}

fn middle(edge: &Edge) -> Node2 {
    [0, 1].map(|axis| i64::from(edge.low[axis]) + i64::from(edge.high[axis]))
}

/// An edge that a ray may cross, in doubled coordinates.
struct Active {
    low: Node2,
    high: Node2,
    index: usize,
    count: i32,
}

impl Active {
    /// Whether the edge lies on the side of smaller y of `point`, which is between its ends.
    fn is_below(&self, point: Node2) -> bool {
        let Self { low, high, .. } = self;
        if low[1].max(high[1]) < point[1] {
            return true;
        }
        if low[1].min(high[1]) > point[1] {
            return false;
        }
        cross([high[0] - low[0], high[1] - low[1]], [point[0] - low[0], point[1] - low[1]]) > 0
    }
}
