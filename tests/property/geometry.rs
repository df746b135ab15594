//! Invariants of the plane: nearest points, maps, hulls, boxes, disjoint sets and the components that they label.

#![expect(clippy::float_cmp, reason = "the sides of a box are coordinates of its points, bit for bit")]

use dvp_core::ImageSize;
use dvp_core::contour::{Connectivity, label_by};
use dvp_core::geometry::{Bounds, DisjointSets, LineSegment, Similarity, Vec2, convex_hull};
use proptest::prelude::*;

fn point() -> impl Strategy<Value = Vec2<f64>> {
    (-4.0..4.0, -4.0..4.0).prop_map(|(x, y)| Vec2::new(x, y))
}

/// Turns of any angle, growth by an eighth to eight, reflected or not.
fn similarity() -> impl Strategy<Value = Similarity<f64>> {
    (0.0..core::f64::consts::TAU, -3.0..3.0_f64, point(), any::<bool>()).prop_map(
        |(angle, power, translation, reflected)| Similarity {
            turn: Vec2::from_angle(angle) * power.exp2(),
            translation,
            reflected,
        },
    )
}

/// Points anywhere, or with coordinates of few whole values: many on a line, many twice, and every cross product exact.
fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
    let anywhere = prop::collection::vec((-4.0..4.0, -4.0..4.0).prop_map(|(x, y)| [x, y]), 0..40);
    let crowded = prop::collection::vec((-3_i8..4, -3_i8..4).prop_map(|(x, y)| [f64::from(x), f64::from(y)]), 0..40);
    prop_oneof![anywhere, crowded]
}

