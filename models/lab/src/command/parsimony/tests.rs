use dvp_core::{AnyShape, Scene};
use proptest::prelude::*;

use super::spent::{Law, Spent};
use super::traced::Drawn;
use super::trial::{self, Contender, Subject};
use super::truth::{Price, written_out};
use crate::command::pictures::Picture;
use dvp_cli::command::options::square;
use dvp_cli::format::mdshr_bank;
use dvp_cli::generate::{SceneSettings, sample_scene};
use dvp_cli::method::load_network;
use dvp_cli::paint::Painter;

fn truth(seed: u64, index: u64) -> Scene<f32> {
    sample_scene(&SceneSettings::mds_hr(), &mdshr_bank(), square(128).unwrap(), seed, index)
}

#[test]
fn prototypes_cost_their_choice_and_shapes_their_harmonics() {
    let mut scene = truth(3, 0);
    while scene.objects.len() < 2 {
        let object = scene.objects[0].clone();
        scene.objects.push(object);
    }
    scene.objects.truncate(2);
    let shape = scene.objects[0].shape.efd().unwrap().clone();
    scene.objects[0].shape = AnyShape::of_efd(shape, Some(1));
    let spent = Spent::of(&scene, 4);
    // Background 24, two objects of 72, a choice of 2 bits for each prototype.
    assert_eq!((spent.objects, spent.numbers), (2, 3 + 2 * 7));
    assert!((spent.bits - (24.0 + 2.0 * 74.0)).abs() < 1e-9 && spent.harmonics.is_nan());
    let price = Price::of(&scene, square(128).unwrap(), 4).unwrap();
    let free = price.by(Law::Free);
    assert!((1.0..=31.0).contains(&free.harmonics), "{free:?}");
    assert!(free.bits <= price.own_bits);
}

#[test]
fn all_harmonics_that_vertices_carry_paint_the_same() {
    let (scene, size) = (truth(3, 0), square(128).unwrap());
    assert!(scene.objects[0].efd_rows().len() > 31);
    let mut written = scene.clone();
    written.objects.iter_mut().for_each(|object| *object = written_out(object, 31));
    let [a, b] = [scene, written].map(|scene| Painter::default().paint(&scene, size).unwrap());
    let most = a.data().iter().zip(b.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(most < 1e-3, "{most}");
}

#[test]
fn two_objects_of_one_shape_write_it_once() {
    let mut scene = truth(3, 0);
    let object = scene.objects[0].clone();
    scene.objects = vec![object.clone(), object];
    // The second hides the first: move it.
    scene.objects[1].pose.translation = [0.3, 0.4];
    scene.objects[0].pose.translation = [0.7, 0.6];
    let price = Price::of(&scene, square(128).unwrap(), 3).unwrap();
    let free = price.by(Law::Free);
    assert_eq!(free.shapes, 1);
    assert!((free.bits - (24.0 + 144.0 + 32.0 * free.harmonics)).abs() < 1e-9);
    assert!(price.own_bits >= free.bits + 32.0);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn a_true_scene_costs_what_it_costs(index in 0_u64..1000) {
        let scene = truth(9, index);
        let price = Price::of(&scene, square(128).unwrap(), 3).unwrap();
        let spent = Spent::of(&scene, 3);
        prop_assert!((price.by(Law::Bank).bits / spent.bits - 1.0).abs() < 1e-12);
        // The order of the objects does not matter to any law.
        let mut turned = scene;
        turned.objects.reverse();
        let other = Price::of(&turned, square(128).unwrap(), 3).unwrap();
        prop_assert!((other.by(Law::Free).bits - price.by(Law::Free).bits).abs() < 1e-6);
        prop_assert!((other.own_bits - price.own_bits).abs() < 1e-6);
        prop_assert!(price.by(Law::Free).bits <= price.own_bits + 1e-9);
    }
}

#[test]
fn paths_and_their_numbers_are_counted() {
    let svg = "<svg><path d=\"M0 0 L-1.5-2,3\" fill=\"#123456\"/><path fill=\"red\" d=\"M1e0\"/></svg>";
    let drawn = Drawn::of(svg);
    // 0, 0, -1.5, -2, 3; the exponent counts as one more.
    assert_eq!((drawn.paths, drawn.coordinates, drawn.bytes), (2, 7, svg.len()));
}

#[test]
fn segment_and_fit_spends_what_the_truth_costs() {
    let (bank, size) = (mdshr_bank(), square(128).unwrap());
    let mut nothing = SceneSettings::mds_hr();
    (nothing.fewest, nothing.most) = (0, 0);
    let scenes = [truth(1, 0), truth(1, 1), sample_scene(&nothing, &bank, size, 1, 2)];
    let subjects: Vec<Subject> = scenes
        .into_iter()
        .map(|truth| {
            let image = Painter::default().paint(&truth, size).unwrap();
            Subject::new(Picture { stem: "picture".into(), truth, image }, 3, None, 1).unwrap()
        })
        .collect();
    let contenders = Contender::methods(&bank, load_network(None).unwrap()).unwrap();
    let trials = trial::run(&contenders[..2], &subjects, 3, 1);
    for (subject, own) in subjects.iter().zip(&trials[0]) {
        let own = own.as_ref().unwrap();
        assert_eq!((own.surplus, own.missing, own.spent.objects), (0, 0, subject.picture.truth.objects.len()));
        assert!((own.spent.bits / own.truth.bits - 1.0).abs() < 1e-12);
    }
    let free = trials[1][2].as_ref().unwrap();
    assert_eq!((free.spent.objects, free.spent.bits, free.truth.bits), (0, 24.0, 24.0));
}
