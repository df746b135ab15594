//! Of the modules that are one file each.

use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;
use core::error::Error;

use dvp_core::render::{Compositing, ContourRenderer, RenderError, Renderer};
use dvp_core::shape::{OutlineBasis, ShapeError};
use dvp_core::{Drawing, Efd, Image, ImageSize, Object, Pose, Scene};

use crate::cholesky::{factor, packed, solve};
use crate::colors::{ColorScratch, is_rounded, refine_colors};
use crate::doubt::visible_share;
use crate::price::{Prices, scene_bits};
use crate::residual::Residual;
use crate::{Ambiguity, Doubts, Fit, FitError, FitOptions, StopReason, fit_image};

#[test]
fn cholesky_of_two_equations() {
    // [[4, 2], [2, 3]] = L L^T with L = [[2, 0], [1, sqrt 2]]; x = (3 x 2 - 2 x 1, 4 x 1 - 2 x 2) / 8.
    let mut matrix = [4.0_f64, 2.0, 3.0];
    assert!(factor(&mut matrix, 2));
    assert!(matrix.iter().zip([2.0, 1.0, 2.0_f64.sqrt()]).all(|(a, b)| (a - b).abs() < 1e-15));
    let mut x = [2.0, 1.0];
    solve(&matrix, 2, &mut x);
    assert!((x[0] - 0.5).abs() < 1e-15 && x[1].abs() < 1e-15);
    assert!(!factor(&mut [1.0, 2.0, 1.0], 2));
    assert!(!factor(&mut [f64::NAN], 1));
}

#[test]
fn cholesky_of_many_equations() {
    // More than two blocks of eight: 1 on the diagonal of (i - j)-dependent positive definite entries 0.5^|i - j|.
    let n = 21_usize;
    let entry = |i: usize, j: usize| 0.5_f64.powi(i32::try_from(i.abs_diff(j)).unwrap());
    let mut matrix: Vec<f64> = (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| entry(i, j)).collect();
    assert_eq!(matrix.len(), packed(n, 0));
    let truth: Vec<f64> = (0..n).map(|i| (1.7 * f64::from(u32::try_from(i).unwrap())).sin()).collect();
    let mut x: Vec<f64> = (0..n).map(|i| (0..n).map(|j| entry(i, j) * truth[j]).sum()).collect();
    assert!(factor(&mut matrix, n));
    solve(&matrix, n, &mut x);
    assert!(x.iter().zip(&truth).all(|(a, b)| (a - b).abs() < 1e-13), "{x:?}");
}

#[test]
fn description_lengths() {
    let object =
        |prototype, harmonics| Object::of_efd(Pose::identity(), [0.0_f64; 3], 1.0, Efd::zeros(harmonics), prototype);
    // Background 24; object 24 + 48 and the choice among 4, or 2 harmonics of 4 coefficients of 8 bits.
    let mut scene = Scene::empty([0.0; 3]);
    assert!((scene_bits(&scene, 4) - 24.0).abs() < 1e-12);
    scene.objects.push(object(Some(1), 16));
    assert!((scene_bits(&scene, 4) - (24.0 + 72.0 + 2.0)).abs() < 1e-12);
    scene.objects.push(object(None, 2));
    let both = 24.0 + 74.0 + 72.0 + 64.0;
    assert!((scene_bits(&scene, 4) - both).abs() < 1e-12);
    // A shape that occurs again is not written again, wherever it stands.
    scene.objects.insert(0, object(None, 2));
    assert!((scene_bits(&scene, 4) - (both + 72.0)).abs() < 1e-12);
    // At other prices.
    let prices = Prices { object: 0.5, harmonic: 2.0, ..Prices::default() };
    assert!((prices.scene_bits(&scene, 4) - (24.0 + 3.0 * 36.0 + 2.0 + 128.0)).abs() < 1e-12);
}

