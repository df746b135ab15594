//! Gradients of the outline with respect to descriptors.

use dvp_core::Efd;
use dvp_core::shape::{EfdModel, OutlineBasis, ShapeModel};
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn outline_vjp_matches_differences(
        efd in strategy::efd(1..20),
        extra in 0_usize..4,
        cotangent in prop::collection::vec(-1.0..1.0, 2 * 4..2 * 300),
    ) {
        let grad_vertices = cotangent.as_chunks::<2>().0;
        let basis = OutlineBasis::new(grad_vertices.len(), efd.harmonic_count() + extra).unwrap();
        let mut grad = vec![[0.0; 4]; efd.harmonic_count()];
        basis.outline_vjp(grad_vertices, &mut grad).unwrap();
        let mut outline = vec![[0.0; 2]; grad_vertices.len()];
        compare(efd.rows().as_flattened(), grad.as_flattened(), 1e-8, |x| {
            basis.outline(x.as_chunks().0, &mut outline).unwrap();
            dot(outline.as_flattened(), grad_vertices.as_flattened())
        }).map_err(TestCaseError::fail)?;
        // Accumulates, and is linear in the cotangent: a second pull-back of -2 g turns the sum into its negative.
        let opposite: Vec<[f64; 2]> = grad_vertices.iter().map(|g| g.map(|g| -2.0 * g)).collect();
        let mut sum = grad.clone();
        basis.outline_vjp(&opposite, &mut sum).unwrap();
        for (sum, grad) in sum.as_flattened().iter().zip(grad.as_flattened()) {
            prop_assert!((sum + grad).abs() < 1e-10, "{sum} against {}", -grad);
        }
    }

    #[test]
    fn the_model_pulls_back_as_the_basis_does(efd in strategy::efd(1..8), cotangent in prop::collection::vec(-1.0..1.0, 48)) {
        let basis = OutlineBasis::new(24, efd.harmonic_count()).unwrap();
        let grad_vertices = cotangent.as_chunks::<2>().0;
        let mut expected = vec![[1.0; 4]; efd.harmonic_count()];
        basis.outline_vjp(grad_vertices, &mut expected).unwrap();
        let model = EfdModel::new(basis);
        let mut grad = vec![1.0; model.parameter_count()];
        model.outline_vjp(efd.rows().as_flattened(), grad_vertices, &mut grad).unwrap();
        prop_assert_eq!(&grad, expected.as_flattened());
    }

    #[test]
    fn normalize_vjp_matches_differences(efd in strategy::efd(1..12), cotangent in prop::collection::vec(-1.0..1.0, 48)) {
        // Near a circular first harmonic the derivative grows without bound, and differences with it.
        let normalized = efd.normalize().unwrap();
        prop_assume!(normalized.efd.rows()[0][3].abs() < 0.95);
        let cotangent = &cotangent[..4 * efd.harmonic_count()];
        let mut grad = vec![[0.0; 4]; efd.harmonic_count()];
        efd.normalize_vjp(cotangent.as_chunks().0, &mut grad).unwrap();
        compare(efd.rows().as_flattened(), grad.as_flattened(), 1e-6, |x| {
            dot(Efd::new(x.as_chunks().0.to_vec()).normalize().unwrap().efd.rows().as_flattened(), cotangent)
        }).map_err(TestCaseError::fail)?;
        let mut sum = grad.clone();
        efd.normalize_vjp(cotangent.as_chunks().0, &mut sum).unwrap();
        for (sum, grad) in sum.as_flattened().iter().zip(grad.as_flattened()) {
            prop_assert!((sum - 2.0 * grad).abs() < 1e-9, "accumulation: {sum} is not twice {grad}");
        }
    }
}
