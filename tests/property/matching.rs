//! The assignment solver against brute force, against a second implementation, and under changes that must not matter.

#![expect(clippy::float_cmp, reason = "the costs are whole numbers, so their sums are exact")]

use dvp_core::matching::{Assignment, CostMatrix, Hungarian};
use pathfinding::prelude::{Matrix, kuhn_munkres_min};
use proptest::prelude::*;

/// Rows, columns and whole costs: sums of whole numbers are exact, so totals can be compared for equality. The narrow
/// range makes ties common.
fn whole(limit: usize) -> impl Strategy<Value = (usize, usize, Vec<f64>)> {
    (1..=limit, 1..=limit, prop_oneof![Just(3_i32), Just(20), Just(1_000_000)]).prop_flat_map(|(r, c, range)| {
        (Just(r), Just(c), prop::collection::vec((-range..=range).prop_map(f64::from), r * c))
    })
}

fn solve(rows: usize, columns: usize, costs: &[f64]) -> Assignment<f64> {
    Hungarian::default().solve(CostMatrix::new(rows, columns, costs).unwrap()).unwrap().clone()
}

/// The least total over all ways to serve the rows from `row` on with the columns not in `taken`.
fn brute_force(rows: usize, columns: usize, cost: &dyn Fn(usize, usize) -> f64, row: usize, taken: u32) -> f64 {
    if row == rows {
        return 0.0;
    }
    (0..columns)
        .filter(|c| taken & (1 << c) == 0)
        .map(|c| cost(row, c) + brute_force(rows, columns, cost, row + 1, taken | 1 << c))
        .fold(f64::INFINITY, f64::min)
}

fn transposed(rows: usize, columns: usize, costs: &[f64]) -> Vec<f64> {
    (0..columns).flat_map(|c| (0..rows).map(move |r| costs[r * columns + c])).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn equals_brute_force((rows, columns, costs) in whole(7)) {
        let best = solve(rows, columns, &costs);
        let least = if rows <= columns {
            brute_force(rows, columns, &|r, c| costs[r * columns + c], 0, 0)
        } else {
            brute_force(columns, rows, &|c, r| costs[r * columns + c], 0, 0)
        };
        prop_assert_eq!(best.total, least);
        let mut used: Vec<usize> = best.column_of.iter().flatten().copied().collect();
        prop_assert_eq!(used.len(), rows.min(columns));
        used.sort_unstable();
        used.dedup();
        prop_assert_eq!(used.len(), rows.min(columns), "a column was given twice");
        let sum: f64 = best.column_of.iter().enumerate().filter_map(|(r, c)| Some(costs[r * columns + (*c)?])).sum();
        prop_assert_eq!(sum, best.total);
    }

    #[test]
    fn equals_brute_force_with_forbidden_pairs(
        (rows, columns, mut costs) in whole(6),
        holes in prop::collection::vec(any::<bool>(), 36),
    ) {
        for (cost, _) in costs.iter_mut().zip(&holes).filter(|(_, hole)| **hole) {
            *cost = f64::INFINITY;
        }
        let (a, b, wide) =
            if rows <= columns { (rows, columns, costs.clone()) } else { (columns, rows, transposed(rows, columns, &costs)) };
        let least = brute_force(a, b, &|r, c| wide[r * b + c], 0, 0);
        let mut solver = Hungarian::default();
        match solver.solve(CostMatrix::new(rows, columns, &costs).unwrap()) {
            Ok(best) => prop_assert_eq!(best.total, least),
            Err(_) => prop_assert_eq!(least, f64::INFINITY),
        }
    }

    #[test]
    fn agrees_with_a_second_implementation((rows, columns, costs) in whole(40)) {
        let (a, b, wide) =
            if rows <= columns { (rows, columns, costs.clone()) } else { (columns, rows, transposed(rows, columns, &costs)) };
        #[expect(clippy::cast_possible_truncation, reason = "the costs are whole numbers below a million")]
        let whole = Matrix::from_vec(a, b, wide.iter().map(|&v| v as i64).collect()).unwrap();
        #[expect(clippy::cast_precision_loss, reason = "at most 40 million")]
        let theirs = kuhn_munkres_min(&whole).0 as f64;
        prop_assert_eq!(solve(rows, columns, &costs).total, theirs);
    }

    #[test]
    fn a_constant_on_a_line_keeps_the_optimum(
        (side, seed) in (1..12_usize).prop_flat_map(|n| (Just(n), prop::collection::vec(-50..50_i32, n * n))),
        shift in -100..100_i32,
        line in 0..12_usize,
    ) {
        let costs: Vec<f64> = seed.iter().map(|&v| f64::from(v)).collect();
        let (line, shift) = (line % side, f64::from(shift));
        let before = solve(side, side, &costs).total;
        let mut row = costs.clone();
        row[line * side..][..side].iter_mut().for_each(|v| *v += shift);
        let mut column = costs;
        column.iter_mut().skip(line).step_by(side).for_each(|v| *v += shift);
        prop_assert_eq!(solve(side, side, &row).total, before + shift);
        prop_assert_eq!(solve(side, side, &column).total, before + shift);
    }

    /// With real-valued costs the best assignment is unique, so the answer itself must follow.
    #[test]
    fn permuting_rows_permutes_the_answer(
        (rows, columns, costs, order) in (1..9_usize, 1..9_usize).prop_flat_map(|(r, c)| (
            Just(r),
            Just(c),
            prop::collection::vec(0.0..1.0_f64, r * c),
            Just((0..r).collect::<Vec<_>>()).prop_shuffle(),
        )),
    ) {
        let before = solve(rows, columns, &costs);
        let permuted: Vec<f64> = order.iter().flat_map(|&r| costs[r * columns..][..columns].to_vec()).collect();
        let after = solve(rows, columns, &permuted);
        let expected: Vec<_> = order.iter().map(|&r| before.column_of[r]).collect();
        prop_assert_eq!(after.column_of, expected);
    }

    #[test]
    fn rectangular_equals_a_padded_square((rows, columns, costs) in whole(12)) {
        let side = rows.max(columns);
        let mut square = vec![0.0; side * side];
        for r in 0..rows {
            square[r * side..][..columns].copy_from_slice(&costs[r * columns..][..columns]);
        }
        prop_assert_eq!(solve(rows, columns, &costs).total, solve(side, side, &square).total);
    }

    #[test]
    fn transposing_keeps_the_total((rows, columns, costs) in whole(12)) {
        prop_assert_eq!(
            solve(rows, columns, &costs).total,
            solve(columns, rows, &transposed(rows, columns, &costs)).total
        );
    }

    #[test]
    fn a_used_solver_answers_as_a_fresh_one(problems in prop::collection::vec(whole(9), 2..6)) {
        let mut solver = Hungarian::default();
        for (rows, columns, costs) in problems {
            let matrix = CostMatrix::new(rows, columns, &costs).unwrap();
            prop_assert_eq!(solver.solve(matrix).unwrap(), &solve(rows, columns, &costs));
        }
    }
}
