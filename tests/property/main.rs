//! The property tests; a module per concern.

mod exact;
mod hard;
mod matching;
mod scene;
mod triangles;
