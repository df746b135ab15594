//! Every number that was chosen: its unit, why it is what it is.

/// Positions that renderers with a lattice of sub-pixels give are off by up to this, pixels, the same along an edge: samples
/// are not trusted further. A quarter of the step of the coarsest lattice in use (4 x 4: resvg and tiny-skia).
pub const RENDERER_SIGMA: f64 = 0.02;

/// Share of a picture's pixels that must lie in flat blocks for it to be a drawing of flat colors. Photographs have fewer than
/// a tenth, dense line art at 128 pixels about a half.
pub const LEAST_FLAT: f64 = 0.3;
/// Most difference of a channel between pixels of one color in a clean picture: rounding to 8 bits, twice.
pub const CLEAN_STEP: f32 = 1.5 / 255.0;
/// Most difference of a channel between pixels of one color in a picture that went through a coder: JPEG of quality 80 leaves
/// about 5 levels within a pixel of an edge.
pub const CODED_STEP: f32 = 6.5 / 255.0;
/// Most difference of a channel between a pixel and the mixture that explains it, clean: rounding of pixel and colors, and renderers that
/// round their coverage to 1/64.
pub const CLEAN_MIX: f32 = 5.0 / 255.0;
/// The same in pictures that went through a coder.
pub const CODED_MIX: f32 = 24.0 / 255.0;
/// Most colors of a drawing.
pub const MOST_COLORS: usize = 96;
/// Least difference of a channel that makes a color of its own of pixels that nothing else explains.
pub const LEAST_CONTRAST: f64 = 12.0 / 255.0;
/// Fewer pixels than this that nothing explains are left to the nearest mixture.
pub const LEAST_THIN: usize = 3;
/// Standard deviation of a channel by rounding to 8 bits.
pub const ROUNDING: f64 = 0.29 / 255.0;
/// Second difference (pixels) of windows side by side from which on there is a corner between them and no bend: that of a circle of two
/// pixels' radius.
pub const MOST_BEND: f64 = 0.5;
