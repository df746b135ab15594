use dvp_core::geometry::Vec2;
use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{
    AnyShape, Cap, Circle, Ellipse, FillRule, Join, Path, PathRing, Piece, Polygon, Rectangle, RegularPolygon, Segment,
    Star, Stroke,
};
use dvp_core::{Efd, ImageSize, Object, Paint, Pose, Scene};
use dvp_fit::Bank;

use super::curves::smooth;
use super::number::short;
use super::path_data::PathData;
use super::{to_svg, to_svg_numbered};

mod overlaps;

fn disk(x: f32, color: [f32; 3]) -> Object<f32> {
    let pose = Pose { translation: [x, 0.5], scale: 0.2, rotation: 0.0 };
    Object::of_efd(pose, color, 1.0, Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]), None)
}

/// The element of a red object in an image of 100 x 100 pixels.
fn element(shape: impl Into<AnyShape<f64>>, rotation: f64) -> String {
    let pose = Pose { translation: [0.5, 0.25], scale: 1.0, rotation };
    let object = Object { shape: shape.into(), pose, paint: Paint::Flat([1.0, 0.0, 0.0]), confidence: 1.0 };
    let scene = Scene {
        objects: vec![object],
        edge: EdgeProfile::area(),
        compositing: Compositing::Over,
        transparent: true,
        ..Scene::empty([1.0; 3])
    };
    let text = to_svg(&scene, ImageSize::new(100, 100).unwrap(), None).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 3, "no background: {text}");
    lines[1].to_owned()
}

#[test]
fn numbers_are_short() {
    let texts = [(0.0, "0"), (-0.0001, "0"), (0.5, ".5"), (-0.25, "-.25"), (12.0, "12"), (1.23456, "1.235")];
    let more = [(-12.5, "-12.5"), (0.031, ".031"), (100.0, "100"), (1e12, "1000000000000"), (-0.0314, "-.031")];
    for (value, text) in texts.into_iter().chain(more) {
        assert_eq!(short(value, 3), text);
    }
    assert_eq!(short(0.123_456_789, 8), "0.12345679", "many decimals");
}

#[test]
fn curves_are_few_and_close() {
    // Halves of a circle as cubics are off by 0.018 of the radius at best, quarters by 2.7e-4, eighths by 4e-6; splits at
    // the worst point leave uneven pieces.
    let circle: Vec<_> = (0..64).map(|i| Vec2::from_angle(f64::from(i) / 63.0 * core::f64::consts::TAU)).collect();
    for (tolerance, most) in [(0.05, 2), (0.002, 6), (1e-4, 14)] {
        let pieces = smooth(&circle, tolerance);
        assert!((1..=most).contains(&pieces.len()), "{tolerance}: {pieces:?}");
        assert!(pieces.iter().all(|piece| matches!(piece, Piece::Cubic(_))), "{pieces:?}");
    }
}

#[test]
fn an_outline_with_one_corner_is_followed_all_around() {
    // A drop: a circle that runs into a tip at the right.
    let drop: Vec<Vec2<f64>> = (0..64)
        .map(|k| {
            let angle = core::f64::consts::TAU * f64::from(k) / 64.0;
            Vec2::new(20.0 * angle.cos(), 10.0 * angle.sin() * (0.5 * angle).sin())
        })
        .collect();
    let pieces = smooth(&drop, 0.05);
    assert!((2..12).contains(&pieces.len()), "{pieces:?}");
    let area = |points: &[Vec2<f64>]| {
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| 0.5 * a.cross(*b)).sum::<f64>()
    };
    let corners: Vec<Vec2<f64>> = pieces.iter().map(Piece::from).collect();
    let inner = area(&corners);
    assert!(inner > 0.5 * area(&drop) && inner <= area(&drop), "{inner} of {}", area(&drop));
}

#[test]
fn corners_stay_and_straight_lines_are_lines() {
    let ring = |points: &[[f64; 2]]| points.iter().copied().map(Vec2::from).collect::<Vec<_>>();
    let square = ring(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.5], [0.0, 0.0]]);
    let mut data = PathData::new(2);
    data.ring(&smooth(&square, 0.01), true);
    assert_eq!(data.into_text(), "M0,0H1V1H0Z");
    // Nothing to draw, but nothing to stumble over either.
    assert_eq!(smooth(&ring(&[[1.0, 1.0]; 5]), 0.01), []);
    assert_eq!(smooth(&[], 0.01), []);
}

