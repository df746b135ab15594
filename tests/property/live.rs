//! Invariants of LIVE.

use dvp_core::geometry::Px;
use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{Path, PathRing, Segment};
use dvp_core::{Image, ImageSize, Object, Paint, Pose, Real as _, Scene, SceneGrad};
use dvp_fit::live::crossing::crossing_and_grad;
use dvp_fit::live::{Live, PathStart};
use proptest::prelude::*;

/// Few steps.
fn short() -> Live {
    let mut settings = Live::default();
    (settings.layer_steps, settings.finish_steps, settings.shape_count) = (8, 8, 3);
    settings
}

/// Boxes of one color and loose pixels on a background, in a picture of any sides.
fn picture() -> impl Strategy<Value = Image<f32>> {
    let color = || prop::array::uniform3(0.0..=1.0_f32);
    let patch = (prop::array::uniform4(0.0..1.0_f32), color());
    let (patches, loose) = (prop::collection::vec(patch, 0..4), prop::collection::vec((0.0..1.0_f32, color()), 0..20));
    (1_usize..24, 1_usize..24, color(), patches, loose).prop_map(|(width, height, ground, patches, loose)| {
        let size = ImageSize::new(width, height).unwrap();
        let mut pixels = vec![ground; size.pixels()];
        let at = |share: f32, count: usize| (share * f32::of_usize(count)).to_count();
        for ([left, top, wide, high], color) in patches {
            for y in at(top, height)..(at(top, height) + 1 + at(high, height)).min(height) {
                for x in at(left, width)..(at(left, width) + 1 + at(wide, width)).min(width) {
                    pixels[y * width + x] = color;
                }
            }
        }
        loose.into_iter().for_each(|(place, color)| pixels[at(place, size.pixels())] = color);
        Image::from_interleaved(size, pixels.as_flattened()).unwrap()
    })
}

fn cubic_ring(points: &[[f64; 2]]) -> Object<f64> {
    let (thirds, _) = points.as_chunks::<3>();
    let segments = thirds.iter().map(|third| Segment::Cubic { controls: [third[1], third[2]] }).collect();
    let path = Path::new(vec![PathRing { points: thirds.iter().map(|third| third[0]).collect(), segments }]).unwrap();
    Object { shape: path.into(), pose: Pose::identity(), paint: Paint::Flat([0.0; 3]), confidence: 1.0 }
}

fn crossing(object: &Object<f64>) -> f64 {
    let objects = vec![object.clone()];
    let mut grad = SceneGrad::default();
    grad.reset(&Scene { objects: objects.clone(), ..Scene::empty([0.0; 3]) });
    crossing_and_grad(&objects, 1.0, &mut grad)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_picture_is_explained_no_worse_than_by_its_background(
        image in picture(),
        over in any::<bool>(),
        circle in any::<bool>(),
        segment_count in 0_usize..7,
    ) {
        let compositing = if over { Compositing::Over } else { Compositing::Blend };
        let edge = if over { EdgeProfile::area() } else { EdgeProfile::reference() };
        let start = if circle { PathStart::Circle(Px(5.0)) } else { PathStart::Ellipse };
        let mut settings = short();
        (settings.start, settings.segment_count) = (start, segment_count);
        let fit = settings.fit(image.view(), edge, compositing).unwrap();
        prop_assert_eq!(&fit.scene, &settings.fit(image.view(), edge, compositing).unwrap().scene);
        // The squared error is what decides whether a shape stays; the last stage may lower the absolute one at its cost.
        settings.finish_steps = 0;
        let unfinished = settings.fit(image.view(), edge, compositing).unwrap();
        settings.shape_count = 0;
        let ground = settings.fit(image.view(), edge, compositing).unwrap();
        prop_assert!(unfinished.unexplained <= ground.unexplained + 1e-6, "{} {}", unfinished.unexplained, ground.unexplained);
        prop_assert!(fit.loss <= unfinished.loss + 1e-6, "{} {}", fit.loss, unfinished.loss);
        prop_assert!(fit.scene.objects.len() <= 3);
    }

    #[test]
    fn published_settings_take_any_picture(image in picture()) {
        let mut settings = Live::published();
        settings.layer_steps = 6;
        let fit = settings.fit(image.view(), EdgeProfile::area(), Compositing::Over).unwrap();
        prop_assert!(fit.loss.is_finite() && fit.scene.objects.len() <= 5);
        prop_assert!(fit.scene.objects.iter().all(|object| (0.0..=1.0).contains(&object.confidence)));
    }

    #[test]
    fn crossings_cost_the_same_wherever_and_however_large(
        points in prop::collection::vec(prop::array::uniform2(-1.0..1.0), 12),
        turn in -3.0..3.0_f64,
        scale in 0.1..9.0,
        shift in prop::array::uniform2(-5.0..5.0),
    ) {
        let (sin, cos) = turn.sin_cos();
        let moved: Vec<[f64; 2]> = points
            .iter()
            .map(|[x, y]| [scale * (cos * x - sin * y) + shift[0], scale * (sin * x + cos * y) + shift[1]])
            .collect();
        // Mirrored, every turn is the other way.
        let mirrored: Vec<[f64; 2]> = points.iter().map(|[x, y]| [-x, *y]).collect();
        let price = crossing(&cubic_ring(&points));
        for other in [moved, mirrored] {
            prop_assert!((crossing(&cubic_ring(&other)) - price).abs() < 1e-9);
        }
    }
}
