//! Bench `efd`: 16 harmonics, 64 vertices, f32; an iteration of the inverse is a whole scene of 4 objects, one of the
//! forward is one contour.

use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use dvp_core::Efd;
use dvp_core::shape::OutlineBasis;

const OBJECTS: usize = 4;
const HARMONICS: usize = 16;
const VERTICES: usize = 64;

fn efd(criterion: &mut Criterion) {
    let Ok(basis) = OutlineBasis::<f32>::new(VERTICES, HARMONICS) else { return };
    let rows = [[[0.5, -0.25, 0.125, 0.0625]; HARMONICS]; OBJECTS];
    let mut outlines = [[[0.0; 2]; VERTICES]; OBJECTS];
    criterion.bench_function("efd/inverse/64x16", |bencher| {
        bencher.iter(|| {
            for (rows, outline) in black_box(&rows).iter().zip(&mut outlines) {
                basis.outline(rows, outline).ok();
            }
            black_box(&mut outlines);
        });
    });
    let contour = outlines[0];
    criterion.bench_function("efd/forward/64x16", |bencher| {
        bencher.iter(|| Efd::from_contour(black_box(&contour), HARMONICS));
    });
    let mut grad_rows = [[[0.0; 4]; HARMONICS]; OBJECTS];
    criterion.bench_function("efd/inverse_vjp/64x16", |bencher| {
        bencher.iter(|| {
            for (grad, outline) in grad_rows.iter_mut().zip(black_box(&outlines)) {
                basis.outline_vjp(outline, grad).ok();
            }
            black_box(&mut grad_rows);
        });
    });
}

criterion_group!(benches, efd);
criterion_main!(benches);
