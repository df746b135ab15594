//! The ladder of outlines: the shortest description of a boundary.
//!
//! In: samples of a boundary. Out: the [`Outline`] whose numbers and misfit cost the fewest bits together.
//!
//! | file | holds |
//! |---|---|
//! | `track` | samples in order, with what pieces are scored by |
//! | `nodes` | places where pieces may meet |
//! | `moments`, `cubic` | how well a line, a circle, a cubic explains a stretch |
//! | `programme` | the cheapest row of pieces: a dynamic programme |
//! | `chain`, `gauge`, `equations`, `skyline`, `solve` | all numbers of a row of pieces together, by least squares |
//! | `ties` | lines along the axes, smooth joins, equal radii, where they make the description shorter |
//! | `revise` | curves joined, left out, put in at corners |
//! | `mend` | polygons where all that is far off |
//! | `path` | from samples to a path |
//! | `as_ring` | outlines of any kind as rings of lines, arcs and cubics |
//! | `behind` | regular polygons and stars that show one side, or one tip |
//! | `bent` | what windows across circles and ellipses are off by |
//! | `rectilinear` | upright and level sides that are known exactly |
//! | `figure`, `conic`, `whole`, `trial` | circles, ellipses, rectangles, regular polygons and stars, fitted to all samples |

mod as_ring;
pub(crate) use as_ring::moved;
mod behind;
mod bent;
mod chain;
mod conic;
mod cubic;
mod equations;
mod figure;
mod gauge;
mod mend;
mod moments;
mod nodes;
mod path;
mod programme;
mod rectilinear;
mod revise;
mod skyline;
pub(crate) use skyline::Skyline;
mod solve;
#[cfg(test)]
mod tests;
mod ties;
mod track;
mod trial;
mod whole;

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::PathRing;

use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};
use path::FittedPath;
use track::Track;

/// An arc of more bulge (the tangent of a quarter of its turn) is more than three quarters of a turn: where it ends beside its start only the tiny
/// distance between both tells its radius.
pub(crate) const MOST_BULGE: f64 = 2.414;

/// An outline, in pixels, and what it costs.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// The outline.
    pub shape: OutlineShape,
    /// Bits of its numbers and of its structure.
    pub bits: f64,
    /// Bits of what it misses the samples by.
    pub misfit: f64,
    /// Covariance, row by row, of the numbers of a circle (x and y of its middle, radius), an ellipse (middle, radii, angle) or a rectangle
    /// (middle, width, height, corner radius, angle), in pixels and radians, from what the samples are found to be off by. 0 for numbers
    /// that are not fitted (the angle of what is upright); empty for other kinds.
    pub covariance: Vec<f64>,
}

/// The kinds of outlines that are tried.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum OutlineShape {
    /// A circle.
    Circle {
        /// Its middle.
        center: Vec2<f64>,
        /// Its radius.
        radius: f64,
    },
    /// An ellipse.
    Ellipse {
        /// Its middle.
        center: Vec2<f64>,
        /// Half its width and height before it is turned.
        radii: [f64; 2],
        /// The turn from +x to +y, radians.
        angle: f64,
    },
    /// A rectangle, with round corners or sharp ones.
    Rectangle {
        /// Its middle.
        center: Vec2<f64>,
        /// Width and height before it is turned.
        size: [f64; 2],
        /// Radius of its corners; 0 if they are sharp.
        corner_radius: f64,
        /// The turn from +x to +y, radians.
        angle: f64,
    },
    /// A polygon of equal sides and angles.
    RegularPolygon {
        /// Its middle.
        center: Vec2<f64>,
        /// How many sides it has.
        sides: usize,
        /// From the middle to its corners.
        radius: f64,
        /// From +x toward +y to its first corner, radians.
        angle: f64,
    },
    /// A star.
    Star {
        /// Its middle.
        center: Vec2<f64>,
        /// How many points it has.
        points: usize,
        /// From the middle to the points, and to the corners between them.
        radii: [f64; 2],
        /// From +x toward +y to its first point, radians.
        angle: f64,
    },
    /// A closed path of lines, arcs and cubics.
    Path(PathRing<f64>),
}

/// An open line and what it costs.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenFit {
    /// Its pieces, in pixels.
    pub path: PathRing<f64>,
    /// Bits of its numbers and of its structure.
    pub bits: f64,
    /// Bits of what it misses the samples by.
    pub misfit: f64,
}

/// The shortest description of a closed boundary. Where it is hidden the outline goes straight on, or to a corner if the
/// directions beside meet in one not far away, or straight across.
///
/// None if fewer than three samples can be used.
#[must_use]
pub fn fit_closed(ring: &RingSamples, ruler: &Ruler) -> Option<Outline> {
    let mut track = Track::of_ring(ring)?;
    if let Some(outline) = rectilinear::fit(&track, ruler) {
        return Some(outline);
    }
    if let Some(outline) = whole::fit_plain(&track, ruler) {
        return Some(outline);
    }
    let draft = path::draft_ring(&mut track, ruler)?;
    // A whole outline is looked for along the path as it was cut: where that is far off, what mends it has corners that nobody drew.
    let mended = draft.mended(&track, ruler);
    let ring = if mended.is_some() { Some(draft.ring()) } else { None };
    let path = mended.unwrap_or_else(|| draft.finish(&track, ruler));
    let whole = whole::fit(&track, ring.as_ref().unwrap_or(&path.ring), path.bits + path.misfit, ruler);
    let FittedPath { ring, bits, misfit } = path;
    whole.or(Some(Outline { shape: OutlineShape::Path(ring), bits, misfit, covariance: Vec::new() }))
}

/// The circle or ellipse, of those that may be, that describes what is seen of a boundary best; none if there is none, or it is not known to half a pixel.
#[must_use]
pub(crate) fn fit_round(
    ring: &RingSamples,
    most: f64,
    ruler: &Ruler,
    may_be: &dyn Fn(&Outline) -> bool,
) -> Option<Outline> {
    whole::fit_round(&Track::of_ring(ring)?, most, ruler, may_be)
}

/// The shortest description of an open line through samples.
///
/// None if fewer than three samples can be used.
#[must_use]
pub fn fit_open(samples: &[Sample], ruler: &Ruler) -> Option<OpenFit> {
    let track = Track::of_line(samples)?;
    let FittedPath { ring, bits, misfit } = path::fit_line(&track, ruler)?;
    Some(OpenFit { path: ring, bits, misfit })
}
