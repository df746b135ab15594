#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use alloc::vec;

use super::*;
use crate::contour::signed_area;

/// The rings that bound what closed polygons fill, and the area inside.
fn resolved(rings: &[&[[f64; 2]]], rule: FillRule) -> (Outline<f64>, f64) {
    let mut raw = Outline::default();
    rings.iter().for_each(|ring| raw.push_ring(ring.iter().copied()));
    let mut outline = Outline::default();
    resolve(raw.rings(), rule).unwrap().append(&raw.vertices, &mut outline);
    let area = outline.rings().iter().map(signed_area).sum();
    (outline, area)
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-12
}

/// From (x, y), sides 2, turning from +x to +y.
fn square(x: f64, y: f64) -> [[f64; 2]; 4] {
    [[x, y], [x + 2.0, y], [x + 2.0, y + 2.0], [x, y + 2.0]]
}

#[test]
fn a_bow_tie_becomes_two_triangles() {
    let (outline, area) = resolved(&[&[[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]], FillRule::EvenOdd);
    assert!(close(area, 2.0), "{outline:?}");
    assert_eq!((outline.vertices.len(), outline.breaks.len()), (6, 1));
    assert_eq!(outline.vertices.iter().filter(|&&vertex| vertex == [1.0, 1.0]).count(), 2);
}

#[test]
fn overlapping_squares() {
    let (first, second) = (square(0.0, 0.0), square(1.0, 1.0));
    // 4 + 4 - 1, and without what both have 6.
    let (union, area) = resolved(&[&first, &second], FillRule::NonZero);
    assert!(close(area, 7.0) && union.breaks.is_empty() && union.vertices.len() == 8, "{union:?}");
    let (outline, area) = resolved(&[&first, &second], FillRule::EvenOdd);
    assert!(close(area, 6.0), "{outline:?}");
    // The other way around they cancel where both are, and nothing is wound twice elsewhere.
    let mut opposite = second;
    opposite.reverse();
    assert!(close(resolved(&[&first, &opposite], FillRule::NonZero).1, 6.0));
}

#[test]
fn edges_in_common_vanish() {
    let (union, area) = resolved(&[&square(0.0, 0.0), &square(2.0, 0.0)], FillRule::NonZero);
    assert!(close(area, 8.0) && union.breaks.is_empty(), "{union:?}");
    // A part of an edge in common.
    let (union, area) = resolved(&[&square(0.0, 0.0), &square(2.0, 1.0)], FillRule::NonZero);
    assert!(close(area, 8.0) && union.breaks.is_empty(), "{union:?}");
    // The same square twice, and there and back.
    assert!(close(resolved(&[square(0.0, 0.0).as_slice(); 2], FillRule::NonZero).1, 4.0));
    assert_eq!(resolved(&[square(0.0, 0.0).as_slice(); 2], FillRule::EvenOdd).0, Outline::default());
    assert_eq!(resolved(&[&[[0.0, 0.0], [1.0, 0.5], [3.0, 1.5]]], FillRule::NonZero).0, Outline::default());
}

#[test]
fn squares_that_touch_in_a_corner_stay_two_rings() {
    let (outline, area) = resolved(&[&square(0.0, 0.0), &square(2.0, 2.0)], FillRule::NonZero);
    assert!(close(area, 8.0));
    assert_eq!(outline.rings().iter().map(<[_]>::len).collect::<Vec<_>>(), [4, 4]);
}

#[test]
fn holes_turn_the_other_way() {
    let outer = [[-1.0, -1.0], [4.0, -1.0], [4.0, 4.0], [-1.0, 4.0]];
    let (outline, area) = resolved(&[&outer, &square(0.0, 0.0)], FillRule::EvenOdd);
    assert!(close(area, 21.0), "{outline:?}");
    let areas: Vec<f64> = outline.rings().iter().map(signed_area).collect();
    assert_eq!(areas, [25.0, -4.0]);
    assert!(close(resolved(&[&outer, &square(0.0, 0.0)], FillRule::NonZero).1, 25.0));
}

#[test]
fn tall_rings_turn_the_same_way() {
    let tall = [[0.0, 0.0], [2.0, 0.0], [2.0, 9.0], [0.0, 9.0]];
    for rule in [FillRule::EvenOdd, FillRule::NonZero] {
        assert!(close(resolved(&[&tall], rule).1, 18.0));
        let mut backward = tall;
        backward.reverse();
        assert!(close(resolved(&[&backward], rule).1, 18.0));
    }
    let (outline, _) = resolved(&[&tall, &[[0.5, 0.5], [1.0, 0.5], [1.0, 1.5]]], FillRule::EvenOdd);
    assert_eq!(outline.rings().iter().map(signed_area).collect::<Vec<_>>(), [18.0, -0.25]);
}

#[test]
fn degenerate_rings() {
    assert_eq!(resolved(&[], FillRule::NonZero).0, Outline::default());
    assert_eq!(resolved(&[&[[3.0, 4.0]; 5]], FillRule::NonZero).0, Outline::default());
    let tiny = square(0.0, 0.0).map(|corner| corner.map(|value| value * 1e-290));
    assert_eq!(resolved(&[&tiny], FillRule::NonZero).0.vertices.len(), 4);
    let mut raw = Outline::<f64>::default();
    raw.push_ring([[0.0, 0.0], [f64::NAN, 0.0], [1.0, 1.0]]);
    assert!(matches!(resolve(raw.rings(), FillRule::NonZero), Err(ShapeError::NotFinite { index: 2 })));
    raw.clear();
    raw.push_ring(vec![[-f64::MAX, 0.0], [f64::MAX, 0.0], [1.0, 1.0]]);
    assert!(matches!(resolve(raw.rings(), FillRule::NonZero), Err(ShapeError::TooLarge)));
}
