//! Rings that cross themselves and each other, made into rings that do not: what they fill by a rule is what the new rings
//! fill by the even-odd rule, each edge with the inside on one side of it only.
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `grid` | vertices | the same on a grid of whole numbers, where every test of sides is exact |
//! | `split` | edges on the grid | edges that meet at their ends only |
//! | `winding` | these | those with the inside on one side, directed |
//! | `chain` | these | rings, and for each vertex where it comes from, [`Origin`] |
//! | `origin` | an [`Origin`] | its place; the way back is in `origin_vjp` |
//!
//! *Why a grid*: with rounded numbers, tests of sides contradict each other where edges nearly coincide, which is the
//! normal case in strokes, and rings fall apart. On the grid, crossings are rounded too, and the edges are bent to
//! go through them, until none is left (snap rounding: Hobby, "Practical segment intersection with finite precision output",
//! 1999). The grid decides which vertices the rings have; where they stand is worked out from the vertices that came in,
//! in full precision, so that it has a derivative. The grid is 2^-28 of half the size.

mod chain;
mod grid;
mod origin;
mod origin_vjp;
mod split;
#[cfg(test)]
mod tests;
mod winding;

use alloc::vec;
use alloc::vec::Vec;

use super::{Outline, Rings, ShapeError};
use crate::real::Real;

pub(super) use origin::{Origin, line_crossing};
pub(super) use origin_vjp::line_crossing_vjp;

/// Which points rings fill, by how often the rings wind around them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum FillRule {
    /// Those that an odd number of turns goes around.
    #[default]
    EvenOdd,
    /// Those around which the turns of both directions do not cancel.
    NonZero,
}

impl FillRule {
    pub(super) fn is_inside(self, winding: i32) -> bool {
        match self {
            Self::EvenOdd => winding % 2 != 0,
            Self::NonZero => winding != 0,
        }
    }
}

/// Rings that neither cross nor overlap, the inside on the side to which +x turns to +y: outer rings turn from +x to +y, holes the
/// other way.
#[derive(Clone, Debug, Default)]
pub(super) struct Resolved<T> {
    /// Where each vertex comes from.
    pub(super) origins: Vec<Origin<T>>,
    /// Where each ring but the first starts.
    pub(super) breaks: Vec<usize>,
}

/// The rings that bound what `rings` fill by `rule`.
///
/// # Errors
/// [`ShapeError::NotFinite`], [`ShapeError::TooLarge`] if the size overflows.
pub(super) fn resolve<T: Real>(rings: Rings<'_, T>, rule: FillRule) -> Result<Resolved<T>, ShapeError> {
    let Some(grid) = grid::Grid::around(rings.vertices)? else { return Ok(Resolved::default()) };
    let sources = grid.edges(rings);
    let mut edges = sources.edges;
    split::split(&mut edges);
    let kept = winding::keep(edges, rule);
    Ok(chain::chain(&kept, &sources.next, &grid, rings.vertices))
}

impl<T: Real> Rings<'_, T> {
    /// Rings that neither cross nor overlap and fill by the even-odd rule what these fill by `rule`: outer rings turn from
    /// +x to +y, holes the other way.
    ///
    /// # Errors
    /// [`ShapeError::NotFinite`], [`ShapeError::TooLarge`] if the size overflows.
    pub fn resolved(&self, rule: FillRule) -> Result<Outline<T>, ShapeError> {
        let mut outline = Outline::default();
        resolve(*self, rule)?.append(self.vertices, &mut outline);
        Ok(outline)
    }
}

impl<T: Real> Resolved<T> {
    /// Appends the rings, given the vertices that came in.
    pub(super) fn append(&self, vertices: &[[T; 2]], outline: &mut Outline<T>) {
        outline.start_ring();
        let first = outline.vertices.len();
        outline.vertices.extend(self.origins.iter().map(|origin| origin.place(vertices).to_array()));
        outline.breaks.extend(self.breaks.iter().map(|start| first + start));
    }

    /// The gradient of the vertices that came in, given that of the vertices that [`Self::append`] writes.
    ///
    /// # Errors
    /// [`ShapeError::Length`] if there is not one gradient per vertex.
    pub(super) fn vjp(&self, vertices: &[[T; 2]], grad: &[[T; 2]]) -> Result<Vec<[T; 2]>, ShapeError> {
        let (expected, len) = (self.origins.len(), grad.len());
        if len != expected {
            return Err(ShapeError::Length { what: "gradient of the vertices", expected, len });
        }
        let mut grad_vertices = vec![[T::zero(); 2]; vertices.len()];
        for (origin, &grad) in self.origins.iter().zip(grad) {
            origin.place_vjp(vertices, grad.into(), &mut grad_vertices);
        }
        Ok(grad_vertices)
    }
}
