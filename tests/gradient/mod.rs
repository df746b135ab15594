//! The gradient tests; a module per concern.

mod compositing;
mod drawing;
mod efd;
mod exact;
mod hard;
mod live;
mod loss;
mod optim;
mod ramp;
mod render_contour;
mod rings;
mod scene;
mod shape;
mod shape_model;
mod smooth;
mod triangles;
