//! The golden tests; a module per concern.

extern crate alloc;

mod efd;
mod symmetry;
