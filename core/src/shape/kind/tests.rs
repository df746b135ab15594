#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use alloc::string::ToString as _;
use alloc::vec;

use super::*;
use crate::geometry::Vec2;
use crate::shape::curve::Piece;
use crate::shape::{AnyShape, OutlineBasis};

fn flattened(shape: &dyn Shape<f64>) -> Outline<f64> {
    let basis = OutlineBasis::new(16, 4).unwrap();
    let mut outline = Outline::default();
    shape.flatten(&Flattening::new(&basis, 0.01), &mut outline).unwrap();
    outline
}

fn close(a: Vec2<f64>, b: [f64; 2]) -> bool {
    (a - b.into()).length() < 1e-12
}

#[test]
fn corners_by_hand() {
    assert_eq!(
        flattened(&Rectangle { size: [4.0, 2.0], corner_radius: 0.0 }).vertices,
        [[2.0, 1.0], [-2.0, 1.0], [-2.0, -1.0], [2.0, -1.0]]
    );
    let square = flattened(&RegularPolygon { sides: 4, radius: 2.0 }).vertices;
    let star = flattened(&Star { points: 4, radius: 2.0, inner_radius: 1.0 }).vertices;
    let corners = [[2.0, 0.0], [0.0, 2.0], [-2.0, 0.0], [0.0, -2.0]];
    let half = core::f64::consts::FRAC_1_SQRT_2;
    for (k, corner) in corners.into_iter().enumerate() {
        assert!(close(square[k].into(), corner) && close(star[2 * k].into(), corner), "{square:?} {star:?}");
    }
    assert!(close(star[1].into(), [half, half]), "{star:?}");
}

#[test]
fn a_corner_radius_is_held_to_half_the_shorter_side() {
    let rectangle = Rectangle { size: [4.0, 2.0], corner_radius: 5.0 };
    assert_eq!(rectangle.held_radius(), 1.0);
    // A disk of radius 1 and the 2 x 2 square between its halves.
    let area = crate::contour::signed_area(&flattened(&rectangle).vertices);
    assert!((area - core::f64::consts::PI - 4.0).abs() < 1e-12, "{area}");
    assert_eq!(Rectangle { size: [4.0, 2.0], corner_radius: -1.0 }.held_radius(), 0.0);
}

#[test]
fn constructors_refuse_what_is_no_shape() {
    assert_eq!(Circle::new(0.0), Err(ShapeError::NotPositive { what: "radius" }));
    assert_eq!(Ellipse::new([1.0, f64::NAN]), Err(ShapeError::NotPositive { what: "radius" }));
    assert_eq!(Rectangle::new([1.0, -1.0], 0.0), Err(ShapeError::NotPositive { what: "side" }));
    assert_eq!(Rectangle::new([1.0, 1.0], -0.5), Err(ShapeError::NotPositive { what: "corner radius" }));
    assert_eq!(RegularPolygon::new(2, 1.0), Err(ShapeError::Corners { what: "sides", count: 2 }));
    assert_eq!(Star::new(5000, 1.0, 0.5), Err(ShapeError::Corners { what: "points", count: 5000 }));
    assert_eq!(Polygon::new(vec![vec![[0.0, 0.0]]]), Err(ShapeError::TooFewPoints { len: 1 }));
    let infinite = vec![[0.0, 0.0], [1.0, f64::INFINITY], [0.0, 0.0]];
    assert_eq!(Polygon::new(vec![infinite]), Err(ShapeError::NotFinite { index: 3 }));
    let ring = |segments| Path::new(vec![PathRing { points: vec![[0.0, 0.0], [1.0, 0.0]], segments }]);
    assert_eq!(ring(vec![]), Err(ShapeError::Length { what: "segments of a ring", expected: 2, len: 0 }));
    assert_eq!(ring(vec![Segment::SmoothArc; 2]), Err(ShapeError::NoDirection), "each waits for the other");
    assert_eq!(ring(vec![Segment::SmoothArc]), Err(ShapeError::NoDirection), "nothing before it");
    assert!(ring(vec![Segment::SmoothArc, Segment::Line]).is_ok());
}

#[test]
fn smooth_segments_continue_the_direction() {
    // Right along y = 0, then a smooth arc from (1, 0) to (1, 1): half a circle, whose bulge is 1, and it arrives leftward.
    let ring = PathRing {
        points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
        segments: vec![Segment::Line, Segment::SmoothArc, Segment::SmoothCubic { handle: 0.5, control: [0.0, 0.5] }],
    };
    let pieces = Path::new(vec![ring]).unwrap().boundary().unwrap().pieces;
    let Piece::Arc { bulge, .. } = pieces[1] else { panic!("{pieces:?}") };
    assert_eq!(bulge, 1.0);
    let Piece::Cubic([_, control, ..]) = pieces[2] else { panic!("{pieces:?}") };
    assert!(close(control, [0.5, 1.0]), "{control:?}");
}

#[test]
fn the_first_segment_of_a_closed_ring_continues_the_last() {
    // The line from (0, 0) to (0, -1) comes last and points up: the arc from (0, -1) to (1, 0) leaves upward and turns by 270
    // degrees around (1, -1); tan(270 / 4 degrees) = 1 + sqrt(2).
    let ring = PathRing {
        points: vec![[0.0, -1.0], [1.0, 0.0], [0.0, 0.0]],
        segments: vec![Segment::SmoothArc, Segment::Line, Segment::Line],
    };
    let pieces = Path::new(vec![ring]).unwrap().boundary().unwrap().pieces;
    let Piece::Arc { bulge, .. } = pieces[0] else { panic!("{pieces:?}") };
    assert!((bulge - 1.0 - core::f64::consts::SQRT_2).abs() < 1e-12, "{bulge}");
}

#[test]
fn numbers_have_names() {
    let ring = PathRing {
        points: vec![[0.0, 1.0], [2.0, 3.0]],
        segments: vec![Segment::Arc { bulge: 4.0 }, Segment::SmoothCubic { handle: 5.0, control: [6.0, 7.0] }],
    };
    let path = AnyShape::from(Path::new(vec![ring]).unwrap());
    let mut numbers = Vec::new();
    path.numbers(&mut numbers);
    assert_eq!(numbers, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
    let names = [
        "rings[0].points[0][0]",
        "rings[0].points[0][1]",
        "rings[0].points[1][0]",
        "rings[0].points[1][1]",
        "rings[0].segments[0].bulge",
        "rings[0].segments[1].handle",
        "rings[0].segments[1].control[0]",
        "rings[0].segments[1].control[1]",
    ];
    assert_eq!(path.number_names(), names.map(|name| name.to_string()));
    assert_eq!(path.cast::<f32>().cast::<f64>(), path, "small whole numbers");
}

#[test]
fn an_absurd_tolerance_makes_no_more_than_1024_edges() {
    let basis = OutlineBasis::<f64>::new(16, 4).unwrap();
    for tolerance in [0.0, -1.0, 1e-300, f64::NAN, f64::INFINITY] {
        let mut outline = Outline::default();
        let how = Flattening::new(&basis, tolerance);
        Circle { radius: 1.0 }.flatten(&how, &mut outline).unwrap();
        let ring = PathRing {
            points: vec![[0.0, 0.0], [1.0, 0.0]],
            segments: vec![Segment::Arc { bulge: 1.0 }, Segment::Cubic { controls: [[1.0, 1.0], [0.0, -1.0]] }],
        };
        Path::new(vec![ring]).unwrap().flatten(&how, &mut outline).unwrap();
        assert!((12..=3 * 1024).contains(&outline.vertices.len()), "{tolerance}: {}", outline.vertices.len());
    }
}
