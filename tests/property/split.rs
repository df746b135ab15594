//! Objects of one color that have run together are told apart by known shapes.

use core::f64::consts::{FRAC_PI_2, TAU};

use dvp_core::contour::contains;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, mdshr_bank};
use dvp_core::{AnyShape, Drawing, Image, Object, Pose, Scene};
use dvp_fit::{Bank, Fit, FitOptions, FitScratch, Fitter};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

use super::fit::{HARMONICS, ORDERS, bank, known, paint, square_size};

/// Pictures, and how many of them must come apart: of 300 such, 296 do, their objects within 0.04 px.
const UNIONS: usize = 100;
const LEAST_FOUND: usize = 96;
/// Pictures that are turned, shifted and fitted by a bank in another order.
const MOVED: usize = 24;
/// An object this near (px) to its truth is found.
const FOUND_PX: f64 = 0.1;
/// Two fits of one picture agree within this (px).
const ALIKE_PX: f64 = 0.05;
/// Share of the vertices of either outline that lies outside the other.
const LEAST_SEEN: f64 = 0.5;

/// Two objects of MDS-HR's shapes in one color, their outlines crossing: at least half of each shows.
fn union() -> impl Strategy<Value = Scene<f64>> {
    let object = || (0_usize..3, 0.12..0.18_f64, -3.1..3.1_f64);
    let place = (prop::array::uniform2(0.46..0.54_f64), -3.1..3.1_f64, 0.5..1.1_f64);
    (object(), object(), place)
        .prop_map(|(first, second, (middle, direction, apart))| {
            let way = [direction.cos(), direction.sin()].map(|v| 0.5 * apart * (first.1 + second.1) * v);
            let object = |(prototype, scale, rotation): (usize, f64, f64), sign: f64| {
                let pose = Pose { translation: [0, 1].map(|c| middle[c] + sign * way[c]), scale, rotation };
                Object::of_efd(
                    pose,
                    [0.8, 0.35, 0.2],
                    1.0,
                    mdshr_bank(HARMONICS).prototypes()[prototype].clone(),
                    Some(prototype),
                )
            };
            Scene { objects: vec![object(first, -1.0), object(second, 1.0)], ..Scene::empty([0.2, 0.4, 0.5]) }
        })
        .prop_filter("outlines that cross, each half seen", |scene| {
            let outlines = outlines(scene);
            let seen = |own: &[[f64; 2]], other: &[[f64; 2]]| {
                own.iter().filter(|&&v| !contains(other, v)).count() as f64 / own.len() as f64
            };
            let [a, b] = [seen(&outlines[0], &outlines[1]), seen(&outlines[1], &outlines[0])];
            a.min(b) >= LEAST_SEEN && a.max(b) < 1.0
        })
}

fn outlines(scene: &Scene<f64>) -> Vec<Vec<[f64; 2]>> {
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(REFERENCE_VERTICES, HARMONICS).unwrap(), &mut drawing).unwrap();
    (0..drawing.object_count()).map(|k| drawing.outline(k).to_vec()).collect()
}

/// How far (px, radians times px) the nearest object of `fit` with the shape of `object` is from its pose.
fn nearest(fit: &Fit<f64>, object: &Object<f64>) -> f64 {
    let off = |found: &Object<f64>| {
        let (a, b) = (&found.pose, &object.pose);
        let turn = TAU / ORDERS[object.prototype().unwrap()];
        let angle = (a.rotation - b.rotation) / turn;
        let angle = (angle - angle.round()) * turn;
        let [x, y] = [0, 1].map(|c| a.translation[c] - b.translation[c]);
        128.0 * x.hypot(y).max((a.scale - b.scale).abs()).max(angle.abs() * b.scale)
    };
    let alike = fit.scene.objects.iter().filter(|found| found.prototype() == object.prototype());
    alike.map(off).fold(f64::INFINITY, f64::min)
}

fn fitted(fitter: &Fitter<f64>, image: &Image<f64>) -> Fit<f64> {
    fitter.fit(image.view(), &mut FitScratch::default()).unwrap()
}

/// Whether `fit` has the objects `expected` within `most` px, and no others.
fn has(fit: &Fit<f64>, expected: &[Object<f64>], most: f64) -> bool {
    fit.scene.objects.len() == expected.len() && expected.iter().all(|object| nearest(fit, object) < most)
}

