//! Posed outlines against the reference system's vertices (f32).
//!
//! `drawing.json` is an excerpt: one object of each MDS-HR shape and seven of its 64 vertices.

use dvp_core::scene::rotation_from_pair;
use dvp_core::shape::{OutlineBasis, mdshr_bank};
use dvp_core::{Drawing, Object, Pose, Scene};
use dvp_tests::fixture::{self, fixture_scenes};
use dvp_tests::golden::{committed, shared};
use serde::Deserialize;

#[derive(Deserialize)]
struct Excerpt {
    prototype: usize,
    translation: [f64; 2],
    scale: f64,
    rotation_vec: [f64; 2],
    /// Index, x, y; scene units.
    vertices: Vec<(usize, f64, f64)>,
}

#[test]
fn reference_committed() {
    let excerpts: Vec<Excerpt> = committed("drawing.json").unwrap();
    assert_eq!(excerpts.len(), 3);
    let bank = mdshr_bank(64);
    for Excerpt { prototype, translation, scale, rotation_vec, vertices } in excerpts {
        let pose = Pose { translation, scale, rotation: rotation_from_pair(rotation_vec) };
        let efd = bank.prototypes()[prototype].clone();
        let object = Object::of_efd(pose, [0.0; 3], 1.0, efd, Some(prototype));
        let scene = Scene { objects: vec![object], ..Scene::empty([1.0; 3]) };
        let mut drawing = Drawing::default();
        scene.draw(&OutlineBasis::new(64, 64).unwrap(), &mut drawing).unwrap();
        for (i, x, y) in vertices {
            let vertex = drawing.outline(0)[i];
            // f32 of a sum of 64 harmonics, in image sides: a ten-thousandth of a pixel.
            assert!((vertex[0] - x).hypot(vertex[1] - y) < 1e-6, "vertex {i}: {vertex:?} against ({x}, {y})");
        }
    }
}

#[derive(Deserialize)]
struct Geometry {
    /// x, -y, depth of 64 vertices per object, object after object.
    verts_ndc: [Vec<[f64; 3]>; 1],
}

#[test]
fn reference_shared() {
    let Some(geometries) = shared::<Vec<Geometry>>("fixtures/a_geometry.json").unwrap() else { return };
    let Some(folder) = fixture::shared() else { return };
    assert_eq!(geometries.len(), 4);
    let basis = OutlineBasis::new(64, 64).unwrap();
    let mut drawing = Drawing::default();
    for (scene, Geometry { verts_ndc: [expected] }) in
        fixture_scenes(&folder, "a_target_scenes.json").iter().zip(&geometries)
    {
        scene.to_scene(&[]).draw(&basis, &mut drawing).unwrap();
        assert_eq!(drawing.vertices.len(), expected.len());
        for (i, (vertex, [x, y, _])) in drawing.vertices.iter().zip(expected).enumerate() {
            assert!((vertex[0] - x).hypot(vertex[1] + y) < 1e-6, "vertex {i}: {vertex:?} against ({x}, {})", -y);
        }
    }
}
