//! Gradients of soft triangles.

use dvp_core::ImageSize;
use dvp_core::render::{EdgeProfile, SoftTriangles};
use dvp_tests::coverage::{coverage, coverage_vjp};
use dvp_tests::finite_difference::{compare, dot};
use dvp_tests::strategy;
use proptest::prelude::*;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

fn size() -> ImageSize {
    ImageSize::new(24, 20).unwrap()
}

/// Half coverage 1.4 px outside, soft over about 1 px, and cut where coverage is 4e-18, too little for a jump to show.
fn squared() -> SoftTriangles<f64> {
    // A doubled unit is 10 px.
    SoftTriangles {
        edge: EdgeProfile { offset: 0.02, sigma: 0.004, cut: 0.18, ..EdgeProfile::reference() },
        ..SoftTriangles::default()
    }
}

/// Half coverage 2 px outside, so that seams, where the nearest triangle jumps, are all but covered; soft over 2 px.
fn plain() -> SoftTriangles<f64> {
    SoftTriangles {
        edge: EdgeProfile { offset: 0.2, cut: 2.0, ..EdgeProfile::distance(0.04) },
        ..SoftTriangles::default()
    }
}

/// Fixed cases: coverage has kinks where two edges are equally near, and a random case within 1e-6 of one would
/// fail for no fault.
fn runner(cases: u32) -> TestRunner {
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha))
}

#[test]
fn vjp_matches_differences() {
    let shift = prop::array::uniform2(-9.0..9.0);
    let cotangent = prop::collection::vec(-1.0..1.0, 480);
    let models = prop_oneof![Just(squared()), Just(plain())];
    let outcome =
        runner(48).run(&(models, strategy::star_px(), shift, cotangent), |(model, star, shift, cotangent)| {
            let outline: Vec<_> = star.iter().map(|v| [v[0] + shift[0], v[1] + shift[1]]).collect();
            let grad = coverage_vjp(model, &outline, size(), &cotangent).unwrap();
            compare(outline.as_flattened(), grad.as_flattened(), 1e-5, |x| {
                dot(&coverage(model, x.as_chunks().0, size()).unwrap(), &cotangent)
            })
            .map_err(TestCaseError::fail)
        });
    outcome.unwrap();
}

proptest! {
    #[test]
    fn wild_outlines_have_finite_gradients(
        outline in strategy::wild_outline(),
        cotangent in prop::collection::vec(-1.0..1.0, 480),
    ) {
        for model in [squared(), plain()] {
            let grad = coverage_vjp(model, &outline, size(), &cotangent).unwrap();
            prop_assert!(grad.as_flattened().iter().all(|g| g.is_finite()));
        }
    }
}
