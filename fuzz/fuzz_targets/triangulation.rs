//! Rings to triangles: no panic, indices in range, and not too many of them.
#![no_main]

use dvp_core::render::triangles::{Delaunay, Triangulate};
use dvp_core::shape::Rings;
use dvp_fuzz::{Breaks, Points};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|rings: (Points, Breaks)| {
    let (Points(vertices), breaks) = rings;
    let breaks = breaks.rising(vertices.len());
    let rings = Rings { vertices: &vertices, breaks: &breaks, first: 0 };
    let mut faces = Vec::new();
    // Borders refuse what is not finite; the triangulation itself must not mind.
    let _ = Delaunay.triangulate(rings, &mut faces);
    assert!(faces.as_flattened().iter().all(|&vertex| vertex < vertices.len()));
    assert!(faces.len() <= 2 * vertices.len());
});
