//! The best assignment of rows to columns of a cost matrix.
//!
//! In: a [`CostMatrix`], for instance the paper's distances between true and predicted objects ([`MatchingCost`]).
//! Out: the [`Assignment`] of least total cost.
//!
//! | file | does |
//! |---|---|
//! | `cost_matrix.rs` | checks the numbers once, so that the solver need not |
//! | `hungarian.rs` | shortest augmenting paths with potentials, after a round of bidding |
//! | `object_cost.rs` | the paper's cost of taking one object for another |
//!
//! Shown by `tests/property/matching.rs` (brute force, invariants, a second implementation) and
//! `tests/golden/matching.rs` (the reference's matchings).

mod cost_matrix;
mod hungarian;
mod object_cost;
#[cfg(test)]
mod tests;

pub use cost_matrix::{CostMatrix, MatchingError};
pub use hungarian::{Assignment, Hungarian};
pub use object_cost::MatchingCost;
