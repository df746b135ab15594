use alloc::vec;

use super::{CostMatrix, Hungarian, MatchingCost, MatchingError};
use crate::scene::{Object, Pose};
use crate::shape::Efd;

const INF: f64 = f64::INFINITY;

#[test]
fn takes_the_second_choice_where_it_pays() {
    // Row 0 prefers column 0 by 1, row 1 by 4: 2 + 1 = 3 beats 1 + 5 = 6.
    let mut solver = Hungarian::default();
    let best = solver.solve(CostMatrix::new(2, 2, &[1.0, 2.0, 1.0, 5.0]).unwrap()).unwrap();
    assert_eq!(best.column_of, [Some(1), Some(0)]);
    assert!((best.total - 3.0_f64).abs() < 1e-12);
}

#[test]
fn spare_rows_stay_free() {
    let mut solver = Hungarian::default();
    let best = solver.solve(CostMatrix::new(3, 1, &[3.0, 1.0, 2.0]).unwrap()).unwrap();
    assert_eq!(best.column_of, [None, Some(0), None]);
    assert!((best.total - 1.0_f64).abs() < 1e-12);
}

#[test]
fn an_empty_side_costs_nothing() {
    let mut solver = Hungarian::<f64>::default();
    assert_eq!(solver.solve(CostMatrix::new(0, 4, &[]).unwrap()).unwrap().column_of, []);
    assert_eq!(solver.solve(CostMatrix::new(2, 0, &[]).unwrap()).unwrap().column_of, [None, None]);
}

#[test]
fn forbidden_pairs_are_avoided_or_reported() {
    let mut solver = Hungarian::default();
    let best = solver.solve(CostMatrix::new(2, 2, &[0.0, 9.0, 0.0, INF]).unwrap()).unwrap();
    assert_eq!(best.column_of, [Some(1), Some(0)]);
    let outcome = solver.solve(CostMatrix::new(2, 3, &[0.0, INF, INF, 1.0, INF, INF]).unwrap()).cloned();
    assert_eq!(outcome, Err(MatchingError::Infeasible { index: 1 }));
    // The solver is whole after a refusal.
    let best = solver.solve(CostMatrix::new(2, 3, &[0.0, INF, INF, 1.0, INF, 7.0]).unwrap()).unwrap();
    assert_eq!(best.column_of, [Some(0), Some(2)]);
}

#[test]
fn bad_numbers_are_named_by_position() {
    let not_a_number = CostMatrix::new(2, 3, &[0.0, 0.0, 0.0, 0.0, f64::NAN, 0.0]).unwrap_err();
    assert_eq!(not_a_number, MatchingError::NotANumber { row: 1, column: 1 });
    let minus = CostMatrix::new(1, 2, &[0.0, -INF]).unwrap_err();
    assert_eq!(minus, MatchingError::TooLarge { row: 0, column: 1, value: -INF });
    let large = CostMatrix::new(1, 1, &[1e30_f32]).unwrap_err();
    assert!(matches!(large, MatchingError::TooLarge { row: 0, column: 0, .. }));
    let short = CostMatrix::new(2, 2, &[0.0_f64; 3]).unwrap_err();
    assert_eq!(short, MatchingError::Length { rows: 2, columns: 2, len: 3 });
}

#[test]
fn object_cost_follows_the_formula() {
    let pose = |translation| Pose { translation, scale: 1.0, rotation: 0.0 };
    let object =
        |translation, color, confidence| Object::of_efd(pose(translation), color, confidence, Efd::default(), None);
    let a = [object([0.0, 0.0], [0.0, 0.0, 0.0], 1.0)];
    let b = [object([0.3, 0.4], [0.2, 0.1, 0.2], 0.5), object([0.0, 0.0], [0.0, 0.0, 0.0], 1.0)];
    let mut costs = vec![];
    // 1 * 0.5 + 0.1 * 0.3 + 0.05 * 0.5 = 0.555; printed: 0.5 + 0.03 + 0.005 = 0.535.
    MatchingCost::reference().fill(&a, &b, &mut costs);
    assert!((costs[0] - 0.555_f64).abs() < 1e-12 && costs[1].abs() < 1e-12);
    MatchingCost::printed().fill(&a, &b, &mut costs);
    assert!((costs[0] - 0.535_f64).abs() < 1e-12);
}
