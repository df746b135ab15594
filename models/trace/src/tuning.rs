//! Every number that was chosen: its unit, why it is what it is.

/// Positions that renderers with a lattice of sub-pixels give are off by up to this, pixels, the same along an edge: samples
/// are not trusted further. A quarter of the step of the coarsest lattice in use (4 x 4: resvg and tiny-skia).
pub const RENDERER_SIGMA: f64 = 0.02;
