//! Things of one color that lie on one another.

use dvp_core::shape::Ellipse;

use super::*;

/// Disks of red in places and of radii, painted.
fn disks(disks: &[([f64; 2], f64)]) -> Image<f32> {
    paint(&scene(WHITE, disks.iter().map(|&(at, radius)| object(circle(radius), at, 0.0, RED)).collect()))
}

/// Whether each disk is there as a circle, within some pixels, and nothing else.
fn are_found(found: &Scene<f32>, disks: &[([f64; 2], f64)], within: f64) -> bool {
    let is_found = |&(at, radius): &([f64; 2], f64)| {
        found.objects.iter().any(|object| {
            let AnyShape::Circle(Circle { radius: found }) = object.shape else { return false };
            let pixels = |value: f32| f64::from(value) * SIZE as f64;
            let [x, y] = object.pose.translation.map(pixels);
            (pixels(found) - radius).abs() < within && (x - at[0]).hypot(y - at[1]) < within
        })
    };
    found.objects.len() == disks.len() && disks.iter().all(is_found)
}

#[test]
fn disks_that_overlap_are_circles() {
    // Of the middle one two stretches are seen, and the three close in on a gap.
    let chain = [([30.3, 40.2], 12.0), ([44.6, 48.1], 12.0), ([57.2, 38.7], 12.0)];
    let around = [([38.0, 40.0], 11.0), ([56.0, 41.0], 10.0), ([47.3, 56.4], 10.5)];
    let near = [([40.2, 48.3], 15.0), ([55.9, 44.8], 9.0)];
    // A notch between two of them is too narrow for the outline to show it.
    let narrow =
        [([48.4, 36.3], 8.4), ([44.6, 45.0], 8.4), ([44.6, 58.5], 8.4), ([30.3, 54.0], 8.4), ([21.8, 51.3], 8.4)];
    for made in [&chain[..], &around, &near, &narrow] {
        let picture = disks(made);
        let found = found(&picture);
        assert!(are_found(&found, made, 0.05), "{found:?}");
        assert!(error(&picture, &found) < 1e-3);
    }
}

#[test]
fn ellipses_that_overlap_are_found() {
    // What is covered by none tells of one of which little is seen, and how far one goes.
    let hidden = [([16.9, 39.7], [7.4, 6.0], 1.69), ([27.4, 40.0], [7.1, 6.1], 1.93), ([32.0, 47.8], [7.3, 6.1], 2.92)];
    let far = [
        ([25.8, 61.1], [7.4, 6.4], 0.23),
        ([32.8, 50.5], [8.5, 5.4], 1.1),
        ([38.9, 62.2], [12.2, 9.5], 1.15),
        ([17.6, 42.1], [12.8, 10.7], 0.16),
    ];
    // The outline shows no corner where two meet; nor that what is seen of one, as a disk, would go beyond the heap.
    let smooth =
        [([76.9, 45.9], [10.4, 6.4], 0.59), ([72.2, 60.4], [10.5, 9.7], 1.46), ([74.6, 25.7], [12.9, 10.0], 1.04)];
    let beyond = [
        ([82.0, 61.9], [8.5, 5.7], 1.28),
        ([78.2, 42.8], [12.0, 8.2], 2.05),
        ([65.4, 32.5], [8.9, 5.5], 3.04),
        ([60.4, 19.2], [11.1, 6.7], 2.31),
    ];
    for made in [&hidden[..], &far, &smooth, &beyond] {
        let ellipse = |&(at, radii, turn): &([f64; 2], [f64; 2], f64)| {
            object(AnyShape::Ellipse(Ellipse { radii }), at, turn, RED)
        };
        let picture = paint(&scene(WHITE, made.iter().map(ellipse).collect()));
        let found = found(&picture);
        assert_eq!(found.objects.len(), made.len(), "{found:?}");
        for &([x, y], ..) in made {
            let off = |object: &Object<f32>| {
                let [found_x, found_y] = object.pose.translation.map(|value| f64::from(value) * SIZE as f64);
                (found_x - x).hypot(found_y - y)
            };
            assert!(found.objects.iter().map(off).fold(f64::INFINITY, f64::min) < 0.5);
        }
        assert!(error(&picture, &found) < 1e-3);
    }
}

