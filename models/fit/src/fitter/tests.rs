use alloc::string::String;
use alloc::vec::Vec;

use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile, Renderer, TriangleRenderer};
use dvp_core::shape::{OutlineBasis, mdshr_bank};
use dvp_core::{Drawing, Image, ImageSize, Object, Pose, Scene};

use super::shown::Shown;
use super::subsample::Subsampling;
use super::{FitScratch, Fitter};
use crate::picture::{Known, PictureScratch, fit_picture};
use crate::residual::Residual;
use crate::{Bank, FitError, FitOptions, StopReason};

/// A disk of 24 vertices, scene units.
fn disk([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let vertex = |i: u32| num_traits::Float::sin_cos(core::f64::consts::TAU * f64::from(i) / 24.0);
    (0..24).map(vertex).map(|(sin, cos)| [x + radius * cos, y + radius * sin]).collect()
}

fn drawing(disks: &[([f64; 2], f64)]) -> Drawing<f64> {
    let mut drawing = Drawing { background: [0.1, 0.2, 0.3], ..Drawing::default() };
    for (k, &(center, radius)) in (1_u32..).zip(disks) {
        drawing.push(&disk(center, radius), [0.9 / f64::from(k), 0.5, 0.1 * f64::from(k)], 1.0);
    }
    drawing
}

#[test]
fn what_is_shown_is_what_a_whole_rendering_shows() {
    // More than 2^16 pixels, not square.
    let size = ImageSize::new(360, 240).unwrap();
    let ramp = (0..size.pixels()).map(|i| f64::from(u32::try_from(i % 360).unwrap()) / 360.0);
    let image = Image::from_interleaved(size, &ramp.flat_map(|v| [v, 1.0 - v, 0.5]).collect::<Vec<_>>()).unwrap();
    let start = [([0.3, 0.3], 0.12), ([0.9, 0.5], 0.1), ([0.38, 0.35], 0.1), ([1.2, 0.2], 0.15)];
    let mut moved = start;
    moved[2] = ([0.45, 0.4], 0.09);
    let steps = [
        start.to_vec(),
        // One moves, where others overlap it.
        moved.to_vec(),
        start.to_vec(),
        // Removed, put in again, one more, half outside the view.
        [&start[..1], &start[2..]].concat(),
        start.to_vec(),
        [&start[..], &[([1.5, 0.98], 0.1)]].concat(),
        // All of it.
        Vec::new(),
        start.to_vec(),
        start.to_vec(),
    ];
    let edges = [EdgeProfile::reference(), EdgeProfile::area(), EdgeProfile::distance(0.01)];
    for setting in edges.into_iter().flat_map(|edge| [(edge, Compositing::Blend), (edge, Compositing::Over)]) {
        let (mut shown, mut residual) = (Shown::default(), Residual::default());
        for (step, disks) in steps.iter().enumerate() {
            let drawing = drawing(disks);
            let error = shown.compare(&drawing, &image.view(), setting, &mut residual).unwrap();
            let (mut whole, mut fresh) = (Shown::default(), Residual::default());
            let expected = whole.compare(&drawing, &image.view(), setting, &mut fresh).unwrap();
            assert!((error - expected).abs() < 1e-9, "step {step}: {error} instead of {expected}");
            let [bits, expected] = [&residual, &fresh].map(|residual| residual.bits(0.1));
            assert!((bits - expected).abs() < 1e-5 * expected, "step {step}: {bits} bits instead of {expected}");
        }
    }
}

/// Not square, of odd sides.
const LARGE: (usize, usize) = (1203, 1131);
const DISKS: [([f64; 2], f64); 3] = [([0.3, 0.35], 0.12), ([0.7, 0.6], 0.1), ([0.25, 0.75], 0.07)];

/// Three disks with edges of so many pixels.
fn large(width_px: f64) -> Image<f64> {
    let size = ImageSize::new(LARGE.0, LARGE.1).unwrap();
    let edge = EdgeProfile::distance(2.0 * width_px / f64::from(u32::try_from(size.unit_px()).unwrap()));
    let mut image = Image::zeros(size);
    let renderer = ContourRenderer::new(edge, Compositing::Over);
    renderer.render(&drawing(&DISKS), size, &mut Default::default(), image.data_mut()).unwrap();
    image
}

#[test]
fn every_kth_pixel_tells_where_objects_with_wide_edges_are() {
    let image = large(5.0);
    let taken = Subsampling::of(&image.view()).unwrap();
    assert!(taken.image(&image.view()).size().unit_px() < 600, "{taken:?}");
    let fit = Fitter::new(FitOptions::default()).unwrap().fit(image.view(), &mut FitScratch::default()).unwrap();
    assert_eq!(fit.scene.objects.len(), DISKS.len());
    for (center, radius) in DISKS {
        let off = |at: [f64; 2]| (at[0] - center[0]).abs().max((at[1] - center[1]).abs());
        let nearest = fit.scene.objects.iter().map(|object| &object.pose);
        let pose = nearest.min_by(|a, b| off(a.translation).total_cmp(&off(b.translation))).unwrap();
        // Half a pixel of the image, a tenth of an edge.
        assert!(off(pose.translation) < 4e-4, "{pose:?} instead of {center:?}");
        assert!((pose.scale / radius - 1.0).abs() < 0.02, "{pose:?} instead of {radius}");
    }
    // As if every pixel had been taken: 1.5e-4.
    assert!(fit.loss < 2e-4, "{}", fit.loss);
}

#[test]
fn of_sharp_pictures_every_pixel_is_taken() {
    assert_eq!(Subsampling::of(&large(0.3).view()), None);
}

#[test]
fn a_sharp_dot_among_wide_edges_is_found() {
    let mut image = large(5.0);
    let pixels = image.size().pixels();
    for (row, column) in (300..306).flat_map(|row| (1003..1008).map(move |column| (row, column))) {
        (0..3).for_each(|channel| image.data_mut()[channel * pixels + row * LARGE.0 + column] = 0.9);
    }
    assert!(Subsampling::of(&image.view()).is_some());
    let fit = Fitter::new(FitOptions::default()).unwrap().fit(image.view(), &mut FitScratch::default()).unwrap();
    let found: Vec<[f64; 2]> = fit.scene.objects.iter().map(|object| object.pose.translation).collect();
    let is_dot = |&[x, y]: &[f64; 2]| (x - 1005.5 / 1131.0).abs() < 2e-3 && (y - 303.0 / 1131.0).abs() < 2e-3;
    assert!(found.iter().any(is_dot), "{found:?}");
}

/// A prototype of MDS-HR's bank: which, position, scale, rotation, color.
type Placed = (usize, [f64; 2], f64, f64, [f64; 3]);

/// A picture of objects of MDS-HR's shapes, square, the scene it shows, and the shapes.
fn known(background: [f64; 3], objects: &[Placed], side: usize) -> (Image<f64>, Scene<f64>, Bank<f64>) {
    let bank = mdshr_bank::<f64>(64);
    let object = |&(prototype, translation, scale, rotation, color): &Placed| {
        let pose = Pose { translation, scale, rotation };
        Object::of_efd(pose, color, 1.0, bank.prototypes()[prototype].clone(), Some(prototype))
    };
    let truth = Scene { objects: objects.iter().map(object).collect(), ..Scene::empty(background) };
    let size = ImageSize::new(side, side).unwrap();
    let (mut drawing, mut image) = (Drawing::default(), Image::zeros(size));
    truth.draw(&OutlineBasis::new(64, 64).unwrap(), &mut drawing).unwrap();
    TriangleRenderer::default().render(&drawing, size, &mut Default::default(), image.data_mut()).unwrap();
    let prototypes = bank.prototypes().iter().map(|efd| (String::new(), efd.clone())).collect();
    (image, truth, Bank { prototypes })
}

/// A square along the pixel grid shows few coverages, and a small ellipse only some more: those of area coverage as well
/// as the reference's. Its outlines tell, when they fit.
#[test]
fn edges_along_the_grid_do_not_hide_the_reference() {
    let objects = [
        (1, [0.66716456, 0.18682371], 0.23570311, -0.7826108, [0.7940591, 0.6805793, 0.23702353]),
        (2, [0.6768109, 0.8212052], 0.11510161, -3.0916421, [0.21781874, 0.033245564, 0.24641508]),
    ];
    let (image, truth, bank) = known([0.7798844, 0.11206132, 0.06749672], &objects, 128);
    for max_steps in [0, 10, 20] {
        let options = FitOptions::default().with_bank(Some(bank.clone())).with_max_steps(max_steps);
        let fit = Fitter::new(options).unwrap().fit(image.view(), &mut FitScratch::default()).unwrap();
        assert_eq!((fit.scene.edge.law, fit.scene.objects.len()), (EdgeLaw::SquaredDistance, 2), "{max_steps} steps");
        for (found, truth) in fit.scene.objects.iter().zip(&truth.objects) {
            let (found, truth) = (found.pose.scale, truth.pose.scale);
            assert!((found - truth).abs() < 1e-3, "{max_steps} steps: {found} for {truth}");
        }
    }
}

/// Starts are off by a share of the size: in large pictures by many pixels.
#[test]
fn objects_that_the_border_cuts_are_found_at_every_size() {
    let heart = (0, [0.541046, 0.074293144], 0.2896785, 1.6675643, [0.29009002, 0.6645625, 0.3359089]);
    for side in [128, 256, 384, 768, 1024] {
        let (image, truth, bank) = known([0.67183375, 0.16439027, 0.82695675], &[heart], side);
        let options = FitOptions::default().with_bank(Some(bank));
        let fit = Fitter::new(options).unwrap().fit(image.view(), &mut FitScratch::default()).unwrap();
        let [object] = &fit.scene.objects[..] else { panic!("{} objects at {side} px", fit.scene.objects.len()) };
        let (found, truth) = (object.pose, truth.objects[0].pose);
        assert_eq!(object.prototype(), Some(0), "{side} px");
        assert!((found.scale - truth.scale).abs() < 2e-4, "{side} px: {} for {}", found.scale, truth.scale);
    }
}

/// An image of gray values.
fn gray(size: ImageSize, value: impl Fn(f64, f64) -> f64) -> Image<f64> {
    let at = |i: usize| f64::from(u32::try_from(i).unwrap()) + 0.5;
    let values = (0..size.pixels()).map(|i| value(at(i % size.width()), at(i / size.width())));
    Image::from_interleaved(size, &values.flat_map(|v| [v; 3]).collect::<Vec<_>>()).unwrap()
}

/// A square frame of lines 6 px wide with two lines across in it, black on white: what icons are made of.
fn frame() -> Image<f64> {
    let corners = [[20.0, 20.0], [108.0, 20.0], [108.0, 108.0], [20.0, 108.0], [20.0, 20.0]];
    let crossed = [[44.0, 44.0], [84.0, 84.0], [84.0, 44.0], [44.0, 84.0]];
    let lines: Vec<_> = corners.windows(2).chain(crossed.chunks(2)).map(|ends| [ends[0], ends[1]]).collect();
    gray(ImageSize::new(128, 128).unwrap(), |x, y| {
        let distance = |[[ax, ay], [bx, by]]: [[f64; 2]; 2]| {
            let (dx, dy) = (bx - ax, by - ay);
            let along = (((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            (x - ax - along * dx).hypot(y - ay - along * dy)
        };
        let nearest = lines.iter().map(|&line| distance(line)).fold(f64::INFINITY, f64::min);
        ((nearest - 2.5).clamp(0.0, 1.0) * 255.0).round() / 255.0
    })
}

/// A smooth spiral of two arms.
fn spiral() -> Image<f64> {
    let wave = |x: f64, y: f64| 0.5 + 0.5 * (0.5 * x.hypot(y) + 2.0 * y.atan2(x)).sin();
    gray(ImageSize::new(96, 96).unwrap(), |x, y| (wave(x - 48.0, y - 48.0) * 255.0).round() / 255.0)
}

/// Mean absolute error of the median color.
fn flat_error(image: &Image<f64>) -> ([f64; 3], f64) {
    let view = image.view();
    let color = [0, 1, 2].map(|channel| {
        let mut values = view.channel(channel).to_vec();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    });
    let errors = (0..3).flat_map(|channel| view.channel(channel).iter().map(move |v| (v - color[channel]).abs()));
    (color, errors.sum::<f64>() / (3 * view.size().pixels()) as f64)
}

#[test]
fn no_fit_is_worse_than_one_flat_color() {
    for (name, image) in [("frame", frame()), ("spiral", spiral())] {
        let fit = Fitter::new(FitOptions::default()).unwrap().fit(image.view(), &mut FitScratch::default()).unwrap();
        let (color, error) = flat_error(&image);
        assert!(fit.loss <= error + 1.0 / 255.0, "{name}: {} where one color has {error}", fit.loss);
        if fit.stop == StopReason::NoBetterThanFlat {
            assert_eq!((fit.scene.objects.len(), fit.scene.background), (0, color), "{name}");
            assert!((fit.loss - error).abs() < 1e-12 && fit.bits.is_finite() && fit.noise > 0.0, "{fit:?}");
            assert!(fit.doubts().stop && fit.unexplained > 0.9, "{:?}", fit.doubts());
        }
    }
}

#[test]
fn what_no_objects_explain_becomes_one_flat_color() {
    // Outlines of its arms, filled where they run into one another, miss more of it than gray does.
    let fit = Fitter::new(FitOptions::default()).unwrap().fit(spiral().view(), &mut FitScratch::default()).unwrap();
    assert_eq!(fit.stop, StopReason::NoBetterThanFlat, "{} objects", fit.scene.objects.len());
}

#[test]
fn values_whose_squares_have_no_sum_are_refused() {
    let size = ImageSize::new(7, 30).unwrap();
    let picture = |value: f32| {
        let data = (0..3 * size.pixels()).map(|i| if i % 7 < 3 { value } else { 0.7 });
        Image::from_planar(size, data.collect()).unwrap()
    };
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    for value in [1.4978256e38, -1e38, 1.1e6] {
        let image = picture(value);
        let refused = Err(FitError::TooLarge { index: 0 });
        assert_eq!(fitter.fit(image.view(), &mut FitScratch::default()).map(|fit| fit.loss), refused);
        let fit = fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default());
        assert_eq!(fit.map(|fit| fit.loss), refused);
    }
    let fit = fitter.fit(picture(65504.0).view(), &mut FitScratch::default()).unwrap();
    assert!(fit.loss.is_finite() && !fit.bits.is_nan(), "{fit:?}");
}
