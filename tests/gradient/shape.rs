//! Gradients of the outlines of every kind of shape with respect to its numbers.

use dvp_core::shape::{AnyShape, Flattening, Outline, OutlineBasis, Shape as _, ShapeError};
use dvp_tests::finite_difference::{are_steady, compare, dot, step};
use dvp_tests::inside_integral::{integral, is_resolved};
use dvp_tests::shape_strategy;
use proptest::prelude::*;

/// The numbers of a shape, and each of them moved by a step of the differences to either side.
fn moved(shape: &AnyShape<f64>) -> impl Iterator<Item = AnyShape<f64>> {
    let mut numbers = Vec::new();
    shape.numbers(&mut numbers);
    let shape = shape.clone();
    (0..numbers.len()).flat_map(|lane| [-1.0, 1.0].map(|sign| (lane, sign))).map(move |(lane, sign)| {
        let (mut shape, mut numbers) = (shape.clone(), numbers.clone());
        numbers[lane] += sign * step(numbers[lane]);
        shape.set_numbers(&numbers).unwrap();
        shape
    })
}

fn flattened(shape: &AnyShape<f64>, how: &Flattening<'_, f64>) -> Result<Outline<f64>, ShapeError> {
    let mut outline = Outline::default();
    shape.flatten(how, &mut outline).map(|()| outline)
}

/// Whether differences may be taken: the numbers of vertices are constant, to the gradient.
fn same_layout(shape: &AnyShape<f64>, how: &Flattening<'_, f64>) -> bool {
    let layout = |shape: &AnyShape<f64>| flattened(shape, how).map(|outline| (outline.vertices.len(), outline.breaks));
    let own = layout(shape);
    own.is_ok() && moved(shape).all(|moved| layout(&moved) == own)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, max_global_rejects: 4096, ..ProptestConfig::default() })]

    #[test]
    fn flatten_vjp_matches_differences(
        shape in shape_strategy::shape(),
        tolerance in prop_oneof![Just(1e-1), Just(1e-2), Just(1e-4)],
        cotangent in prop::collection::vec(-1.0..1.0, 1009),
    ) {
        let basis = OutlineBasis::new(32, 8).unwrap();
        let how = Flattening::new(&basis, tolerance);
        prop_assume!(same_layout(&shape, &how));
        let outline = flattened(&shape, &how).unwrap();
        let cotangent: Vec<f64> = cotangent.into_iter().cycle().take(2 * outline.vertices.len()).collect();
        let is_resolved = is_resolved(&shape);
        let cotangent = if is_resolved { integral(outline.rings()).1.into_flattened() } else { cotangent };
        let mut numbers = Vec::new();
        shape.numbers(&mut numbers);
        let mut grad = vec![1.0; numbers.len()];
        shape.flatten_vjp(&how, cotangent.as_chunks().0, &mut grad).unwrap();
        grad.iter_mut().for_each(|grad| *grad -= 1.0);
        let mut moved = shape.clone();
        let mut value = |x: &[f64]| {
            moved.set_numbers(x).unwrap();
            match flattened(&moved, &how) {
                Ok(outline) if is_resolved => integral(outline.rings()).0,
                Ok(outline) => dot(outline.vertices.as_flattened(), &cotangent),
                Err(_) => f64::NAN,
            }
        };
        prop_assume!(are_steady(&numbers, &mut value));
        compare(&numbers, &grad, 1e-6, value).map_err(TestCaseError::fail)?;
    }
}