#[test]
fn all_of_a_heap_know_of_it() {
    let made = [([30.3, 40.2], 12.0), ([44.6, 48.1], 12.0), ([75.0, 70.0], 12.0)];
    let traced = trace(&disks(&made).view(), &Known::default()).unwrap();
    let heaps: Vec<Option<usize>> = traced.doubts.iter().map(|doubt| doubt.heap).collect();
    let alone = heaps.iter().position(Option::is_none).unwrap();
    assert_eq!(heaps.len(), 3);
    assert!((f64::from(traced.scene.objects[alone].pose.translation[0]) * SIZE as f64 - 75.0).abs() < 0.1);
    assert_eq!(heaps[(alone + 1) % 3], heaps[(alone + 2) % 3]);
}

#[test]
fn triangles_that_overlap_are_others_again() {
    let triangle = || {
        let points = vec![[0.0, -10.0], [9.0, 6.0], [-9.0, 6.0]];
        AnyShape::Path(Path { rings: vec![PathRing::polygon(points)], fill: FillRule::EvenOdd })
    };
    let at = |x, y| object(triangle(), [x, y], 0.0, BLUE);
    let made = scene(WHITE, vec![at(20.3, 24.4), at(60.2, 50.1), at(68.7, 58.3), at(56.4, 61.2)]);
    let picture = paint(&made);
    let found = found(&picture);
    assert_eq!(found.objects.len(), 4, "{found:?}");
    assert!(error(&picture, &found) < 1e-3);
    // Without one that is seen whole, those that show all but a corner tell what they are.
    for apart in [[10.0, 7.0], [-9.0, 6.0]] {
        let heap = paint(&scene(WHITE, vec![at(40.3, 45.2), at(40.3 + apart[0], 45.2 + apart[1])]));
        assert_eq!(self::found(&heap).objects.len(), 2);
    }
    let notched = AnyShape::Path(Path {
        rings: vec![PathRing::polygon(vec![[-12.0, -9.0], [0.0, -2.0], [12.0, -9.0], [9.0, 11.0], [-9.0, 11.0]])],
        fill: FillRule::EvenOdd,
    });
    let alone = paint(&scene(WHITE, vec![object(notched, [48.0, 48.0], 0.0, BLUE)]));
    assert_eq!(self::found(&alone).objects.len(), 1);
}

/// Upright rectangles by their sides, in red.
fn rectangles(sides: &[[f64; 4]]) -> Image<f32> {
    let rectangle = |&[left, top, right, bottom]: &[f64; 4]| {
        object(rectangle(right - left, bottom - top), [0.5 * (left + right), 0.5 * (top + bottom)], 0.0, RED)
    };
    paint(&scene(WHITE, sides.iter().map(rectangle).collect()))
}

#[test]
fn squares_that_overlap_are_others_again() {
    let whole = [5.0, 5.0, 20.0, 20.0];
    // Sides on one line, and one that is a pixel wider, as on the grid of pixels.
    let in_line = [[30.0, 30.0, 45.0, 45.0], [40.0, 30.0, 55.0, 45.0], [48.0, 40.0, 63.0, 55.0]];
    let wider = [[30.0, 30.0, 45.0, 45.0], [38.0, 41.0, 54.0, 56.0]];
    for heap in [&in_line[..], &wider] {
        let picture = rectangles(&[&[whole], heap].concat());
        let found = found(&picture);
        assert_eq!(found.objects.len(), heap.len() + 1, "{found:?}");
        assert!(error(&picture, &found) < 1e-4);
    }
}

#[test]
fn a_square_of_which_no_corner_is_seen_is_another_again() {
    let lefts_and_tops = [[3.0, 3.0], [42.0, 42.0], [28.0, 28.0], [58.0, 26.0], [27.0, 58.0], [57.0, 59.0]];
    let picture = rectangles(&lefts_and_tops.map(|[left, top]| [left, top, left + 22.0, top + 22.0]));
    assert_eq!(found(&picture).objects.len(), 6);
}

