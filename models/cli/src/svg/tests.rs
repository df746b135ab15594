//! There and back: what is written as SVG reads as the same shape.

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{AnyShape, FillRule, Path, PathRing, Rectangle, Segment};
use dvp_core::{Efd, ImageSize, Object, Pose, Scene};
use dvp_fit::Bank;

use super::*;

/// The text of a scene of one object, its units 100 pixels long.
fn text_of(shape: impl Into<AnyShape<f64>>, bank: Option<&Bank<f64>>) -> String {
    let object = Object { shape: shape.into(), pose: Pose::identity(), paint: [1.0, 0.0, 0.0].into(), confidence: 1.0 };
    let (edge, compositing) = (EdgeProfile::area(), Compositing::Over);
    let scene = Scene { objects: vec![object], edge, compositing, transparent: true, ..Scene::empty([1.0; 3]) };
    to_svg(&scene, ImageSize::new(100, 100).unwrap(), bank).unwrap()
}

fn again(text: &str) -> AnyShape<f64> {
    from_svg(text).unwrap().scene.objects.remove(0).shape
}

#[test]
fn corners_of_half_a_side_stay_round() {
    // Half of 6.999 px is 3.4995 px: a radius of 3.5 would be another one along x than along y.
    for width in [0.06999, 0.07, 0.070_014] {
        let text = text_of(Rectangle { size: [width, 0.1], corner_radius: 0.5 * width }, None);
        let AnyShape::Rectangle(again) = again(&text) else { panic!("{text}") };
        assert!((again.corner_radius - 0.5 * width).abs() < 1.1e-5, "{text}");
    }
}

#[test]
fn radii_next_to_half_a_chord_keep_the_height_of_the_arc() {
    // Over a chord of 19.99 px a radius of 10 px that is rounded by 0.0005 px is off by 0.016 px in height.
    for bulge in [0.2, 0.9, 0.969, 0.999, 1.0, 1.001, 1.3, 30.0] {
        let points = vec![[0.012_345, 0.02], [0.212_251, 0.023]];
        let ring = PathRing { points, segments: vec![Segment::Arc { bulge }, Segment::Line] };
        let text = text_of(Path { rings: vec![ring], fill: FillRule::NonZero }, None);
        let AnyShape::Path(path) = again(&text) else { panic!("{text}") };
        let Segment::Arc { bulge: again } = path.rings[0].segments[0] else { panic!("{text}") };
        // Half the chord is 10 px: heights agree to 0.002 px, and where the arc is most of a circle its radius does.
        assert!((again - bulge).abs() * 10.0 < 2e-3 * bulge.max(1.0), "{text}: {again} for {bulge}");
    }
}

#[test]
fn titles_are_xml_whatever_the_names_are() {
    let efd = Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]);
    let bank = Bank::new(vec![("a & \u{1}\u{ffff}b".to_owned(), efd.clone())]);
    assert!(from_svg(&text_of(AnyShape::of_efd(efd, Some(0)), Some(&bank))).is_ok(), "control characters are no XML");
}
