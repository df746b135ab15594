//! The gradient tests; a module per concern.

mod efd;
mod exact;
mod loss;
mod hard;
mod scene;
mod shape_model;
mod triangles;
