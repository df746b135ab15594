//! A cost matrix whose numbers were checked once.

use core::fmt;

use crate::real::Real;

/// A borrowed matrix of costs, row by row.
///
/// A cost of +infinity forbids the pair. Every other cost is finite and at most the square root of the type's largest
/// number in magnitude (about 1e19 for f32, 1e154 for f64), so that sums of costs cannot overflow.
#[derive(Clone, Copy, Debug)]
pub struct CostMatrix<'a, T> {
    rows: usize,
    columns: usize,
    values: &'a [T],
}

impl<'a, T: Real> CostMatrix<'a, T> {
    /// A view of `rows` x `columns` costs; either may be 0.
    ///
    /// # Errors
    /// [`MatchingError`] if the length is not rows x columns, or a cost is NaN, -infinity or too large.
    pub fn new(rows: usize, columns: usize, values: &'a [T]) -> Result<Self, MatchingError> {
        if rows.checked_mul(columns) != Some(values.len()) {
            return Err(MatchingError::Length { rows, columns, len: values.len() });
        }
        let limit = T::max_value().sqrt();
        if let Some(index) = values.iter().position(|&v| !(v.abs() <= limit || v == T::infinity())) {
            let (row, column, value) = (index / columns, index % columns, values[index].as_f64());
            return Err(if value.is_nan() {
                MatchingError::NotANumber { row, column }
            } else {
                MatchingError::TooLarge { row, column, value }
            });
        }
        Ok(Self { rows, columns, values })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of columns.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// The costs, row by row.
    #[must_use]
    pub fn values(&self) -> &'a [T] {
        self.values
    }
}

/// Why no assignment was made.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MatchingError {
    /// The slice has the wrong length.
    Length {
        /// Rows announced.
        rows: usize,
        /// Columns announced.
        columns: usize,
        /// Number of values that came.
        len: usize,
    },
    /// A cost is NaN.
    NotANumber {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
    },
    /// A cost is -infinity or beyond the square root of the largest number.
    TooLarge {
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
        /// The cost.
        value: f64,
    },
    /// The forbidden pairs leave no complete assignment of the shorter side.
    Infeasible {
        /// A row that cannot be assigned together with those before it (a column, if there are more rows than columns).
        index: usize,
    },
}

impl fmt::Display for MatchingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { rows, columns, len } => {
                write!(f, "a cost matrix of {rows} x {columns} got {len} values; pass rows x columns")
            }
            Self::NotANumber { row, column } => {
                write!(f, "the cost at row {row}, column {column} is NaN; use +infinity to forbid a pair")
            }
            Self::TooLarge { row, column, value } => {
                write!(f, "the cost at row {row}, column {column} is {value:e}; scale the costs down")
            }
            Self::Infeasible { index } => {
                write!(
                    f,
                    "the forbidden pairs leave no partner for row or column {index}; allow more pairs at a high cost"
                )
            }
        }
    }
}

impl core::error::Error for MatchingError {}
