//! Vertices and edges in whole numbers.

use alloc::vec::Vec;

use num_traits::Float;

use crate::geometry::Bounds;
use crate::real::Real;
use crate::shape::{Rings, ShapeError};

/// Cells of the grid from the middle to its border: cross products of differences stay far below 2^63.
const HALF_SIZE: f64 = 268_435_456.0;

/// A point of the grid.
pub(super) type Node = [i32; 2];

/// A piece of an input edge, from its end of smaller x (at equal x, smaller y) to the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Edge {
    pub(super) low: Node,
    pub(super) high: Node,
    /// How often input edges run here from low to high, less how often back.
    pub(super) count: i32,
    /// The first vertex of the input edge.
    pub(super) source: u32,
    /// Whether it was looked at before: two edges that were need not be compared again.
    pub(super) is_settled: bool,
}

/// How coordinates become whole numbers.
pub(super) struct Grid {
    center: [f64; 2],
    scale: f64,
    /// Whether x and y change places: edges are swept along the longer side of what they enclose, so that few are in the way at a time.
    pub(super) is_transposed: bool,
}

/// The edges of rings.
pub(super) struct Sources {
    pub(super) edges: Vec<Edge>,
    /// The vertex after each.
    pub(super) next: Vec<u32>,
}

impl Grid {
    /// A grid that the vertices just fit on; none if they are all the same.
    pub(super) fn around<T: Real>(vertices: &[[T; 2]]) -> Result<Option<Self>, ShapeError> {
        if let Some(index) = vertices.as_flattened().iter().position(|value| !value.is_finite()) {
            return Err(ShapeError::NotFinite { index });
        }
        let Some(bounds) = Bounds::of(vertices.iter().map(|vertex| vertex.map(Real::as_f64).into())) else {
            return Ok(None);
        };
        let half = bounds.size() * 0.5;
        let scale = HALF_SIZE / Float::max(half.x, half.y);
        if vertices.len() > u32::MAX as usize || !half.is_finite() {
            return Err(ShapeError::TooLarge);
        }
        let center = bounds.center().to_array();
        Ok(scale.is_finite().then_some(Self { center, scale, is_transposed: half.y > half.x }))
    }

    #[expect(clippy::cast_possible_truncation, reason = "within the grid by construction, and saturating")]
    pub(super) fn node<T: Real>(&self, vertex: [T; 2]) -> Node {
        let [x, y] = [0, 1].map(|axis| {
            let value = (vertex[axis].as_f64() - self.center[axis]) * self.scale;
            Float::round(value) as i32
        });
        if self.is_transposed { [y, x] } else { [x, y] }
    }

    /// Where a node is.
    pub(super) fn point(&self, node: Node) -> [f64; 2] {
        let [x, y] = if self.is_transposed { [node[1], node[0]] } else { node };
        [f64::from(x) / self.scale + self.center[0], f64::from(y) / self.scale + self.center[1]]
    }

    /// The width of a cell.
    pub(super) fn cell(&self) -> f64 {
        self.scale.recip()
    }

    /// The edges of rings that have a length.
    #[expect(clippy::cast_possible_truncation, reason = "numbers of vertices were checked")]
    pub(super) fn edges<T: Real>(&self, rings: Rings<'_, T>) -> Sources {
        let nodes: Vec<Node> = rings.vertices.iter().map(|&vertex| self.node(vertex)).collect();
        let mut next: Vec<u32> = (1..=nodes.len() as u32).collect();
        let mut edges = Vec::with_capacity(2 * nodes.len());
        for range in rings.ranges().filter(|range| !range.is_empty()) {
            next[range.end - 1] = range.start as u32;
            edges.extend(range.filter_map(|i| Edge::new(nodes[i], nodes[next[i] as usize], i as u32)));
        }
        Sources { edges, next }
    }
}

impl Edge {
    /// None if it has no length.
    fn new(from: Node, to: Node, source: u32) -> Option<Self> {
        let (low, high, count) = if from < to { (from, to, 1) } else { (to, from, -1) };
        (low != high).then_some(Self { low, high, count, source, is_settled: false })
    }
}

/// The difference of two nodes.
pub(super) fn difference(to: Node, from: Node) -> [i64; 2] {
    [0, 1].map(|axis| i64::from(to[axis]) - i64::from(from[axis]))
}

/// a x b: positive if b lies a turn from +x to +y further on.
pub(super) fn cross(a: [i64; 2], b: [i64; 2]) -> i64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn dot(a: [i64; 2], b: [i64; 2]) -> i64 {
    a[0] * b[0] + a[1] * b[1]
}
