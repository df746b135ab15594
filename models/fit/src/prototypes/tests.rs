use alloc::vec::Vec;

use dvp_core::Efd;

use super::form::Form;
use super::learn::{LearnError, PrototypeOptions, learn};
use super::medoids::{DistanceMatrix, Partition, k_medoids, silhouette};
use super::member::Member;

fn on_a_line(points: &[f64]) -> DistanceMatrix {
    DistanceMatrix::new(points.len(), |i, j| (points[i] - points[j]).abs())
}

/// An outline r(t) = 1 + depth cos(lobes t), `samples` points.
fn flower(lobes: f64, depth: f64) -> Form {
    let point = |i: usize| {
        let t = core::f64::consts::TAU * i as f64 / 400.0;
        let radius = 1.0 + depth * num_traits::Float::cos(lobes * t);
        let (sin, cos) = num_traits::Float::sin_cos(t);
        [radius * cos, radius * sin]
    };
    Form::of_polygon(&(0..400).map(point).collect::<Vec<_>>()).unwrap()
}

fn members(forms: impl IntoIterator<Item = Form>) -> Vec<Member> {
    let member = |(object, form)| Member { form, radius_px: 30.0, noise_px: 0.7, image: 0, object };
    forms.into_iter().enumerate().map(member).collect()
}

#[test]
fn medoids_and_silhouette_of_two_pairs() {
    let distances = on_a_line(&[0.0, 1.0, 10.0, 12.0]);
    let found = k_medoids(&distances, 2);
    assert_eq!(found.clusters[0], found.clusters[1]);
    assert_eq!(found.clusters[2], found.clusters[3]);
    // One within the first pair, two within the second.
    assert!((found.cost - 3.0).abs() < 1e-12);
    // a: 1, 1, 2, 2; b: 11, 10, 9.5, 11.5.
    let expected = (10.0 / 11.0 + 9.0 / 10.0 + 7.5 / 9.5 + 9.5 / 11.5) / 4.0;
    assert!((silhouette(&distances, &found).mean - expected).abs() < 1e-12);
    // One alone counts 0: (0 + two thirds of the others).
    let lonely = Partition { medoids: alloc::vec![0, 1], clusters: alloc::vec![0, 1, 1, 1], cost: 0.0 };
    assert!(silhouette(&distances, &lonely).mean < expected);
    assert!(silhouette(&distances, &k_medoids(&distances, 1)).mean.abs() < 1e-12);
    assert_eq!(k_medoids(&distances, 9).medoids.len(), 4);
}

#[test]
fn evident_symmetry_is_taken() {
    // A five-fold flower bent by a weak two-fold wave.
    let mut efd = flower(5.0, 0.3).efd(0.0);
    efd.rows_mut()[2][0] += 0.004;
    let bent = Form::new(&efd).unwrap();
    let (form, order, own_mirror) = bent.symmetrized(0.01);
    assert_eq!((order, own_mirror), (5, true));
    assert!(form.distance(&flower(5.0, 0.3), false) < 0.004);
    assert_eq!(bent.symmetrized(1e-4).1, 1);
    assert_eq!(Form::new(&Efd::new(alloc::vec![[1.0, 0.0, 0.0, 1.0]])).unwrap().symmetrized(0.01).1, 0);
}

#[test]
fn one_shape_is_one_shape() {
    // Depths scatter as noise does.
    let scatter = (0..24).map(|i| flower(3.0, 0.2 + 0.002 * f64::from(i * 7 % 24) / 24.0));
    let learned = learn(&members(scatter), &PrototypeOptions::default()).unwrap();
    assert_eq!((learned.prototypes.len(), learned.outliers.len()), (1, 0));
    assert_eq!(learned.prototypes[0].symmetry, 3);
    assert!(learned.silhouettes.iter().all(|value| value.mean < 0.5), "{:?}", learned.silhouettes);
}

#[test]
fn similar_shapes_stay_apart_and_strays_are_dropped() {
    let forms = [(3.0, 0.2), (3.0, 0.3), (4.0, 0.2), (7.0, 0.2)].map(|(lobes, depth)| flower(lobes, depth));
    let mut all: Vec<Form> = (0..20).map(|i| forms[i % 4].clone()).collect();
    all.extend([flower(2.0, 0.5), flower(5.0, 0.4)]);
    let learned = learn(&members(all), &PrototypeOptions::default()).unwrap();
    assert_eq!(learned.prototypes.len(), 4);
    assert_eq!(learned.outliers, [20, 21]);
    assert_eq!(learned.bank::<f32>().prototypes.len(), 4);
}

#[test]
fn too_little_to_learn_from_is_said() {
    let options = PrototypeOptions::default();
    assert_eq!(learn(&[], &options), Err(LearnError::TooFewMembers { len: 0, least: 3 }));
    let different = (2..8).map(|lobes| flower(f64::from(lobes), 0.3));
    assert_eq!(learn(&members(different), &options), Err(LearnError::NoShape { len: 6 }));
    let none = PrototypeOptions { max_shapes: 0, ..options };
    assert_eq!(learn(&[], &none), Err(LearnError::Zero { what: "max_shapes" }));
}
