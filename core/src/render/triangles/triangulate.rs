//! From an outline to the triangles of its interior.

use alloc::vec::Vec;

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::real::Real;

/// A triangle: three indices into the outline.
pub type Face = [usize; 3];

/// What a triangulation had to leave out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TriangulationReport {
    /// Edges of the outline that cross an earlier edge. Near them the triangles follow the Delaunay edges instead of the
    /// outline; 0 for simple outlines.
    pub crossing_edges: usize,
    /// Vertices that the triangulation refused (beyond 2^201 pixels).
    pub refused_vertices: usize,
}

/// Where the triangles of an outline come from.
pub trait Triangulate {
    /// Writes the triangles of the interior of the closed `outline` to `faces`. Coverage is the largest of all triangles,
    /// so that their order has no effect.
    fn triangulate<T: Real>(&self, outline: &[[T; 2]], faces: &mut Vec<Face>) -> TriangulationReport;
}

/// Constrained Delaunay triangulation; inside is where the centroid of a triangle lies inside the outline under the even-odd
/// rule.
///
/// Never panics: an edge that crosses an earlier one is left out and counted, coincident vertices become one (the first
/// of them stands in the faces), and an outline without area has no faces. Allocates.
///
/// *Source*: the crate spade. The reference cuts ears instead, so its interior edges, and with them the faint seams
/// of soft triangles, run elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Delaunay;

impl Triangulate for Delaunay {
    fn triangulate<T: Real>(&self, outline: &[[T; 2]], faces: &mut Vec<Face>) -> TriangulationReport {
        faces.clear();
        let mut report = TriangulationReport::default();
        let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        // Spade numbers its vertices in the order in which they appear; this maps them back to the outline.
        let mut first_seen = Vec::with_capacity(outline.len());
        let mut handles = Vec::with_capacity(outline.len());
        for (k, &[x, y]) in outline.iter().enumerate() {
            let point = spade::mitigate_underflow(Point2::new(x.as_f64(), y.as_f64()));
            match mesh.insert(point) {
                Ok(handle) => {
                    if handle.index() == first_seen.len() {
                        first_seen.push(k);
                    }
                    handles.push(handle);
                }
                Err(_) => report.refused_vertices += 1,
            }
        }
        let Some(&last) = handles.last() else { return report };
        let mut from = last;
        for &to in &handles {
            if from != to && mesh.try_add_constraint(from, to).is_empty() && !mesh.exists_constraint(from, to) {
                report.crossing_edges += 1;
            }
            from = to;
        }
        for face in mesh.inner_faces() {
            let [a, b, c] = face.vertices().map(|vertex| first_seen[vertex.fix().index()]);
            let third = T::of(1.0 / 3.0);
            let centroid = [0, 1].map(|i| third * outline[a][i] + third * outline[b][i] + third * outline[c][i]);
            if is_inside(outline, centroid) {
                faces.push([a, b, c]);
            }
        }
        report
    }
}

/// Whether a point lies inside a closed outline under the even-odd rule.
fn is_inside<T: Real>(outline: &[[T; 2]], [x, y]: [T; 2]) -> bool {
    let mut inside = false;
    let Some(&last) = outline.last() else { return false };
    let mut a = last;
    for &b in outline {
        if (a[1] <= y) != (b[1] <= y) {
            let t = (y - a[1]) / (b[1] - a[1]);
            if x > a[0] + t * (b[0] - a[0]) {
                inside = !inside;
            }
        }
        a = b;
    }
    inside
}
