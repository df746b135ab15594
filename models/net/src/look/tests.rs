use dvp_core::render::EdgeProfile;
use dvp_core::shape::mdshr_bank;
use dvp_core::{AnyShape, Image, ImageSize, Object, Pose, Scene};

use super::*;
use crate::look::{Aim, Layout};

const BACKGROUND: [f64; 3] = [0.1, 0.6, 0.3];

fn object(translation: [f64; 2], scale: f64, rotation: f64, color: [f64; 3], prototype: usize) -> Object<f64> {
    let efd = mdshr_bank::<f64>(16).prototypes()[prototype].clone();
    Object::of_efd(Pose { translation, scale, rotation }, color, 1.0, efd, Some(prototype))
}

fn painted(objects: Vec<Object<f64>>) -> Image<f64> {
    let steps = SceneSteps::new(1, 16, EdgeProfile::reference()).unwrap();
    let scene = Scene { objects, ..Scene::empty(BACKGROUND) };
    steps.paint(&scene, ImageSize::new(128, 128).unwrap()).unwrap()
}

/// The planes of the window of `object` in a picture, of which `seen` was painted.
fn window(picture: Vec<Object<f64>>, seen: Vec<Object<f64>>, object: &Object<f64>) -> Vec<f64> {
    let (picture, painted) = (painted(picture), painted(seen));
    let sight = Sight { picture: &picture, painted: &painted, background: BACKGROUND };
    let mut out = Vec::new();
    sight.window(&LookConfig::small(), object, &mut out);
    out
}

#[test]
fn an_object_is_one_and_its_background_zero_whatever_its_color_place_size_and_angle() {
    let planes = |translation, scale, rotation, color| {
        let own = object(translation, scale, rotation, color, 1);
        window(vec![own.clone()], vec![own.clone()], &own)
    };
    let first = planes([0.5, 0.5], 0.25, 0.0, [0.9, 0.1, 0.2]);
    let place = |row: usize, column: usize| row * 32 + column;
    // The middle lies inside of the shape, the corner 1.9 scales away from it along both axes.
    for plane in [0, 2] {
        let (middle, corner) = (first[1024 * plane + place(16, 16)], first[1024 * plane + place(0, 0)]);
        assert!((middle - 1.0).abs() < 0.01 && corner.abs() < 0.01, "plane {plane}: {middle} {corner}");
    }
    // Nothing of another color, but for what keeps faint objects from a division by nothing: 1e-3 of 0.8^2 + 0.5^2 + 0.1^2. All of it in the
    // picture.
    assert!(first[1024..2048].iter().chain(&first[3072..4096]).all(|beside| beside.abs() < 1.2e-3));
    assert!(first[4096..].iter().all(|share| (share - 1.0).abs() < 1e-12));
    // Edges are some pixels wide, whatever the size: windows differ there alone.
    let other = planes([0.45, 0.52], 0.2, 1.0, [0.0, 0.9, 0.9]);
    let apart = |plane: usize| {
        (0..1024).map(|k| (first[1024 * plane + k] - other[1024 * plane + k]).abs()).sum::<f64>() / 1024.0
    };
    assert!((0..5).all(|plane| apart(plane) < 0.03), "{:?}", [0, 1, 2, 3, 4].map(apart));
}

#[test]
fn what_is_off_is_a_difference_between_picture_and_painting() {
    let (own, shifted) = (object([0.5, 0.5], 0.2, 0.3, [0.9; 3], 1), object([0.52, 0.5], 0.2, 0.3, [0.9; 3], 1));
    let planes = window(vec![own], vec![shifted.clone()], &shifted);
    let sums = [0, 2].map(|plane| planes[1024 * plane..1024 * (plane + 1)].iter().sum::<f64>());
    let moved = (0..1024).map(|k| (planes[k] - planes[2048 + k]).abs()).sum::<f64>();
    // The same area, elsewhere: 0.1 of a scale over the height of the shape, on both sides of it.
    assert!((sums[0] / sums[1] - 1.0).abs() < 0.02 && moved > 0.05 * sums[0], "{sums:?} {moved}");
}

#[test]
fn beside_the_picture_there_is_nothing() {
    let own = object([0.0, 0.5], 0.2, 0.0, [0.9; 3], 1);
    let planes = window(vec![own.clone()], vec![own.clone()], &own);
    // The left half of the window.
    for (k, share) in planes[4096..].iter().enumerate() {
        assert!((share - if k % 32 < 16 { 0.0 } else { 1.0 }).abs() < 1e-12, "place {k}: {share}");
    }
}

#[test]
fn what_should_be_said_puts_an_object_right() {
    let bank = mdshr_bank::<f64>(16);
    let layout = Layout::of(&bank);
    for prototype in 0..3 {
        let truth = object([0.4, 0.6], 0.22, 0.7, [0.3; 3], prototype);
        let mut seen = object([0.45, 0.52], 0.25, 2.9, [0.3; 3], (prototype + 1) % 3);
        let mut aim = Aim::default();
        layout.aim(&seen, &truth, prototype, &mut aim);
        let said = [&aim.moves[..], &aim.shapes, &aim.turns].concat();
        assert_eq!(said.len(), layout.len());
        layout.apply(&said, &mut seen, &bank);
        let off = (0..2).map(|axis| (seen.pose.translation[axis] - truth.pose.translation[axis]).abs());
        assert!(off.fold((seen.pose.scale - truth.pose.scale).abs(), f64::max) < 1e-12, "{seen:?}");
        assert_eq!(seen.shape, AnyShape::of_efd(bank.prototypes()[prototype].clone(), Some(prototype)));
        // Up to a turn that maps the shape on itself.
        let apart =
            painted(vec![truth]).data().iter().zip(painted(vec![seen]).data()).map(|(a, b)| (a - b).abs()).sum::<f64>();
        assert!(apart / 49152.0 < 1e-3, "prototype {prototype}: {apart}");
    }
}

#[test]
fn what_is_said_wildly_moves_an_object_by_no_more_than_its_size() {
    let bank = mdshr_bank::<f64>(16);
    let mut seen = object([0.5, 0.5], 0.2, 0.0, [0.3; 3], 0);
    let mut said = vec![0.0; 12];
    (said[0], said[1], said[2]) = (1e9, f64::NAN, -1e9);
    Layout::of(&bank).apply(&said, &mut seen, &bank);
    assert!((seen.pose.translation[0] - 0.7).abs() < 1e-12 && (seen.pose.translation[1] - 0.5).abs() < 1e-12);
    assert!((seen.pose.scale - 0.2 * (-1.0_f64).exp()).abs() < 1e-12);
}

#[test]
fn sizes_of_which_no_network_can_be_made_are_named() {
    let small = LookConfig::small();
    for (config, key) in [
        (LookConfig { side: 20, ..small.clone() }, "side"),
        (LookConfig { reach: f64::NAN, ..small.clone() }, "reach"),
        (LookConfig { channels: [3, 0], ..small.clone() }, "channels"),
        (LookConfig { width: 0, ..small }, "width"),
    ] {
        assert!(config.validate().unwrap_err().to_string().starts_with(key), "{key}");
    }
}
