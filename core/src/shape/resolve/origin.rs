//! Where the vertices of resolved rings come from.

use crate::geometry::Vec2;
use crate::real::Real;

/// Where a vertex comes from, in indices of the vertices that came in. *Derivative*: [`Origin::place_vjp`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::shape) enum Origin<T> {
    /// A vertex.
    Vertex(usize),
    /// The crossing of the lines through two pairs of vertices.
    Crossing([[usize; 2]; 2]),
    /// The point a fixed share of the way from one vertex to another.
    Along {
        /// The two vertices.
        edge: [usize; 2],
        /// 0 for the first, 1 for the second.
        share: T,
    },
}

impl<T: Real> Origin<T> {
    /// Where the vertex is; not finite for the crossing of parallel lines.
    pub(in crate::shape) fn place(&self, vertices: &[[T; 2]]) -> Vec2<T> {
        let at = |vertex: usize| Vec2::from(vertices[vertex]);
        match *self {
            Self::Vertex(vertex) => at(vertex),
            Self::Crossing([first, second]) => line_crossing([first, second].map(|edge| edge.map(at))),
            Self::Along { edge: [from, to], share } => at(from).lerp(at(to), share),
        }
    }
}

/// Where two lines cross, each given by two points. *Derivative*:
/// [`line_crossing_vjp`](super::line_crossing_vjp).
pub(in crate::shape) fn line_crossing<T: Real>([[a, b], [c, d]]: [[Vec2<T>; 2]; 2]) -> Vec2<T> {
    a + (b - a) * ((c - a).cross(d - c) / (b - a).cross(d - c))
}
