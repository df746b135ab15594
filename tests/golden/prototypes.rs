//! Shapes learned from generated pictures: as many as the pictures were drawn with, and the same ones.

use core::f64::consts::TAU;

use dvp::format::mdshr_bank;
use dvp::generate::{SceneSettings, sample_scene};
use dvp::paint::Painter;
use dvp_core::{Efd, Image, ImageSize, Real};
use dvp_fit::prototypes::{Form, Learned, Pool, PrototypeOptions, learn, members};
use dvp_fit::{Bank, FitOptions, FitScratch, Fitter};

/// Pictures of `bank`'s shapes, rounded to 8 bits.
fn pictures(settings: &SceneSettings, bank: &Bank<f32>, side: usize, count: u64) -> Vec<Image<f32>> {
    let size = ImageSize::new(side, side).unwrap();
    let picture = |index| {
        let scene = sample_scene(settings, bank, size, 3, index);
        let mut image = Painter::default().paint(&scene, size).unwrap();
        image.data_mut().iter_mut().for_each(|value| *value = (*value * 255.0).round() / 255.0);
        image
    };
    (0..count).map(picture).collect()
}

fn learn_from(pictures: &[Image<f32>]) -> Learned {
    let (fitter, mut scratch) = (Fitter::new(FitOptions::default()).unwrap(), FitScratch::default());
    let mut all = Vec::new();
    for (index, picture) in pictures.iter().enumerate() {
        let fit = fitter.fit(picture.view(), &mut scratch).unwrap();
        all.extend(members(&fit, picture.size(), index).unwrap());
    }
    let learned = learn(&all, &PrototypeOptions::default()).unwrap();
    let means: Vec<f64> = learned.silhouettes.iter().map(|value| value.mean).collect();
    eprintln!("{} members, {} outliers, silhouettes {means:.3?}", all.len(), learned.outliers.len());
    learned
}

/// Distance of every true shape to the nearest learned one.
fn distances(truth: &Bank<f32>, learned: &Bank<f32>) -> Vec<f64> {
    let form = |(_, efd): &(String, Efd<f32>)| Form::new(efd).unwrap();
    let learned: Vec<Form> = learned.prototypes.iter().map(form).collect();
    let nearest = |truth: Form| learned.iter().map(|form| truth.distance(form, false)).fold(f64::INFINITY, f64::min);
    truth.prototypes.iter().map(|prototype| nearest(form(prototype))).collect()
}

fn better(pictures: &[Image<f32>], bank: &Bank<f32>) -> Bank<f32> {
    let fitter = Fitter::new(FitOptions::default().with_bank(Some(bank.clone()))).unwrap();
    let (mut scratch, mut pool) = (FitScratch::default(), Pool::new(bank).unwrap());
    for picture in pictures {
        let fit = fitter.fit(picture.view(), &mut scratch).unwrap();
        pool.add(&fit, picture.size(), &scratch);
    }
    pool.bank().unwrap()
}

#[test]
fn the_three_shapes_of_mds_hr() {
    let truth = mdshr_bank();
    let pictures = pictures(&SceneSettings::mds_hr(), &truth, 128, 48);
    let learned = learn_from(&pictures);
    assert_eq!(learned.prototypes.len(), 3);
    let mut orders: Vec<usize> = learned.prototypes.iter().map(|prototype| prototype.symmetry).collect();
    orders.sort_unstable();
    assert_eq!(orders, [1, 2, 4]);
    assert!(learned.prototypes.iter().all(|prototype| prototype.own_mirror));
    let first = learned.bank();
    let before = distances(&truth, &first);
    // Notch and corners are cut in single fits; all members together have them.
    assert!(before.iter().all(|&d| d < 0.03), "{before:?}");
    let after = distances(&truth, &better(&pictures, &first));
    eprintln!("{before:.4?}, then {after:.4?}");
    assert!(after.iter().all(|&d| d < 0.01) && after.iter().sum::<f64>() < 0.6 * before.iter().sum::<f64>());
}

fn polygon(name: &str, corners: &[[f64; 2]]) -> (String, Efd<f32>) {
    let (efd, _) = Efd::from_contour(corners, 64).unwrap();
    let efd = efd.normalize().unwrap().efd;
    (name.to_owned(), Efd::new(efd.rows().iter().map(|row| row.map(|v| v.as_f32())).collect()))
}

/// A star (or, with equal radii, a regular polygon of twice as many corners).
fn star(points: usize, inner: f64) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let (sin, cos) = (TAU * f64::of_usize(i) / f64::of_usize(2 * points)).sin_cos();
        let radius = if i.is_multiple_of(2) { 1.0 } else { inner };
        [radius * cos, radius * sin]
    };
    (0..2 * points).map(corner).collect()
}

fn others() -> Vec<(String, Efd<f32>)> {
    let cross =
        [[1, 3], [1, 1], [3, 1], [3, -1], [1, -1], [1, -3], [-1, -3], [-1, -1], [-3, -1], [-3, 1], [-1, 1], [-1, 3]];
    let letter = [[0, 0], [4, 0], [4, 1], [1, 1], [1, 3], [3, 3], [3, 4], [1, 4], [1, 6], [0, 6]];
    let corners = |points: &[[i32; 2]]| points.iter().map(|p| p.map(f64::from)).collect::<Vec<_>>();
    vec![
        polygon("star", &star(5, 0.5)),
        polygon("triangle", &star(3, 0.5)),
        polygon("cross", &corners(&cross)),
        polygon("letter", &corners(&letter)),
        polygon("bar", &corners(&[[0, 0], [5, 0], [5, 2], [0, 2]])),
    ]
}

#[test]
fn other_shapes() {
    for (count, images) in [(1, 40), (2, 52), (5, 88)] {
        let truth = Bank::new(others().into_iter().take(count).collect());
        // Each shape needs several whole members.
        let pictures = pictures(&SceneSettings::mds_hr(), &truth, 128, images);
        let learned = learn_from(&pictures);
        assert_eq!(learned.prototypes.len(), count);
        let off = distances(&truth, &learned.bank());
        assert!(off.iter().all(|&d| d < 0.05), "{off:?}");
    }
}

#[test]
fn hard_edges_and_occlusion() {
    let truth = mdshr_bank();
    // 20 to 50 px across: at 64 x 64, half as large, hard pixels leave the shapes of the smallest open.
    let pictures = pictures(&SceneSettings::multi_dsprites(), &truth, 128, 48);
    let learned = learn_from(&pictures);
    assert_eq!(learned.prototypes.len(), 3);
    let off = distances(&truth, &learned.bank());
    assert!(off.iter().all(|&d| d < 0.04), "{off:?}");
}
