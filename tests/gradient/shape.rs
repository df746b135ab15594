//! Gradients of the outlines of every kind of shape with respect to its numbers, alone and through scenes.

use dvp_core::shape::{AnyShape, FillRule, Flattening, Outline, OutlineBasis, Shape as _, ShapeError};
use dvp_tests::finite_difference::{compare, dot, step};
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

/// A number that depends on what an outline encloses alone, and its gradient with respect to the vertices: the integral of
/// 1 + x - 2 y + 3 x y over the inside, rings that turn from +y to +x subtracted.
fn integral(outline: &Outline<f64>) -> (f64, Vec<[f64; 2]>) {
    // By Green's theorem that of (x + x^2 / 2 - 2 x y + 3 x^2 y / 2) dy along the rings, of degree 4 along an edge: three points
    // of Gauss are exact.
    const GAUSS: [(f64, f64); 3] =
        [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
    let (mut sum, mut grad) = (0.0, vec![[0.0; 2]; outline.vertices.len()]);
    for range in outline.rings().ranges() {
        for i in range.clone() {
            let j = if i + 1 < range.end { i + 1 } else { range.start };
            let ([px, py], [qx, qy]) = (outline.vertices[i], outline.vertices[j]);
            for (t, weight) in GAUSS {
                let (x, y) = (px + t * (qx - px), py + t * (qy - py));
                let value = x + x * x / 2.0 - 2.0 * x * y + 1.5 * x * x * y;
                let (by_x, by_y) = (1.0 + x - 2.0 * y + 3.0 * x * y, -2.0 * x + 1.5 * x * x);
                let height = weight * (qy - py);
                sum += value * height;
                for (k, share, sign) in [(i, 1.0 - t, -1.0), (j, t, 1.0)] {
                    grad[k][0] += by_x * share * height;
                    grad[k][1] += by_y * share * height + sign * weight * value;
                }
            }
        }
    }
    (sum, grad)
}

/// Whether the outline is made by resolving crossings, so that the order of its vertices may change at any number.
fn is_resolved(shape: &AnyShape<f64>) -> bool {
    match shape {
        AnyShape::Path(path) => path.fill == FillRule::NonZero,
        AnyShape::Stroke(_) => true,
        _ => false,
    }
}

/// Whether differences over steps of several lengths agree. Near cusps and where a smooth arc all but turns back, vertices move
/// faster than differences can follow.
fn are_differences_steady(x: &[f64], f: &mut dyn FnMut(&[f64]) -> f64) -> bool {
    let mut moved = x.to_vec();
    (0..x.len()).all(|lane| {
        let [short, long] = [1.0, 3.0].map(|factor| {
            let step = factor * step(x[lane]);
            let [below, above] = [-step, step].map(|step| {
                moved[lane] = x[lane] + step;
                f(&moved)
            });
            moved[lane] = x[lane];
            (above - below) / (2.0 * step)
        });
        (short - long).abs() <= 1e-6 * (1.0 + short.abs())
    })
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
        let cotangent = if is_resolved { integral(&outline).1.into_flattened() } else { cotangent };
        let mut numbers = Vec::new();
        shape.numbers(&mut numbers);
        let mut grad = vec![1.0; numbers.len()];
        shape.flatten_vjp(&how, cotangent.as_chunks().0, &mut grad).unwrap();
        grad.iter_mut().for_each(|grad| *grad -= 1.0);
        let mut moved = shape.clone();
        let mut value = |x: &[f64]| {
            moved.set_numbers(x).unwrap();
            match flattened(&moved, &how) {
                Ok(outline) if is_resolved => integral(&outline).0,
                Ok(outline) => dot(outline.vertices.as_flattened(), &cotangent),
                Err(_) => f64::NAN,
            }
        };
        prop_assume!(are_differences_steady(&numbers, &mut value));
        compare(&numbers, &grad, 1e-6, value).map_err(TestCaseError::fail)?;
    }
}
