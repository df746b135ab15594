//! L_p: terms, totals and gradients of the reference implementation (single precision).

use alloc::collections::BTreeMap;

use dvp_core::loss::{Loss, RotationTerm, SceneLoss, ScenePairs, SceneTerms};
use dvp_core::scene::rotation_from_pair_vjp;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Scene, SceneGrad};

use super::scene_pairs::{self, PairRecord};

/// The reference's form of the rotation term is not the default.
fn reference() -> SceneLoss<f64> {
    let mut loss = SceneLoss::reference(REFERENCE_VERTICES, 64).unwrap();
    loss.rotation = RotationTerm::EveryOrder;
    loss
}

/// Single precision: 2e-5 of the value; 1e-7 for differences of numbers near 1 that are squared or turned into cosines.
fn close(ours: f64, theirs: f64) -> bool {
    (ours - theirs).abs() <= 2e-5 * theirs.abs() + 1e-7
}

fn assert_terms(name: &str, ours: &SceneTerms<f64>, theirs: &BTreeMap<String, f64>, total: f64) {
    let table = [
        ("con", ours.confidence),
        ("t", ours.translation),
        ("s", ours.scale),
        ("r", ours.rotation),
        ("c", ours.color),
        ("e", ours.shape),
        ("b", ours.background),
    ];
    for (term, value) in table {
        assert!(close(value, theirs[term]), "{name}, {term}: {value:e}, reference {:e}", theirs[term]);
    }
    assert!(close(ours.sum(), total), "{name}: {}, reference {total}", ours.sum());
}

#[test]
fn terms_of_single_pairs() {
    let (loss, mut scratch, mut checked) = (reference(), Default::default(), 0);
    for (index, pair) in scene_pairs::all().iter().flat_map(|file| file.pairs.iter().enumerate()) {
        let (truth, prediction) = ([pair.truth.scene()], [pair.pred.scene()]);
        let terms = loss.terms(ScenePairs::new(&prediction, &truth).unwrap(), &mut scratch).unwrap();
        assert_terms(&format!("pair {index}"), &terms, &pair.terms, pair.total);
        checked += 1;
    }
    assert!(checked >= 3);
}

/// In a batch, scenes are grouped by their number of objects; the rotation term mixes the orders of a group.
#[test]
fn terms_of_batches() {
    let (loss, mut scratch) = (reference(), Default::default());
    for file in scene_pairs::all() {
        for (name, batch) in &file.batch_values {
            let range = match name.as_str() {
                "first32_4obj" => 0..32,
                "next16_8obj" => 32..48,
                "last16_8obj" => 48..64,
                other => panic!("a batch named {other}"),
            };
            let scenes = |get: fn(&PairRecord) -> Scene<f64>| file.pairs[range.clone()].iter().map(get).collect();
            let truths: Vec<_> = scenes(|pair| pair.truth.scene());
            let predictions: Vec<_> = scenes(|pair| pair.pred.scene());
            let terms = loss.terms(ScenePairs::new(&predictions, &truths).unwrap(), &mut scratch).unwrap();
            assert_terms(name, &terms, &batch.terms, batch.total);
        }
    }
}

#[test]
fn gradients_of_single_pairs() {
    let (loss, mut scratch) = (reference(), Default::default());
    for (index, pair) in scene_pairs::all().iter().flat_map(|file| file.pairs.iter().enumerate()) {
        let (truth, prediction) = ([pair.truth.scene()], [pair.pred.scene()]);
        let mut grads = [SceneGrad::default()];
        grads[0].reset(&prediction[0]);
        loss.vjp(ScenePairs::new(&prediction, &truth).unwrap(), 1.0, &mut scratch, &mut grads).unwrap();
        let check = |what: &str, ours: &[f64], theirs: &[f64]| {
            assert_eq!(ours.len(), theirs.len());
            // Relative to the largest entry: small ones are differences of large ones.
            let largest = theirs.iter().fold(0.0_f64, |largest, v| largest.max(v.abs()));
            for (lane, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
                let far = (ours - theirs).abs() > 1e-4 * largest + 1e-7;
                assert!(!far, "pair {index}, {what}, lane {lane}: {ours:e}, reference {theirs:e}");
            }
        };
        check("background", &grads[0].background, &pair.grad.b);
        for (k, grad) in grads[0].objects.iter().enumerate() {
            check("translation", &grad.translation, &pair.grad.t[k]);
            check("scale", &[grad.scale], &[pair.grad.s[k].iter().sum()]);
            check("color", &grad.color, &pair.grad.c[k]);
            check("confidence", &[grad.confidence], &pair.grad.f[k]);
            let mut rotation = [0.0; 2];
            rotation_from_pair_vjp(pair.pred.objects[k].rotation_vec, grad.rotation, &mut rotation);
            check("rotation", &rotation, &pair.grad.r[k]);
            check("efd", &grad.numbers, pair.grad.e[k].as_flattened());
        }
    }
}

/// Where all objects of a scene have one order, the reference's rotation term is the documented one.
#[test]
fn forms_of_the_rotation_term_agree_on_equal_orders() {
    let (mut scratch, mut checked) = (Default::default(), 0);
    for pair in scene_pairs::all().iter().flat_map(|file| &file.pairs).filter(|pair| pair.n_true == 1) {
        let (truth, prediction) = ([pair.truth.scene()], [pair.pred.scene()]);
        let loss = SceneLoss::reference(REFERENCE_VERTICES, 64).unwrap();
        let terms = loss.terms(ScenePairs::new(&prediction, &truth).unwrap(), &mut scratch).unwrap();
        assert!(close(terms.rotation, pair.terms["r"]));
        checked += 1;
    }
    // The committed pairs have several objects each.
    assert!(checked == 0 || checked == 16);
}
