use alloc::vec;

use dvp_core::scene::ObjectGrad;
use dvp_core::{Efd, Object, Pose, Scene, SceneGrad};

use super::{Free, Parameters, renormalize};

fn scene() -> Scene<f64> {
    let pose = Pose { translation: [0.25, 0.75], scale: 0.2, rotation: core::f64::consts::FRAC_PI_2 };
    let efd = Efd::new(vec![[1.0, 0.0, 0.0, -0.5], [0.1, 0.0, 0.0, 0.1]]);
    let object = Object::of_efd(pose, [0.1, 0.2, 0.3], 0.5, efd, Some(1));
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
    assert_eq!((scene.background[0], scene.objects[0].pose.scale, scene.objects[0].color()[0]), (0.0, 1e-3, 1.0));
}

#[test]
fn size_and_angle_go_to_the_pose() {
    // 3 R(0.3) [[1, 0.2], [0, -0.5]], and twice the identity.
    let (s, c) = 0.3_f64.sin_cos();
    let mut rows = [[3.0 * c, 0.6 * c + 1.5 * s, 3.0 * s, 0.6 * s - 1.5 * c], [2.0, 0.0, 0.0, 2.0]];
    let mut scale = 2.0;
    let turn = renormalize(&mut rows, &mut scale);
    assert!((turn - 0.3).abs() < 1e-12 && (scale - 6.0).abs() < 1e-12, "{turn} {scale}");
    let expected = [1.0, 0.2, 0.0, -0.5, 2.0 / 3.0 * c, 2.0 / 3.0 * s, -2.0 / 3.0 * s, 2.0 / 3.0 * c];
    for (value, expected) in rows.as_flattened().iter().zip(expected) {
        assert!((value - expected).abs() < 1e-12, "{rows:?}");
    }
}

#[test]
fn nothing_to_normalize_by() {
    let mut scale = 2.0;
    let mut rows = [[0.0, 0.0, 0.0, 0.0], [1.0, 2.0, 3.0, 4.0]];
    assert_eq!((renormalize(&mut rows, &mut scale), scale, rows[1]), (0.0, 2.0, [1.0, 2.0, 3.0, 4.0]));
    assert_eq!((renormalize(&mut [], &mut scale), scale), (0.0, 2.0));
}
