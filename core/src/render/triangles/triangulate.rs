//! From rings to the triangles of what they enclose.

use alloc::vec;
use alloc::vec::Vec;

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use crate::real::Real;
use crate::render::even_odd::{Probe, Probes};
use crate::shape::Rings;

/// A triangle: three indices into the vertices of all rings.
pub type Face = [usize; 3];

/// What a triangulation had to leave out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
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
        let mut handles = vec![None; rings.vertices.len()];
        for ring in rings.ranges().filter(|ring| ring.len() >= 3) {
            for k in coarse_to_fine(ring.len()).map(|k| ring.start + k) {
                let [x, y] = rings.vertices[k].map(Real::as_f64);
                handles[k] = mesh.insert(spade::mitigate_underflow(Point2::new(x, y))).ok();
            }
            report.refused_vertices += handles[ring].iter().filter(|handle| handle.is_none()).count();
        }
        // The first vertex at each place.
        let mut first = vec![0; mesh.num_vertices()];
        for (k, handle) in handles.iter().enumerate().rev() {
            if let Some(handle) = handle {
                first[handle.index()] = k;
            }
        }
        for ring in rings.ranges() {
            let mut ends = handles[ring].iter().flatten().copied();
            let Some(mut from) = ends.clone().next_back() else { continue };
            for to in &mut ends {
                if from != to && mesh.try_add_constraint(from, to).is_empty() && !mesh.exists_constraint(from, to) {
                    report.crossing_edges += 1;
                }
                from = to;
            }
        }
        let third = T::of(1.0 / 3.0);
        let mut centroids = Probes::default();
        centroids.fill(mesh.inner_faces().map(|face| {
            let corners = face.vertices().map(|vertex| first[vertex.fix().index()]);
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

/// The numbers below `count`: 0, then those in the middle of gaps between earlier ones. Vertices one after the other along a
/// ring would make long triangles that are flipped again and again, which takes a time that grows as their square.
pub(super) fn coarse_to_fine(count: usize) -> impl Iterator<Item = usize> {
    let coarsest = count.next_power_of_two().max(2) / 2;
    let steps = core::iter::successors(Some(coarsest), |&step| (step > 1).then_some(step / 2));
    (0..count.min(1)).chain(steps.flat_map(move |step| (step..count).step_by(2 * step)))
}
