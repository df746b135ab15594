//! From rings to the triangles of what they enclose.

use alloc::vec::Vec;

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::real::Real;
use crate::render::even_odd::{Probe, Probes};
use crate::shape::Rings;

/// A triangle: three indices into the vertices of all rings.
pub type Face = [usize; 3];

/// What a triangulation had to leave out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TriangulationReport {
    /// Edges that cross an earlier edge, of any ring. Near them the triangles follow the Delaunay edges instead of the
    /// rings; 0 for rings that cross neither themselves nor each other.
    pub crossing_edges: usize,
    /// Vertices that the triangulation refused (beyond 2^201 pixels).
    pub refused_vertices: usize,
}

/// Where the triangles of an object come from.
pub trait Triangulate {
    /// Writes the triangles of what lies inside of an odd number of `rings` to `faces`. Coverage is the largest of all
    /// triangles, so that their order has no effect.
    fn triangulate<T: Real>(&self, rings: Rings<'_, T>, faces: &mut Vec<Face>) -> TriangulationReport;
}

/// Constrained Delaunay triangulation; inside is where the centroid of a triangle lies inside of an odd number of rings.
///
/// Never panics: an edge that crosses an earlier one is left out and counted, coincident vertices become one (the first
/// of them stands in the faces), a ring of fewer than three vertices is none, and rings without area have no faces. Allocates.
///
/// *Source*: the crate spade. The reference cuts ears instead, so its interior edges, and with them the faint seams
/// of soft triangles, run elsewhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Delaunay;

impl Triangulate for Delaunay {
    fn triangulate<T: Real>(&self, rings: Rings<'_, T>, faces: &mut Vec<Face>) -> TriangulationReport {
        faces.clear();
        let mut report = TriangulationReport::default();
        let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        // Spade numbers its vertices in the order in which they appear; this maps them back to the rings.
        let mut first_seen = Vec::with_capacity(rings.vertices.len());
        let mut handles = Vec::new();
        for ring in rings.ranges().filter(|ring| ring.len() >= 3) {
            handles.clear();
            for (k, &[x, y]) in ring.clone().zip(&rings.vertices[ring]) {
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
            let Some(&last) = handles.last() else { continue };
            let mut from = last;
            for &to in &handles {
                if from != to && mesh.try_add_constraint(from, to).is_empty() && !mesh.exists_constraint(from, to) {
                    report.crossing_edges += 1;
                }
                from = to;
            }
        }
        let third = T::of(1.0 / 3.0);
        let mut centroids = Probes::default();
        centroids.fill(mesh.inner_faces().map(|face| {
            let corners = face.vertices().map(|vertex| first_seen[vertex.fix().index()]);
            let [a, b, c] = corners.map(|k| rings.vertices[k]);
            Probe::new([0, 1].map(|i| third * a[i] + third * b[i] + third * c[i]), corners)
        }));
        for ring in rings.iter().filter(|ring| ring.len() >= 3) {
            centroids.cross(ring, |_| true);
        }
        faces.extend(centroids.iter().filter(|centroid| centroid.inside).map(|centroid| centroid.owner));
        report
    }
}
