#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use super::{DisjointSets, LineSegment, Nearest, Similarity, Vec2, convex_hull};

#[test]
fn turning_multiplies_complex_numbers() {
    let (a, b) = (Vec2::new(3.0, 4.0), Vec2::new(0.0, 2.0));
    // (3 + 4i) 2i = -8 + 6i.
    assert_eq!(a.turned(b), Vec2::new(-8.0, 6.0));
    assert_eq!(a.perp(), Vec2::new(-4.0, 3.0));
    assert_eq!((a.length(), a.dot(b), a.cross(b)), (5.0, 8.0, 6.0));
    assert_eq!(Vec2::<f64>::default().normalized(), None);
    assert_eq!(a.normalized(), Some(Vec2::new(0.6, 0.8)));
    assert_eq!(a.lerp(b, 0.5).to_array(), [1.5, 3.0]);
}

#[test]
fn the_nearest_point_of_a_segment_is_at_an_end_or_across() {
    let segment = LineSegment::new(Vec2::new(1.0, 1.0), Vec2::new(5.0, 1.0));
    let at = |x, y| segment.nearest(Vec2::new(x, y));
    assert_eq!((at(2.0, 4.0).share, at(2.0, 4.0).distance()), (0.25, 3.0));
    assert_eq!((at(0.0, 1.0).share, at(9.0, 4.0).share), (0.0, 1.0));
    assert_eq!(at(9.0, 4.0).distance_squared(), 25.0);
    let point = LineSegment::new(Vec2::new(1.0, 1.0), Vec2::new(1.0, 1.0));
    assert_eq!(point.nearest(Vec2::new(4.0, 5.0)), Nearest { share: 0.0, offset: Vec2::new(3.0, 4.0) });
}

#[test]
fn maps_are_undone_and_chained() {
    // A quarter turn about (1, 0) takes (2, 0) to (1, 1), from +x toward +y; a reflection at the line x = y swaps.
    let turn = Similarity::turn_about(Vec2::new(1.0, 0.0), core::f64::consts::FRAC_PI_2);
    let mirror = Similarity::reflection(Vec2::new(0.0, 0.0), core::f64::consts::FRAC_PI_4);
    let near = |a: Vec2<f64>, b: Vec2<f64>| (a - b).length() < 1e-15;
    assert!(near(turn.point(Vec2::new(2.0, 0.0)), Vec2::new(1.0, 1.0)));
    assert!(near(mirror.point(Vec2::new(2.0, 3.0)), Vec2::new(3.0, 2.0)));
    assert!(near(turn.fixed_point().unwrap(), Vec2::new(1.0, 0.0)));
    assert_eq!(mirror.fixed_point(), None);
    let both = turn.then(&mirror);
    assert!(near(both.point(Vec2::new(2.0, 0.0)), Vec2::new(1.0, 1.0)));
    assert!(near(both.inverse().unwrap().point(both.point(Vec2::new(0.3, -7.0))), Vec2::new(0.3, -7.0)));
    let nothing = Similarity { turn: Vec2::<f64>::default(), ..Similarity::identity() };
    assert_eq!(nothing.inverse(), None);
}

#[test]
fn hulls_leave_out_what_is_inside_or_on_a_side() {
    let points = [[1.0, 1.0], [0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [4.0, 4.0], [0.0, 4.0], [4.0, 2.0], [0.0, 0.0]];
    assert_eq!(convex_hull(&points), [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]);
    assert_eq!(convex_hull(&[[1.0, 2.0], [1.0, 2.0]]), [[1.0, 2.0]]);
    assert_eq!(convex_hull(&[[2.0, 2.0], [0.0, 0.0], [1.0, 1.0]]), [[0.0, 0.0], [2.0, 2.0]]);
}

#[test]
fn united_numbers_share_the_lowest_root() {
    let mut sets = DisjointSets::default();
    sets.reset(3);
    assert_eq!((sets.push(), sets.len()), (3, 4));
    assert_eq!((sets.unite(3, 2), sets.unite(2, 1)), (2, 1));
    assert_eq!([0, 1, 2, 3].map(|i| sets.root(i)), [0, 1, 1, 1]);
}
