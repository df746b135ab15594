//! The rings around what the pen touches.

use alloc::vec;
use alloc::vec::Vec;

use super::leg::{At, Frame, Leg, legs_of};
use super::place::Source;
use super::{Cap, Join, Stroke};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{End, Piece, PieceGrad};
use crate::shape::{Outline, ShapeError};

/// The side of the normal, 1, or the other, -1.
pub(super) type Side = i8;

/// Rings that cross each other, and where their vertices come from.
pub(super) struct Raw<T> {
    pub(super) outline: Outline<T>,
    pub(super) legs: Vec<Leg<T>>,
    /// How many legs each line has.
    pub(super) leg_counts: Vec<usize>,
    half: T,
    sources: Vec<Source<T>>,
    places: Vec<Vec2<T>>,
    /// The source of each vertex of the outline.
    indices: Vec<usize>,
}

/// Goes along the lines and notes the vertices beside them.
pub(super) struct Walker<'a, T> {
    pub(super) legs: &'a [Leg<T>],
    pub(super) half: T,
    pub(super) tolerance: T,
    pub(super) join: Join<T>,
    pub(super) sources: Vec<Source<T>>,
    pub(super) places: Vec<Vec2<T>>,
    /// The chains of sources to both sides: of -1, then of 1.
    pub(super) chains: [Vec<usize>; 2],
    /// Whether the sides met those of the leg before in one vertex, so that a line needs none of its own at its start.
    pub(super) has_tip: [bool; 2],
    /// Rings of their own.
    pub(super) islands: Vec<Vec<usize>>,
    /// Memory for parameters of cubics.
    pub(super) parameters: Vec<T>,
}

/// Least tolerance per half width: a sharp turn may come after each cut of a cubic, and all of them together must not eat the
/// memory. A round cap then has 300 edges.
const LEAST_TOLERANCE: f64 = 1e-5;

/// The rings of a stroke.
pub(super) fn walk<T: Real>(stroke: &Stroke<T>, tolerance: T) -> Result<Raw<T>, ShapeError> {
    let half = stroke.width.abs() * T::of(0.5);
    let (mut legs, mut spans) = (Vec::new(), Vec::new());
    for ring in &stroke.rings {
        let first = legs.len();
        let is_closed = legs_of(ring, &mut legs)?;
        spans.push((first..legs.len(), is_closed));
    }
    let mut walker = Walker {
        legs: &legs,
        half,
        tolerance: tolerance.max(half * T::of(LEAST_TOLERANCE)),
        join: stroke.join,
        sources: Vec::new(),
        places: Vec::new(),
        chains: [Vec::new(), Vec::new()],
        has_tip: [false; 2],
        islands: Vec::new(),
        parameters: Vec::new(),
    };
    let (mut outline, mut indices) = (Outline::default(), Vec::new());
    if half > T::zero() {
        for (span, is_closed) in spans.iter().filter(|(span, _)| !span.is_empty()) {
            for leg in span.clone() {
                walker.along(leg);
                if leg + 1 < span.end {
                    walker.corner(At::End(leg, End::Finish), At::End(leg + 1, End::Start));
                } else if *is_closed {
                    walker.corner(At::End(leg, End::Finish), At::End(span.start, End::Start));
                }
            }
            let rings = walker.close(stroke, span.clone(), *is_closed);
            for ring in rings.iter().chain(&core::mem::take(&mut walker.islands)) {
                outline.push_ring(ring.iter().map(|&source| walker.places[source].to_array()));
                indices.extend_from_slice(ring);
            }
        }
    }
    if !outline.vertices.as_flattened().iter().all(|value| value.is_finite()) {
        return Err(ShapeError::TooLarge);
    }
    let (sources, places) = (walker.sources, walker.places);
    let leg_counts = spans.into_iter().map(|(span, _)| span.len()).collect();
    Ok(Raw { outline, leg_counts, half, sources, places, indices, legs })
}

impl<T: Real> Walker<'_, T> {
    /// The rings of a line from the chains to both sides of it.
    fn close(&mut self, stroke: &Stroke<T>, span: core::ops::Range<usize>, is_closed: bool) -> Vec<Vec<usize>> {
        let [mut ahead, mut back] = core::mem::take(&mut self.chains);
        let has_tip = core::mem::take(&mut self.has_tip);
        if is_closed {
            // The first vertices came before the corner at the start.
            for (chain, has_tip) in [&mut ahead, &mut back].into_iter().zip(has_tip) {
                if has_tip && self.is_straight(span.start) {
                    chain.remove(0);
                }
            }
            back.reverse();
            return vec![ahead, back];
        }
        if stroke.cap == Cap::Square {
            for chain in [&mut ahead, &mut back] {
                if self.is_straight(span.end - 1) {
                    chain.pop();
                }
                if self.is_straight(span.start) {
                    chain.remove(0);
                }
            }
        }
        back.reverse();
        let caps = [(span.end - 1, End::Finish), (span.start, End::Start)];
        let [finish, start] = caps.map(|(leg, end)| self.cap(stroke.cap, At::End(leg, end)));
        ahead.extend(finish);
        ahead.append(&mut back);
        ahead.extend(start);
        vec![ahead]
    }

    /// Notes a vertex.
    pub(super) fn add(&mut self, source: Source<T>) -> usize {
        self.places.push(source.place(self.legs, self.half, &self.places));
        self.sources.push(source);
        self.sources.len() - 1
    }

    /// Notes a vertex and appends it to the chain of a side.
    pub(super) fn add_to(&mut self, side: Side, source: Source<T>) {
        let index = self.add(source);
        self.chains[usize::from(side > 0)].push(index);
    }

    /// Whether a leg is a line.
    pub(super) fn is_straight(&self, leg: usize) -> bool {
        matches!(self.legs[leg].piece, Piece::Line { .. })
    }

    pub(super) fn frame(&self, at: At<T>) -> Frame<T> {
        self.legs[at.leg()].frame(at)
    }
}

impl<T: Real> Raw<T> {
    /// The gradients of the pieces of the legs and of half the width, given those of the vertices of the outline.
    pub(super) fn vjp(&self, grad_vertices: &[[T; 2]]) -> (Vec<PieceGrad<T>>, T) {
        let mut grads = vec![Vec2::default(); self.sources.len()];
        for (&source, &grad) in self.indices.iter().zip(grad_vertices) {
            grads[source] += Vec2::from(grad);
        }
        let (mut grad_legs, mut grad_half) = (vec![PieceGrad::default(); self.legs.len()], T::zero());
        // Backward: a crossing hands its gradient to earlier ones.
        for (index, source) in self.sources.iter().enumerate().rev() {
            let (earlier, rest) = grads.split_at_mut(index);
            if let Some(&grad) = rest.first().filter(|&&grad| grad != Vec2::default()) {
                grad_half += source.place_vjp(&self.legs, self.half, &self.places, grad, earlier, &mut grad_legs);
            }
        }
        (grad_legs, grad_half)
    }
}
