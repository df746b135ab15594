//! Every number of segment-and-fit that was chosen: what it decides, its unit, and the reason where one is known. What halving and doubling
//! each of them changes is measured: `tests/report/sensitivity.md`.
//!
//! Numbers that follow from others, sizes of memory and of lanes, and the law of [`crate::Prices`] stand where they are used; lists of
//! starts and steps too.

// Which reading of a picture.

/// Below this noise a picture is read as if it had none.
pub(crate) const QUIET_NOISE: f64 = 0.0015;
/// What compression leaves beside edges is averaged away as noise of this standard deviation.
pub(crate) const COMPRESSED_NOISE: f64 = 0.06;
/// In a picture whose coder is known, this much is averaged away in a second reading, for faint objects.
pub(crate) const CODED_NOISE: f64 = 0.03;
/// A picture with more regions than this is not fitted as clean if most of its soft pixels lie between no two regions, and is none of flat
/// objects if they leave much. It bounds the time: a picture of 139 bands took 27 s instead of 0.3 s without it.
pub(crate) const MANY_REGIONS: usize = 64;
/// Denoised neighbors that differ by less than this much of the noise are never cut apart. .08 finds 3 of 40 scenes fewer right at a noise of .1
/// (MDS-HR), .04 no more, and takes three times as long for pictures of 512 x 512.
pub(crate) const ZONE_NOISE: f64 = 0.05;
/// The same of what compression left, whose pixels are not off by chance: finer zones are pieces of ringing. .05 finds 26 of 160 scenes fewer right
/// in JPEGs of quality 8 to 15.
pub(crate) const COMPRESSED_ZONE: f64 = 0.17;
/// Compression blurs edges by up to about this much (scale of a logistic curve, px).
pub(crate) const COMPRESSED_BLUR_PX: f64 = 1.0;
/// A picture of which flat objects leave a larger share of the variance is not flat.
pub(crate) const NOT_FLAT_SHARE: f64 = 0.05;
/// A picture read with the wrong kind of edges leaves more than this share of its variance unexplained.
pub(crate) const MISSED_SHARE: f64 = 0.002;
/// Pictures of more contrast are not faint: what is not found in them is not flat.
pub(crate) const FAINT_CONTRAST: f64 = 0.05;
/// The shorter side of what is left has at least so many pixels.
pub(crate) const SUBSAMPLED_UNIT_PX: usize = 256;
/// A pixel is sharp if it is off the middle between its neighbors by this share of the contrast around it. Of the pixels on
/// the reference's edges that are 2.6 pixels wide 1 % are, 1.3 pixels wide 20 %.
pub(crate) const SHARP_BEND: f64 = 0.15;
/// Edges are wide if of their pixels at most one in so many is sharp.
pub(crate) const WIDE_EDGES_FEW: usize = 10;
/// Pixels that may be missed in the whole picture although none was among those looked at, and what may be missed per
/// pixel that was.
pub(crate) const MISSES: f64 = 4.0;
/// See [`MISSES`].
pub(crate) const MISSES_EACH: f64 = 1.5;
/// Colors that differ from the matte by less than this in every channel are the matte: it is chosen to be much farther from the
/// colors of the picture, and fits find flat colors to a hundredth.
pub(crate) const OPENING_COLOR: f64 = 0.1;

// Flat regions of clean pictures.

/// Regions of fewer pixels have no core in which neighbors agree: their colors are those of pixels that edges reach.
pub(crate) const CORE_PIXELS: usize = 32;
/// How far edges move the color of a region that is all rim, by the number of its pixels.
pub(crate) const RIM_COLOR: f64 = 0.08;
/// Standard deviations that noise may move a color by: one in 27 pairs of one color goes farther in one of its channels.
pub(crate) const SAME_COLOR_DOUBT: f64 = 2.5;
/// Filters that sharpen leave a rim along an edge, off its color by at most this share of the edge's contrast.
pub(crate) const OVERSHOOT: f64 = 0.25;
/// Least channel contrast of a pixel of a thin region with the region around it.
pub(crate) const THIN_CONTRAST: f64 = 0.05;
/// From this share of the full contrast on a pixel counts as covered.
pub(crate) const THIN_CORE: f64 = 0.8;
/// At most this share of the pixels of a group may be off the line between its two colors.
pub(crate) const THIN_STRAY: f64 = 0.25;
/// Pixels that a group must cover together.
pub(crate) const THIN_COVERAGE: f64 = 1.9;
/// A group this near to another region (px) is a part of it if it has its color, or a tip if its colors are on the way there.
pub(crate) const TIP_REACH_PX: usize = 2;
/// The rim that a filter leaves along an edge is this near to the flat pixels beyond the edge (px).
pub(crate) const RIM_REACH_PX: usize = 4;

