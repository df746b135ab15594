//! The property tests; a module per concern.

mod matching;
mod scene;
