//! Random shapes of every kind.

use dvp_core::shape::{
    AnyShape, Circle, Efd, Ellipse, Path, PathRing, Polygon, Prototype, Rectangle, RegularPolygon, Segment, Star,
};
use proptest::collection::vec;
use proptest::prelude::*;

fn point() -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(-1.0..1.0)
}

fn segment() -> impl Strategy<Value = Segment<f64>> {
    prop_oneof![
        Just(Segment::Line),
        (-1.5..1.5).prop_map(|bulge| Segment::Arc { bulge }),
        Just(Segment::SmoothArc),
        prop::array::uniform2(point()).prop_map(|controls| Segment::Cubic { controls }),
        (0.1..1.0, point()).prop_map(|(handle, control)| Segment::SmoothCubic { handle, control }),
    ]
}

/// A ring of 1 to 5 segments, closed or open, whose smooth segments have a direction to continue.
pub fn path_ring() -> impl Strategy<Value = PathRing<f64>> {
    (vec((point(), segment()), 2..6), any::<bool>()).prop_map(|(parts, closed)| {
        let (points, mut segments): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        if !closed {
            segments.pop();
        }
        let is_smooth = matches!(segments[0], Segment::SmoothArc | Segment::SmoothCubic { .. });
        if is_smooth && (!closed || segments.iter().all(|segment| *segment == Segment::SmoothArc)) {
            segments[0] = Segment::Line;
        }
        PathRing { points, segments }
    })
}

/// A path of 1 to 3 rings.
pub fn path() -> impl Strategy<Value = Path<f64>> {
    vec(path_ring(), 1..4).prop_map(|rings| Path { rings })
}

fn efd() -> impl Strategy<Value = Efd<f64>> {
    vec(prop::array::uniform4(-1.0..1.0_f64), 1..6).prop_map(|mut rows| {
        for (n, row) in (1_i32..).zip(&mut rows) {
            row.iter_mut().for_each(|value| *value /= f64::from(n * n));
        }
        Efd::new(rows)
    })
}

/// A shape of any kind whose boundary is known piece by piece, of a size of about 1.
pub fn shape() -> impl Strategy<Value = AnyShape<f64>> {
    let length = || 0.1..1.0;
    prop_oneof![
        length().prop_map(|radius| Circle { radius }.into()),
        prop::array::uniform2(length()).prop_map(|radii| Ellipse { radii }.into()),
        (prop::array::uniform2(length()), prop_oneof![Just(0.0), 0.0..0.6])
            .prop_map(|(size, corner_radius)| Rectangle { size, corner_radius }.into()),
        (3_usize..12, length()).prop_map(|(sides, radius)| RegularPolygon { sides, radius }.into()),
        (3_usize..12, length(), length()).prop_map(|(points, radius, inner_radius)| Star {
            points,
            radius,
            inner_radius
        }
        .into()),
        vec(vec(point(), 3..7), 1..4).prop_map(|rings| Polygon { rings }.into()),
        path().prop_map(AnyShape::from),
        efd().prop_map(AnyShape::from),
        (0_usize..9, efd()).prop_map(|(index, efd)| Prototype { index, efd }.into()),
    ]
}
