//! Gradients of exact coverage.

use dvp_core::ImageSize;
use dvp_core::render::ExactArea;
use dvp_tests::coverage::{coverage, coverage_vjp};
use dvp_tests::finite_difference::{self, compare_by, dot};
use dvp_tests::strategy;
use proptest::prelude::*;

fn size() -> ImageSize {
    ImageSize::new(24, 20).unwrap()
}

/// The vjp against central differences in every coordinate.
fn check(outline: &[[f64; 2]], cotangent: &[f64]) -> Result<(), TestCaseError> {
    let grad = coverage_vjp(ExactArea, outline, size(), cotangent).unwrap();
    // The second derivative jumps where an edge crosses a corner of a pixel, by up to about a thousand for a short edge: steps of 1e-7
    // leave 1e-4 / 4 of that, and less than 1e-6 of rounding.
    let step = |x: f64| 0.1 * finite_difference::step(x);
    compare_by(step, outline.as_flattened(), grad.as_flattened(), 1e-4, |x| {
        dot(&coverage(ExactArea, x.as_chunks().0, size()).unwrap(), cotangent)
    })
    .map_err(TestCaseError::fail)
}

fn cotangent() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0..1.0, 480)
}

proptest! {
    #[test]
    fn vjp_matches_differences(star in strategy::star_px(), cotangent in cotangent()) {
        check(&star, &cotangent)?;
    }

    #[test]
    fn vjp_matches_differences_where_the_image_ends(
        star in strategy::star_px(),
        shift in prop::array::uniform2(-14.0..14.0),
        reversed in any::<bool>(),
        cotangent in cotangent(),
    ) {
        let mut moved: Vec<_> = star.iter().map(|v| [v[0] + shift[0], v[1] + shift[1]]).collect();
        if reversed {
            moved.reverse();
        }
        check(&moved, &cotangent)?;
    }

    #[test]
    fn area_gradient_is_that_of_the_polygon(star in strategy::star_px()) {
        // The star fits an image of 24 x 24: with a cotangent of 1, sum(coverage) is the polygon's area, whose derivative
        // by vertex k is half the normal to the chord of its neighbors.
        let size = ImageSize::new(24, 24).unwrap();
        let grad = coverage_vjp(ExactArea, &star, size, &[1.0; 576]).unwrap();
        let count = star.len();
        for (k, found) in grad.iter().enumerate() {
            let (before, after) = (star[(k + count - 1) % count], star[(k + 1) % count]);
            let expected = [(after[1] - before[1]) / 2.0, (before[0] - after[0]) / 2.0];
            for axis in 0..2 {
                prop_assert!((found[axis] - expected[axis]).abs() < 1e-10, "vertex {k}: {found:?}, not {expected:?}");
            }
        }
    }

    #[test]
    fn wild_outlines_have_finite_gradients(outline in strategy::wild_outline(), cotangent in cotangent()) {
        let grad = coverage_vjp(ExactArea, &outline, size(), &cotangent).unwrap();
        prop_assert!(grad.as_flattened().iter().all(|g| g.is_finite()));
    }
}
