//! Pictures that had noise, a blur or a filter after they were drawn are read as what they were before.

use dvp_core::shape::Ellipse;

use super::*;
use crate::noise::tests::add_noise;
use crate::partition::{Partition, Reading};

/// A disk, an upright rectangle and an ellipse that is turned.
fn drawn() -> Scene<f32> {
    let ellipse = AnyShape::Ellipse(Ellipse { radii: [17.0, 9.0] });
    scene(
        [0.9, 0.9, 0.8],
        vec![
            object(circle(17.3), [27.2, 30.6], 0.0, RED),
            object(rectangle(30.0, 22.0), [70.0, 25.0], 0.0, BLUE),
            object(ellipse, [55.0, 70.0], 0.5, [0.1, 0.5, 0.2]),
        ],
    )
}

/// The picture after every row and column went through a filter, weights from the middle outward; rounded to 8 bits.
fn filtered(picture: &Image<f32>, weights: &[f32]) -> Image<f32> {
    let mut data = picture.data().to_vec();
    for step in [1, SIZE] {
        let before = data.clone();
        for (i, value) in data.iter_mut().enumerate() {
            let place = i / step % SIZE;
            let at =
                |offset: isize| before[i - place * step + place.saturating_add_signed(offset).min(SIZE - 1) * step];
            let beside = |k: usize| at(k as isize) + at(-(k as isize));
            *value = weights[0] * at(0) + (1..weights.len()).map(|k| weights[k] * beside(k)).sum::<f32>();
        }
    }
    let rounded = data.into_iter().map(|value| (value.clamp(0.0, 1.0) * 255.0).round() / 255.0);
    Image::from_planar(size(), rounded.collect()).unwrap()
}

/// A Gaussian blur of some standard deviation, pixels.
fn blurred(picture: &Image<f32>, deviation: f32) -> Image<f32> {
    let weights: Vec<f32> = (0..=12).map(|k| (-0.5 * (k as f32 / deviation).powi(2)).exp()).collect();
    let sum = 2.0 * weights.iter().sum::<f32>() - weights[0];
    filtered(picture, &weights.iter().map(|weight| weight / sum).collect::<Vec<f32>>())
}

/// The same with noise of some standard deviation, cut off at black and white and rounded to 8 bits.
fn noisy(picture: &Image<f32>, deviation: f64) -> Image<f32> {
    let mut noisy = picture.clone();
    add_noise(&mut noisy, deviation);
    noisy.data_mut().iter_mut().for_each(|value| *value = (value.clamp(0.0, 1.0) * 255.0).round() / 255.0);
    noisy
}

/// That the three shapes are found, `off` pixels off at most, and their colors.
fn assert_found(picture: &Image<f32>, off: f64, of_color: f32) {
    let traced = trace(&picture.view(), &Known::default().with_spoiled(true)).unwrap();
    let found = &traced.scene.objects;
    assert_eq!(found.len(), 3, "{found:?}");
    let mut kinds = [0; 3];
    for object in found {
        let near = |truth: &&Object<f32>| {
            let [x, y] = [0, 1].map(|k| truth.pose.translation[k] - object.pose.translation[k]);
            f64::from(x.hypot(y)) * (SIZE as f64) < off
        };
        let truth = drawn();
        let truth = truth.objects.iter().find(near).expect("an object at its place");
        let (sizes, kind) = match &object.shape {
            AnyShape::Circle(circle) => ([circle.radius, 17.3 / SIZE as f32], 0),
            AnyShape::Rectangle(rectangle) => {
                ([rectangle.size[0] * rectangle.size[1], 660.0 / (SIZE * SIZE) as f32], 1)
            }
            AnyShape::Ellipse(ellipse) => ([ellipse.radii[0] * ellipse.radii[1], 153.0 / (SIZE * SIZE) as f32], 2),
            shape => panic!("{shape:?}"),
        };
        kinds[kind] += 1;
        assert!((sizes[0] / sizes[1] - 1.0).abs() < 0.1 * off as f32, "{sizes:?}");
        for (a, b) in object.color().into_iter().zip(truth.color()) {
            assert!((a - b).abs() < of_color, "{a} instead of {b}");
        }
    }
    assert_eq!(kinds, [1; 3]);
}

#[test]
fn noise_is_averaged_away() {
    for deviation in [0.02, 0.05, 0.1] {
        let picture = noisy(&paint(&drawn()), deviation);
        assert!(matches!(trace(&picture.view(), &Known::default()), Err(NoDrawing::Partition(_))));
        assert_found(&picture, 3.0 * deviation + 0.05, 0.01 + 0.1 * deviation as f32);
    }
}

#[test]
fn a_blur_is_taken_off_and_told() {
    for deviation in [0.6, 1.0, 2.0] {
        let picture = blurred(&paint(&drawn()), deviation);
        assert_found(&picture, 0.1, 0.004);
        let traced = trace(&picture.view(), &Known::default().with_spoiled(true)).unwrap();
        assert!((traced.blur / f64::from(deviation) - 1.0).abs() < 0.1, "{} instead of {deviation}", traced.blur);
    }
}

