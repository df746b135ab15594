//! Cost matrices: an error, or a one-to-one assignment no worse than the greedy one.
#![no_main]

use arbitrary::{Arbitrary, Result, Unstructured};
use dvp_core::matching::{CostMatrix, Hungarian};
use dvp_fuzz::{Numbers, number};
use libfuzzer_sys::fuzz_target;

#[derive(Debug)]
struct Input {
    rows: usize,
    columns: usize,
    costs: Numbers,
}

impl<'a> Arbitrary<'a> for Input {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let (rows, columns) = (u.int_in_range(0..=12)?, u.int_in_range(0..=12)?);
        let costs = (0..rows * columns).map(|_| number(u)).collect::<Result<_>>()?;
        Ok(Self { rows, columns, costs: Numbers(costs) })
    }
}

fuzz_target!(|input: Input| {
    let Input { rows, columns, costs: Numbers(costs) } = &input;
    let Ok(matrix) = CostMatrix::new(*rows, *columns, costs) else { return };
    let mut solver = Hungarian::default();
    let Ok(best) = solver.solve(matrix) else { return };
    let mut taken = vec![false; *columns];
    let (mut count, mut total) = (0, 0.0);
    for (row, column) in best.column_of.iter().enumerate() {
        let Some(column) = *column else { continue };
        assert!(!std::mem::replace(&mut taken[column], true), "column {column} twice");
        let cost = f64::from(costs[row * columns + column]);
        assert!(cost.is_finite(), "a forbidden pair");
        count += 1;
        total += cost;
    }
    assert_eq!(count, *rows.min(columns));
    // Greedy, row by row or column by column: feasible, so not better.
    let cost =
        |i: usize, j: usize| f64::from(if rows <= columns { costs[i * columns + j] } else { costs[j * columns + i] });
    let mut free = vec![true; *rows.max(columns)];
    let mut greedy = 0.0;
    for i in 0..count {
        let choice = (0..free.len()).filter(|&j| free[j]).min_by(|&a, &b| cost(i, a).total_cmp(&cost(i, b)));
        let j = choice.expect("as many partners as rows");
        free[j] = false;
        greedy += cost(i, j);
    }
    // Potentials round in steps of the largest cost of the matrix, whichever entries are chosen.
    let largest =
        costs.iter().filter(|cost| cost.is_finite()).fold(0.0, |most: f64, &cost| most.max(f64::from(cost).abs()));
    let rounding = 1e-5 * largest * f64::from(u32::try_from(count).expect("at most 12"));
    assert!(total <= greedy + rounding || greedy.is_infinite(), "{total} against {greedy}");
});
