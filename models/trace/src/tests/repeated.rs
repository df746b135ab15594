//! Things that are there twice, in two sizes: what is seen of one tells what is hidden of the other.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::Similarity;
use dvp_core::shape::{AnyShape, FillRule, Path, PathRing, Shape as _};
use dvp_core::{Object, Scene, Vec2};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::{WHITE, error, found, object, paint, rectangle, scene};
use crate::outline::OutlineShape;

const SAND: [f32; 3] = [0.9, 0.8, 0.5];
const BLUE: [f32; 3] = [0.1, 0.2, 0.7];
const GRAY: [f32; 3] = [0.35, 0.4, 0.42];

/// A hook with an opening that no simpler rule than another hook tells the hidden half of.
fn hook(scale: f64) -> AnyShape<f64> {
    let ring = |points: &[[f64; 2]]| PathRing::polygon(points.iter().map(|point| point.map(|c| c * scale)).collect());
    let outer = ring(&[[-14.0, -15.0], [15.0, -15.0], [10.0, -3.0], [3.0, -3.0], [6.0, 15.0], [-14.0, 15.0]]);
    let opening = ring(&[[-9.0, 3.0], [-9.0, 10.0], [1.0, 10.0], [-1.0, 3.0]]);
    AnyShape::Path(Path { rings: vec![outer, opening], fill: FillRule::EvenOdd })
}

/// Square pixels inside an object of the picture.
fn area(object: &Object<f32>) -> f64 {
    let scale = f64::from(object.pose.scale) * super::SIZE as f64;
    f64::from(object.shape.area().unwrap()) * scale * scale
}

fn of_color(objects: &[Object<f32>], color: [f32; 3]) -> Vec<&Object<f32>> {
    let is_near = |object: &&Object<f32>| object.color().iter().zip(color).all(|(a, b)| (a - b).abs() < 0.01);
    objects.iter().filter(is_near).collect()
}

/// Half of a hook in some scale behind a bar is found as it is where another thing is a hook.
fn assert_told_by(other: AnyShape<f64>, scale: f64) {
    let bar = object(rectangle(12.0, 50.0), [71.3, 61.4], 0.0, GRAY);
    let hidden = object(hook(scale), [70.4, 62.6], 0.0, BLUE);
    let made = scene(WHITE, vec![object(other, [24.3, 25.2], 0.0, SAND), hidden, bar]);
    let picture = paint(&made);
    let found = found(&picture);
    let blue = of_color(&found.objects, BLUE);
    assert!(found.objects.len() == 3 && blue.len() == 1, "{found:?}");
    let truth = area(&made.objects[1]);
    // Three numbers known to hundredths of a pixel.
    assert!((area(blue[0]) / truth - 1.0).abs() < 0.01, "{} of {truth}", area(blue[0]));
    assert!(error(&picture, &found) < 1e-3);
}

#[test]
fn what_is_hidden_of_a_thing_is_as_it_is_of_another() {
    [0.9, 1.0, 1.3].into_iter().for_each(|scale| assert_told_by(hook(1.0), scale));
}

#[test]
fn what_is_hidden_of_a_thing_is_as_it_is_of_another_upside_down_or_mirrored() {
    for flip in [[1.0, -1.0], [-1.0, 1.0]] {
        let mut flipped = hook(1.0);
        let AnyShape::Path(path) = &mut flipped else { unreachable!() };
        path.rings.iter_mut().flat_map(|ring| &mut ring.points).for_each(|point| {
            *point = [point[0] * flip[0], point[1] * flip[1]];
        });
        assert_told_by(flipped, 1.2);
    }
}

#[test]
fn another_thing_is_no_reason_for_what_is_seen_otherwise() {
    let other = PathRing::polygon(vec![[-14.0, -15.0], [15.0, -15.0], [10.0, 12.0], [-4.0, 6.0]]);
    let other = AnyShape::Path(Path { rings: vec![other], fill: FillRule::EvenOdd });
    let bar = object(rectangle(12.0, 50.0), [66.3, 61.4], 0.0, GRAY);
    let made =
        scene(WHITE, vec![object(hook(1.0), [24.3, 25.2], 0.0, SAND), object(other, [70.4, 62.6], 0.0, BLUE), bar]);
    let picture = paint(&made);
    let found = found(&picture);
    assert!(error(&picture, &found) < 1e-3);
    let AnyShape::Path(path) = &of_color(&found.objects, BLUE)[0].shape else { panic!("{found:?}") };
    assert_eq!(path.rings.len(), 1, "{found:?}");
}

#[test]
fn nothing_is_found_that_covers_nothing() {
    // Corners of three colors a part of a pixel apart.
    let made = scene(
        WHITE,
        vec![
            object(hook(1.0), [40.3, 40.2], 0.0, SAND),
            object(hook(1.1), [52.7, 44.9], 0.0, BLUE),
            object(hook(0.9), [46.4, 58.6], 0.0, GRAY),
        ],
    );
    let found = found(&paint(&made));
    assert!(found.objects.iter().all(|object| area(object) > 1.0 / 255.0), "{found:?}");
}

/// A triangle with an opening, in shares of a size; standing on its tip where `tip` is -1.
fn gable(size: f64, tip: f64) -> AnyShape<f64> {
    let ring =
        |points: &[[f64; 2]]| PathRing::polygon(points.iter().map(|[x, y]| [x * size, y * tip * size]).collect());
    let outer = ring(&[[-0.01, -0.12], [0.01, -0.12], [0.22, 0.09], [0.22, 0.12], [-0.22, 0.12], [-0.22, 0.09]]);
    let opening = ring(&[[-0.01, -0.02], [-0.09, 0.06], [0.09, 0.06], [0.01, -0.02]]);
    AnyShape::Path(Path { rings: vec![outer, opening], fill: FillRule::EvenOdd })
}

