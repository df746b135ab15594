//! Gradients of the outlines of every shape model with respect to its parameters.

use dvp_core::shape::{EfdModel, OutlineBasis, PrototypeBank, PrototypeModel, ShapeModel, mdshr_bank};
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;

/// The vjp of `model` at parameters from `numbers` against differences; it adds to what is there.
fn check(model: &dyn ShapeModel<f64>, numbers: &[f64]) -> Result<(), String> {
    let mut numbers = numbers.iter().copied().cycle();
    let parameters: Vec<f64> = numbers.by_ref().take(model.parameter_count()).collect();
    let cotangent: Vec<f64> = numbers.take(2 * model.vertex_count()).collect();
    let mut grad = vec![1.0; parameters.len()];
    model.outline_vjp(&parameters, cotangent.as_chunks().0, &mut grad).map_err(|error| error.to_string())?;
    let grad: Vec<f64> = grad.iter().map(|grad| grad - 1.0).collect();
    let mut outline = vec![[0.0; 2]; model.vertex_count()];
    compare(&parameters, &grad, 1e-8, |x| match model.outline(x, &mut outline) {
        Ok(()) => dot(outline.as_flattened(), &cotangent),
        Err(_) => f64::NAN,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn models_match_differences(
        numbers in prop::collection::vec(-1.0..1.0, 101),
        vertex_count in 4_usize..40,
        parts in 1_usize..6,
        efd in strategy::efd(1..6),
    ) {
        let basis = OutlineBasis::new(vertex_count, 6).unwrap();
        let bank = PrototypeBank::new(vec![efd; parts]);
        check(&PrototypeModel::new(&bank, &basis).unwrap(), &numbers).map_err(TestCaseError::fail)?;
        check(&PrototypeModel::new(&mdshr_bank(6), &basis).unwrap(), &numbers).map_err(TestCaseError::fail)?;
        check(&EfdModel::new(basis), &numbers).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn weights_through_mixture_and_normal_form(
        first in strategy::efd(8..9),
        second in strategy::efd(3..8),
        weights in prop::array::uniform2(0.1..1.0),
        cotangent in prop::collection::vec(-1.0..1.0, 32),
    ) {
        // What the reference system does with its softmax weights.
        let bank = PrototypeBank::new(vec![first, second]);
        let mix = |weights: &[f64]| {
            let mut mixed = dvp_core::Efd::zeros(8);
            bank.mix(weights, mixed.rows_mut()).unwrap();
            mixed
        };
        let mixed = mix(&weights);
        prop_assume!(mixed.normalize().unwrap().efd.rows()[0][3].abs() < 0.95);
        let mut grad_rows = [[0.0; 4]; 8];
        mixed.normalize_vjp(cotangent.as_chunks().0, &mut grad_rows).unwrap();
        let mut grad = [0.0; 2];
        bank.mix_vjp(&grad_rows, &mut grad).unwrap();
        compare(&weights, &grad, 1e-6, |x| {
            dot(mix(x).normalize().unwrap().efd.rows().as_flattened(), &cotangent)
        }).map_err(TestCaseError::fail)?;
    }
}