/// Pictures of unions that come apart, and what was found in them: the same ones in each run.
fn parted() -> Vec<(Image<f64>, Vec<Object<f64>>)> {
    let (mut runner, fitter, unions) = (TestRunner::deterministic(), known(), union());
    let scenes = (0..MOVED).map(|_| unions.new_tree(&mut runner).unwrap().current());
    let parted: Vec<_> = scenes
        .filter_map(|scene| {
            let image = paint(&scene, square_size());
            let fit = fitted(&fitter, &image);
            has(&fit, &scene.objects, FOUND_PX).then_some((image, fit.scene.objects))
        })
        .collect();
    assert!(parted.len() + 1 >= MOVED, "{} of {MOVED} come apart", parted.len());
    parted
}

/// The picture whose pixel (column, row) is that of `source(column, row)`.
fn rearranged(image: &Image<f64>, source: impl Fn(usize, usize) -> [usize; 2]) -> Image<f64> {
    let mut out = image.clone();
    let side = image.size().width();
    for (plane, old) in out.data_mut().chunks_exact_mut(side * side).zip(image.data().chunks_exact(side * side)) {
        for (i, value) in plane.iter_mut().enumerate() {
            let [x, y] = source(i % side, i / side);
            *value = old[y * side + x];
        }
    }
    out
}

#[test]
fn unions_come_apart_into_the_objects_they_are_made_of() {
    let (mut runner, fitter, unions) = (TestRunner::deterministic(), known(), union());
    let mut found = 0;
    for _ in 0..UNIONS {
        let scene = unions.new_tree(&mut runner).unwrap().current();
        let fit = fitter.fit(paint(&scene, square_size()).view(), &mut FitScratch::default()).unwrap();
        let off = scene.objects.iter().map(|object| nearest(&fit, object)).fold(0.0, f64::max);
        if fit.scene.objects.len() == 2 && off < FOUND_PX {
            found += 1;
            // Together they cover the union and nothing else.
            assert!(fit.loss < 5e-4, "{}", fit.loss);
        }
    }
    assert!(found >= LEAST_FOUND, "{found} of {UNIONS}");
}

#[test]
fn a_turned_union_comes_apart_alike() {
    let (fitter, side) = (known(), square_size().width());
    for (image, objects) in parted() {
        // Column x, row y goes to column y, row side - 1 - x: a quarter turn from +y to +x.
        let turned = rearranged(&image, |x, y| [side - 1 - y, x]);
        let turn = |object: &Object<f64>| {
            let [x, y] = object.pose.translation;
            let pose = Pose { translation: [y, 1.0 - x], rotation: object.pose.rotation - FRAC_PI_2, ..object.pose };
            Object { pose, ..object.clone() }
        };
        let expected: Vec<_> = objects.iter().map(turn).collect();
        assert!(has(&fitted(&fitter, &turned), &expected, ALIKE_PX), "{expected:?}");
    }
}

#[test]
fn a_shifted_union_comes_apart_alike() {
    let (fitter, side) = (known(), square_size().width());
    for (at, (image, objects)) in parted().into_iter().enumerate() {
        // The border shows the background all around.
        let shift = [1 + at % 3, at % 4];
        let shifted = rearranged(&image, |x, y| [(x + side - shift[0]) % side, (y + side - shift[1]) % side]);
        let move_on = |object: &Object<f64>| {
            let translation = [0, 1].map(|c| object.pose.translation[c] + shift[c] as f64 / side as f64);
            Object { pose: Pose { translation, ..object.pose }, ..object.clone() }
        };
        let expected: Vec<_> = objects.iter().map(move_on).collect();
        assert!(has(&fitted(&fitter, &shifted), &expected, ALIKE_PX), "{expected:?}");
    }
}

#[test]
fn the_order_of_the_bank_is_not_seen() {
    let reversed = Bank::new(bank().prototypes.into_iter().rev().collect());
    let fitter = Fitter::new(FitOptions::default().with_bank(Some(reversed))).unwrap();
    for (image, objects) in parted() {
        let mut fit = fitted(&fitter, &image);
        for object in &mut fit.scene.objects {
            if let AnyShape::Prototype(prototype) = &mut object.shape {
                prototype.index = ORDERS.len() - 1 - prototype.index;
            }
        }
        assert!(has(&fit, &objects, ALIKE_PX), "{objects:?}");
    }
}