// Flat regions of noisy and coded pictures.

/// How far from the line between two colors a denoised pixel may lie, in units of the noise.
pub(crate) const LINE_NOISES: f64 = 2.0;
/// Compression moves the color of a whole region by up to a step of its coarsest quantization, about this.
pub(crate) const COMPRESSED_COLOR: f64 = 0.004;
/// In a clean picture this share of the soft pixels lies between two regions or shows the color of one, at least.
pub(crate) const CLEAN_SHARE: f64 = 0.8;
/// A soft pixel off the color of a region by this share of the contrast of an edge, away from the other side, is part of a
/// rim. Filters that scale pictures down leave 4 % and more; of a picture with rims, this share of the soft pixels is.
pub(crate) const RIM_BEYOND: f64 = 0.02;
/// See [`RIM_BEYOND`].
pub(crate) const RIM_SHARE: f64 = 0.05;
/// Noise that compression leaves along edges, at least: it is measured across the lines between two colors only.
pub(crate) const LEAST_COMPRESSED_NOISE: f64 = 0.03;
/// Compression leaves differences beside an edge, in units of the edge's contrast.
pub(crate) const HALO_SHARE: f64 = 0.8;
/// Compression that halves the resolution of color leaves strips of mixed color as wide as this (px).
pub(crate) const COMPRESSED_STRIP_PX: f64 = 6.0;
/// Strips along the edges of a picture that is not compressed are up to this wide (px).
pub(crate) const STRIP_WIDTH_PX: f64 = 2.6;
/// Rings of pixels beside a boundary that may still be soft.
pub(crate) const SOFT_RINGS: usize = 3;
/// Fewer flat pixels than this are no region.
pub(crate) const MIN_REGION_PIXELS: u32 = 4;
/// What compression leaves beside an edge stays in the unit of 16 x 16 pixels that its color is coded in: larger regions, if
/// they are wider than this (px; twice the area over the boundary) and differ by more than steps of means do, are no halo.
pub(crate) const HALO_PIXELS: f64 = 256.0;
/// See [`HALO_PIXELS`].
pub(crate) const HALO_WIDTH_PX: f64 = 8.0;
/// See [`HALO_WIDTH_PX`].
pub(crate) const HALO_COLOR: f64 = 0.03;

// Edges.

/// Least distance between two colors whose soft pixels are looked at, and the same in units of the noise.
pub(crate) const EDGE_CONTRAST: f64 = 0.06;
/// See [`EDGE_CONTRAST`].
pub(crate) const EDGE_NOISES: f64 = 5.0;
/// A neighbor farther from the line between the two colors than this, and than so many times the noise, belongs to
/// something else.
pub(crate) const EDGE_LINE: f64 = 0.05;
/// See [`EDGE_LINE`].
pub(crate) const EDGE_LINE_NOISES: f64 = 3.0;
/// Fewer pixels than this tell nothing.
pub(crate) const EDGE_PIXELS: usize = 12;
/// Softness (px) up to which pixels are hard.
pub(crate) const HARD_SOFTNESS_PX: f64 = 0.02;
/// Softness (px) up to which coverage is that of areas: at random positions it is 0.15 to 0.19, along the grid 0 to 0.25;
/// 0.24 is a further Gaussian blur of 0.3 px, which changes no coverage by more than 0.05.
pub(crate) const AREA_SOFTNESS_PX: f64 = 0.24;
/// Edges along the grid may hide this much of it.
pub(crate) const LOPSIDED_LEAST: f64 = 0.06;
/// No blur comes near this.
pub(crate) const LOPSIDED_SURELY: f64 = 0.1;

// What covers what.

/// Two objects with fewer soft pixels between them merely touch in a point.
pub(crate) const MIN_BORDER: u32 = 3;
/// An overlap touches the background at most with this share of its contacts (outlines cross in points).
pub(crate) const BACKGROUND_CONTACT: f64 = 0.34;
/// A hole touches the object around it with at least this share of its contacts.
pub(crate) const HOLE_CONTACT: f64 = 0.6;
/// What lies inside another region touches it with at least this share of its contacts.
pub(crate) const MOSTLY_INSIDE: f64 = 0.75;
/// How exactly an overlap shows the mean of its colors.
pub(crate) const MEAN_COLOR: f64 = 0.006;
/// How exactly an overlap shows the color that opacity foretells.
pub(crate) const OVERLAP_COLOR: f64 = 0.008;
/// Least contrast of an object with the background, for its shadow in an overlap to tell the opacity.
pub(crate) const SHADOW_CONTRAST: f64 = 0.1;
/// Two objects that overlap meet in points; longer contacts, relative to those of the overlap, speak against it.
pub(crate) const CROSSING_CONTACT: f64 = 0.25;
/// Pieces some of which are in front and some behind must explain the outlines by so much better than one object does.
pub(crate) const MIXED_ORDER_BITS: f64 = 72.0;

