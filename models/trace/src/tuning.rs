//! Every number that was chosen: its unit, why it is what it is.

/// Positions that renderers with a lattice of sub-pixels give are off by up to this, pixels, the same along an edge: samples
/// are not trusted further. A quarter of the step of the coarsest lattice in use (4 x 4: resvg and tiny-skia).
pub const RENDERER_SIGMA: f64 = 0.02;

/// The outline's dynamic programme. A corner: the polygon along the samples turns by more than this, radians (23 degrees): less
/// may be a bend of a small circle, more is tried at all samples around.
pub const OUTLINE_SHARP: f64 = 0.4;

/// Distance of that polygon from the samples, in their sigmas: places between pieces that are off by a step of the polygon cost
/// less than a number.
pub const OUTLINE_POLYGON_SIGMAS: f64 = 2.5;

/// Boundaries of up to this many samples are cut at any of them.
pub const OUTLINE_ALL_PLACES: usize = 40;

/// Samples whose window holds a corner say where neither side is: so many may be left out between two pieces.
pub const OUTLINE_SPOILED: usize = 2;

/// What leaving out one of them costs, bits: as a sample that is 2.9 sigma off.
pub const OUTLINE_SPOILED_BITS: f64 = 6.0;

/// What a piece costs beside its numbers, bits: its kind, one of four.
pub const OUTLINE_PIECE_BITS: f64 = 2.0;

/// Fewest samples of a cubic: one more than its numbers.
pub const OUTLINE_CUBIC_SAMPLES: usize = 9;

/// Misfits of samples beyond so many sigmas count linearly: a few samples beside corners and under speckles are wrong.
pub const OUTLINE_HUBER: f64 = 3.0;

/// The curves beside a hidden stretch are drawn out to where they meet if that is no further than this many times the chord over
/// it: else the corner would be a spike that nothing speaks for.
pub const OUTLINE_BRIDGE: f64 = 3.0;
