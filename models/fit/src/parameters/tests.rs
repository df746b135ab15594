use alloc::vec;

use dvp_core::scene::ObjectGrad;
use dvp_core::{Efd, Object, Pose, Scene, SceneGrad};

use super::{Free, Parameters, renormalize};

fn scene() -> Scene<f64> {
    let pose = Pose { translation: [0.25, 0.75], scale: 0.2, rotation: core::f64::consts::FRAC_PI_2 };
    let efd = Efd::new(vec![[1.0, 0.0, 0.0, -0.5], [0.1, 0.0, 0.0, 0.1]]);
    let object = Object { pose, color: [0.1, 0.2, 0.3], confidence: 0.5, efd, prototype: Some(1) };
    Scene { objects: vec![object], ..Scene::empty([0.4, 0.5, 0.6]) }
}

#[test]
fn layout_and_way_back() {
    let mut scene = scene();
    let mut parameters = Parameters::new();
    parameters.load(&scene, Free::PoseColorAndShape);
    let expected = [0.4, 0.5, 0.6, 0.25, 0.75, 0.2, 1.0, 0.0, 0.1, 0.2, 0.3, 1.0, 0.0, 0.0, -0.5, 0.1, 0.0, 0.0, 0.1];
    assert_eq!(parameters.values().len(), expected.len());
    assert!(parameters.values().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{parameters:?}");
    let before = scene.clone();
    parameters.store(&mut scene);
    assert_eq!(scene, before);
}

#[test]
fn gradient_of_the_angle_goes_to_the_pair() {
    let scene = scene();
    let mut parameters = Parameters::new();
    parameters.load(&scene, Free::PoseAndColor);
    let object =
        ObjectGrad { translation: [1.0, 2.0], scale: 3.0, rotation: 4.0, color: [5.0, 6.0, 7.0], ..Default::default() };
    parameters.pull_back(&SceneGrad { background: [8.0, 9.0, 10.0], objects: vec![object] });
    // The pair is (1, 0): d angle / d sine = cosine = 0, d angle / d cosine = -sine = -1.
    let expected = [8.0, 9.0, 10.0, 1.0, 2.0, 3.0, 0.0, -4.0, 5.0, 6.0, 7.0];
    assert!(parameters.gradient().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{parameters:?}");
}

#[test]
fn settling_keeps_to_the_box() {
    let mut scene = scene();
    let mut parameters = Parameters::new();
    parameters.load(&scene, Free::PoseAndColor);
    let values = parameters.values_and_gradient().0;
    (values[0], values[5], values[8]) = (-0.5, -1.0, 1.5);
    parameters.settle(&scene);
    parameters.store(&mut scene);
    assert_eq!((scene.background[0], scene.objects[0].pose.scale, scene.objects[0].color[0]), (0.0, 1e-3, 1.0));
}

#[test]
fn first_harmonic_becomes_normal() {
    // 3 R(0.3) diag(1, -0.5) R(0.1): size 3, angle 0.3, starting point 0.1.
    let ((s, c), (p, q)) = (0.3_f64.sin_cos(), 0.1_f64.sin_cos());
    let mut rows = [[
        3.0 * (c * q + 0.5 * s * p),
        3.0 * (-c * p + 0.5 * s * q),
        3.0 * (s * q - 0.5 * c * p),
        3.0 * (-s * p - 0.5 * c * q),
    ]];
    let mut scale = 2.0;
    let turn = renormalize(&mut rows, &mut scale);
    // The gap of the axes is 0.6 of their sum: the fade near a circle takes (0.01 / 0.6)^2 of the phase, 3e-5.
    assert!((turn - 0.3).abs() < 1e-4 && (scale - 6.0).abs() < 1e-4, "{turn} {scale}");
    for (value, expected) in rows[0].into_iter().zip([1.0, 0.0, 0.0, -0.5]) {
        assert!((value - expected).abs() < 1e-4, "{rows:?}");
    }
}

#[test]
fn nothing_to_normalize_by() {
    let mut scale = 2.0;
    let mut rows = [[0.0, 0.0, 0.0, 0.0], [1.0, 2.0, 3.0, 4.0]];
    assert_eq!((renormalize(&mut rows, &mut scale), scale, rows[1]), (0.0, 2.0, [1.0, 2.0, 3.0, 4.0]));
    assert_eq!((renormalize(&mut [], &mut scale), scale), (0.0, 2.0));
}
