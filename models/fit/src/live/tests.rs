use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::Px;
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, Renderer};
use dvp_core::shape::{Path, PathRing, Segment, Shape as _};
use dvp_core::{Drawing, Image, ImageSize, Object, Paint, Pose, Scene, SceneGrad};

use super::crossing::crossing_and_grad;
use super::focus::Focus;
use super::{Live, PathStart};
use crate::StopReason;
use crate::opt_iter::blob::BlobFinder;

fn object(points: [[f64; 2]; 4]) -> Object<f64> {
    let [from, first, second, to] = points;
    let ring = PathRing { points: vec![from, to], segments: vec![Segment::Cubic { controls: [first, second] }] };
    let path = Path::new(vec![ring]).unwrap();
    Object { shape: path.into(), pose: Pose::identity(), paint: Paint::Flat([0.0; 3]), confidence: 1.0 }
}

fn crossing(objects: &[Object<f64>]) -> (f64, Vec<Vec<f64>>) {
    let mut grad = SceneGrad::default();
    grad.reset(&Scene { objects: objects.to_vec(), ..Scene::empty([0.0; 3]) });
    let price = crossing_and_grad(objects, 2.0, &mut grad);
    (price, grad.objects.into_iter().map(|object| object.numbers).collect())
}

#[test]
fn cubics_that_turn_back_are_priced() {
    // AB along +x, BC along +y: it turns from +x to +y. CD back along -x is half a turn: no price, no gradient beyond.
    let free = object([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 1.5]]);
    let (price, numbers) = crossing(core::slice::from_ref(&free));
    assert!(price.abs() < 1e-15 && numbers[0].iter().all(|slope| slope.abs() < 1e-15), "{price} {numbers:?}");
    // CD along -y: the sine is -1, the price 1, of two cubics half, times the weight 2.
    let priced = object([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.5]]);
    let (price, numbers) = crossing(&[free, priced]);
    assert!((price - 1.0).abs() < 1e-15, "{price}");
    // At a sine of -1 turning changes nothing, nor does length.
    assert!(numbers.iter().flatten().all(|slope| slope.abs() < 1e-15), "{numbers:?}");
    // Legs without length cost nothing.
    assert_eq!(crossing(&[object([[0.0, 0.0], [0.0, 0.0], [1.0, 1.0], [1.0, 0.5]])]).0.to_bits(), 0.0_f64.to_bits());
}

#[test]
fn weights_fall_with_the_distance() {
    // A line down the middle of 8 x 8 pixels, there and back.
    let mut drawing = Drawing::default();
    drawing.push(&[[0.5, -9.0], [0.5, 9.0]], [0.0; 3], 1.0);
    let mut focus = Focus::new();
    focus.measure(&drawing, ImageSize::new(8, 8).unwrap(), Px(3.0));
    // Centers are 0.5, 1.5, 2.5 and 3.5 px away to either side: 2.5 + 1.5 + 0.5 twice is 9 in each of 8 rows.
    for (index, weight) in focus.weights().iter().enumerate() {
        let expected: f64 = [0.0, 0.5, 1.5, 2.5, 2.5, 1.5, 0.5, 0.0][index % 8] / 72.0;
        assert!((weight - expected).abs() < 1e-12, "{index}: {weight}");
    }
    // Out of reach all count alike.
    let mut far = Drawing::default();
    far.push(&[[9.0, 9.0], [9.0, 10.0]], [0.0; 3], 1.0);
    focus.measure(&far, ImageSize::new(8, 8).unwrap(), Px(3.0));
    assert!(focus.weights().iter().all(|weight: &f64| (weight - 1.0 / 64.0).abs() < 1e-15));
}

/// 32 x 32, white, with a dark upright rectangle of 8 x 16 pixels from (4, 6) and a red square of 8 from (20, 12).
fn picture() -> Image<f64> {
    let size = ImageSize::new(32, 32).unwrap();
    let mut image = Image::from_planar(size, vec![1.0; 3 * 1024]).unwrap();
    for y in 0..32 {
        for x in 0..32 {
            let color = if (4..12).contains(&x) && (6..22).contains(&y) {
                [0.1, 0.2, 0.3]
            } else if (20..28).contains(&x) && (12..20).contains(&y) {
                [0.9, 0.1, 0.1]
            } else {
                continue;
            };
            for (channel, value) in color.into_iter().enumerate() {
                image.data_mut()[channel * 1024 + y * 32 + x] = value;
            }
        }
    }
    image
}

