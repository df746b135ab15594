//! The assignment solver against the crates `pathfinding` and `lapjv`, on square matrices of uniform random costs.
//!
//! `cargo bench -p dvp-tests --bench hungarian`; ids `hungarian/{ours,pathfinding,lapjv}/{4,8,32,128}`. Each sample goes
//! over the same matrices. `pathfinding` needs an order, so it gets the costs as integers (of a billion); `lapjv` and
//! ours get f64. Nobody is charged for making the matrix; ours is charged for checking it.

#![expect(clippy::unwrap_used, reason = "a bench that cannot build its problem should stop")]

use core::hint::black_box;

use criterion::{BenchmarkId, Criterion};
use dvp_core::matching::{CostMatrix, Hungarian};
use pathfinding::prelude::{Matrix, kuhn_munkres_min};
use rand::{RngExt, SeedableRng};

const PROBLEMS: usize = 16;

fn hungarian(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("hungarian");
    for side in [4_usize, 8, 32, 128] {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let problems: Vec<Vec<f64>> =
            (0..PROBLEMS).map(|_| (0..side * side).map(|_| rng.random::<f64>()).collect()).collect();
        #[expect(clippy::cast_possible_truncation, reason = "below a billion")]
        let whole: Vec<Matrix<i64>> = problems
            .iter()
            .map(|costs| Matrix::from_vec(side, side, costs.iter().map(|v| (v * 1e9) as i64).collect()).unwrap())
            .collect();
        let arrays: Vec<lapjv::Matrix<f64>> =
            problems.iter().map(|costs| lapjv::Matrix::from_shape_vec((side, side), costs.clone()).unwrap()).collect();

        group.bench_function(BenchmarkId::new("ours", side), |bencher| {
            let mut solver = Hungarian::default();
            bencher.iter(|| {
                for costs in &problems {
                    let matrix = CostMatrix::new(side, side, black_box(costs)).unwrap();
                    black_box(solver.solve(matrix).unwrap());
                }
            });
        });
        group.bench_function(BenchmarkId::new("pathfinding", side), |bencher| {
            bencher.iter(|| whole.iter().for_each(|costs| drop(black_box(kuhn_munkres_min(black_box(costs))))));
        });
        group.bench_function(BenchmarkId::new("lapjv", side), |bencher| {
            bencher.iter(|| arrays.iter().for_each(|costs| drop(black_box(lapjv::lapjv(black_box(costs)).unwrap()))));
        });
    }
    group.finish();
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    hungarian(&mut criterion);
    criterion.final_summary();
}
