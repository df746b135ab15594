use alloc::vec;
use core::f64::consts::PI;

use super::*;
use crate::contour::signed_area;
use crate::shape::{AnyShape, OutlineBasis, Segment};

const MITER: Join<f64> = Join::Miter { limit: 4.0 };

fn outline_of(stroke: &Stroke<f64>, tolerance: f64) -> Outline<f64> {
    let basis = OutlineBasis::new(8, 2).unwrap();
    let mut outline = Outline::default();
    stroke.flatten(&Flattening::new(&basis, tolerance), &mut outline).unwrap();
    outline
}

/// The rings of a stroke of width 2 and the area inside, rings that turn the other way taken off.
fn drawn(rings: Vec<PathRing<f64>>, cap: Cap, join: Join<f64>) -> (Vec<usize>, f64) {
    let outline = outline_of(&Stroke { rings, width: 2.0, cap, join }, 1e-6);
    (outline.rings().iter().map(<[_]>::len).collect(), outline.rings().iter().map(signed_area).sum())
}

fn line(points: &[[f64; 2]]) -> Vec<PathRing<f64>> {
    vec![PathRing::polyline(points.to_vec())]
}

fn polygon(points: &[[f64; 2]]) -> Vec<PathRing<f64>> {
    vec![PathRing::polygon(points.to_vec())]
}

#[track_caller]
fn assert_area(area: f64, expected: f64) {
    assert!((area - expected).abs() < 1e-6, "{area} is not {expected}");
}

#[test]
fn caps() {
    let segment = line(&[[0.0, 0.0], [10.0, 0.0]]);
    let (rings, area) = drawn(segment.clone(), Cap::Butt, MITER);
    assert_eq!(rings, [4]);
    assert_area(area, 20.0);
    assert_area(drawn(segment.clone(), Cap::Square, MITER).1, 24.0);
    assert_area(drawn(segment, Cap::Round, MITER).1, 20.0 + PI);
}

#[test]
fn joins_of_a_right_angle() {
    let corner = line(&[[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]);
    // Two strips of 20 that share the inner unit square at the corner, and the wedge outside of it.
    assert_area(drawn(corner.clone(), Cap::Butt, Join::Bevel).1, 39.0 + 0.5);
    assert_area(drawn(corner.clone(), Cap::Butt, Join::Round).1, 39.0 + PI / 4.0);
    assert_eq!(drawn(corner.clone(), Cap::Butt, MITER), (vec![6], 40.0));
    // The miter of a right angle is sqrt(2) widths long.
    assert_area(drawn(corner.clone(), Cap::Butt, Join::Miter { limit: 1.42 }).1, 40.0);
    assert_area(drawn(corner, Cap::Butt, Join::Miter { limit: 1.41 }).1, 39.5);
}

#[test]
fn closed_lines_have_a_hole() {
    let square = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];
    let (rings, area) = drawn(polygon(&square), Cap::Round, MITER);
    assert_eq!(rings, [4, 4]);
    assert_area(area, 144.0 - 64.0);
    let backward: Vec<_> = square.into_iter().rev().collect();
    assert_area(drawn(polygon(&backward), Cap::Butt, MITER).1, 144.0 - 64.0);
    // The hole of a square of side 2 is filled.
    let (rings, area) = drawn(polygon(&square.map(|point| point.map(|x| x / 5.0))), Cap::Butt, MITER);
    assert_eq!((rings.len(), rings[0]), (1, 4));
    assert_area(area, 16.0);
}

#[test]
fn crossings_are_covered_once() {
    // An X of two lines of length 10 and width 2 at right angles: the square in the middle belongs to both.
    let cross =
        vec![PathRing::polyline(vec![[0.0, 5.0], [10.0, 5.0]]), PathRing::polyline(vec![[5.0, 0.0], [5.0, 10.0]])];
    let (rings, area) = drawn(cross, Cap::Butt, MITER);
    assert_eq!(rings, [12]);
    assert_area(area, 36.0);
    // The same in one go, by way of a detour whose corners are mitered.
    let (rings, area) = drawn(line(&[[0.0, 5.0], [10.0, 5.0], [10.0, 0.0], [5.0, 0.0], [5.0, 10.0]]), Cap::Butt, MITER);
    // 20 + 20 for the long lines, less 4 where they cross; corners at (10, 5), (10, 0), (5, 0) join strips of 10 and 10.
    assert_eq!(rings.len(), 2, "the detour encloses a hole: {rings:?}");
    assert_area(area, 20.0 + 10.0 + 10.0 + 20.0 - 4.0);
}

#[test]
fn doubling_back_covers_nothing_twice() {
    assert_area(drawn(line(&[[0.0, 0.0], [10.0, 0.0], [4.0, 0.0]]), Cap::Butt, MITER).1, 20.0);
    assert_area(drawn(line(&[[0.0, 0.0], [10.0, 0.0], [4.0, 0.0]]), Cap::Butt, Join::Round).1, 20.0 + PI / 2.0);
    assert_area(drawn(polygon(&[[0.0, 0.0], [10.0, 0.0]]), Cap::Butt, Join::Round).1, 20.0 + PI);
    assert_area(drawn(polygon(&[[0.0, 0.0], [10.0, 0.0]]), Cap::Butt, Join::Bevel).1, 20.0);
}