/// Twice the area of a triangle, positive if it turns from +x toward +y.
fn turn([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let [a, b, c] = [a, b, c].map(Vec2::from);
    (b - a).cross(c - a)
}

/// The set of every number: unions as lists of sets, one number after another.
fn sets_of(count: u32, pairs: &[(u32, u32)]) -> Vec<Vec<u32>> {
    let mut sets: Vec<Vec<u32>> = (0..count).map(|number| vec![number]).collect();
    for (a, b) in pairs {
        let (joined, others): (Vec<_>, Vec<_>) = sets.into_iter().partition(|set| set.contains(a) || set.contains(b));
        sets = others;
        sets.push(joined.concat());
    }
    sets
}

/// The components of pixels of equal value, 0 being outside, numbered by their first pixels: a flood from each pixel
/// that no flood before has reached.
fn flooded(values: &[u8], size: ImageSize, connectivity: Connectivity) -> Vec<u32> {
    let mut labels = vec![0; values.len()];
    let mut count = 0;
    for first in 0..values.len() {
        if values[first] == 0 || labels[first] > 0 {
            continue;
        }
        count += 1;
        let mut waiting = vec![first];
        while let Some(pixel) = waiting.pop() {
            labels[pixel] = count;
            let (x, y) = (pixel % size.width(), pixel / size.width());
            for other in 0..values.len() {
                let (across, down) = (x.abs_diff(other % size.width()), y.abs_diff(other / size.width()));
                let is_neighbor = match connectivity {
                    Connectivity::Four => across + down == 1,
                    Connectivity::Eight => across.max(down) == 1,
                };
                if is_neighbor && labels[other] == 0 && values[other] == values[pixel] {
                    waiting.push(other);
                }
            }
        }
    }
    labels
}

proptest! {
    #[test]
    fn the_nearest_point_is_on_the_segment_and_no_other_is_nearer(from in point(), to in point(), at in point()) {
        let nearest = LineSegment::new(from, to).nearest(at);
        prop_assert!((0.0..=1.0).contains(&nearest.share));
        prop_assert!((at - nearest.offset - from.lerp(to, nearest.share)).length() < 1e-12);
        for k in 0..=100 {
            let other = from.lerp(to, f64::from(k) / 100.0);
            prop_assert!(nearest.distance() <= (at - other).length() + 1e-12, "{k} hundredths along is nearer");
        }
        prop_assert!((nearest.distance().powi(2) - nearest.distance_squared()).abs() < 1e-12);
    }

    #[test]
    fn an_inverse_undoes_a_similarity_before_and_after_it(map in similarity(), at in point()) {
        let inverse = map.inverse().unwrap();
        for there_and_back in [map.then(&inverse), inverse.then(&map)] {
            prop_assert!((there_and_back.point(at) - at).length() < 1e-12);
        }
        prop_assert!((inverse.point(map.point(at)) - at).length() < 1e-12);
        prop_assert!((map.scale() * inverse.scale() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn maps_are_chained_in_any_grouping(a in similarity(), b in similarity(), c in similarity(), at in point()) {
        let expected = c.point(b.point(a.point(at)));
        for chained in [a.then(&b).then(&c), a.then(&b.then(&c))] {
            // Up to 8^3 times as far away as the points are, and as many roundings.
            prop_assert!((chained.point(at) - expected).length() < 1e-10);
        }
        let scale = a.scale() * b.scale();
        prop_assert!((a.then(&b).scale() / scale - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_hull_is_convex_and_holds_every_point(points in points()) {
        let hull = convex_hull(&points);
        prop_assert!(hull.iter().all(|corner| points.contains(corner)));
        for (k, &corner) in hull.iter().enumerate() {
            prop_assert!(!hull[..k].contains(&corner), "{corner:?} twice");
            let next = hull[(k + 1) % hull.len()];
            for &point in &points {
                prop_assert!(turn([corner, next, point]) >= -1e-12, "{point:?} is beyond {corner:?} to {next:?}");
            }
            if hull.len() > 2 {
                let turn = turn([corner, next, hull[(k + 2) % hull.len()]]);
                prop_assert!(turn > 0.0, "no turn at {next:?}");
            }
        }
        // The farthest points in any direction are corners, so that nothing of the hull is missing.
        for k in 0..16 {
            let direction = Vec2::from_angle(f64::from(k));
            let farthest = |of: &[[f64; 2]]| of.iter().map(|&p| direction.dot(p.into())).reduce(f64::max);
            let (of_points, of_hull) = (farthest(&points), farthest(&hull));
            prop_assert!(
                of_points.zip(of_hull).map_or(points.is_empty() && hull.is_empty(), |(a, b)| a - b < 1e-12),
                "{of_points:?} against {of_hull:?}"
            );
        }
    }

    #[test]
    fn bounds_hold_their_points_and_touch_them_on_every_side(points in points()) {
        let Some(bounds) = Bounds::of_vertices(&points) else {
            prop_assert!(points.is_empty());
            return Ok(());
        };
        let Bounds { min, max } = bounds;
        prop_assert!(points.iter().all(|[x, y]| (min.x..=max.x).contains(x) && (min.y..=max.y).contains(y)));
        // A smaller box would leave out a point of a side.
        prop_assert!(points.iter().any(|p| p[0] == min.x) && points.iter().any(|p| p[0] == max.x));
        prop_assert!(points.iter().any(|p| p[1] == min.y) && points.iter().any(|p| p[1] == max.y));
        prop_assert!((bounds.center() * 2.0 - (min + max)).length() < 1e-12);
        prop_assert!((min + bounds.size() - max).length() < 1e-12);
    }

    #[test]
    fn sets_are_what_was_united(count in 1_u32..24, pairs in prop::collection::vec((0_u32..24, 0_u32..24), 0..24)) {
        let pairs: Vec<(u32, u32)> = pairs.into_iter().map(|(a, b)| (a % count, b % count)).collect();
        let mut sets = DisjointSets::default();
        sets.reset(count);
        for &(a, b) in &pairs {
            let root = sets.unite(a, b);
            prop_assert_eq!((sets.root(a), sets.root(b)), (root, root));
        }
        let mut expected = sets_of(count, &pairs);
        expected.iter_mut().for_each(|set| set.sort_unstable());
        prop_assert_eq!(sets.len(), expected.iter().map(Vec::len).sum::<usize>());
        // Every number has the lowest of its set as its root: one root in a set, and none in two.
        for set in expected {
            prop_assert!(set.iter().all(|&number| sets.root(number) == set[0]), "{set:?}");
        }
    }

    #[test]
    fn labels_are_those_of_a_flood(
        (width, values) in (1_usize..9, 1_usize..9)
            .prop_flat_map(|(width, height)| (Just(width), prop::collection::vec(0_u8..4, width * height))),
        eight in any::<bool>(),
    ) {
        let size = ImageSize::new(width, values.len() / width).unwrap();
        let connectivity = if eight { Connectivity::Eight } else { Connectivity::Four };
        let found = label_by(size, connectivity, |i| values[i] > 0, |i, j| values[i] == values[j]);
        let expected = flooded(&values, size, connectivity);
        prop_assert_eq!(&found.labels, &expected);
        let count = expected.iter().max().map_or(0, |&most| most as usize);
        prop_assert_eq!(found.sizes.len(), count);
        for (number, &size) in (1..).zip(&found.sizes) {
            prop_assert_eq!(expected.iter().filter(|&&label| label == number).count(), size);
        }
    }
}
