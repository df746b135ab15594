use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Efd, ImageSize, Object, Pose, Scene};

use super::overlap::{Body, shared_regions};
use super::path::{path_data, short};
use super::to_svg;

fn square(x: f64, y: f64, half: f64) -> Body {
    let vertices = vec![[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]];
    Body { vertices, reach: 0.5 }
}

fn disk(x: f32, color: [f32; 3]) -> Object<f32> {
    let pose = Pose { translation: [x, 0.5], scale: 0.2, rotation: 0.0 };
    Object::of_efd(pose, color, 1.0, Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]), None)
}

#[test]
fn numbers_are_short() {
    let texts = [(0.0, "0"), (-0.0001, "0"), (0.5, ".5"), (-0.25, "-.25"), (12.0, "12"), (1.23456, "1.235")];
    for (value, text) in texts {
        assert_eq!(short(value, 3.0), text);
    }
}

#[test]
fn curves_are_few_and_close() {
    // Halves of a circle as cubics are off by 0.018 of the radius at best, quarters by 2.7e-4, eighths by 4e-6; splits at
    // the worst point leave uneven pieces.
    let circle: Vec<[f64; 2]> =
        (0..64).map(|i| (f64::from(i) / 63.0 * core::f64::consts::TAU).sin_cos().into()).collect();
    for (tolerance, most) in [(0.05, 2), (0.002, 6), (1e-4, 14)] {
        let path = path_data(&circle, tolerance);
        let pieces = path.matches('C').count();
        assert!((1..=most).contains(&pieces), "{tolerance}: {path}");
        assert!(path.starts_with("M0,1C") && path.ends_with('Z'), "{path}");
    }
}

#[test]
fn corners_stay_and_straight_lines_are_lines() {
    let square = [[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.5], [0.0, 0.0]];
    assert_eq!(path_data(&square, 0.01), "M0,0L1,0L1,1L0,1L0,0Z");
    // Nothing to draw, but nothing to stumble over either.
    assert_eq!(path_data(&[[1.0, 1.0]; 5], 0.01), "M1,1Z");
    assert_eq!(path_data(&[], 0.01), "M0,0Z");
}

#[test]
fn overlaps_are_found() {
    // Three squares of side 8: the first two share a strip, all three a corner of it.
    let bodies = [square(10.0, 10.0, 4.0), square(15.0, 10.0, 4.0), square(12.0, 16.0, 4.0)];
    assert_eq!(shared_regions(&bodies, 32.0, 32.0), [vec![0, 1], vec![0, 2], vec![1, 2], vec![0, 1, 2]]);
    assert!(shared_regions(&bodies[..1], 32.0, 32.0).is_empty());
}

#[test]
fn blended_objects_get_their_mean_color() {
    let objects = vec![disk(0.4, [1.0, 0.0, 0.0]), disk(0.6, [0.0, 0.0, 1.0])];
    let mut scene = Scene { objects, compositing: Compositing::Blend, ..Scene::empty([1.0; 3]) };
    let size = ImageSize::new(128, 128).unwrap();
    let text = to_svg(&scene, size).unwrap();
    assert!(text.contains("<g mask=\"url(#in-object-0)\"><use href=\"#object-1\" fill=\"#800080\""), "{text}");
    // 2 x 1.431 px over 25.6 px
    assert!(text.contains("stroke-width=\".1118\""), "{text}");
    scene.compositing = Compositing::Over;
    assert!(!to_svg(&scene, size).unwrap().contains("mask"));
}

#[test]
fn blurred_scenes_have_a_filter() {
    // Sigma 1/64 of the doubled frame is 1 px of 128: a Gaussian of 1.702 px, of which 1/12 px^2 is anti-aliasing.
    let with = |edge| {
        let scene = Scene { edge, objects: vec![disk(0.4, [1.0, 0.0, 0.0])], ..Scene::empty([1.0; 3]) };
        to_svg(&scene, ImageSize::new(128, 128).unwrap()).unwrap()
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
