//! Every number that was chosen: its unit, why it is what it is. What halving and doubling each of them changes is measured:
//! `tests/report/sensitivity.md`.

/// Positions that renderers with a lattice of sub-pixels (4 x 4: resvg and tiny-skia) give are off by about this, pixels, the same along an
/// edge: samples are not trusted further. Counted once, by what fits lines to samples; less makes corners of the lattice's steps.
pub const RENDERER_SIGMA: f64 = 0.028;

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

/// The same for samples twice as far from the first guess, which the refinement brings closer.
pub const STROKE_MOST_LOOSE: f64 = 0.15;

/// Positions that a renderer with quarters of pixels gives are off by this, pixels, the same along a straight edge: a quarter over the
/// square root of 12. Only the constant width of a pen shows it.
pub const STROKE_OFFSET: f64 = 0.072;

/// Misfits of samples beyond so many sigmas count linearly: a few samples beside corners and under speckles are wrong.
pub const OUTLINE_HUBER: f64 = 3.0;

/// What a piece costs beside its numbers, bits: its kind, one of four.
pub const OUTLINE_PIECE_BITS: f64 = 2.0;

/// Pixels up to this far apart (along rows and columns) are averaged, pixels.
pub const DENOISE_REACH: usize = 5;
/// Noise that the first of two averages leaves, in units of the picture's.
pub const DENOISE_LEFT: f64 = 0.25;

/// How many times as much noise the brightest of a picture must have as the darkest for it to be noise of a camera that counts photons.
pub const SHOT_RATIO: f64 = 1.5;
/// How far the variance at alike values may be off the line, on the mean of its logarithm. Of 18 pictures of simulated cameras it was .08 to .17, of
/// scikit-image's photographs whose noise seems to grow .39 to 1.28.
pub const SHOT_MISSED: f64 = 0.3;

/// Least standard deviation of uneven light over a picture, of 1: clean flat colors are of one step of 256.
pub const LEAST_LIGHT: f64 = 1.0 / 255.0;
/// The same, in units of the noise, which hides less.
pub const LEAST_LIGHT_NOISES: f64 = 0.2;

/// What is averaged away, in units of the noise from pixel to pixel, one after the other as long as what is left has too many faces: noise alone, then
/// texture. Of 642 drawings with noise, blur or a coder's marks none came to the second. Of scikit-image's photographs `coins` is 116 things without the
/// last two and 27 with them, `text` none and 57.
pub const TEXTURES: [usize; 3] = [1, 4, 16];

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
/// Most difference of a channel between pixels of one color, and between a pixel and the mixture that explains it, and the standard deviation of a
/// channel in pixels at edges, of a picture whose noise was averaged away: in units of the noise. Of 50 icons, emoji and flags with noise of 4, 12
/// and 25 levels, 99.9 % of the flat pixels were off by less than the first, 99 % of those at edges by less than the second.
pub const NOISY_STEP: f32 = 0.6;
/// See [`NOISY_STEP`].
pub const NOISY_MIX: f32 = 2.6;
/// See [`NOISY_STEP`].
pub const NOISY_SIGMA: f64 = 0.7;
/// Weight of color differences beside brightness in pictures that went through a coder: across edges they are off by 13 levels and brightness
/// by 5.
pub const CODED_COLOR_WEIGHT: f64 = 0.35;
/// Standard deviation of brightness in pixels at edges of pictures that went through a coder: 4.5 to 6 levels across edges, 3.5 beside.
pub const CODED_SIGMA: f64 = 4.5 / 255.0;
/// So many pixels of a coded picture are off by the same.
pub const CODED_ALIKE: f64 = 16.0;
/// Shorter side (pixels) from which on the profile of the paper's renderer is wider than that of area coverage, and would be seen as
/// blur in a coded picture too: 8 / 5 of the 128 of its data, where it is 0.65 pixels wide.
pub const CODED_SMALL: usize = 200;
/// Regions of coded pictures of up to so many pixels may be stains beside edges.
pub const CODED_MOST_STAIN: usize = 600;
/// How far from edges (pixels) colors are looked for, since coders stain there: half a block of 8; beyond, colors are off by 1.5 levels only.
pub const CODED_REACH: usize = 4;
/// Most colors of a drawing.
pub const MOST_COLORS: usize = 96;
/// Least difference of a channel that makes a color of its own of pixels that nothing else explains.
pub const LEAST_CONTRAST: f64 = 12.0 / 255.0;
/// The same in pictures that went through a coder: twice what a mixture may be off.
pub const CODED_CONTRAST: f64 = 48.0 / 255.0;
/// The same of [`LEAST_THIN`]: half of what a coder changes alike.
pub const CODED_THIN: usize = 8;
/// Fewer pixels than this that nothing explains are left to the nearest mixture.
pub const LEAST_THIN: usize = 3;
/// Standard deviation of a channel by rounding to 8 bits.
pub const ROUNDING: f64 = 0.29 / 255.0;
/// Second difference (pixels) of windows side by side from which on there is a corner between them and no bend: that of a circle of two
/// pixels' radius.
pub const MOST_BEND: f64 = 0.5;
/// Distance (pixels) within which the walks of three faces past one another are the same junction.
pub const JUNCTION_SIZE: f64 = 4.0;
/// Samples on either side of a junction that tell whether a boundary goes on through it: few, since a corner or a bend may be near, and more.
pub const JUNCTION_SAMPLES: [usize; 2] = [5, 8];
/// Distance (pixels) from a junction within which windows see all three faces.
pub const JUNCTION_BLUR: f64 = 1.5;
/// Standard deviation (pixels) of a boundary that goes on through a junction: what a parabola over 16 pixels cannot follow.
pub const JUNCTION_SIGMA: f64 = 0.08;
/// Most bits that one junction may speak for an order: one that is read wrongly must not outvote all others.
pub const MOST_VOTE: f64 = 40.0;
/// Bits for a face with a single neighbor lying in front of it: less than any junction that was read.
pub const ENCLOSED_VOTE: f64 = 2.0;
/// Steps without a sample after which a boundary counts as unread: at 45 degrees every second step has one.
pub const MOST_UNREAD: usize = 5;
/// Standard deviation (pixels) of a boundary that is known from the cracks between pixels alone: 1 / sqrt(12), and a little for their
/// being stairs.
pub const CRACK_SIGMA: f64 = 0.35;
/// Share of a face's pixels that its outline may get wrong.
pub const MOST_WRONG: f64 = 0.01;
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

