//! What can be said of the numbers alone, in one binary: each test binary links the whole workspace.
//!
//! | folder | holds |
//! |---|---|
//! | `property` | what must hold for every input: invariants, as proptests |
//! | `gradient` | every gradient against central differences in f64 |
//! | `golden` | numbers of others: the reference's, of pyefd, scipy, scikit-learn, PyTorch |
#![expect(clippy::unwrap_used, reason = "a failed unwrap is a failed test with a line number")]

extern crate alloc;

mod golden;
mod gradient;
mod property;
