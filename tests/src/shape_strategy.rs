//! Random shapes of every kind.

use dvp_core::shape::{
    AnyShape, Cap, Circle, Efd, Ellipse, FillRule, Join, Path, PathRing, Polygon, Prototype, Rectangle, RegularPolygon,
    Segment, Star, Stroke,
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
        if closed && points.len() == 2 && segments.contains(&Segment::Line) {
            // No circle leads back against the line that it continues.
            segments.iter_mut().filter(|segment| **segment == Segment::SmoothArc).for_each(|arc| *arc = Segment::Line);
        }
        PathRing { points, segments }
    })
}

/// A path of 1 to 3 rings that are filled by either rule.
pub fn path() -> impl Strategy<Value = Path<f64>> {
    let fill = prop_oneof![Just(FillRule::EvenOdd), Just(FillRule::NonZero)];
    (vec(path_ring(), 1..4), fill).prop_map(|(rings, fill)| Path { rings, fill })
}

/// A stroke of 1 to 3 open and closed lines.
pub fn stroke() -> impl Strategy<Value = Stroke<f64>> {
    let cap = prop_oneof![Just(Cap::Butt), Just(Cap::Round), Just(Cap::Square)];
    let join = prop_oneof![(1.0..6.0).prop_map(|limit| Join::Miter { limit }), Just(Join::Round), Just(Join::Bevel)];
    (vec(path_ring(), 1..4), 0.02..0.6, cap, join).prop_map(|(rings, width, cap, join)| Stroke {
        rings,
        width,
        cap,
        join,
    })
}

/// Polygons that cross, touch, run back over themselves and repeat vertices: on few whole numbers, or anywhere.
pub fn tangled_polygons() -> impl Strategy<Value = Vec<Vec<[f64; 2]>>> {
    let on_grid = (0..5_i32, 0..5_i32).prop_map(|(x, y)| [f64::from(x), f64::from(y)]);
    let anywhere = prop::array::uniform2(0.0..4.0);
    prop_oneof![
        vec(vec(on_grid.clone(), 1..10), 1..4),
        vec(vec(anywhere.clone(), 1..10), 1..4),
        vec(vec(prop_oneof![on_grid, anywhere], 1..10), 1..4),
    ]
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
        stroke().prop_map(AnyShape::from),
        efd().prop_map(AnyShape::from),
        (0_usize..9, efd()).prop_map(|(index, efd)| Prototype { index, efd }.into()),
    ]
}