/// Fewest samples of a cubic: one more than its numbers.
pub const OUTLINE_CUBIC_SAMPLES: usize = 9;

/// The curves beside a hidden stretch are drawn out to where they meet if that is no further than this many times the chord over
/// it: else the corner would be a spike that nothing speaks for.
pub const OUTLINE_BRIDGE: f64 = 3.0;
/// Bits for a line lying in front of what it touches: as much as a junction may speak for.
pub const PEN_VOTE: f64 = 40.0;
/// Most pixels of any face that an outline may get wrong, however large the face is: more can be seen.
pub const MOST_WRONG_PIXELS: f64 = 3.0;
/// Standard deviation (pixels) of an outline along the border of the picture: what lies beyond cannot be seen.
pub const BORDER_SIGMA: f64 = 0.1;

/// By how much a curve may be longer than the walk along its samples, pixels: corners lie beyond the last samples beside them.
pub const OUTLINE_SLACK: f64 = 6.0;
/// Of more colors no three are tried for a pixel: among so many some explain any, and it takes the third power of their number (a flag as WebP, of 96
/// colors: 17 s, without 6).
pub const MOST_OF_THREE: usize = 16;
/// How far from a pixel of a blurred edge its colors are looked for, and how far its window reaches, pixels: three standard deviations of a blur of
/// two and a half pixels.
pub const SOFT_REACH: usize = 8;
/// Ripple from which on a picture may have gone through a coder or a filter: of 160 drawings, 100 of them of near colors, one flag with fine arms leaves
/// more, of 160 that went through JPEG or WebP all but a few flags of stripes.
pub const RIPPLED: f64 = 0.06;
/// Blur (standard deviation, pixels) from which on its ramps may be taken for things: clean pictures show less than a tenth of it.
pub const WIDE_BLUR: f64 = 0.5;
/// A picture has if that makes its boundaries so much shorter, as a share: what ringing adds.
pub const RINGING: f64 = 0.02;
/// Share of another color in a pixel beyond an edge from which on the edge is not one of area coverage: 8 bits cannot show less at
/// full contrast.
pub const LEAST_STAIN: f64 = 0.003;
/// Share of stained pixels from which on edges are soft. Renderers of area coverage leave up to .27 (emoji with lines thinner than a pixel, of 210
/// pictures), the reference renderer of the paper .32 and more on nine of ten pictures.
pub const SOFT_STAINED: f64 = 0.3;
/// Share of stained pixels from which on edges leave a doubt: a fifth of those of the least stained picture of the reference renderer at 128 pixels.
pub const DOUBTFUL_STAINED: f64 = 0.02;
/// Wobble (share of that of pixels that show what is at their center) from which on edges that leave a doubt are steeper than area coverage: half of
/// what the reference renderer has at 128 pixels (.28, with a standard deviation of .04); drawings have .05 and, with a lattice of sub-pixels, .18.
pub const STEEP_WOBBLE: f64 = 0.12;
/// Wobble from which on edges without a stain leave a doubt: the reference renderer has .66 at 64 pixels, drawings .35 at most, but .6 to .9 with two by
/// two places in a pixel and slopes near 1.
pub const SURE_WOBBLE: f64 = 0.4;
/// So many times as many blocks that differ a little as blocks that differ much make a picture a noisy one: 384 pictures of the paper's renderer
/// have up to 1.1 times as many, noise of a standard deviation of .01 gives a hundred times.
pub const NOISY_BLOCKS: usize = 2;
/// Pixels that a pixel's length along the border counts when the background is chosen.
pub const BORDER_WEIGHT: usize = 4;
/// Bits of misfit per sample, along a stretch, from which on an outline is drawn anew there: as of samples that are 4 sigma off.
pub const OUTLINE_MOST_MISFIT: f64 = 10.0;

