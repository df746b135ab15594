use alloc::vec;
use alloc::vec::Vec;

use super::triangulate::coarse_to_fine;
use super::{Delaunay, Face, SoftTriangles, Triangulate, TriangulationReport};
use crate::dims::ImageSize;
use crate::render::triangles::TriangleScratch;
use crate::render::{Compositing, EdgeProfile, RenderError, TileRenderer};
use crate::scene::Drawing;
use crate::shape::{Outline, Rings};

/// Sum of the areas of the faces.
fn area(outline: &[[f64; 2]], faces: &[Face]) -> f64 {
    let doubled = faces.iter().map(|face| {
        let [a, b, c] = face.map(|k| outline[k]);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    });
    doubled.sum::<f64>() / 2.0
}

fn triangulate(outline: &[[f64; 2]]) -> (Vec<Face>, TriangulationReport) {
    triangulate_rings(Rings::one(outline))
}

fn triangulate_rings(rings: Rings<'_, f64>) -> (Vec<Face>, TriangulationReport) {
    let mut faces = vec![[7; 3]];
    let report = Delaunay.triangulate(rings, &mut faces);
    (faces, report)
}

#[test]
fn every_vertex_is_inserted_once() {
    for count in [0, 1, 2, 3, 4, 5, 8, 9, 31, 100] {
        let mut order: Vec<_> = coarse_to_fine(count).collect();
        assert!(order.len() < 3 || order[1] >= count / 2, "{order:?}");
        order.sort_unstable();
        assert_eq!(order, (0..count).collect::<Vec<_>>());
    }
}

#[test]
fn holes_stay_outside() {
    // A square of 4 x 4, a hole of 2 x 2 the same way round, an island of 1 x 1 in it, and rings that enclose nothing.
    let square = |low: f64, high: f64| [[low, low], [high, low], [high, high], [low, high]];
    let mut outline = Outline::default();
    outline.push_ring([[0.5, 0.5]]);
    outline.push_ring(square(0.0, 4.0));
    outline.push_ring([[0.1, 0.2], [3.0, 0.5]]);
    outline.push_ring(square(1.0, 3.0));
    outline.push_ring(square(1.5, 2.5).into_iter().rev());
    outline.breaks.push(outline.vertices.len());
    let (faces, report) = triangulate_rings(outline.rings());
    assert_eq!(report, TriangulationReport::default());
    assert!((area(&outline.vertices, &faces) - (16.0 - 4.0 + 1.0)).abs() < 1e-12);
    // 8 between the borders of the frame, 2 in the island.
    assert_eq!(faces.len(), 10);
}

#[test]
fn notch_stays_outside() {
    // A unit square with a notch from the top down to its center, area 1 - 0.5 x 0.5 / 2; the first vertex is repeated.
    let outline = [[0.0, 0.0], [0.25, 0.0], [0.5, 0.5], [0.75, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    let (faces, report) = triangulate(&outline);
    assert_eq!(report, TriangulationReport::default());
    assert_eq!(faces.len(), 5, "7 distinct vertices make 5 triangles");
    assert!((area(&outline, &faces) - 0.875).abs() < 1e-12);
    assert!(faces.as_flattened().iter().all(|&k| k < 7), "the repeated vertex is named by its first index");
}

#[test]
fn crossing_edges_are_counted() {
    let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
    let (_, report) = triangulate(&bow_tie);
    assert_eq!(report, TriangulationReport { crossing_edges: 1, refused_vertices: 0 });
}

#[test]
fn degenerate_outlines_have_no_area() {
    for outline in
        [&[][..], &[[1.0, 1.0]], &[[0.0, 0.0], [1.0, 2.0]], &[[0.5, 0.5]; 6], &[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]]
    {
        let (faces, _) = triangulate(outline);
        assert!(area(outline, &faces) < 1e-12, "{faces:?}");
    }
}

#[test]
fn far_vertices_are_refused_without_a_panic() {
    let (_, report) = triangulate(&[[0.0, 0.0], [1e300, 0.0], [0.0, 1e-300], [1.0, f64::NAN]]);
    assert_eq!(report.refused_vertices, 2);
}

/// The two halves of a square, cut along its diagonal.
#[derive(Clone, Copy)]
struct Halves;

impl Triangulate for Halves {
    fn triangulate<T>(&self, _: Rings<'_, T>, faces: &mut Vec<Face>) -> TriangulationReport {
        faces.clear();
        faces.extend([[0, 1, 2], [0, 2, 3]]);
        TriangulationReport::default()
    }
}

fn coverage(outline: &[[f64; 2]]) -> Result<Vec<f64>, RenderError> {
    let size = ImageSize::new(8, 8).unwrap();
    let mut drawing = Drawing::default();
    drawing.push(outline, [1.0; 3], 1.0);
    // One doubled unit is 4 px: squares of distances are 16 times larger in pixels.
    let edge = EdgeProfile { offset: 0.0, sigma: 1.0 / 16.0, cut: 1.0 / 4.0, ..EdgeProfile::reference() };
    let renderer = TileRenderer { coverage: SoftTriangles { edge, faces: Halves }, compositing: Compositing::Blend };
    let mut coverage = vec![0.0; 64];
    renderer.object_coverage(&drawing, size, &mut TriangleScratch::default(), &mut coverage)?;
    Ok(coverage)
}

#[test]
fn coverage_follows_the_signed_distance() {
    // A square from pixel center (2, 2) to (6, 6): scene coordinates (c + 0.5) / 8.
    let (low, high) = (2.5 / 8.0, 6.5 / 8.0);
    let found = coverage(&[[low, low], [high, low], [high, high], [low, high]]).unwrap();
    let logistic = |d2: f64| 1.0 / (1.0 + d2.exp());
    // The square of the distance in pixels, negative inside; the seam is the diagonal from (2, 2) to (6, 6).
    for (row, column, d2) in
        [(2, 4, 0.0), (4, 4, 0.0), (1, 4, 1.0), (0, 4, 4.0), (1, 1, 2.0), (5, 3, -1.0), (4, 5, -0.5), (5, 4, -0.5)]
    {
        let p = found[row * 8 + column];
        assert!((p - logistic(d2)).abs() < 1e-12, "({row}, {column}): {p} instead of {}", logistic(d2));
    }
    // Beyond the cut of 2 px: (0, 0) is at 8 px^2.
    assert!(found[0] == 0.0);
}

#[test]
fn faces_of_another_outline_are_refused() {
    let refused = coverage(&[[0.1, 0.1], [0.9, 0.1], [0.5, 0.9]]).unwrap_err();
    assert!(matches!(refused, RenderError::Setting { what: "face", .. }), "{refused}");
}
