#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::{FRAC_PI_2, PI, TAU};

use super::*;
use crate::geometry::LineSegment;
use crate::shape::{
    AnyShape, Circle, Efd, Ellipse, Flattening, Outline, OutlineBasis, Path, PathRing, Polygon, Rectangle,
    RegularPolygon, Segment, Shape as _, ShapeError, Star, Symmetry,
};

fn path(points: &[[f64; 2]], segments: &[Segment<f64>]) -> Path<f64> {
    Path::new(vec![PathRing { points: points.to_vec(), segments: segments.to_vec() }]).unwrap()
}

/// A half disk of radius 1 above y = 0: the arc from (1, 0) to (-1, 0) by way of (0, 1), and a line back.
fn half_disk() -> Path<f64> {
    path(&[[1.0, 0.0], [-1.0, 0.0]], &[Segment::Arc { bulge: 1.0 }, Segment::Line])
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

#[test]
fn measures_by_hand() {
    let circle = AnyShape::from(Circle { radius: 2.0 });
    let moments = circle.moments().unwrap();
    assert!(close(moments.area, 4.0 * PI) && close(circle.perimeter().unwrap(), 4.0 * PI));
    // A quarter of the squared radius along both axes.
    assert!(
        close(moments.covariance[0], 1.0) && close(moments.covariance[1], 0.0) && close(moments.covariance[2], 1.0)
    );
    let bounds = circle.bounds().unwrap().unwrap();
    assert_eq!((bounds.min, bounds.max), (Vec2::new(-2.0, -2.0), Vec2::new(2.0, 2.0)));

    let rectangle = Rectangle { size: [4.0, 2.0], corner_radius: 0.5 };
    // Without the four corners of 1/4 (1 - pi / 4) each; 2 (3 + 1) straight and a whole circle of radius 1/2.
    assert!(close(rectangle.area().unwrap(), 8.0 - (1.0 - PI / 4.0)));
    assert!(close(rectangle.perimeter().unwrap(), 8.0 + PI));
    let sharp = Rectangle { size: [4.0, 2.0], corner_radius: 0.0 }.moments().unwrap();
    assert!(close(sharp.covariance[0], 16.0 / 12.0) && close(sharp.covariance[2], 4.0 / 12.0));

    let half = half_disk();
    // The centroid of a half disk is 4 / (3 pi) from its diameter; bounds by the top of the arc.
    let [x, y] = half.centroid().unwrap();
    assert!(close(x, 0.0) && close(y, 4.0 / (3.0 * PI)), "({x}, {y})");
    assert!(close(half.area().unwrap(), FRAC_PI_2) && close(half.perimeter().unwrap(), PI + 2.0));
    let bounds = half.bounds().unwrap().unwrap();
    assert!(close(bounds.max.y, 1.0) && close(bounds.min.y, 0.0) && close(bounds.min.x, -1.0), "{bounds:?}");
}

#[test]
fn the_perimeter_of_an_ellipse_is_the_elliptic_integral() {
    // 4 a E(e) with E(sqrt(3) / 2) = 1.2110560275684594 (Abramowitz and Stegun, table 17.1, at 60 degrees).
    assert!(close(Ellipse { radii: [1.0, 0.5] }.perimeter().unwrap(), 4.0 * 1.211_056_027_568_459_4));
    assert!(close(Ellipse { radii: [3.0, 3.0] }.perimeter().unwrap(), 6.0 * PI));
    assert_eq!(Ellipse { radii: [0.0, 3.0] }.perimeter().unwrap(), 12.0);
    let thin: f64 = Ellipse { radii: [1.0, 1e-9] }.perimeter().unwrap();
    assert!((thin - 4.0).abs() < 1e-12, "{thin}");
    assert!((f64::from(Ellipse { radii: [1.0_f32, 0.5] }.perimeter().unwrap()) - 4.844_224_1).abs() < 1e-5);
}

#[test]
fn cubics_by_hand() {
    // p = (3 t - 3 t^2, 3 t^2 - 2 t^3 ...): controls at (1, 0) and (1, 1) between (0, 0) and (0, 1): x = 3 t (1 - t) with the greatest
    // x 3/4 at t = 1/2; y = 3 t^2 (1 - t) + t^3 = 3 t^2 - 2 t^3. Area: the integral of x dy = 3 t (1 - t) 6 t (1 - t), 18 x 1/30.
    let curve =
        path(&[[0.0, 0.0], [0.0, 1.0]], &[Segment::Cubic { controls: [[1.0, 0.0], [1.0, 1.0]] }, Segment::Line]);
    assert!(close(curve.area().unwrap(), 0.6), "{}", curve.area().unwrap());
    assert!(close(curve.bounds().unwrap().unwrap().max.x, 0.75));
    // A cubic along a line that overshoots: from 0 by 1 and 0 to 1, x = 3 t (1 - t)^2 + t^3, greatest and least at the roots of
    // 3 - 12 t + 12 t^2, a double one at 1/2: no overshoot, length 1.
    let straight = Piece::Cubic([[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0]].map(Vec2::from));
    assert!((straight.length() - 1.0_f64).abs() < 1e-9, "{}", straight.length());
    // With controls at 2 and -1: x = 6 t (1 - t)^2 - 3 t^2 (1 - t) + t^3, x' = 6 - 30 t + 30 t^2, roots 1/2 -+ 1 / (2 sqrt(5)).
    let there_and_back = Piece::Cubic([[0.0, 0.0], [2.0, 0.0], [-1.0, 0.0], [1.0, 0.0]].map(Vec2::from));
    let x = |t: f64| 6.0 * t * (1.0 - t) * (1.0 - t) - 3.0 * t * t * (1.0 - t) + t * t * t;
    let (first, second) = (x(0.5 - 0.05_f64.sqrt()), x(0.5 + 0.05_f64.sqrt()));
    assert!((there_and_back.length() - (2.0 * first - 2.0 * second + 1.0)).abs() < 1e-9);
    let boundary = Boundary { pieces: vec![there_and_back], ..Boundary::default() };
    assert!(close(boundary.bounds().unwrap().max.x, first.max(1.0)), "{first}");
}

#[test]
fn polygons_of_cubics_keep_the_tolerance_next_to_cusps_and_inflections() {
    let curves = [
        // Turns by 200 degrees along its first edge.
        [[-0.714, 0.362], [-1.012, 0.033], [-0.606, 0.983], [0.247, 0.56]],
        // Turns both ways along its last edge.
        [[-1.255, -1.274], [0.919, -0.347], [-0.035, -0.91], [0.553, -0.537]],
        // The same, with one sign at both of its ends.
        [[-0.823, -0.991], [1.039, -0.471], [-0.101, -0.971], [0.836, -0.548]],
    ];
    for [from, first, second, to] in curves {
        let shape = path(&[from, to], &[Segment::Cubic { controls: [first, second] }, Segment::Line]);
        let mut outline = Outline::default();
        shape.flatten(&Flattening::new(&OutlineBasis::new(8, 1).unwrap(), 0.03), &mut outline).unwrap();
        let edges = outline.vertices.iter().zip(outline.vertices.iter().cycle().skip(1));
        let edges: Vec<_> = edges.map(|(&from, &to)| LineSegment::new(from.into(), to.into())).collect();
        for i in 0..=400 {
            let point = Piece::Cubic([from, first, second, to].map(Vec2::from)).point(f64::from(i) / 400.0);
            let off = edges.iter().map(|edge| edge.nearest(point).distance()).fold(f64::INFINITY, f64::min);
            assert!(off <= 0.03, "{off} at {point:?} of the cubic from {from:?}");
        }
    }
}

#[test]
fn holes_and_crossings_count_by_the_rule() {
    let ring = |x: f64, size: f64| {
        vec![[x, 0.0], [x + size, 0.0], [x + size, size], [x, size]].into_iter().map(|[x, y]| [x, y + 1.0]).collect()
    };
    // A square of side 4 with a hole of side 1, whichever way they turn.
    let mut rings: Vec<Vec<[f64; 2]>> = vec![ring(0.0, 4.0), vec![[1.0, 2.0], [2.0, 2.0], [2.0, 3.0], [1.0, 3.0]]];
    for _ in 0..2 {
        let shape = Polygon { rings: rings.clone() };
        assert!(close(shape.area().unwrap(), 15.0), "{}", shape.area().unwrap());
        assert!(close(shape.perimeter().unwrap(), 20.0));
        rings[1].reverse();
    }
    // Two squares of side 2 that share a quarter.
    let crossing = Polygon { rings: vec![ring(0.0, 2.0), vec![[1.0, 2.0], [3.0, 2.0], [3.0, 4.0], [1.0, 4.0]]] };
    assert!(close(crossing.area().unwrap(), 6.0), "{}", crossing.area().unwrap());
    let mut both = crossing.to_path().unwrap();
    both.fill = crate::shape::FillRule::NonZero;
    assert!(close(both.area().unwrap(), 7.0), "{}", both.area().unwrap());
    // A nonzero disk inside of a disk is no hole; turned around it is.
    let disk =
        |bulge: f64, r: f64| PathRing { points: vec![[r, 0.0], [-r, 0.0]], segments: vec![Segment::Arc { bulge }; 2] };
    let disks = |bulge| Path { rings: vec![disk(1.0, 2.0), disk(bulge, 1.0)], fill: crate::shape::FillRule::NonZero };
    assert!(close(disks(1.0).area().unwrap(), 4.0 * PI) && close(disks(-1.0).area().unwrap(), 3.0 * PI));
}

#[test]
fn descriptors_of_circle_and_ellipse_have_one_harmonic() {
    let (efd, center) = Ellipse { radii: [3.0, 2.0] }.efd_of_ring(0, 8).unwrap();
    assert_eq!(center, [0.0, 0.0]);
    assert_eq!(efd.rows()[0], [3.0, 0.0, 0.0, 2.0]);
    assert_eq!(efd.rows()[1..], [[0.0; 4]; 7]);
    // A circle of two arcs around (5, 7).
    let arcs = path(&[[6.0, 7.0], [4.0, 7.0]], &[Segment::Arc { bulge: 1.0 }; 2]);
    let (efd, center) = arcs.efd_of_ring(0, 8).unwrap();
    assert!(close(center[0], 5.0) && close(center[1], 7.0), "{center:?}");
    let expected = Efd::new(vec![[1.0, 0.0, 0.0, 1.0]]).resized(8);
    for (value, expected) in efd.rows().as_flattened().iter().zip(expected.rows().as_flattened()) {
        assert!(close(*value, *expected), "{efd:?}");
    }
    assert_eq!(arcs.efd_of_ring(1, 8), Err(ShapeError::NoRing { ring: 1, count: 1 }));
}

/// x(t) = sum a_n cos + b_n sin by the trapezoidal rule at `count` points per piece, with Richardson's extrapolation: slow, and
/// nothing in common with the closed forms.
fn sampled(pieces: &[Piece<f64>], n: usize, parts: usize) -> [f64; 4] {
    let perimeter: f64 = pieces.iter().map(Piece::length).sum();
    let mut row = [0.0; 4];
    let mut along = 0.0;
    for piece in pieces {
        let share = piece.length() / perimeter;
        for part in 0..parts {
            for [at, weight] in measure::GAUSS {
                let t = (f64::of_usize(part) + at) / f64::of_usize(parts);
                let point = piece.point(t);
                let (sin, cos) = (TAU * f64::of_usize(n) * (along + share * t)).sin_cos();
                let weight = 2.0 * weight * share / f64::of_usize(parts);
                let values = [point.x * cos, point.x * sin, point.y * cos, point.y * sin];
                row.iter_mut().zip(values).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        along += share;
    }
    row
}

#[test]
fn descriptors_of_arcs_and_cubics_are_their_integrals() {
    for bulge in [1.0, 0.3, -0.7, 2.5, 1e-3, -1e-5, 1e-9, 0.0] {
        let segments = [
            Segment::Arc { bulge },
            Segment::Cubic { controls: [[3.0, 3.0], [0.0, -1.0]] },
            Segment::Line,
            Segment::Cubic { controls: [[-1.0, 0.5], [-0.9, 0.4]] },
        ];
        let shape = path(&[[0.0, 0.0], [2.0, 0.5], [1.0, 2.0], [-1.0, 1.0]], &segments);
        let boundary = shape.boundary().unwrap();
        let (efd, _) = shape.efd_of_ring(0, 40).unwrap();
        for n in [1, 2, 3, 7, 40] {
            let expected = sampled(&boundary.pieces, n, 40);
            for (value, expected) in efd.rows()[n - 1].iter().zip(expected) {
                assert!((value - expected).abs() < 1e-11, "bulge {bulge}, harmonic {n}: {:?}", efd.rows()[n - 1]);
            }
        }
        let (efd, _) = shape.efd_of_ring(0, 4000).unwrap();
        // What is wound twice counts twice, as in the sum over harmonics.
        let twice = boundary.pieces.iter().map(|piece| {
            measure::integral(&|t| piece.point(t).cross(piece.velocity(t)), 0.0, 0.5)
                + measure::integral(&|t| piece.point(t).cross(piece.velocity(t)), 0.5, 1.0)
        });
        let signed: f64 = twice.sum::<f64>() / 2.0;
        assert!((efd.signed_area() - signed).abs() < 1e-3, "{} and {signed}", efd.signed_area());
    }
}

#[test]
fn descriptors_of_a_polygon_are_those_of_its_contour() {
    let corners = vec![[0.0, 0.0], [3.0, 0.5], [2.0, 2.0], [2.0, 2.0], [-1.0, 1.0]];
    let exact = Efd::from_contour(&corners, 9).unwrap();
    assert_eq!(Polygon { rings: vec![corners] }.efd_of_ring(0, 9).unwrap(), exact);
    let flat = Polygon { rings: vec![vec![[0.0, 0.0], [1.0, 1.0], [1.0, 1.0]]] };
    assert_eq!(flat.efd_of_ring(0, 3), Err(ShapeError::TooFewPoints { len: 2 }));
}

#[test]
fn symmetries() {
    let order = |shape: &dyn crate::shape::Shape<f64>| shape.efd_of_ring(0, 32).unwrap().0.symmetry(1e-9);
    assert_eq!(order(&Circle { radius: 3.0 }), Symmetry::Continuous);
    assert_eq!(order(&Ellipse { radii: [3.0, 2.0] }), Symmetry::Finite(2));
    assert_eq!(order(&Rectangle { size: [2.0, 2.0], corner_radius: 0.3 }), Symmetry::Finite(4));
    assert_eq!(order(&Rectangle { size: [2.0, 1.0], corner_radius: 0.3 }), Symmetry::Finite(2));
    assert_eq!(order(&Rectangle { size: [2.0, 2.0], corner_radius: 0.0 }), Symmetry::Finite(4));
    for n in 3..9 {
        assert_eq!(order(&RegularPolygon { sides: n, radius: 1.0 }), Symmetry::Finite(n));
        assert_eq!(order(&Star { points: n, radius: 1.0, inner_radius: 0.4 }), Symmetry::Finite(n));
    }
}

#[test]
fn elements_trace_the_boundary() {
    let elements: Vec<_> = half_disk().boundary().unwrap().elements().collect();
    let arc = PathElement::Arc { radii: [1.0; 2], rotation: 0.0, sweep: PI, to: [-1.0, 0.0] };
    assert_eq!(elements, [PathElement::Move([1.0, 0.0]), arc, PathElement::Close]);
    let elements: Vec<_> = Ellipse { radii: [3.0, 2.0] }.boundary().unwrap().elements().collect();
    let half = |x| PathElement::Arc { radii: [3.0, 2.0], rotation: 0.0, sweep: PI, to: [x, 0.0] };
    assert_eq!(elements, [PathElement::Move([3.0, 0.0]), half(-3.0), half(3.0), PathElement::Close]);
    // Three quarters of a circle: two elements of 3/8.
    let bulge = (3.0 * PI / 8.0).tan();
    let wide = path(&[[1.0, 0.0], [0.0, -1.0]], &[Segment::Arc { bulge }, Segment::Line]);
    let elements: Vec<_> = wide.boundary().unwrap().elements().collect();
    assert_eq!(elements.len(), 4, "{elements:?}");
    let PathElement::Arc { sweep, to: [x, y], .. } = elements[1] else { panic!("{elements:?}") };
    assert!(close(sweep, 0.75 * PI) && close(x, -0.5_f64.sqrt()) && close(y, 0.5_f64.sqrt()), "{elements:?}");
}

#[test]
fn every_kind_becomes_a_path_of_the_same_area() {
    let shapes: [AnyShape<f64>; 4] = [
        Circle { radius: 2.0 }.into(),
        Ellipse { radii: [3.0, 2.0] }.into(),
        Rectangle { size: [3.0, 2.0], corner_radius: 0.5 }.into(),
        Efd::new(vec![[2.0, 0.1, 0.0, 1.0], [0.0, 0.2, 0.1, 0.0]]).into(),
    ];
    for shape in shapes {
        let (path, area) = (shape.to_path().unwrap(), shape.area().unwrap());
        assert!((path.area().unwrap() / area - 1.0).abs() < 1e-5, "{path:?}");
        assert!(path.rings.iter().all(PathRing::is_closed));
    }
    let efd = Efd::new(vec![[2.0, 0.1, 0.0, 1.0], [0.0, 0.2, 0.1, 0.0]]);
    let ratio: f64 = efd.area().unwrap() / efd.signed_area();
    assert!((ratio - 1.0).abs() < 1e-6, "{ratio}");
}

#[test]
fn huge_numbers_are_refused_and_small_ones_kept() {
    let huge = Circle { radius: 1e300 };
    assert_eq!(huge.area(), Err(ShapeError::TooLarge));
    let basis = crate::shape::OutlineBasis::new(8, 2).unwrap();
    let how = crate::shape::Flattening::new(&basis, 0.1);
    let flattened = Circle { radius: f64::MAX }.flatten(&how, &mut crate::shape::Outline::default());
    assert_eq!(flattened, Err(ShapeError::TooLarge));
    let tiny = Circle { radius: 1e-100 };
    assert!((tiny.area().unwrap() / (PI * 1e-200) - 1.0).abs() < 1e-9);
}