#[test]
fn blurred_scenes_have_a_filter() {
    // Sigma 1/64 of the doubled frame is 1 px of 128: a Gaussian of 1.702 px, of which 1/12 px^2 is anti-aliasing.
    let with = |edge| {
        let scene = Scene { edge, objects: vec![disk(0.4, [1.0, 0.0, 0.0])], ..Scene::empty([1.0; 3]) };
        to_svg(&scene, ImageSize::new(128, 128).unwrap(), None).unwrap()
    };
    let text = with(EdgeProfile::distance(1.0 / 64.0));
    assert!(text.contains("<feGaussianBlur stdDeviation=\"1.677\"/>"), "{text}");
    assert!(text.contains("<rect x=\"-6\" y=\"-6\" width=\"140\" height=\"140\" fill=\"#ffffff\"/>"), "{text}");
    assert_eq!(text.matches("<g").count(), text.matches("</g>").count());
    for edge in [EdgeProfile::reference(), EdgeProfile::area(), EdgeProfile::hard(128.0), EdgeProfile::distance(0.003)]
    {
        assert!(!with(edge).contains("filter"), "{edge:?}");
    }
}

#[test]
fn simple_shapes_are_simple_elements() {
    let circle = Circle { radius: 0.1 };
    let title = "<title>circle #ff0000</title></circle>";
    assert_eq!(
        element(circle, 0.7),
        format!("<circle id=\"object-1\" cx=\"50\" cy=\"25\" r=\"10\" fill=\"#ff0000\">{title}")
    );
    let ellipse = Ellipse { radii: [0.2, 0.1] };
    assert!(element(ellipse, 0.0).contains("cx=\"50\" cy=\"25\" rx=\"20\" ry=\"10\" fill"));
    // A quarter of a turn exchanges the axes; half of one is none.
    assert!(element(ellipse, core::f64::consts::FRAC_PI_2).contains("rx=\"10\" ry=\"20\" fill"));
    assert!(element(ellipse, core::f64::consts::PI).contains("rx=\"20\" ry=\"10\" fill"));
    assert!(element(ellipse, 0.5).contains("rx=\"20\" ry=\"10\" transform=\"rotate(28.648 50 25)\""));
    let rectangle = Rectangle { size: [0.2, 0.1], corner_radius: 0.02 };
    assert!(
        element(rectangle, 0.0)
            .contains("<rect id=\"object-1\" x=\"40\" y=\"20\" width=\"20\" height=\"10\" rx=\"2\" fill")
    );
    let square = RegularPolygon { sides: 4, radius: 0.1 };
    assert!(element(square, 0.0).contains("class=\"regular_polygon\" points=\"60,25 50,35 40,25 50,15\""));
    let star = element(Star { points: 3, radius: 0.2, inner_radius: 0.1 }, 0.0);
    assert!(star.contains("class=\"star\" points=\"70,25 55,33.66 40,42.321"), "{star}");
    assert!(star.contains("<title>star #ff0000</title>"), "{star}");
}

#[test]
fn negative_lengths_are_drawn_as_positive_ones() {
    let circle = |radius| element(Circle { radius }, 0.3);
    assert_eq!(circle(-0.1), circle(0.1));
    let ellipse = |radii| element(Ellipse { radii }, 0.3);
    assert_eq!(ellipse([-0.2, 0.1]), ellipse([0.2, 0.1]));
    assert_eq!(ellipse([0.2, -0.1]), ellipse([0.2, 0.1]));
    let rectangle = |size| element(Rectangle { size, corner_radius: 0.02 }, 0.3);
    assert_eq!(rectangle([-0.2, -0.1]), rectangle([0.2, 0.1]));
}

#[test]
fn a_pen_that_fattens_follows_the_side_that_closes_a_path() {
    let ring = PathRing::polyline(vec![[0.2, 0.2], [0.8, 0.2], [0.8, 0.8]]);
    let shape = AnyShape::from(Path { rings: vec![ring.clone()], fill: FillRule::EvenOdd });
    assert!(element(shape.clone(), 0.0).contains(" d=\"M70,45H130V105\""), "{}", element(shape.clone(), 0.0));
    let object = Object { shape, pose: Pose::identity(), paint: Paint::Flat([0.0; 3]), confidence: 1.0 };
    let scene = Scene { objects: vec![object], ..Scene::empty([1.0_f64; 3]) };
    let text = to_svg(&scene, ImageSize::new(100, 100).unwrap(), None).unwrap();
    assert!(text.contains(" d=\"M20,20H80V80Z\"") && text.contains(" stroke=\"#000000\""), "{text}");
}

