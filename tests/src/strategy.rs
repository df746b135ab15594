//! Random inputs for the property tests, one function per kind.

use core::f64::consts::PI;
use core::ops::Range;

use dvp_core::shape::{Outline, OutlineBasis};
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

/// One to four rings, each inside of the one before and not touching it, as thin as 1/50 of their size, in pixels, wholly
/// inside of an image of 24 x 24; any direction and first vertex.
pub fn nested_rings_px() -> impl Strategy<Value = Vec<Vec<[f64; 2]>>> {
    let inner = (0.3..0.98, any::<bool>(), any::<prop::sample::Index>());
    (star_polygon(4..25), 2.0..8.0, prop::array::uniform2(9.0..15.0), vec(inner, 1..5)).prop_map(
        |(star, radius, center, rings)| {
            let mut size: f64 = radius;
            let ring = |(factor, reversed, start): (f64, bool, prop::sample::Index)| {
                // From four rays on the center lies inside, and a star is seen whole from there: a smaller one is inside of it.
                let mut ring: Vec<_> = star.iter().map(|[x, y]| [size * x + center[0], size * y + center[1]]).collect();
                size *= factor;
                ring.rotate_left(start.index(star.len()));
                if reversed {
                    ring.reverse();
                }
                ring
            };
            rings.into_iter().map(ring).collect()
        },
    )
}

/// Objects of several rings around an image of 24 x 24, in pixels: nested ones and others that may cross them.
pub fn rings_px() -> impl Strategy<Value = Outline<f64>> {
    let shifted = |star: Vec<[f64; 2]>, [dx, dy]: [f64; 2]| star.iter().map(|[x, y]| [x + dx, y + dy]).collect();
    let other = (star_px(), prop::array::uniform2(-9.0..9.0)).prop_map(move |(star, shift)| shifted(star, shift));
    (nested_rings_px(), vec(other, 0..3)).prop_map(|(nested, others)| outline_of(nested.into_iter().chain(others)))
}

/// Rings that nobody should draw: those of [`wild_outline`], cut anywhere, so that rings may have any number of vertices.
pub fn wild_rings() -> impl Strategy<Value = Outline<f64>> {
    (wild_outline(), vec(any::<prop::sample::Index>(), 0..5)).prop_map(|(vertices, breaks)| {
        let mut breaks: Vec<usize> = breaks.iter().map(|at| at.index(vertices.len() + 1)).collect();
        breaks.sort_unstable();
        Outline { vertices, breaks }
    })
}

/// Rings as one outline.
pub fn outline_of(rings: impl IntoIterator<Item = Vec<[f64; 2]>>) -> Outline<f64> {
    let mut outline = Outline::default();
    for ring in rings {
        outline.push_ring(ring);
    }
    outline
}