#[test]
fn residuals_of_two_pixels() {
    // Pixel 0 off by 0.01 in green, pixel 1 by 0.2 in red and 0.3 in blue.
    let size = ImageSize::new(2, 1).unwrap();
    let image = Image::from_planar(size, vec![0.5_f64; 6]).unwrap();
    let mut residual = Residual::default();
    let loss = residual.measure(&image.view(), &[0.5, 0.7, 0.51, 0.5, 0.5, 0.2]);
    assert!((loss - 0.51 / 6.0).abs() < 1e-15);
    // In units of noise 0.01 the first is 1: half a nat; the second is capped.
    assert!((residual.bits(0.01) - (0.5 * core::f64::consts::LOG2_E + 24.0)).abs() < 1e-9);
    assert_eq!(residual.count_above(size, [1.0, 0.5], 1.0, 0.25), 1);
    assert_eq!(residual.count_above(size, [0.5, 0.5], 0.5, 0.25), 0);
    assert_eq!(residual.count_above(size, [-9.0, 0.5], 2.0, 0.0), 0);
}

#[test]
fn visible_vertices_are_counted() {
    let size = ImageSize::new(10, 10).unwrap();
    let outline = [[1.0, 1.0], [-1.0, 1.0], [9.9, 9.9], [10.0, 5.0]];
    assert!((visible_share(&outline, size) - 0.5).abs() < 1e-15);
}

#[test]
fn soft_pixels_tell_fractions_of_a_step() {
    // One object whose coverage runs through 200 values; colors between the steps of 8 bits.
    let truth = [[0.701_3, 0.302_1, 0.118_9], [0.233_7, 0.851_4, 0.549_2]];
    let round = |value: f64| (value * 255.0).round() / 255.0;
    let coverage: Vec<f64> = (0..200_u32).map(|i| (f64::from(i) + 0.5) / 200.0).collect();
    let mixed = |c: usize| coverage.iter().map(move |p| round(p * truth[0][c] + (1.0 - p) * truth[1][c]));
    let data: Vec<f64> = (0..3).flat_map(mixed).collect();
    assert!(is_rounded(data.iter().copied()) && !is_rounded(truth.into_iter().flatten()));
    let image = Image::from_planar(ImageSize::new(200, 1).unwrap(), data).unwrap();
    let mut scratch = ColorScratch::default();
    scratch.coverage = coverage;
    let mut colors = truth.map(|color| color.map(round));
    let worst = |colors: &[[f64; 3]; 2]| {
        let pairs = colors.iter().flatten().zip(truth.iter().flatten());
        pairs.fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()))
    };
    let before = worst(&colors);
    refine_colors(&image.view(), 0..200, &mut colors, &mut scratch);
    // Rounding 0.29 steps each, 67 pixels' worth for either color: 0.04 steps.
    assert!(before > 0.3 / 255.0 && worst(&colors) < 0.12 / 255.0, "{before} to {}", worst(&colors));
}

/// Two disks of radius 10 px, `steps` of 8 bits off the background in one channel and half as much in another.
fn faint_disks(steps: f64) -> Image<f64> {
    let size = ImageSize::new(64, 64).unwrap();
    let color = [100.0 + steps, 100.0 - (0.5 * steps).floor(), 100.0].map(|value| value / 255.0);
    let mut scene = Scene::empty([100.0 / 255.0; 3]);
    for center in [[0.25, 0.3], [0.7, 0.65]] {
        let pose = Pose { translation: center, scale: 10.0 / 64.0, rotation: 0.0 };
        let efd = Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]);
        scene.objects.push(Object::of_efd(pose, color, 1.0, efd, None));
    }
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(64, 1).unwrap(), &mut drawing).unwrap();
    let mut image = Image::zeros(size);
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.render(&drawing, size, &mut Default::default(), image.data_mut()).unwrap();
    image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0).round() / 255.0);
    image
}

#[test]
fn faint_objects_are_objects() {
    for steps in [1.0, 2.0, 4.0, 8.0] {
        let fit = fit_image(faint_disks(steps).view(), &FitOptions::default()).unwrap();
        assert_eq!(fit.scene.objects.len(), 2, "{steps} steps");
        // Off by the rounding of a step at most.
        assert!((fit.scene.objects[0].color()[0] * 255.0 - 100.0 - steps).abs() < 1.0, "{:?}", fit.scene);
        assert!(fit.loss < 1e-3, "{}", fit.loss);
    }
    let fit = fit_image(faint_disks(0.0).view(), &FitOptions::default()).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.stop, fit.doubts()), (0, StopReason::Empty, Doubts::default()));
}

