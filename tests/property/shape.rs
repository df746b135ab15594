//! Invariants of every kind of shape.

use dvp_core::geometry::{Bounds, Vec2};
use dvp_core::shape::{
    AnyShape, Cap, Circle, Ellipse, FillRule, Flattening, Join, Outline, OutlineBasis, Path, PathRing, Polygon,
    Segment, Shape as _, ShapeError, Stroke,
};
use dvp_tests::inside_integral::is_resolved;
use dvp_tests::shape_strategy;
use proptest::prelude::*;

fn flattened(shape: &AnyShape<f64>, tolerance: f64) -> Outline<f64> {
    let basis = OutlineBasis::new(32, 8).unwrap();
    let mut outline = Outline::default();
    shape.flatten(&Flattening::new(&basis, tolerance), &mut outline).unwrap();
    outline
}

fn signed_area(polygon: &[[f64; 2]]) -> f64 {
    dvp_core::contour::signed_area(polygon)
}

/// How often polygons wind around a point, +x to +y positive.
fn winding<'a>(rings: impl Iterator<Item = &'a [[f64; 2]]>, [x, y]: [f64; 2]) -> i32 {
    let mut winding = 0;
    for ring in rings {
        for (p, q) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            // A ray to +x crosses the edge.
            if (p[1] > y) != (q[1] > y) && x < p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]) {
                winding += if q[1] > p[1] { 1 } else { -1 };
            }
        }
    }
    winding
}

