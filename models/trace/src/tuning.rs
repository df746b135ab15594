//! Every number that was chosen: its unit, why it is what it is.

/// Positions that renderers with a lattice of sub-pixels give are off by up to this, pixels, the same along an edge: samples
/// are not trusted further. A quarter of the step of the coarsest lattice in use (4 x 4: resvg and tiny-skia).
pub const RENDERER_SIGMA: f64 = 0.02;

/// Places at which the boundary of a face is asked how wide the face is, before more is spent on it.
pub const STROKE_PROBES: usize = 96;

/// Least share of these places at which the face is as wide as at most of them: the rest are ends, corners and junctions.
pub const STROKE_PAIRED_SHARE: f64 = 0.5;

/// Distances across the face that differ from the pen's width by less than this, per width and as of a width of two pixels at least,
/// may be the width: what blurred ends and bends do to it.
pub const STROKE_WIDTH_TOLERANCE: f64 = 0.1;

/// Least length of the boundary of a stroke, in widths: a square has 4, a disk pi, a rectangle of twice its width 6.
pub const STROKE_LEAST_LENGTH: f64 = 6.0;

/// Lines go on straight through a junction if they turn by less, radians (25 degrees).
pub const STROKE_STRAIGHT_TURN: f64 = 0.44;

/// Samples further from the drawn strokes are strays, pixels: half a pixel can be seen.
pub const STROKE_STRAY: f64 = 0.5;

/// Strokes that leave a larger share of the samples as strays are none.
pub const STROKE_MOST_STRAYS: f64 = 0.02;

/// Misfits of samples beyond so many sigmas count linearly: a few samples beside corners and under speckles are wrong.
pub const OUTLINE_HUBER: f64 = 3.0;

/// What a piece costs beside its numbers, bits: its kind, one of four.
pub const OUTLINE_PIECE_BITS: f64 = 2.0;