#[test]
fn doubts_by_hand() {
    let fit = fit_image(faint_disks(100.0).view(), &FitOptions::default()).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.doubts()), (2, Doubts::default()));
    // Clean disks of 10 px agree to a thousandth, and say so.
    assert!(fit.expected_iou.len() == 2 && fit.expected_iou.iter().all(|iou| (0.995..1.0).contains(iou)), "{fit:?}");
    let unsure = Fit { expected_iou: vec![0.99, 0.94], ..fit.clone() };
    assert_eq!(unsure.doubts(), Doubts { pose: true, ..Doubts::default() });
    // What cannot be told is no reason to doubt what is.
    let cropped = Fit { ambiguity: vec![Ambiguity::Cropped { object: 0, visible: 0.9 }], ..fit.clone() };
    assert!(!cropped.doubts().any());
    // Adam, which states no covariance, takes all its steps.
    let limit = Fit { stop: StopReason::StepLimit, ..fit.clone() };
    assert!(limit.doubts().stop && !Fit { covariance: Vec::new(), ..limit }.doubts().stop);
    assert!(
        Fit { unexplained: 0.02, ..fit.clone() }.doubts().any() && !Fit { unexplained: f64::NAN, ..fit }.doubts().any()
    );
}

#[test]
fn objects_that_may_be_one_too_many_are_doubted() {
    let fit = fit_image(faint_disks(100.0).view(), &FitOptions::default()).unwrap();
    let redundant = |change: &dyn Fn(&mut Fit<f64>)| {
        let mut changed = fit.clone();
        change(&mut changed);
        assert_eq!(changed.doubts(), Doubts { redundant: changed.doubts().redundant, ..Doubts::default() });
        changed.doubts().redundant
    };
    assert!(!redundant(&|_| {}));
    assert!(redundant(&|fit| fit.marginal_gain[1] = 9e-4));
    assert!(redundant(&|fit| fit.marginal_gain[0] = -0.1));
    let redder = |object: &mut Object<f64>, by: f64| {
        let [red, green, blue] = object.color();
        object.paint.set_color([red + by, green, blue]);
    };
    // The second disk beside the first one, in its color or in another.
    let moved = |fit: &mut Fit<f64>, apart: f64| {
        let [x, y] = fit.scene.objects[0].pose.translation;
        fit.scene.objects[1].pose.translation = [x + apart * fit.scene.objects[0].pose.scale, y];
        fit.scene.objects[1].paint = fit.scene.objects[0].paint.clone();
    };
    assert!(redundant(&|fit| moved(fit, 1.5)) && !redundant(&|fit| moved(fit, 4.0)));
    assert!(!redundant(&|fit| {
        moved(fit, 1.5);
        redder(&mut fit.scene.objects[1], 0.1);
    }));
    // A third one of the color that two others have where they overlap, if overlaps blend.
    let third = |fit: &mut Fit<f64>, compositing| {
        moved(fit, 1.5);
        redder(&mut fit.scene.objects[1], 0.2);
        let mut between = fit.scene.objects[0].clone();
        redder(&mut between, 0.1);
        fit.scene.objects.push(between);
        fit.scene.compositing = compositing;
    };
    assert!(redundant(&|fit| third(fit, Compositing::Blend)) && !redundant(&|fit| third(fit, Compositing::Over)));
}

#[test]
fn errors_hand_on_what_caused_them() {
    let prototype = FitError::Prototype { index: 2, source: ShapeError::Degenerate };
    for error in [prototype, ShapeError::Degenerate.into()] {
        assert_eq!(error.source().map(ToString::to_string), Some(ShapeError::Degenerate.to_string()), "{error}");
    }
    let render = FitError::from(RenderError::Starts);
    assert_eq!(render.source().map(ToString::to_string), Some(RenderError::Starts.to_string()));
    assert!(FitError::NotFinite { index: 0 }.source().is_none());
}
