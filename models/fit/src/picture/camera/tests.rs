use alloc::vec;
use alloc::vec::Vec;

use dvp_core::shape::{AnyShape, Circle};
use dvp_core::{Image, ImageSize, Object, Pose, Scene};

use super::super::{Known, fit_picture};
use super::*;
use crate::split_mix::SplitMix;
use crate::{FitOptions, Fitter};

const SIDE: usize = 96;

/// A cell and what it is: its middle and radius, pixels, and its color.
type Cell = ([f32; 2], f32, f32);

/// What is seen of a color at a place.
type Lit<'a> = &'a dyn Fn(f32, [f32; 2]) -> f32;

const CELLS: [Cell; 5] = [
    ([22.0, 25.0], 11.0, 0.55),
    ([63.0, 20.0], 8.0, 0.7),
    ([75.0, 55.0], 12.0, 0.45),
    ([35.0, 62.0], 13.0, 0.6),
    ([60.0, 82.0], 7.0, 0.65),
];

/// Cells on dark ground, of one color each, in the light that `lit` makes of it at a place from -1/2 to 1/2.
fn cells(lit: impl Fn(f32, [f32; 2]) -> f32) -> Image<f32> {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let unit = SIDE as f32;
    let objects = CELLS.map(|(middle, radius, color)| Object {
        shape: Circle { radius: radius / unit }.into(),
        pose: Pose { translation: middle.map(|at| at / unit), ..Pose::identity() },
        paint: [color; 3].into(),
        confidence: 1.0,
    });
    let scene = Scene {
        objects: objects.into(),
        edge: dvp_core::render::EdgeProfile::distance(1.0 / unit),
        compositing: Compositing::Over,
        ..Scene::empty([0.15; 3])
    };
    let mut image = Canvas::default().paint(&scene, size).unwrap().0.clone();
    for (i, value) in image.data_mut().iter_mut().enumerate() {
        let at = [i % SIDE, i % (SIDE * SIDE) / SIDE].map(|at| (at as f32 + 0.5) / unit - 0.5);
        *value = lit(*value, at);
    }
    image
}

/// The picture with noise of the variance `read` squared plus the value over `photons`, alike in all channels, in 8 bits.
fn with_noise_of(image: &Image<f32>, read: f64, photons: f64, seed: u64) -> Image<f32> {
    let mut random = SplitMix(seed);
    let pixels = SIDE * SIDE;
    let mut values = vec![0.0; 3 * pixels];
    for i in 0..pixels {
        let value = f64::from(image.data()[i]);
        let normal = (0..12).map(|_| random.unit()).sum::<f64>() - 6.0;
        let seen = value + (read * read + value / photons).sqrt() * normal;
        let rounded = (255.0 * seen.clamp(0.0, 1.0)).round() / 255.0;
        (0..3).for_each(|c| values[c * pixels + i] = f32::of(rounded));
    }
    Image::from_planar(image.size(), values).unwrap()
}

fn read(image: &Image<f32>) -> Fit<f32> {
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default()).unwrap()
}

/// The objects that are cells: all but a ground that is a thing.
fn found(fit: &Fit<f32>) -> Vec<&Object<f32>> {
    // A cell under noise may be a rectangle with round corners.
    let is_ground = |object: &&Object<f32>| match &object.shape {
        AnyShape::Rectangle(rectangle) => rectangle.size.iter().all(|&side| side > 0.9),
        _ => false,
    };
    fit.scene.objects.iter().filter(|object| !is_ground(object)).collect()
}

#[test]
fn noise_that_grows_with_the_light_makes_no_things() {
    let clean = cells(|color, _| color);
    for (photons, seed) in [(600.0, 1), (300.0, 2), (150.0, 3)] {
        let fit = read(&with_noise_of(&clean, 0.005, photons, seed));
        assert_eq!(fit.scene.objects.len(), CELLS.len(), "{photons} photons");
        for (middle, ..) in CELLS {
            let off = |object: &Object<f32>| {
                let [x, y] = object.pose.translation;
                (SIDE as f32 * x - middle[0]).hypot(SIDE as f32 * y - middle[1])
            };
            let nearest = fit.scene.objects.iter().map(off).fold(f32::INFINITY, f32::min);
            assert!(nearest < 0.5, "{nearest} px, {photons} photons");
        }
    }
}

#[test]
fn uneven_light_makes_no_things() {
    let lights: [(&str, Lit); 3] = [
        ("along a line", &|color, [x, y]| color + 0.08 * x + 0.06 * y),
        ("about the middle", &|color, [x, y]| color - 0.2 * (x * x + y * y)),
        ("multiplied", &|color, [x, y]| color * (1.0 - 0.6 * (x * x + y * y))),
    ];
    for (name, lit) in lights {
        let clean = cells(lit);
        for (read_noise, photons) in [(0.0, 1e9), (0.015, 1e9), (0.005, 400.0)] {
            let image = with_noise_of(&clean, read_noise, photons, 4);
            let fit = read(&image);
            assert_eq!(found(&fit).len(), CELLS.len(), "{name}, noise {read_noise}, {photons} photons");
            if photons < 1e9 || read_noise > 0.0 {
                continue;
            }
            // Clean, it is seen: the ground has the ramp, and nothing that is shown is off by much.
            assert!(fit.scene.objects[0].paint.ramp().is_some(), "{name}");
            assert!(fit.loss < 1.5 / 255.0, "{name}: {} steps", 255.0 * fit.loss);
            assert!(fit.marginal_gain.iter().all(|&gain| gain > 1e-3), "{name}: {:?}", fit.marginal_gain);
        }
    }
}

#[test]
fn poses_are_as_uncertain_as_the_noise_at_their_edges() {
    let image = cells(|color, _| color);
    let noisy = with_noise_of(&image, 0.005, 300.0, 5);
    let evened = dvp_trace::noise::evened(&noisy.view()).expect("it grows");
    let fit = read(&evened.image);
    let restored = with_noise(fit.clone(), &evened, noisy.view(), &mut Canvas::default()).unwrap();
    for (k, (before, after)) in fit.covariance.iter().zip(&restored.covariance).enumerate() {
        // Half way between a cell and the ground there is more noise than on most of the picture.
        let middle = 0.5 * (fit.scene.objects[k].color()[0] + fit.scene.background[0]);
        let is = (0.005_f32.powi(2) + middle / 300.0) / f32::of(evened.level).powi(2);
        assert!((after[0] / before[0] / is - 1.0).abs() < 0.4, "{} for {is}", after[0] / before[0]);
    }
}