// Poses of known shapes.

/// Samples used while searching; all are used at the end.
pub(crate) const SEARCH_SAMPLES: usize = 32;
/// Samples of the last steps but two.
pub(crate) const FINISH_SAMPLES: usize = 80;
/// Start angles over a full turn.
pub(crate) const FULL_TURN_STARTS: usize = 12;
/// Residuals of starts count up to this (px).
pub(crate) const START_WIDTH_PX: f64 = 3.0;
/// Where the usual search fails, they count up to this share of the object's radius as well: shares from 0.22 to 0.6 find the same.
pub(crate) const START_WIDTH_SHARE: f64 = 0.225;
/// An object with more visibly missed pixels around is searched for again.
pub(crate) const MISSED_PIXELS: usize = 4;
/// Mean squared distance error (px^2) below which an outline is where it should be, whatever is missed around it.
pub(crate) const SURE_COST: f64 = 1e-3;
/// A joint refinement is worth its time if more pixels of the image are visibly missed. Its mean error would not tell:
/// that of a perfect fit depends on rounding and on the seams of whoever drew the picture.
pub(crate) const JOINT_PIXELS: usize = 8;
/// Residual at which a pixel loses most of its say in the joint refinement.
pub(crate) const JOINT_WIDTH: f64 = 0.05;
/// A twin is worth telling if its squared error is below this many times that of the chosen prototype.
pub(crate) const ALTERNATIVE_RATIO: f64 = 4.0;

// Outlines of unknown shapes.

/// An outline with more visibly missed pixels around may have folded; a corner that is cut misses fewer.
pub(crate) const FOLDED_PIXELS: usize = 16;
/// An outline with less freedom has more harmonics: it must miss clearly less.
pub(crate) const CLEARLY_LESS_LOSS: f64 = 0.8;
/// Noise of independent samples that says as little of an outline as that of a coded picture, in units of the latter.
pub(crate) const CODED_ALIKE: f64 = 2.0;
/// Description length, as a share of that with the renderer's edges, at which a coded picture has area coverage. What a coder
/// leaves makes either shorter by as much, and more.
pub(crate) const CODED_CLEARLY_SHORTER: f64 = 0.9;
/// Weight of samples that hold an outline where nothing is seen of it.
pub(crate) const HOLD_WEIGHT: f64 = 0.02;
/// Descriptions whose lengths differ by less say nothing.
pub(crate) const CLEARLY_SHORTER_BITS: f64 = 8.0;
/// Coupling of neighboring displacements relative to the mean weight of a vertex: bridges stretches without samples.
pub(crate) const VERTEX_COUPLING: f64 = 1e-3;

// Several objects of one color.

