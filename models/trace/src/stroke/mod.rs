//! Strokes: the lines of a pen of constant width that drew a face, if that is what it is.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `mod.rs` | the boundary of a face | [`StrokeFit`] |
//! | `border` | samples | marks that know their inside, and what lies across from them |
//! | `branch` | marks that face each other a width apart | branches, and the nodes where they end |
//! | `chain` | branches, nodes | chains through junctions and around corners |
//! | `center` | chains of center points | lines of lines, arcs and cubics, with their ends |
//! | `bend` | lines with corners | arcs where the outer side of the boundary cuts past them |
//! | `piece`, `draw` | lines, a width | how far a point is outside of what they draw |
//! | `refine` | lines, marks | all numbers at once, what they miss and what they cost |
//! | `thin` | positions across lines without pure pixels | strokes |
//!
//! *Why the boundary alone says which lines there are*: a walk along the boundary of a drawing of lines has each line once on
//! its right, going, and once more, coming back. What follows what on the boundary is the order of lines around their junctions;
//! no skeleton of pixels is needed, and every position keeps the precision of the samples.

mod bend;
mod border;
mod branch;
mod center;
mod chain;
mod draw;
pub(crate) mod piece;
mod refine;
#[cfg(test)]
mod tests;
mod thin;

use alloc::vec::Vec;

use dvp_core::shape::{Cap, Join, Segment, Stroke};

use crate::ruler::Ruler;
use crate::sample::RingSamples;
use crate::tuning;
use border::Border;
use draw::{Drawing, Line, MITER_LIMIT};
use refine::Refined;

pub use thin::{ThinChain, ThinSample, fit_thin};

/// Strokes that together explain a face. All lengths in pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeFit {
    /// The strokes: one for all lines with round ends, one for all lines with straight ones. They have the same width.
    pub strokes: Vec<Stroke<f64>>,
    /// Bits of the numbers and kinds.
    pub bits: f64,
    /// Bits of what all samples of the face miss by.
    pub misfit: f64,
}

/// The strokes that drew a face, given the samples of its outer boundary and of its holes; none if the face is not that wide
/// everywhere, or its boundary is not that of such strokes, or they are one bar, which a rectangle says as well.
///
/// How far samples are off is measured on the face itself: the width of a pen does not change. Both prices are by that noise,
/// which may be more than what the samples say of themselves.
#[must_use]
pub fn fit_strokes(rings: &[RingSamples], ruler: &Ruler) -> Option<StrokeFit> {
    let mut border = Border::new(rings);
    let width = branch::pen_width(&border)?;
    let skeleton = branch::skeleton(&border, width);
    border.marks.iter_mut().for_each(|mark| mark.sigma = mark.sigma.max(skeleton.noise.single));
    let chains = chain::chains(&border, &skeleton);
    let mut drawing = center::lines(&border, &chains, skeleton.width, ruler)?;
    // A straight line with straight ends is a rectangle.
    let is_bar = |line: &Line| line.cap == Cap::Butt && matches!(line.ring.segments[..], [Segment::Line]);
    if matches!(&drawing.lines[..], []) || matches!(&drawing.lines[..], [line] if is_bar(line)) {
        return None;
    }
    // Without corners and ends to go by, lines with straight ends have mitered corners.
    drawing.is_mitered = drawing.lines.iter().any(|line| line.cap == Cap::Butt);
    if refine::strays(&drawing, &border, 2.0 * tuning::STROKE_STRAY) > tuning::STROKE_MOST_LOOSE {
        return None;
    }
    let price = |refined: &Refined| refined.bits + ruler.misfit(refined.chi2);
    let refine = |drawing: Drawing| refine::refine(drawing, &border, skeleton.noise.block, ruler);
    let mut refined = refine(drawing)?;
    for propose in [refine::other_join, bend::round_corners] {
        let other = propose(&refined.drawing, &border).and_then(refine);
        if let Some(other) = other.filter(|other| price(other) < price(&refined)) {
            refined = other;
        }
    }
    if refine::strays(&refined.drawing, &border, tuning::STROKE_STRAY) > tuning::STROKE_MOST_STRAYS {
        return None;
    }
    Some(StrokeFit { strokes: strokes(&refined.drawing), bits: refined.bits, misfit: ruler.misfit(refined.chi2) })
}

/// The lines by their ends.
fn strokes(drawing: &Drawing) -> Vec<Stroke<f64>> {
    let width = 2.0 * drawing.half_width;
    let join = if drawing.is_mitered { Join::Miter { limit: MITER_LIMIT } } else { Join::Round };
    let of = |cap: Cap| {
        let rings = drawing.lines.iter().filter(|line| line.cap == cap).map(|line| line.ring.clone()).collect();
        Stroke { rings, width, cap, join }
    };
    [of(Cap::Round), of(Cap::Butt)].into_iter().filter(|stroke| !stroke.rings.is_empty()).collect()
}