#[test]
fn small_round_things_tell_of_a_blur() {
    let disks = [([20.3, 22.6], 6.3), ([50.7, 30.2], 7.1), ([29.4, 60.8], 5.6), ([70.1, 68.9], 6.8)];
    let disks = disks.map(|(at, radius)| object(circle(radius), at, 0.0, RED));
    let picture = blurred(&paint(&scene(WHITE, disks.to_vec())), 0.8);
    let traced = trace(&picture.view(), &Known::default().with_spoiled(true)).unwrap();
    assert!((traced.blur / 0.8 - 1.0).abs() < 0.1, "{}", traced.blur);
}

#[test]
fn uneven_things_under_a_blur_are_one_each() {
    for k in 0..24 {
        let phase = 0.7 * f64::from(k);
        let point = |i: usize| {
            let turn = core::f64::consts::TAU * i as f64 / 96.0;
            let radius = 11.0 * (1.0 + 0.12 * (2.0 * turn).cos() + 0.05 * (3.0 * turn + phase).cos());
            [radius * turn.cos(), radius * turn.sin()]
        };
        let ring = PathRing::polygon((0..96).map(point).collect());
        let cell = AnyShape::Path(Path { rings: vec![ring], fill: FillRule::EvenOdd });
        let picture = blurred(&paint(&scene(WHITE, vec![object(cell, [47.3, 48.6], 0.3 * phase, RED)])), 1.0);
        let traced = trace(&picture.view(), &Known::default().with_spoiled(true)).unwrap();
        assert_eq!(traced.scene.objects.len(), 1, "{k}");
    }
}

#[test]
fn a_clean_picture_has_no_blur() {
    let traced = trace(&paint(&drawn()).view(), &Known::default().with_spoiled(true)).unwrap();
    assert!(traced.blur < 0.05, "{}", traced.blur);
}

#[test]
fn noise_on_a_blur_is_both() {
    assert_found(&noisy(&blurred(&paint(&drawn()), 0.8), 0.02), 0.15, 0.01);
}

#[test]
fn ringing_is_no_thing() {
    // A filter that sharpens leaves rims of up to a fifth of the contrast.
    let picture = filtered(&paint(&drawn()), &[1.3, -0.15, 0.0]);
    let traced = trace(&picture.view(), &Known::default()).unwrap();
    assert_eq!(traced.scene.objects.len(), 3, "{:?}", traced.scene.objects);
    assert_found(&picture, 0.1, 0.02);
}

#[test]
fn holes_that_a_coder_would_have_hidden_stay() {
    // Read as coded, a hole of five pixels in a color near that of the ground is lost. One square is so faint that blocks along its edge differ no more
    // than those that a coder changes.
    let ground = [0.07, 0.76, 0.79];
    let square = |side: f64, [x, y]: [f64; 2], color: [f32; 3]| object(rectangle(side, side), [x, y], 0.0, color);
    let picture = paint(&scene(
        ground,
        vec![
            square(12.0, [70.0, 70.0], ground.map(|c| c + 0.016)),
            square(19.0, [20.5, 20.5], [0.32, 0.64, 0.45]),
            square(5.0, [20.5, 20.5], ground),
        ],
    ));
    let view = picture.view();
    let reading = Reading { soft: true, ..Reading::default() };
    let [plain, coded] = [false, true].map(|coded| Partition::of(&view, reading.with_coded(coded)).unwrap());
    assert!(plain.ripple < crate::tuning::RIPPLED, "{}", plain.ripple);
    assert!(coded.faces.len() < plain.faces.len() && coded.lost_blocks(&plain) > 0, "{} faces", coded.faces.len());
    let traced = trace(&view, &Known::default().with_spoiled(true)).unwrap();
    assert!(!traced.coded);
}

#[test]
fn texture_is_noise_of_a_larger_scale() {
    // Grain of about ten pixels, as paper and grass have it, which no mean over single pixels takes away.
    let gray = paint(&scene([0.5; 3], Vec::new()));
    let grain = blurred(&noisy(&gray, 0.2), 3.0);
    let mut picture = paint(&drawn());
    for (value, grain) in picture.data_mut().iter_mut().zip(grain.data()) {
        *value += grain - 0.5;
    }
    let picture = noisy(&picture, 0.01);
    let (smooth, noise) = crate::noise::denoised(picture.view()).unwrap();
    let crumbs = Partition::of(&smooth.view(), Reading { noise, soft: true, ..Reading::default() }).unwrap();
    assert!(crumbs.check_faces(1).is_err(), "{} faces", crumbs.faces.len());
    let traced = trace(&picture.view(), &Known::default().with_spoiled(true)).unwrap();
    let found = &traced.scene.objects;
    assert!(found.len() <= 6, "{} things", found.len());
    for truth in &drawn().objects {
        let off = |object: &Object<f32>| {
            let [x, y] = [0, 1].map(|k| truth.pose.translation[k] - object.pose.translation[k]);
            x.hypot(y) * SIZE as f32
        };
        assert!(found.iter().any(|object| off(object) < 2.0), "{truth:?} in {found:?}");
    }
}