/// The distance of a point from the edges of polygons.
fn edge_distance<'a>(rings: impl Iterator<Item = &'a [[f64; 2]]>, [x, y]: [f64; 2]) -> f64 {
    let mut least = f64::INFINITY;
    for ring in rings {
        for (p, q) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let [dx, dy] = [q[0] - p[0], q[1] - p[1]];
            let share = (((x - p[0]) * dx + (y - p[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            let share = if share.is_nan() { 0.0 } else { share };
            least = least.min((x - p[0] - share * dx).hypot(y - p[1] - share * dy));
        }
    }
    least
}

/// Whether two edges cross within both, and not just at an end.
fn cross_inside([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        let cross = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        // Distance of r from the line.
        cross / (q[0] - p[0]).hypot(q[1] - p[1])
    };
    let apart = |s: f64, t: f64| s.min(t) < -1e-6 && s.max(t) > 1e-6;
    apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_nonzero_fill_becomes_even_odd(
        rings in shape_strategy::tangled_polygons(),
        points in prop::collection::vec(prop::array::uniform2(-0.5..4.5_f64), 40),
    ) {
        let path_rings = rings.iter().cloned().map(PathRing::polygon).collect();
        let path = Path { rings: path_rings, fill: FillRule::NonZero };
        let outline = flattened(&path.into(), 0.1);
        for point in points {
            if edge_distance(rings.iter().map(Vec::as_slice), point) < 1e-5 {
                continue;
            }
            let inside = winding(rings.iter().map(Vec::as_slice), point) != 0;
            // Every ring has the inside on one side, so that the windings are 0 and 1.
            prop_assert_eq!(winding(outline.rings().iter(), point), i32::from(inside), "{:?} of {:?}", point, outline);
        }
        let edges: Vec<_> = outline
            .rings()
            .iter()
            .flat_map(|ring| ring.iter().copied().zip(ring.iter().copied().cycle().skip(1)))
            .map(|(p, q)| [p, q])
            .collect();
        for (i, &edge) in edges.iter().enumerate() {
            for &other in &edges[..i] {
                prop_assert!(!cross_inside(edge, other), "{edge:?} crosses {other:?}");
            }
        }
    }

    #[test]
    fn round_strokes_cover_what_is_near_the_line(
        rings in prop::collection::vec(shape_strategy::path_ring(), 1..3),
        width in 0.02..1.0_f64,
        points in prop::collection::vec(prop::array::uniform2(-1.5..1.5_f64), 40),
    ) {
        // The lines as fine polylines; an open ring is closed on the way, by a line that does not count.
        let mut segments = Vec::new();
        for ring in &rings {
            let closed = Path { rings: vec![ring.clone()], fill: FillRule::EvenOdd };
            let outline = flattened(&closed.into(), 1e-5);
            let vertices = &outline.vertices;
            let ends = vertices.iter().skip(1).chain(ring.is_closed().then_some(&vertices[0]));
            segments.extend(vertices.iter().zip(ends).map(|(&p, &q)| [p, q]));
        }
        let stroke = Stroke { rings, width, cap: Cap::Round, join: Join::Round };
        let outline = flattened(&stroke.into(), 1e-3);
        for point in points {
            let distance = segments.iter().map(|edge| edge_distance(core::iter::once(edge.as_slice()), point));
            let off = distance.fold(f64::INFINITY, f64::min) - width / 2.0;
            if off.abs() > 2.5e-3 {
                let winding = winding(outline.rings().iter(), point);
                prop_assert_eq!(winding, i32::from(off < 0.0), "{:?}, {} off the edge", point, off);
            }
        }
    }

    #[test]
    fn numbers_come_back(shape in shape_strategy::shape(), seed in prop::collection::vec(0.1..1.0, 97)) {
        let mut numbers = Vec::new();
        shape.numbers(&mut numbers);
        prop_assert_eq!(numbers.len(), shape.number_count());
        let names = shape.number_names();
        prop_assert_eq!(names.len(), numbers.len());
        let distinct: alloc::collections::BTreeSet<_> = names.iter().collect();
        prop_assert_eq!(distinct.len(), names.len());
        let mut copy = shape.clone();
        let others: Vec<f64> = seed.into_iter().cycle().take(numbers.len()).collect();
        copy.set_numbers(&others).unwrap();
        let mut read = Vec::new();
        copy.numbers(&mut read);
        prop_assert_eq!(read, others);
        copy.set_numbers(&numbers).unwrap();
        prop_assert_eq!(&copy, &shape);
        prop_assert!(copy.set_numbers(&numbers[1..]).is_err());
        numbers[0] = f64::NAN;
        prop_assert!(copy.set_numbers(&numbers).is_err());
        prop_assert_eq!(copy, shape);
    }

    #[test]
    fn circles_ellipses_and_arcs_keep_their_area(
        radii in prop::array::uniform2(1.0..500.0_f64),
        bulge in -3.0..3.0_f64,
        tolerance in prop_oneof![Just(0.01), Just(0.1), Just(1.0)],
    ) {
        let close = |area: f64, exact: f64| (area / exact - 1.0).abs() < 1e-12;
        let circle = flattened(&Circle { radius: radii[0] }.into(), tolerance);
        prop_assert!(close(signed_area(&circle.vertices), core::f64::consts::PI * radii[0] * radii[0]));
        for &[x, y] in &circle.vertices {
            let off = x.hypot(y) - radii[0];
            prop_assert!((0.0..=tolerance).contains(&off), "{off}");
        }
        let ellipse = flattened(&Ellipse { radii }.into(), tolerance);
        prop_assert!(close(signed_area(&ellipse.vertices), core::f64::consts::PI * radii[0] * radii[1]));
        // A segment of a circle: radius^2 (sweep - sin sweep) / 2, with the chord 2 radius sin(sweep / 2).
        prop_assume!(bulge.abs() > 0.01);
        let points = vec![[3.0, -2.0], [3.0 + radii[0], -2.0 + radii[1]]];
        let path = Path::new(vec![PathRing { points, segments: vec![Segment::Arc { bulge }, Segment::Line] }]).unwrap();
        let arc = flattened(&path.into(), tolerance);
        let sweep = 4.0 * bulge.atan();
        let radius = radii[0].hypot(radii[1]) / (2.0 * (sweep / 2.0).sin());
        let area = radius * radius * (sweep - sweep.sin()) / 2.0;
        prop_assert!((signed_area(&arc.vertices) / area - 1.0).abs() < 1e-9, "{} against {area}", signed_area(&arc.vertices));
        let middle = [3.0 + radii[0] / 2.0, -2.0 + radii[1] / 2.0];
        let height = radius * (sweep / 2.0).cos() / radii[0].hypot(radii[1]);
        let center = [middle[0] - radii[1] * height, middle[1] + radii[0] * height];
        for &[x, y] in &arc.vertices[1..arc.vertices.len() - 1] {
            let off = (x - center[0]).hypot(y - center[1]) - radius.abs();
            prop_assert!((0.0..=tolerance).contains(&off), "{off}");
        }
    }

    #[test]
    fn polygons_stray_no_further_than_the_tolerance(
        ring in shape_strategy::path_ring(),
        tolerance in prop_oneof![Just(0.1), Just(0.01), Just(1e-3)],
    ) {
        let path = Path { rings: vec![ring], fill: FillRule::EvenOdd };
        let boundary = path.boundary().unwrap();
        // Where a smooth arc all but turns back, the circle is huge and its samples are far apart.
        prop_assume!(boundary.perimeter() < 100.0);
        let outline = flattened(&path.into(), tolerance);
        let samples: Vec<[f64; 2]> = boundary
            .pieces
            .iter()
            .flat_map(|piece| (0..1000).map(|i| piece.point(f64::from(i) / 1000.0).to_array()))
            .collect();
        let far = |polygon: &[[f64; 2]], point: [f64; 2]| edge_distance(core::iter::once(polygon), point);
        // Beyond the tolerance there is rounding alone.
        for &sample in samples.iter().step_by(7) {
            let off = far(&outline.vertices, sample);
            prop_assert!(off <= tolerance + 1e-9, "{off} off the curve at {sample:?}");
        }
        for &vertex in &outline.vertices {
            prop_assert!(far(&samples, vertex) <= tolerance + 1e-9, "the vertex {vertex:?}");
        }
    }

    #[test]
    fn measures_are_those_of_fine_polygons(shape in shape_strategy::shape()) {
        let outline = flattened(&shape, 1e-5);
        prop_assume!(outline.vertices.iter().flatten().all(|value| value.abs() < 10.0));
        // The outline may cross itself: as a nonzero path of itself, an even-odd one is resolved.
        let rings = outline.rings().iter().map(<[_]>::to_vec).collect();
        let polygon = Polygon { rings };
        let (fine, exact) = (polygon.moments().unwrap(), shape.moments().unwrap());
        // Descriptors are drawn with few vertices, whatever the tolerance.
        let tolerance = if shape.efd().is_some() { 0.2 } else { 1e-4 };
        prop_assert!((fine.area - exact.area).abs() <= tolerance, "{fine:?} {exact:?}");
        if exact.area > 0.1 {
            for (fine, exact) in fine.centroid.iter().chain(&fine.covariance).zip(exact.centroid.iter().chain(&exact.covariance)) {
                prop_assert!((fine - exact).abs() <= 20.0 * tolerance, "{fine:?} {exact:?}");
            }
        }
        let all = outline.vertices.iter().map(|&vertex| vertex.into());
        if let (Some(fine), Some(exact)) = (Bounds::of(all), shape.bounds().unwrap()) {
            // Positive where the polygons reach less far. Resolved ones leave out what encloses nothing.
            let missing = [fine.min - exact.min, exact.max - fine.max].map(Vec2::to_array);
            let (least, most) = (-tolerance.max(1e-3), if is_resolved(&shape) { 10.0 } else { tolerance.max(1e-3) });
            let fits = missing.as_flattened().iter().all(|missing| (least..=most).contains(missing));
            prop_assert!(fits, "{fine:?} {exact:?}");
        }
        // Where curves all but touch, resolved outlines have slivers without area, or not: their length is not comparable.
        if !is_resolved(&shape) {
            let (polygon, exact) = (polygon.perimeter().unwrap(), shape.perimeter().unwrap());
            prop_assert!((polygon - exact).abs() <= exact * 1e-3 + tolerance, "{polygon} {exact}");
        }
    }

    #[test]
    fn descriptors_of_a_boundary_are_those_of_a_fine_polygon(ring in shape_strategy::path_ring()) {
        let path = Path { rings: vec![ring], fill: FillRule::EvenOdd };
        let boundary = path.boundary().unwrap();
        // There and back along a line are no descriptors.
        prop_assume!(boundary.perimeter() < 100.0 && boundary.efd(0, 5).is_ok());
        // As many points on each piece as its share of the length, in its own parameter; cubics do not run at constant speed, so that
        // the polygon cannot be one of arc length: sums over its points instead.
        let (efd, center) = boundary.efd(0, 5).unwrap();
        let mut sums = [[0.0; 4]; 5];
        let mut mean = [0.0; 2];
        let mut along = 0.0;
        for piece in &boundary.pieces {
            let share = piece.length() / boundary.perimeter();
            let count = 4000;
            for i in 0..count {
                let t = (f64::from(i) + 0.5) / f64::from(count);
                let (point, weight) = (piece.point(t), share / f64::from(count));
                mean[0] += point.x * weight;
                mean[1] += point.y * weight;
                for (n, row) in (1_u8..).zip(&mut sums) {
                    let (sin, cos) = (core::f64::consts::TAU * f64::from(n) * (along + share * t)).sin_cos();
                    let values = [point.x * cos, point.x * sin, point.y * cos, point.y * sin];
                    row.iter_mut().zip(values).for_each(|(sum, value)| *sum += 2.0 * weight * value);
                }
            }
            along += share;
        }
        for (value, sum) in efd.rows().as_flattened().iter().chain(&center).zip(sums.as_flattened().iter().chain(&mean)) {
            prop_assert!((value - sum).abs() < 1e-4, "{efd:?} {center:?}, sums {sums:?} {mean:?}");
        }
    }

    #[test]
    fn paths_of_other_kinds_enclose_the_same(shape in shape_strategy::shape()) {
        let (path, area) = (AnyShape::from(shape.to_path().unwrap()), shape.area().unwrap());
        prop_assume!(area < 100.0);
        prop_assert!((path.area().unwrap() - area).abs() < 1e-4 * (1.0 + area), "{path:?}");
    }
}

/// Numbers that nobody should give: huge, tiny, equal.
fn wild_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -3.0..3.0,
        3 => (-2_i8..3).prop_map(f64::from),
        1 => prop::sample::select(vec![0.0, -0.0, 1e-30, 1e-300, -1e-8, 1e8, 1e30, -1e30, 1e300, f64::MAX, f64::MIN_POSITIVE]),
        1 => -1e5..1e5,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn wild_numbers_do_no_harm(
        shape in shape_strategy::shape(),
        numbers in prop::collection::vec(wild_number(), 1..60),
        not_finite in prop::option::weighted(0.05, prop::sample::select(vec![f64::NAN, f64::INFINITY])),
        tolerance in prop_oneof![4 => Just(1e-2), 2 => Just(1.0), 1 => prop::sample::select(vec![1e-12, 0.0, f64::NAN])],
    ) {
        let mut shape = shape;
        let mut numbers: Vec<f64> = numbers.into_iter().cycle().take(shape.number_count()).collect();
        shape.set_numbers(&numbers).unwrap();
        let basis = OutlineBasis::new(32, 8).unwrap();
        let mut outline = Outline::default();
        if shape.flatten(&Flattening::new(&basis, tolerance), &mut outline).is_ok() {
            let mut grad = vec![0.0; numbers.len()];
            let grad_vertices = vec![[1.0, -1.0]; outline.vertices.len()];
            shape.flatten_vjp(&Flattening::new(&basis, tolerance), &grad_vertices, &mut grad).unwrap();
        }
        if let Ok(boundary) = shape.boundary() {
            let _ = (boundary.perimeter(), boundary.bounds(), boundary.moments(), boundary.to_path());
            let _ = (boundary.efd(0, 3), boundary.elements().count());
        }
        let small = shape.cast::<f32>();
        let basis = OutlineBasis::new(32, 8).unwrap();
        let mut outline = Outline::default();
        let _ = (small.flatten(&Flattening::new(&basis, 1e-2), &mut outline), small.moments(), small.bounds());
        if let Some(value) = not_finite {
            numbers[0] = value;
            prop_assert_eq!(shape.set_numbers(&numbers), Err(ShapeError::NotFinite { index: 0 }));
        }
    }
}
