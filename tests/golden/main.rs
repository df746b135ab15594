//! The golden tests; a module per concern.

extern crate alloc;

mod efd;
mod render_contour;
mod symmetry;
