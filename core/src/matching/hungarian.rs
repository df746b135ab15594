//! The linear assignment problem by shortest augmenting paths with column potentials, O(n^3).
//!
//! Rows first bid for columns (Jonker and Volgenant's augmenting row reduction), which assigns most of them; each row
//! left then gets a shortest path in reduced costs. A potential v is kept per column, those of the rows follow from it.
//! The rectangular case needs no padding: v is 0 on columns that were never assigned and falls below 0 only on assigned
//! ones, which is the optimality condition when columns may stay free.
//!
//! *Source*: R. Jonker and A. Volgenant, A shortest augmenting path algorithm for dense and sparse linear assignment
//! problems, Computing 38 (1987). Differences: no column reduction (it is not valid with spare columns), rounds of bids
//! are counted so that ties between rounded numbers cannot go round in circles, and the inner loops have no branches.

use alloc::vec::Vec;

use super::{CostMatrix, MatchingError};
use crate::real::Real;

/// Marks a row or column without a partner.
const FREE: usize = usize::MAX;
/// Bids per row before the exact search takes over; Jonker and Volgenant use two rounds.
const BIDS_PER_ROW: usize = 3;

/// Rows and the columns they got.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assignment<T> {
    /// Per row its column; `None` only if there are more rows than columns.
    pub column_of: Vec<Option<usize>>,
    /// Sum of the costs of the assigned pairs.
    pub total: T,
}

/// The solver, with memory that is kept between calls: nothing is allocated after the first call of a size.
///
/// # Examples
/// ```
/// use dvp_core::matching::{CostMatrix, Hungarian};
///
/// let mut solver = Hungarian::default();
/// let best = solver.solve(CostMatrix::new(2, 3, &[4.0, 1.0, 3.0, 2.0, 0.0, 5.0])?)?;
/// assert_eq!(best.column_of, [Some(1), Some(0)]);
/// assert_eq!(best.total, 3.0);
/// # Ok::<(), dvp_core::matching::MatchingError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Hungarian<T> {
    /// The transposed costs, if there are more rows than columns.
    transposed: Vec<T>,
    /// Potential per column.
    price: Vec<T>,
    /// Potential per column, -infinity where the search has been: such columns come out at distance +infinity.
    price_of_open: Vec<T>,
    /// Reduced path length per column found so far, +infinity where the search has been.
    open: Vec<T>,
    /// Reduced path length per visited column, in the order of the visits.
    visited: Vec<(usize, T)>,
    /// The row from which each column is reached.
    reached_from: Vec<usize>,
    row_of: Vec<usize>,
    column_of: Vec<usize>,
    waiting: Vec<usize>,
    assignment: Assignment<T>,
}

impl<T: Real> Hungarian<T> {
    /// The assignment of least total cost that gives a partner to every row, or to every column if there are fewer
    /// columns. Among equally good ones, which is found is not specified, but it depends on the costs alone.
    ///
    /// # Errors
    /// [`MatchingError::Infeasible`] if forbidden pairs (+infinity) leave no such assignment.
    #[inline(never)]
    pub fn solve(&mut self, costs: CostMatrix<'_, T>) -> Result<&Assignment<T>, MatchingError> {
        let (rows, columns) = (costs.rows(), costs.columns());
        self.assignment.column_of.clear();
        self.assignment.column_of.resize(rows, None);
        self.assignment.total = T::zero();
        if rows <= columns {
            self.solve_wide(costs.values(), rows, columns)?;
            for (slot, &column) in self.assignment.column_of.iter_mut().zip(&self.column_of) {
                *slot = Some(column);
            }
        } else {
            let mut transposed = core::mem::take(&mut self.transposed);
            transposed.clear();
            transposed.extend((0..columns).flat_map(|c| (0..rows).map(move |r| costs.values()[r * columns + c])));
            let outcome = self.solve_wide(&transposed, columns, rows);
            self.transposed = transposed;
            outcome?;
            for (column, &row) in self.column_of.iter().enumerate() {
                self.assignment.column_of[row] = Some(column);
            }
        }
        for (row, column) in self.assignment.column_of.iter().enumerate() {
            if let Some(column) = column {
                self.assignment.total += costs.values()[row * columns + column];
            }
        }
        Ok(&self.assignment)
    }

    /// Fills `column_of` for a matrix with `rows <= columns`.
    fn solve_wide(&mut self, costs: &[T], rows: usize, columns: usize) -> Result<(), MatchingError> {
        for (vec, len) in [(&mut self.row_of, columns), (&mut self.column_of, rows), (&mut self.reached_from, columns)]
        {
            vec.clear();
            vec.resize(len, FREE);
        }
        for vec in [&mut self.price, &mut self.open] {
            vec.clear();
            vec.resize(columns, T::zero());
        }
        self.visited.clear();
        self.visited.reserve(columns);
        self.waiting.clear();
        if rows == 0 {
            return Ok(());
        }
        self.bid(costs, rows, columns);
        self.price_of_open.clone_from(&self.price);
        for row in 0..rows {
            if self.column_of[row] == FREE {
                self.augment(costs, columns, row)?;
            }
        }
        Ok(())
    }