/// Widest line that is looked for across both of its sides at once, pixels: wider ones have pixels of their own.
pub const THIN_WIDTH: f64 = 2.2;

/// Widest lines that are taken out where they cross one another, pixels: of a chart of 512 pixels.
pub const CROSSING_WIDTH: f64 = 9.0;

/// Fewest windows across a thin line, and fewest that make a color of its own of it.
pub const THIN_LEAST_LENGTH: usize = 6;

/// How often a color that only thin lines have is looked for.
pub const THIN_TRIES: usize = 48;

/// By how much the width of a thin line may differ from window to window, per width.
pub const THIN_TOLERANCE: f64 = 0.2;

/// Standard deviation of the middle of a thin line in one window, pixels: what slanted lines look like to windows.
pub const THIN_SIGMA: f64 = 0.05;

/// Windows of a line that are further apart than this (pixels) are not next to one another: two apart at 45 degrees are 2.8.
pub const CHAIN_NEXT: f64 = 2.5;
/// Least that is seen of a line that another one hides in part, pixels: half a pixel is more than mixtures are off.
pub const PAIR_SEEN: f64 = 0.5;
/// How far the line in a window of two may be from where its chain goes on, pixels: half of the step from which windows side by side are one
/// chain. And how much further after every window that is missing.
pub const PAIR_ASIDE: [f64; 2] = [0.75, 0.05];
/// So many windows at the end of a chain tell where it goes on; fewer than so many do not.
pub const PAIR_REACH: usize = 7;
/// See [`PAIR_REACH`].
pub const PAIR_MARKS: usize = 4;
/// Where lines are steeper to their windows, those along the other axis read them: a little more than 45 degrees, so that both overlap.
pub const PAIR_SLOPE: f64 = 1.1;

/// Windows of a thin line, with three on both sides of each, that are asked how dark it is.
pub const SHADE_LEAST: usize = 6;

/// How many times as much (mean square) windows across a thin line have to differ from those of a smooth one of its color before it has another color.
pub const SHADE_CLEARLY: f64 = 4.0;

/// What they differ by without telling of it, mean square of a window: a step of 8 bits in some pixels, and what curves add.
pub const SHADE_FLOOR: f64 = 2e-5;

/// How far apart (pixels) the parts of a thin line may be that something crosses.
pub const THIN_GAP: f64 = 32.0;

/// Seams along fewer steps than this are mixtures of the three colors that meet in a corner.
pub const LEAST_SEAM: usize = 16;
/// Share of a boundary's steps that tell the same of it, at least, for it to be that: more than half, and some that are wrong.
pub const SEAM_SHARE: f64 = 0.6;
/// Share of a boundary's steps that show a mixture, at least, for seams to be looked for: fewer and it runs along the pixel grid.
pub const SEAM_LEAST_MIXED: f64 = 0.25;
/// Most of a pixel that shows through between two things side by side: a quarter, and rounding.
pub const SEAM_MOST: f64 = 0.27;

/// What a thing costs beside its outline, bits: its color, 24, and that there is one more at all, at some place in the order: people see few
/// things rather than many. Of 900 pictures of shapes that show one another through openings about .91 had the right count with 24 when it was
/// chosen, .95 with 60, .96 with 80 and with 100; about .97 have it today.
pub const THING_BITS: f64 = 80.0;

/// What a face of a few pixels costs, bits: its color, 24, and three numbers of 10.
pub const SPECK_BITS: f64 = 54.0;

/// Bits that a grid must save over the whole drawing, and a class of equal numbers over what telling its members costs: chance saves so
/// many in less than one of 200 drawings.
pub const TIES_BITS: f64 = 8.0;