/// Noise of a pixel value that free outlines leave: harmonics cut corners, by more the sharper they are, which does not say how many
/// objects there are.
pub(crate) const CORNER_NOISE: f64 = 0.01;
/// A union may miss the samples by this many times as much as the single outline did, and by so much (px^2) in any case.
pub(crate) const MISFIT_RATIO: f64 = 2.0;
/// See [`MISFIT_RATIO`].
pub(crate) const MISFIT_SLACK: f64 = 0.004;
/// Turn (radians) over four edges from which an outline bends inward.
pub(crate) const WAIST_TURN: f64 = 0.12;
/// See [`WAIST_TURN`].
pub(crate) const WAIST_SHARP_TURN: f64 = 0.2;
/// Depth (px) below its convex hull at which a traced outline is surely not convex: soft pixels place it to a part of a
/// pixel.
pub(crate) const WAIST_HOLLOW_PX: f64 = 0.75;
/// Nearer to the image border (px) an outline is held by samples on one side only.
pub(crate) const WAIST_BORDER_PX: f64 = 3.0;
/// A set of three must miss the samples by so many times less than one of two.
pub(crate) const THIRD_PART: f64 = 4.0;
/// Distance error (px) up to which an outline explains a sample.
pub(crate) const EXPLAINED_PX: f64 = 0.3;
/// Where two outlines pass within this distance (px) of a sample both cover its pixel, and its color tells neither distance.
pub(crate) const CROSSING_PX: f64 = 2.5;
/// Width (px) of residuals that stand out.
pub(crate) const STANDING_OUT_PX: f64 = 4.0;
/// Radius (px) around a seed whose samples tell its outward direction.
pub(crate) const DIRECTION_REACH_PX: f64 = 3.0;
/// Share of the samples beyond which an outline may not stand out.
pub(crate) const MOST_STANDING_OUT: f64 = 0.04;
/// Least share of the samples that a part must explain.
pub(crate) const LEAST_EXPLAINED: f64 = 0.1;
/// Least share of all samples by which each part must add to a set, and a set to the best part alone.
pub(crate) const PART_GAIN: f64 = 0.08;
/// Distance error (px) at which a sample counts as missed.
pub(crate) const UNION_WIDTH_PX: f64 = 0.5;
/// Least mean displacement of the outline, relative to the square root of its area.
pub(crate) const LEAST_SHIFT: f64 = 0.2;
/// A motion that leaves more of the outline inside in both directions is a symmetry of the union.
pub(crate) const MOST_INSIDE_TWICE: f64 = 0.8;
/// Distance (px) up to which a point lies inside while starts are compared, and after refinement.
pub(crate) const ROUGHLY_INSIDE_PX: f64 = 1.5;
/// See [`ROUGHLY_INSIDE_PX`].
pub(crate) const INSIDE_PX: f64 = 0.7;
/// Distances count up to this (px).
pub(crate) const FAR_PX: f64 = 5.0;
/// Share of the outline that a motion may leave unexplained.
pub(crate) const MOST_UNEXPLAINED: f64 = 0.08;
/// Distance (px) by which an outline may stand out of the union.
pub(crate) const STANDS_OUT_PX: f64 = 0.8;
/// Distance (px) beyond which a sample lies on neither outline.
pub(crate) const TWINS_ASTRAY_PX: f64 = 1.5;
/// Distance error (px) of a sample that agrees.
pub(crate) const AGREES_PX: f64 = 0.6;
/// Least share of the samples that must be carried to supported stretches, and of those that must agree.
pub(crate) const LEAST_TESTED: f64 = 0.25;
/// See [`LEAST_TESTED`].
pub(crate) const LEAST_AGREEING: f64 = 0.9;
/// Most samples that may be carried to where they are not allowed, as a share of all.
pub(crate) const MOST_FORBIDDEN: f64 = 0.06;

// What stays, and what is doubted.

/// A rendering that misses a pixel by this much in some channel does so visibly.
pub(crate) const VISIBLE_ERROR: f64 = 0.03;
/// Under noise, this many standard deviations are visible; a picture has about one such pixel in 5000 by chance.
pub(crate) const VISIBLE_NOISE: f64 = 4.0;
/// Objects of fewer flat pixels, or of less contrast, must show that they pay for their description.
pub(crate) const SURE_PIXELS: usize = 12;
/// See [`SURE_PIXELS`].
pub(crate) const SURE_CONTRAST: f64 = 0.03;
/// Standard deviation of what the outlines of such objects miss: those of a few pixels are not fitted as exactly as those of
/// many.
pub(crate) const ROUGH_NOISE: f64 = 0.015;
/// A color closer than this to the mean of two others, in every channel, may be their mixture.
pub(crate) const MEAN_OF_TWO_COLOR: f64 = 0.02;
/// Harmonics of a plain shape.
pub(crate) const PLAIN_HARMONICS: usize = 3;
/// Noise of a soft pixel beyond its own rounding: what the outline misses.
pub(crate) const SOFT_PIXEL_NOISE: f64 = 0.002;
/// Residual above which a pixel is no mixture of the colors around.
pub(crate) const MIXTURE_OUTLIER: f64 = 0.015;
/// Samples that miss the outline by more (px) are those of another object.
pub(crate) const COVARIANCE_ASTRAY_PX: f64 = 1.5;
/// Standard deviation (px) of what all samples of an outline, or of a part of it, miss alike at best: 64 vertices and rounded colors.
pub(crate) const SYSTEMATIC_PX: f64 = 0.002;
/// An object is sure if the IoU to expect of what is seen of it is at least this: one that agrees to 0.9 only counts as not found, and half of what
/// may be wrong by then is expected. `tests/report/stability.md` says what other values come to.
pub(crate) const SURE_IOU: f64 = 0.95;
/// Of a picture that a scene explains, less is left.
pub(crate) const UNEXPLAINED_SHARE: f64 = 0.01;
/// An object whose marginal gain is a smaller share of the picture's variance may as well not be there.
pub(crate) const IDLE_SHARE: f64 = 1e-3;
/// Colors closer than this, in every channel, may be one.
pub(crate) const ONE_COLOR: f64 = 0.02;

// Drawings that are mended.

/// Twice the area over the length of the outline (px), up to which what is drawn may be a piece of something thin: pens of charts and letters are one to
/// two pixels wide.
pub(crate) const PIECE_WIDTH_PX: f64 = 3.0;
/// Share of a thing's outline along which the picture shows something else, from which on it is no thing, or a piece of one.
pub(crate) const PIECE_WRONG: f64 = 0.3;
