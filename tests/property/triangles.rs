//! Invariants of triangulation and of soft triangles.

use dvp_core::ImageSize;
use dvp_core::render::SoftTriangles;
use dvp_core::render::triangles::{Delaunay, Face, Triangulate};
use dvp_core::shape::Rings;
use dvp_tests::coverage::coverage;
use dvp_tests::strategy;
use proptest::prelude::*;

fn area(outline: &[[f64; 2]], faces: &[Face]) -> f64 {
    let doubled = faces.iter().map(|face| {
        let [a, b, c] = face.map(|k| outline[k]);
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs()
    });
    doubled.sum::<f64>() / 2.0
}

proptest! {
    #[test]
    fn triangles_fill_simple_outlines(star in strategy::star_polygon(3..40), closed in any::<bool>()) {
        let mut outline = star.clone();
        if closed {
            outline.push(star[0]);
        }
        let mut faces = Vec::new();
        let report = Delaunay.triangulate(Rings::one(&outline), &mut faces);
        prop_assert_eq!(report.crossing_edges, 0);
        // A fan around the origin, from which the star is seen whole, has the same area.
        let next = star.iter().cycle().skip(1);
        let expected = star.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() / 2.0;
        prop_assert!((area(&outline, &faces) - expected).abs() < 1e-9, "{} instead of {expected}", area(&outline, &faces));
        prop_assert_eq!(faces.len(), star.len() - 2);
    }

    #[test]
    fn any_outline_is_triangulated(outline in strategy::wild_outline()) {
        let mut faces = Vec::new();
        Delaunay.triangulate(Rings::one(&outline), &mut faces);
        prop_assert!(faces.as_flattened().iter().all(|&k| k < outline.len()));
    }

    #[test]
    fn stays_in_range(outline in strategy::wild_outline()) {
        let coverage = coverage(SoftTriangles::default(), &outline, ImageSize::new(24, 24).unwrap()).unwrap();
        prop_assert!(coverage.iter().all(|p| (0.0..=1.0).contains(p)));
    }
}