    /// Rows take their cheapest column and lower its potential to the level of their second choice; a row that loses
    /// its column bids again at once.
    fn bid(&mut self, costs: &[T], rows: usize, columns: usize) {
        let mut left = BIDS_PER_ROW * rows;
        for first in 0..rows {
            let mut row = first;
            while left > 0 {
                left -= 1;
                let (column, best, second) = two_smallest(&costs[row * columns..][..columns], &self.price);
                let loser = self.row_of[column];
                // Without a lower potential, taking the column would only swap two equal claims; +infinity as second
                // choice is no price. The exact search settles both.
                let lower = second > best && second < T::infinity();
                if loser != FREE && !lower || best == T::infinity() {
                    break;
                }
                if lower {
                    self.price[column] -= second - best;
                }
                self.row_of[column] = row;
                self.column_of[row] = column;
                if loser == FREE {
                    break;
                }
                self.column_of[loser] = FREE;
                row = loser;
            }
        }
    }

    /// Dijkstra from the free row `start` over reduced costs to the nearest free column; potentials and partners follow.
    fn augment(&mut self, costs: &[T], columns: usize, start: usize) -> Result<(), MatchingError> {
        let mut row = start;
        // Row potential of `row` minus the path length so far.
        let mut offset = T::zero();
        self.open.fill(T::infinity());
        self.visited.clear();
        let (end, length) = loop {
            let row_costs = &costs[row * columns..][..columns];
            let (column, length) =
                relax(row_costs, &self.price_of_open, offset, row, &mut self.open, &mut self.reached_from);
            if length == T::infinity() {
                self.reopen();
                return Err(MatchingError::Infeasible { index: start });
            }
            if self.row_of[column] == FREE {
                break (column, length);
            }
            row = self.row_of[column];
            offset = costs[row * columns + column] - self.price[column] - length;
            self.visited.push((column, length));
            self.open[column] = T::infinity();
            self.price_of_open[column] = T::neg_infinity();
        };
        for &(column, at) in &self.visited {
            self.price[column] += at - length;
        }
        self.reopen();
        let mut column = end;
        loop {
            let row = self.reached_from[column];
            self.row_of[column] = row;
            core::mem::swap(&mut self.column_of[row], &mut column);
            if row == start {
                return Ok(());
            }
        }
    }

    /// Gives the visited columns their potentials back.
    fn reopen(&mut self) {
        for &(column, _) in &self.visited {
            self.price_of_open[column] = self.price[column];
        }
    }
}

/// Numbers treated side by side in the scans below; a vector register's worth or two.
const LANES: usize = 8;

#[inline(always)]
fn lower<T: Real>(a: T, b: T) -> T {
    // Not `min`: its rule for NaN costs two more instructions per number.
    if a < b { a } else { b }
}

/// Position of the smallest `cost - price`, its value, and the second smallest (+infinity if there is one column).
fn two_smallest<T: Real>(costs: &[T], prices: &[T]) -> (usize, T, T) {
    let mut best = [T::infinity(); LANES];
    let mut second = [T::infinity(); LANES];
    let mut visit = |costs: &[T], prices: &[T]| {
        for ((&c, &v), (b, s)) in costs.iter().zip(prices).zip(best.iter_mut().zip(second.iter_mut())) {
            let x = c - v;
            *s = lower(*s, if x < *b { *b } else { x });
            *b = lower(*b, x);
        }
    };
    let (chunks, rest) = costs.as_chunks::<LANES>();
    let (price_chunks, price_rest) = prices.as_chunks::<LANES>();
    for (c, v) in chunks.iter().zip(price_chunks) {
        visit(c, v);
    }
    visit(rest, price_rest);
    let (mut first, mut next) = (T::infinity(), T::infinity());
    for (&b, &s) in best.iter().zip(&second) {
        next = lower(lower(next, s), if b < first { first } else { b });
        first = lower(first, b);
    }
    let at = costs.iter().zip(prices).position(|(&c, &v)| c - v <= first).unwrap_or(0);
    (at, first, next)
}

/// Shortens the paths to all open columns by way of `row`; returns the nearest open column and its distance.
fn relax<T: Real>(
    costs: &[T],
    prices: &[T],
    offset: T,
    row: usize,
    open: &mut [T],
    reached_from: &mut [usize],
) -> (usize, T) {
    let mut nearest = [T::infinity(); LANES];
    let mut visit = |costs: &[T], prices: &[T], open: &mut [T], reached_from: &mut [usize]| {
        let targets = open.iter_mut().zip(reached_from).zip(nearest.iter_mut());
        for ((&c, &v), ((at, from), near)) in costs.iter().zip(prices).zip(targets) {
            let length = c - v - offset;
            let shorter = length < *at;
            *at = if shorter { length } else { *at };
            *from = if shorter { row } else { *from };
            *near = lower(*near, *at);
        }
    };
    let (chunks, rest) = costs.as_chunks::<LANES>();
    let (price_chunks, price_rest) = prices.as_chunks::<LANES>();
    let (open_chunks, open_rest) = open.as_chunks_mut::<LANES>();
    let (from_chunks, from_rest) = reached_from.as_chunks_mut::<LANES>();
    for (((c, v), at), from) in chunks.iter().zip(price_chunks).zip(open_chunks).zip(from_chunks) {
        visit(c, v, at, from);
    }
    visit(rest, price_rest, open_rest, from_rest);
    let length = nearest.iter().fold(T::infinity(), |a, &b| lower(a, b));
    (open.iter().position(|&at| at <= length).unwrap_or(0), length)
}
