use dvp_core::geometry::Vec2;
use dvp_core::render::Compositing;
use dvp_core::{ImageSize, Object, Pose, Scene};

use super::super::overlap::{Body, MOST_IN_SET, MOST_SETS, Shared, shared_regions};
use super::super::to_svg;
use super::disk;

fn square(x: f64, y: f64, half: f64) -> Body {
    let corners = [[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half]];
    Body { rings: vec![corners.map(Vec2::from).to_vec()], reach: 0.5 }
}

#[test]
fn overlaps_are_found() {
    // Three squares of side 8: the first two share a strip, all three a corner of it.
    let bodies = [square(10.0, 10.0, 4.0), square(15.0, 10.0, 4.0), square(12.0, 16.0, 4.0)];
    let all: Vec<&Body> = bodies.iter().collect();
    let found = |bodies: &[&Body], width| {
        let Shared { sets, is_complete } = shared_regions(bodies, width, 32.0);
        assert!(is_complete);
        sets
    };
    assert_eq!(found(&all, 32.0), [vec![0, 1], vec![0, 2], vec![1, 2], vec![0, 1, 2]]);
    assert!(found(&all[..1], 32.0).is_empty());
    assert_eq!(found(&all, 9.0), [vec![0, 2]], "what is seen of the image");
}

#[test]
fn a_hole_is_no_overlap() {
    let mut ring = square(16.0, 16.0, 10.0);
    ring.rings.extend(square(16.0, 16.0, 6.0).rings);
    // 5.4 + 0.5 is inside of 6 - 0.5 by neither edge; 4 is, by a wide margin.
    for (half, sets) in [(4.0, 0), (6.5, 1)] {
        assert_eq!(shared_regions(&[&ring, &square(16.0, 16.0, half)], 32.0, 32.0).sets.len(), sets, "{half}");
    }
}

#[test]
fn more_overlaps_than_can_be_drawn_are_left_out_and_said() {
    let text = |objects: Vec<Object<f32>>| {
        let scene = Scene { objects, compositing: Compositing::Blend, ..Scene::empty([1.0; 3]) };
        to_svg(&scene, ImageSize::new(256, 256).unwrap(), None).unwrap()
    };
    let circle = |x: f32, y: f32, radius: f32| Object {
        pose: Pose { translation: [x, y], scale: radius, rotation: 0.0 },
        ..disk(0.0, [1.0, 0.0, 0.0])
    };
    // Each lies in the one before it: as many sets as disks, but one.
    let nested = |count: u8| text((0..count).map(|k| circle(0.5, 0.5, 0.45 - 0.02 * f32::from(k))).collect());
    let whole = nested(16);
    assert!(!whole.contains("<!--") && whole.matches("<use").count() == 30, "15 masks, 15 mixtures: {whole}");
    let limited = nested(17);
    assert!(limited.contains("<!-- Common parts of more than 16 objects"), "{limited}");
    assert_eq!(limited.matches("<use").count(), 30, "{limited}");
    // In a ring of a thousand disks hundreds lie over each other, and every one of them begins somewhere else.
    let ring = |count: u16, radius: f32| {
        let place = |k: u16| f32::from(k) / f32::from(count) * core::f32::consts::TAU;
        text((0..count).map(|k| circle(0.5 + 0.3 * place(k).cos(), 0.5 + 0.3 * place(k).sin(), radius)).collect())
    };
    let crowd = ring(1000, 0.01);
    assert!(crowd.contains("<!-- "), "{}", crowd.len());
    assert!(crowd.matches("<g mask").count() <= MOST_SETS * (MOST_IN_SET - 1));
    assert!(crowd.len() < 1 << 22, "{}", crowd.len());
    let heap = ring(1000, 0.2);
    assert!(heap.contains("<!-- ") && heap.len() < 1 << 22, "{}", heap.len());
    assert!(usvg::roxmltree::Document::parse(&heap).is_ok());
}

#[test]
fn blended_objects_get_their_mean_color() {
    let mut scene = Scene {
        objects: vec![disk(0.4, [1.0, 0.0, 0.0]), disk(0.6, [0.0, 0.0, 1.0])],
        compositing: Compositing::Blend,
        ..Scene::empty([1.0; 3])
    };
    let size = ImageSize::new(128, 128).unwrap();
    let text = to_svg(&scene, size, None).unwrap();
    assert!(text.contains("<g mask=\"url(#in-object-1)\"><use href=\"#object-2\" fill=\"#800080\""), "{text}");
    // 2 x 1.431 px
    assert!(text.contains("stroke-width=\"2.862\""), "{text}");
    scene.compositing = Compositing::Over;
    assert!(!to_svg(&scene, size, None).unwrap().contains("mask"));
}

#[test]
fn translucent_mixtures_have_the_color_that_the_background_shows_through() {
    // Confidences 1/2 and 1/2, equal weights: mean (1/2, 0, 1/2), seen to 3/4 over white: 5/8, 1/4, 5/8.
    let mut objects = vec![disk(0.4, [1.0, 0.0, 0.0]), disk(0.6, [0.0, 0.0, 1.0])];
    objects.iter_mut().for_each(|object| object.confidence = 0.5);
    let mut scene = Scene { objects, compositing: Compositing::Blend, ..Scene::empty([1.0; 3]) };
    let size = ImageSize::new(128, 128).unwrap();
    assert!(to_svg(&scene, size, None).unwrap().contains("fill=\"#9f409f\""));
    scene.transparent = true;
    assert!(!to_svg(&scene, size, None).unwrap().contains("mask"), "one over the other on transparent ground");
}
