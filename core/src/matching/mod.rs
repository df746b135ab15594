//! The best assignment of rows to columns of a cost matrix.