#[test]
fn dots() {
    for ring in [PathRing::polyline(vec![[3.0, 4.0]]), PathRing::polygon(vec![[3.0, 4.0]; 3])] {
        assert_area(drawn(vec![ring.clone()], Cap::Round, MITER).1, PI);
        assert_eq!(drawn(vec![ring.clone()], Cap::Square, MITER), (vec![4], 4.0));
        assert_eq!(drawn(vec![ring], Cap::Butt, MITER), (vec![0], 0.0));
    }
    assert_eq!(drawn(vec![PathRing::default()], Cap::Round, MITER), (vec![0], 0.0));
    // Repeated points have no corners.
    let repeated = line(&[[0.0, 0.0], [0.0, 0.0], [10.0, 0.0], [10.0, 0.0]]);
    assert_area(drawn(repeated, Cap::Square, Join::Round).1, 24.0);
}

#[test]
fn arcs_are_strips_of_rings() {
    let arc = |r: f64, segments| vec![PathRing { points: vec![[r, 0.0], [-r, 0.0]], segments }];
    let half = vec![Segment::Arc { bulge: 1.0 }];
    assert_area(drawn(arc(5.0, half.clone()), Cap::Butt, MITER).1, PI / 2.0 * (36.0 - 16.0));
    let whole = vec![Segment::Arc { bulge: -1.0 }; 2];
    let (rings, area) = drawn(arc(5.0, whole.clone()), Cap::Butt, MITER);
    assert_eq!(rings.len(), 2);
    assert_area(area, PI * (36.0 - 16.0));
    // Around a center nearer than half the width: all of the disk, and half of it the inner half disk of the other side too.
    assert_area(drawn(arc(0.5, whole), Cap::Butt, MITER).1, PI * 2.25);
    assert_area(drawn(arc(0.5, half), Cap::Butt, MITER).1, PI / 2.0 * (2.25 + 0.25));
}

#[test]
fn a_leg_over_the_far_side_of_a_tight_bend_has_no_hole() {
    // Half a circle of radius 1/2 from (0, -1/2) to (0, 1/2), and on along y = 1/2 to x = -10. The strip of the bend reaches half a disk of
    // radius 1/2 beyond the center, turned around, which lies in the strip of the leg, from y = -1/2 to 3/2.
    let points = vec![[0.0, -0.5], [0.0, 0.5], [-10.0, 0.5]];
    let bend = vec![PathRing { points, segments: vec![Segment::Arc { bulge: 1.0 }, Segment::Line] }];
    let (rings, area) = drawn(bend, Cap::Butt, MITER);
    assert_eq!(rings.len(), 1, "{rings:?}");
    assert_area(area, 20.0 + PI / 2.0 * 2.25);
}

#[test]
fn cubics_as_arcs() {
    // A quarter of a circle of radius 10 as a cubic, off by 0.003.
    let k = 4.0 / 3.0 * (core::f64::consts::SQRT_2 - 1.0) * 10.0;
    let segments = vec![Segment::Cubic { controls: [[10.0, k], [k, 10.0]] }];
    let (_, area) = drawn(vec![PathRing { points: vec![[10.0, 0.0], [0.0, 10.0]], segments }], Cap::Butt, MITER);
    assert!((area - PI / 4.0 * (121.0 - 81.0)).abs() < 0.01, "{area}");
}

#[test]
fn numbers_and_what_is_refused() {
    let stroke = Stroke::new(line(&[[0.0, 1.0], [2.0, 3.0]]), 4.0, Cap::Butt, MITER).unwrap();
    let mut numbers = Vec::new();
    stroke.numbers(&mut numbers);
    assert_eq!(numbers, [0.0, 1.0, 2.0, 3.0, 4.0]);
    let names = stroke.number_names();
    assert_eq!((names[3].as_str(), names[4].as_str()), ("rings[0].points[1][1]", "width"));
    let refused = Stroke::new(line(&[[0.0, 1.0], [2.0, 3.0]]), 0.0, Cap::Butt, MITER);
    assert_eq!(refused, Err(ShapeError::NotPositive { what: "width" }));
    assert_eq!(AnyShape::from(stroke.cast::<f32>()).cast::<f64>(), AnyShape::from(stroke));
    assert_eq!(
        outline_of(&Stroke { rings: line(&[[0.0, 1.0], [2.0, 3.0]]), width: 0.0, cap: Cap::Round, join: MITER }, 0.1),
        Outline::default()
    );
}

#[test]
fn measures_of_a_stroke() {
    let ring = vec![PathRing { points: vec![[5.0, 0.0], [-5.0, 0.0]], segments: vec![Segment::Arc { bulge: 1.0 }; 2] }];
    let ring = Stroke { rings: ring, width: 2.0, cap: Cap::Butt, join: MITER };
    assert!((ring.area().unwrap() / (20.0 * PI) - 1.0).abs() < 1e-9, "{:?}", ring.area());
    assert!((ring.perimeter().unwrap() / (20.0 * PI) - 1.0).abs() < 1e-4, "{:?}", ring.perimeter());
    let bounds = ring.bounds().unwrap().unwrap();
    assert!((bounds.max.x - 6.0).abs() < 1e-3 && (bounds.min.y + 6.0).abs() < 1e-3, "{bounds:?}");
    assert_eq!(ring.efd_of_ring(0, 8).unwrap().0.symmetry(1e-2), crate::shape::Symmetry::Continuous);
}