#[test]
fn two_bars_in_a_row_are_a_longer_one() {
    // A corner is cut off, so that it is no rectangle.
    let points = vec![[-8.0, -26.0], [8.0, -26.0], [8.0, 24.5], [6.5, 26.0], [-8.0, 26.0]];
    let longer = AnyShape::Path(Path { rings: vec![PathRing::polygon(points)], fill: FillRule::EvenOdd });
    for turn in [0.0, 0.1] {
        let red = |shape, x, y| object(shape, [x, y], turn, RED);
        let bars = vec![red(rectangle(16.0, 40.0), 25.0, 48.0), red(longer.clone(), 62.0, 48.0)];
        let picture = paint(&scene(WHITE, [bars, vec![red(rectangle(10.0, 10.0), 82.0, 18.0)]].concat()));
        assert_eq!(found(&picture).objects.len(), 3);
    }
}

#[test]
fn squares_side_by_side_are_a_figure() {
    let [whole, a, b] = [[5.0, 5.0, 20.0, 20.0], [30.0, 30.0, 45.0, 45.0], [45.0, 30.0, 60.0, 45.0]];
    // An L, and one whose squares overlap by the pixel by which they may be larger.
    for c in [[30.0, 45.0, 45.0, 60.0], [30.0, 44.0, 45.0, 59.0]] {
        let found = found(&rectangles(&[whole, a, b, c]));
        assert_eq!(found.objects.len(), 2, "{found:?}");
    }
}

/// A closed path of arcs of one bulge around a place.
fn scallops(count: usize, radius: f64, bulge: f64) -> AnyShape<f64> {
    let turn = |k: usize| core::f64::consts::TAU * k as f64 / count as f64;
    let points = (0..count).map(|k| [radius * turn(k).cos(), radius * turn(k).sin()]).collect();
    let ring = PathRing { points, segments: vec![Segment::Arc { bulge }; count] };
    AnyShape::Path(Path { rings: vec![ring], fill: FillRule::EvenOdd })
}

#[test]
fn a_thing_of_arcs_that_round_things_do_not_fill_is_one() {
    for count in [8, 12] {
        let picture = paint(&scene(WHITE, vec![object(scallops(count, 28.0, 0.8), [48.2, 47.7], 0.0, RED)]));
        let found = found(&picture);
        assert_eq!(found.objects.len(), 1, "{found:?}");
        assert!(error(&picture, &found) < 2e-3);
    }
}

/// Two to four disks, each next to one before, none hidden by more than about half.
fn heaps() -> impl Strategy<Value = Vec<([f64; 2], f64)>> {
    let next = (0.0..core::f64::consts::TAU, 0.75..1.6, 8.0..13.0);
    proptest::collection::vec(next, 2..5).prop_map(|steps| {
        let mut heap: Vec<([f64; 2], f64)> = Vec::new();
        let mut way = 0.0;
        for (turn, apart, radius) in steps {
            let Some(&([x, y], before)) = heap.last() else {
                heap.push(([48.0, 48.0], radius));
                way = turn;
                continue;
            };
            // On around, so that none comes to lie on those before the last.
            way += 0.25 * turn - 0.125 * core::f64::consts::TAU;
            let far = apart * f64::max(before, radius);
            heap.push(([x + far * way.cos(), y + far * way.sin()], radius));
        }
        heap
    })
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(41), cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn heaps_of_disks_come_back(heap in heaps()) {
        let is_inside = |&([x, y], radius): &([f64; 2], f64)| {
            [x, y].iter().all(|&at| at > radius + 2.0 && at + radius + 2.0 < SIZE as f64)
        };
        prop_assume!(heap.iter().all(is_inside));
        let picture = disks(&heap);
        let found = found(&picture);
        // Radii that are about equal are made so, which moves an edge by up to a fifth of a pixel.
        prop_assert!(error(&picture, &found) < 2e-3, "{found:?}");
        // Of what is nearly hidden, or touches, less can be told.
        let is_told = heap.iter().enumerate().all(|(k, one)| heap[..k].iter().all(|other| {
            let far = (one.0[0] - other.0[0]).hypot(one.0[1] - other.0[1]);
            far > 0.75 * one.1.max(other.1) && (far < 0.9 * (one.1 + other.1) || far > one.1 + other.1 + 2.0)
        }));
        prop_assume!(is_told);
        prop_assert!(are_found(&found, &heap, 0.2), "{heap:?} {found:?}");
    }
}