#[test]
fn shapes_start_at_the_largest_blob() {
    let image = picture();
    let blob = BlobFinder::new().largest(image.view(), &[1.0; 3 * 1024]).unwrap();
    // The rectangle: its center is (8, 14) px; variances (8^2 - 1 + 1) / 12 and 16^2 / 12, half axes twice their roots.
    let half_axes = [16.0_f64, 8.0].map(|side| 2.0 * side / 12.0_f64.sqrt() / 32.0);
    for (found, expected) in blob.half_axes.iter().zip(half_axes) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    let bounds = |start: PathStart| {
        let object: Object<f64> = start.object(&blob, 4, image.size());
        assert_eq!(object.shape.number_count(), 24);
        let bounds = object.shape.bounds().unwrap().unwrap();
        [bounds.min, bounds.max].map(|corner| corner.to_array().map(|value| value * 32.0))
    };
    let [low, high] = bounds(PathStart::Ellipse);
    let expected = [half_axes[1], half_axes[0]].map(|axis| axis * 32.0);
    for (k, middle) in [8.0, 14.0].into_iter().enumerate() {
        assert!((low[k] - (middle - expected[k])).abs() < 1e-9 && (high[k] - (middle + expected[k])).abs() < 1e-9);
    }
    // The mean is where four pixels meet: the first of them, (7.5, 13.5) px.
    let [low, high] = bounds(PathStart::Circle(Px(3.0)));
    assert!((low[0] - 4.5).abs() < 1e-9 && (high[1] - 16.5).abs() < 1e-9, "{low:?} {high:?}");
}

#[test]
fn layers_explain_a_picture() {
    let image = picture();
    let fit = Live::default().fit(image.view(), EdgeProfile::area(), Compositing::Over).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.stop), (2, StopReason::Converged));
    assert!(
        fit.loss < 2e-3 && fit.marginal_gain.iter().all(|&gain| gain > 0.1),
        "{} {:?}",
        fit.loss,
        fit.marginal_gain
    );
    // The larger one comes first.
    assert!(fit.scene.objects[0].color()[0] < 0.2, "{:?}", fit.scene.objects[0]);
    // What was painted is what the scene paints.
    let mut painted = Image::zeros(image.size());
    let renderer = ContourRenderer::new(fit.scene.edge, fit.scene.compositing);
    let drawing = crate::paint::drawing_of(&fit.scene, image.size(), 64).unwrap();
    renderer.render(&drawing, image.size(), &mut Default::default(), painted.data_mut()).unwrap();
    let sum: f64 = painted.data().iter().zip(image.data()).map(|(a, b)| (a - b).abs()).sum();
    assert!((sum / 3072.0 - fit.loss).abs() < 1e-4, "{sum}");
}

#[test]
fn published_settings_keep_every_shape() {
    let image = picture();
    let settings = Live { layer_steps: 40, shape_count: 3, ..Live::published() };
    let fit = settings.fit(image.view(), EdgeProfile::area(), Compositing::Over).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.steps), (3, 120));
    assert_eq!(fit.scene.background.map(f64::to_bits), [1.0_f64.to_bits(); 3]);
}

#[test]
fn nothing_to_explain() {
    let size = ImageSize::new(9, 7).unwrap();
    let flat = Image::from_planar(size, vec![0.25_f32; 3 * 63]).unwrap();
    let fit = Live::default().fit(flat.view(), EdgeProfile::area(), Compositing::Over).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.stop), (0, StopReason::Empty));
    assert!(fit.loss < 1e-6, "{}", fit.loss);
    let mut broken = flat;
    broken.data_mut()[5] = f32::NAN;
    assert!(Live::default().fit(broken.view(), EdgeProfile::area(), Compositing::Over).is_err());
}