/// Least share of a face in a pixel for the pixel to show that face alone: what else is in it is less than rounding at the border of a
/// pure one.
pub const PURE_SHARE: f32 = 0.9;
/// Most pixels of a face without a flat one that may be a mixture of what lies further off than beside it: a wedge between two edges at
/// a sharp angle ends in so many.
pub const MOST_SPECK: usize = 6;
/// Least width, pixels, of a line that may be a gap through which what lies behind shows: narrower ones have no pixel of their own.
pub const GAP_LEAST: f64 = 0.95;
/// Pixels beyond the end of a line within which it leads to what lies behind all: what is mixed at the edge of things, and one more.
pub const GAP_REACH: usize = 3;
/// Share of the places along edges that may have mixed pixels in a picture of hard edges: upright ones on whole pixels have none either,
/// but hardly a whole picture is made of them alone.
pub const MOST_HARD: f64 = 0.05;
/// Steps of one pixel per place along edges from which on edges without mixed pixels are stairs: an edge that is one pixel off over 66 has as many.
/// With fewer everything is upright and on whole pixels, and known as well as any edge.
pub const LEAST_STAIRS: f64 = 0.015;
/// Steps of one pixel that follow each other along a boundary whose edges mix elsewhere, without its being slanted there: things side by side that begin a
/// pixel from one another make one or two.
pub const MOST_STAIRS: usize = 2;
/// Most pixels, on the mean, from one of such steps to the next: flatter slopes have one on a side.
pub const STAIRS_APART: usize = 12;
/// Most faces of one color behind the same that are joined pair by pair: more take too long, and are all one thing or none.
pub const MOST_PAIRED: usize = 5;
/// Share of stained pixels that is supposed where no edge is long and straight enough to tell: what leaves a doubt.
pub const UNKNOWN_STAINED: f64 = 0.1;
/// Faces through which a way from one face behind others is looked for, at most: what people draw has a few hundred, dots of a dithered picture are
/// thousands, of which each would be looked for from every other.
pub const MOST_WAYS: usize = 1_000;
/// Times that the order of all faces that meet is asked again.
pub const MOST_ROUNDS: usize = 3;
/// Bits that another order, or one thing in place of two, must save.
pub const LEAST_SAVED: f64 = 1.0;
/// Most bits for faces lying to one another as others of their colors do: less than a junction that was read, more than [`ENCLOSED_VOTE`].
pub const COLORS_VOTE: f64 = 8.0;
/// Bits from which on a vote is not asked again.
pub const CLEAR_VOTE: f64 = 7.0;
/// So many times as many samples as all boundaries of a picture have, outlines may be fitted to before no other order of faces is tried any more,
/// and again for groups of faces; the usual picture needs one to three times as many.
pub const MOST_TRIED: usize = 4;
/// The same for pictures with long boundaries, in all of their readings together, samples.
pub const MOST_TRIED_SAMPLES: usize = 14_000;
/// Share of the windows of a thin line that must lie between two faces for it to be a sliver of a third one: windows at its ends see more.
pub const SLIVER_MOSTLY: f64 = 0.8;
/// Longest gap between windows (pixels) that a sliver is supposed to go on in.
pub const SLIVER_GAP: f64 = 4.0;
/// How far from a window's reading of an edge (pixels) a crack may be that the reading is of: slivers are narrower than two.
pub const SLIVER_NEAR: f64 = 1.5;
/// Change of the position per window of edges that tell how uneven they are: upright ones are off by the same everywhere, steep ones are read by
/// windows of the other axis.
pub const UNEVEN_SLOPES: [f64; 2] = [0.1, 1.5];
/// Residual (pixels) of five positions in a row from a straight line up to which there is no corner between them, however uneven they are.
pub const UNEVEN_BENT: f64 = 0.7;
/// Fewest stretches of five windows that tell how uneven edges are.
pub const UNEVEN_LEAST: usize = 6;

/// What a pixel costs that is told as it is, bits: three channels of 8.
pub const PIXEL_BITS: f64 = 24.0;

/// Standard deviation of a level line of coverage that is interpolated between the middles of pixels, pixels.
pub const LEVEL_SIGMA: f64 = 0.08;

/// Fewest pixels of a color ramp: of fewer, a flat color and what it misses are as short.
pub const LEAST_RAMP_PIXELS: usize = 64;
/// Least change of a channel over a color ramp, steps of 256: three are what rounding makes of one.
pub const LEAST_RAMP_STEPS: f32 = 4.0;
/// How far the color that stands for a ramp is from all others, of 1: that of edges that are read to a hundredth of a pixel.
pub const MARKERS_APART: f64 = 0.12;
/// Side (pixels) of the squares of a picture that is made of such, as sprites are read: from 5 on windows read all of their sides.
pub const SQUARE: usize = 6;
