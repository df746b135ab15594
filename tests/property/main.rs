//! The property tests; a module per concern.

mod scene;