#[test]
fn holes_are_subpaths() {
    let rings = vec![vec![[0.0, 0.0], [0.3, 0.0], [0.0, 0.3]], vec![[0.05, 0.05], [0.1, 0.05], [0.05, 0.1]]];
    let one = element(Polygon { rings: rings[..1].to_vec() }, 0.0);
    assert!(one.contains("<polygon id=\"object-1\" fill-rule=\"evenodd\" points=\"50,25 80,25 50,55\""), "{one}");
    let two = element(Polygon { rings }, 0.0);
    assert!(two.contains("fill-rule=\"evenodd\" d=\"M50,25H80L50,55ZM55,30H60L55,35Z\" class=\"polygon\""), "{two}");
}

#[test]
fn paths_have_true_arcs_and_strokes_are_strokes() {
    let ring = PathRing {
        points: vec![[0.0, 0.0], [0.2, 0.0], [0.2, 0.2]],
        segments: vec![
            Segment::Arc { bulge: -1.0 },
            Segment::Cubic { controls: [[0.3, 0.0], [0.3, 0.2]] },
            Segment::Line,
        ],
    };
    let path = element(Path { rings: vec![ring.clone()], fill: FillRule::NonZero }, 0.0);
    assert!(path.contains("fill-rule=\"nonzero\" d=\"M50,25A10 10 0 0 0 70,25C80,25 80,45 70,45Z\""), "{path}");
    let open = PathRing { points: ring.points, segments: ring.segments[..2].to_vec() };
    let dot = PathRing { points: vec![[0.1, 0.1]], segments: vec![] };
    let stroke = Stroke { rings: vec![open, dot], width: 0.02, cap: Cap::Round, join: Join::Miter { limit: 2.0 } };
    let stroke = element(stroke, 0.0);
    assert!(
        stroke.contains(
            "fill=\"none\" stroke-width=\"2\" stroke-linecap=\"round\" stroke-miterlimit=\"2\" \
             d=\"M50,25A10 10 0 0 0 70,25C80,25 80,45 70,45M60,35L60,35\" stroke=\"#ff0000\""
        ),
        "{stroke}"
    );
}

#[test]
fn fattened_strokes_are_wider_or_outlined() {
    let draw = |cap, join| {
        let rings = vec![PathRing::polyline(vec![[0.2, 0.2], [0.8, 0.2], [0.8, 0.8]])];
        let shape = Stroke { rings, width: 0.05, cap, join }.into();
        let object = Object { shape, pose: Pose::identity(), paint: Paint::Flat([0.0; 3]), confidence: 0.25 };
        let scene = Scene { objects: vec![object], ..Scene::empty([1.0_f64; 3]) };
        to_svg(&scene, ImageSize::new(128, 128).unwrap(), None).unwrap()
    };
    // 6.4 + 2 x 1.431 px
    let round = draw(Cap::Round, Join::Round);
    assert!(round.contains("stroke-width=\"9.262\"") && round.contains(" opacity=\".25\""), "{round}");
    let sharp = draw(Cap::Butt, Join::default());
    assert!(
        sharp.contains("fill=\"#000000\" stroke=\"#000000\"") && sharp.contains("stroke-width=\"2.862\""),
        "{sharp}"
    );
}

#[test]
fn objects_are_numbered_from_one_or_as_they_are_told() {
    let mut objects = [0.2, 0.5, 0.8].map(|x| disk(x, [0.0; 3])).to_vec();
    objects[1].confidence = 0.0;
    let scene = Scene { objects, ..Scene::empty([1.0; 3]) };
    let size = ImageSize::new(64, 64).unwrap();
    let ids = |text: &str| {
        let parts = text.split("id=\"object-").skip(1);
        parts.map(|part| part.split('"').next().unwrap().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(ids(&to_svg(&scene, size, None).unwrap()), ["1", "3"], "the second is not seen");
    assert_eq!(ids(&to_svg_numbered(&scene, size, None, &[7, 2, 90]).unwrap()), ["7", "90"]);
    let refused = to_svg_numbered(&scene, size, None, &[7, 2]).unwrap_err().to_string();
    assert!(refused.contains("numbers of objects"), "{refused}");
}

#[test]
fn prototypes_are_titled_with_their_names() {
    let efd = Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]);
    let bank = Bank::new(vec![("a & \u{1}\u{ffff}b".to_owned(), efd.clone())]);
    let object = |prototype| Object { shape: AnyShape::of_efd(efd.clone(), Some(prototype)), ..disk(0.5, [0.0; 3]) };
    let scene = Scene { objects: vec![object(0), object(7)], ..Scene::empty([1.0; 3]) };
    let text = to_svg(&scene, ImageSize::new(64, 64).unwrap(), Some(&bank)).unwrap();
    assert!(text.contains("<title>a &amp; b #000000</title>"), "{text}");
    assert!(text.contains("<title>prototype #000000</title>"), "{text}");
}