/// All things of a picture are found, each as large as it is behind the others; and in this order.
fn assert_whole(made: &Scene<f32>) {
    let found = found(&paint(made));
    assert_eq!(found.objects.len(), made.objects.len(), "{found:?}");
    for (truth, found) in made.objects.iter().zip(&found.objects) {
        assert!(truth.color().iter().zip(found.color()).all(|(a, b)| (a - b).abs() < 0.01), "order: {found:?}");
        let [truth, area] = [truth, found].map(area);
        // Arms of a few pixels tell of a size to one or two percent.
        assert!((area / truth - 1.0).abs() < 0.03, "{area} of {truth}");
    }
}

#[test]
fn two_sides_and_a_corner_tell_of_what_is_hidden() {
    let (left, front) =
        (object(gable(78.4, 1.0), [37.15, 25.19], 0.0, BLUE), object(gable(93.11, 1.0), [40.37, 27.91], 0.0, SAND));
    assert_whole(&scene(WHITE, vec![left, front]));
}

#[test]
fn who_lies_in_front_is_told_by_what_is_there_again() {
    let back = object(gable(92.99, 1.0), [41.34, 29.9], 0.0, [0.84, 0.37, 0.9]);
    let middle = object(gable(95.17, 1.0), [26.82, 18.15], 0.0, [0.98, 0.95, 0.99]);
    let front = object(gable(73.94, -1.0), [38.17, 29.66], 0.0, [0.52, 0.05, 0.91]);
    assert_whole(&scene([0.28, 0.92, 0.91], vec![back, middle, front]));
}

/// A square with a square opening.
fn frame(square: f64, opening: f64) -> AnyShape<f64> {
    let ring = |side: f64| {
        PathRing::polygon(
            [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|at| at.map(|c| 0.5 * c * side)).into(),
        )
    };
    AnyShape::Path(Path { rings: vec![ring(square), ring(opening)], fill: FillRule::EvenOdd })
}

#[test]
fn what_is_seen_of_a_frame_tells_what_is_hidden_of_it() {
    let square = object(frame(24.0, 12.0), [40.3, 40.6], 0.0, BLUE);
    // A side of it behind a bar, and a corner behind a larger square.
    let bar = object(rectangle(50.0, 10.0), [42.0, 29.2], 0.0, SAND);
    let corner = object(rectangle(24.0, 24.0), [56.2, 27.4], 0.0, SAND);
    for front in [bar, corner] {
        assert_whole(&scene(WHITE, vec![square.clone(), front]));
    }
}

fn shapes() -> impl Strategy<Value = OutlineShape> {
    let center = || (5.0..90.0, 5.0..90.0).prop_map(|(x, y)| Vec2::new(x, y));
    prop_oneof![
        (center(), 1.0..20.0).prop_map(|(center, radius)| OutlineShape::Circle { center, radius }),
        (center(), [1.0..20.0, 1.0..20.0], 0.0..3.0).prop_map(|(center, radii, angle)| OutlineShape::Ellipse {
            center,
            radii,
            angle
        }),
        (center(), [4.0..30.0, 4.0..30.0], 0.0..1.9, 0.0..3.0).prop_map(|(center, size, corner_radius, angle)| {
            OutlineShape::Rectangle { center, size, corner_radius, angle }
        }),
        (center(), 3_usize..8, 2.0..20.0, 0.0..3.0)
            .prop_map(|(center, sides, radius, angle)| OutlineShape::RegularPolygon { center, sides, radius, angle }),
        (center(), 3_usize..8, 8.0..20.0, 2.0..7.0, 0.0..3.0).prop_map(|(center, points, outer, inner, angle)| {
            OutlineShape::Star { center, points, radii: [outer, inner], angle }
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(0x5ca1e), ..ProptestConfig::default() })]

    #[test]
    fn a_moved_outline_is_the_outline_of_moved_points(
        shape in shapes(), scale in 0.3..3.0, angle in -3.0..3.0, x in -40.0..40.0, y in -40.0..40.0, reflected in any::<bool>(),
    ) {
        let turn = Vec2::from_angle(angle) * scale;
        let map = Similarity { turn, translation: Vec2::new(x, y), reflected };
        let (moved, ring) = (shape.moved(&map).ring(), shape.ring());
        // A path is moved point by point.
        let as_path = OutlineShape::Path(ring.clone()).moved(&map).ring();
        for (k, point) in ring.points.iter().enumerate() {
            let expected = map.point(Vec2::from(*point));
            // The two points that make a circle are where they are, however it is turned.
            let is_round = matches!(shape, OutlineShape::Circle { .. });
            // A figure that is reflected may begin elsewhere.
            let is_there = |at: &[f64; 2]| (Vec2::from(*at) - expected).length() < 1e-9;
            prop_assert!(is_round || moved.points.iter().any(is_there));
            prop_assert!((Vec2::from(as_path.points[k]) - expected).length() < 1e-9);
        }
        let area = |ring: PathRing<f64>| Path { rings: vec![ring], fill: FillRule::EvenOdd }.area().unwrap();
        let before = area(ring);
        for after in [area(moved), area(as_path)] {
            prop_assert!((after - scale * scale * before).abs() < 1e-6 * after.abs());
        }
    }
}
