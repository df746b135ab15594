//! The property tests; a module per concern.

mod contour;
mod efd;
mod exact;
mod hard;
mod matching;
mod scene;
mod symmetry;
mod triangles;
