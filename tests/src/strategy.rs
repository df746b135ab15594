//! Random inputs for the property tests, one function per kind.

use core::f64::consts::PI;
use core::ops::Range;

use dvp_core::shape::OutlineBasis;
use dvp_core::{Efd, Object, Pose, Scene};
use proptest::collection::vec;
use proptest::prelude::*;

/// Descriptors that fall as 1 / n^2, as those of closed contours without jumps do; the first harmonic is an ellipse
/// with half axes of 0.5 to 1 and the direction of travel of an MDS-HR shape.
pub fn efd(harmonic_count: Range<usize>) -> impl Strategy<Value = Efd<f64>> {
    vec(prop::array::uniform4(-0.5..0.5), harmonic_count).prop_map(|mut rows| {
        for (n, row) in (1_u32..).zip(&mut rows) {
            let n = f64::from(n);
            row.iter_mut().for_each(|value| *value /= n * n);
        }
        if let Some([a, b, c, d]) = rows.first_mut() {
            *a = 0.75 + *a / 2.0;
            *d = -0.75 + *d / 2.0;
            *b /= 4.0;
            *c /= 4.0;
        }
        Efd::new(rows)
    })
}

/// Poses that MDS-HR could have drawn.
pub fn pose() -> impl Strategy<Value = Pose<f64>> {
    (prop::array::uniform2(0.05..0.95), 0.1..0.3, -PI..PI).prop_map(|(translation, scale, rotation)| Pose {
        translation,
        scale,
        rotation,
    })
}

/// One object with `harmonic_count` harmonics.
pub fn object(harmonic_count: Range<usize>) -> impl Strategy<Value = Object<f64>> {
    (pose(), color(), 0.0..1.0, efd(harmonic_count))
        .prop_map(|(pose, color, confidence, efd)| Object::of_efd(pose, color, confidence, efd, None))
}

/// A color with every channel in [0, 1].
pub fn color() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.0..1.0)
}

/// Scenes in the reference system's edge profile; every object has its own number of harmonics.
pub fn scene(object_count: Range<usize>, harmonic_count: Range<usize>) -> impl Strategy<Value = Scene<f64>> {
    (color(), vec(object(harmonic_count), object_count))
        .prop_map(|(background, objects)| Scene { objects, ..Scene::empty(background) })
}

/// A closed polygon around the origin, counter-clockwise with y up: distinct rays, radii 0.3 to 1, so that it never
/// crosses itself.
pub fn star_polygon(vertex_count: Range<usize>) -> impl Strategy<Value = Vec<[f64; 2]>> {
    vec((0.3..1.0, 0.1..0.9), vertex_count).prop_map(|points| {
        let count = f64::from(u32::try_from(points.len()).unwrap_or(u32::MAX));
        (0_u32..)
            .zip(points)
            .map(|(i, (radius, jitter)): (u32, (f64, f64))| {
                let (sin, cos) = ((f64::from(i) + jitter) / count * 2.0 * PI).sin_cos();
                [radius * cos, radius * sin]
            })
            .collect()
    })
}

/// Outlines that nobody should draw: up to 12 vertices of any size, repeated, collinear, crossing, far outside; in
/// pixels of an image of 24 x 24.
pub fn wild_outline() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let coordinate = prop_oneof![
        4 => -8.0..32.0,
        2 => (-2_i8..26).prop_map(f64::from),
        1 => (-2_i8..26).prop_map(|x| f64::from(x) + 0.5),
        1 => -1e5..1e5,
        1 => prop::sample::select(vec![0.0, -0.0, 24.0, 1e-30, 1e30, -1e30, 1e300, -1e300]),
    ];
    let vertex = (coordinate.clone(), coordinate).prop_map(|(x, y)| [x, y]);
    // The second number picks an earlier vertex to repeat.
    vec((vertex, prop::option::weighted(0.2, any::<prop::sample::Index>())), 1..13).prop_map(|picks| {
        let mut outline: Vec<[f64; 2]> = Vec::with_capacity(picks.len());
        for (vertex, repeat) in picks {
            let vertex = match repeat {
                Some(index) if !outline.is_empty() => outline[index.index(outline.len())],
                _ => vertex,
            };
            outline.push(vertex);
        }
        outline
    })
}

/// A star polygon of 3 to 24 vertices in pixels, wholly inside an image of 24 x 24.
pub fn star_px() -> impl Strategy<Value = Vec<[f64; 2]>> {
    (star_polygon(3..25), 2.0..8.0, prop::array::uniform2(9.0..15.0)).prop_map(|(star, radius, center)| {
        star.into_iter().map(|[x, y]| [radius * x + center[0], radius * y + center[1]]).collect()
    })
}

/// The unit outline of `efd`; no vertices if `vertex_count` is too small for one.
#[must_use]
pub fn outline(efd: &Efd<f64>, vertex_count: usize) -> Vec<[f64; 2]> {
    let mut outline = std::vec![[0.0; 2]; vertex_count];
    let written = OutlineBasis::new(vertex_count, efd.harmonic_count().max(1))
        .and_then(|basis| basis.outline(efd.rows(), &mut outline));
    if written.is_ok() { outline } else { Vec::new() }
}
