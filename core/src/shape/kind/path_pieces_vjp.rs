//! The way back from exact pieces to the numbers of a ring.

use alloc::vec;
use alloc::vec::Vec;

use super::path::{PathRing, Segment};
use super::path_pieces::{LEAST_DIVISOR, bulge_divisor};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::ShapeError;
use crate::shape::curve::{End, Piece, PieceGrad};

/// Gradients of the numbers that one segment depends on.
struct SegmentGrad<'a, T> {
    points: &'a mut [[T; 2]],
    ends: [usize; 2],
    /// Of its own numbers.
    numbers: &'a mut [T],
}

impl<T: Real> SegmentGrad<'_, T> {
    fn add_end(&mut self, end: usize, grad: Vec2<T>) {
        let point = &mut self.points[self.ends[end]];
        *point = (Vec2::from(*point) + grad).to_array();
    }

    /// Adds the gradient of the point whose coordinates are the segment's own numbers `first` and the next.
    fn add_control(&mut self, first: usize, grad: Vec2<T>) {
        self.numbers[first] += grad.x;
        self.numbers[first + 1] += grad.y;
    }
}

impl<T: Real> PathRing<T> {
    /// Adds the gradient of the ring's numbers, given that of its pieces: of the segments, and of the line that closes an
    /// open ring if it has one.
    ///
    /// # Errors
    /// As [`Self::pieces`].
    pub(in crate::shape) fn pieces_vjp(
        &self,
        grads: &[PieceGrad<T>],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        let (mut arrival, order) = self.order()?;
        let mut before = vec![arrival; self.segments.len()];
        for k in order.clone() {
            before[k] = arrival;
            arrival = self.piece(k, arrival).direction(End::Finish).unwrap_or(arrival);
        }
        let mut starts = Vec::with_capacity(self.segments.len());
        let mut start = 0;
        for segment in &self.segments {
            starts.push(start);
            start += segment.number_count();
        }
        let (points, numbers) = grad_numbers.split_at_mut(2 * self.points.len());
        let points = points.as_chunks_mut::<2>().0;
        let mut pull_back = |k: usize, grad: &PieceGrad<T>| {
            let numbers = &mut numbers[starts[k]..][..self.segments[k].number_count()];
            let mut sink = SegmentGrad { points: &mut *points, ends: self.end_points(k), numbers };
            self.piece_vjp(k, before[k], grad, &mut sink)
        };
        // Of the direction in which the segment at hand arrives, from the one after it.
        let mut grad_arrival = Vec2::default();
        for k in order.clone().rev() {
            let mut grad = grads.get(k).copied().unwrap_or_default();
            let passed_on = self.arrival_vjp(k, before[k], grad_arrival, &mut grad);
            grad_arrival = pull_back(k, &grad) + passed_on;
        }
        if let (true, Some(k)) = (self.is_closed(), order.last()) {
            // The direction before the first in order does not depend on that before the last one.
            let mut grad = PieceGrad::default();
            self.arrival_vjp(k, before[k], grad_arrival, &mut grad);
            pull_back(k, &grad);
        }
        if let (false, Some(grad)) = (self.is_closed(), grads.get(self.segments.len())) {
            for (end, grad) in [(points.len() - 1, grad.points[0]), (0, grad.points[1])] {
                points[end] = (Vec2::from(points[end]) + grad).to_array();
            }
        }
        Ok(())
    }

    /// Adds the gradient of the direction in which segment `k` arrives to that of its piece; returns what goes to the direction
    /// before it, which a segment without length passes on.
    fn arrival_vjp(&self, k: usize, before: Vec2<T>, grad: Vec2<T>, grad_piece: &mut PieceGrad<T>) -> Vec2<T> {
        let piece: Piece<T> = self.piece(k, before);
        if piece.direction(End::Finish).is_none() {
            return grad;
        }
        piece.direction_vjp(End::Finish, grad, grad_piece);
        Vec2::default()
    }

    /// Returns the gradient of the direction before.
    fn piece_vjp(&self, k: usize, before: Vec2<T>, grad: &PieceGrad<T>, sink: &mut SegmentGrad<'_, T>) -> Vec2<T> {
        sink.add_end(0, grad.points[0]);
        match self.segments[k] {
            Segment::Line => sink.add_end(1, grad.points[1]),
            Segment::Arc { .. } => {
                sink.add_end(1, grad.points[1]);
                sink.numbers[0] += grad.bulge;
            }
            Segment::SmoothArc => {
                sink.add_end(1, grad.points[1]);
                return self.smooth_bulge_vjp(k, before, grad.bulge, sink);
            }
            Segment::Cubic { .. } => {
                sink.add_control(0, grad.points[1]);
                sink.add_control(2, grad.points[2]);
                sink.add_end(1, grad.points[3]);
            }
            Segment::SmoothCubic { handle, .. } => {
                sink.add_end(0, grad.points[1]);
                sink.numbers[0] += grad.points[1].dot(before);
                sink.add_control(1, grad.points[2]);
                sink.add_end(1, grad.points[3]);
                return grad.points[1] * handle;
            }
        }
        Vec2::default()
    }

    /// The way back of the bulge of a smooth arc.
    fn smooth_bulge_vjp(&self, k: usize, before: Vec2<T>, grad: T, sink: &mut SegmentGrad<'_, T>) -> Vec2<T> {
        let piece = self.piece(k, before);
        let chord = piece.to() - piece.from();
        let (length, divisor) = (chord.length(), bulge_divisor(before, chord));
        if divisor <= T::zero() {
            return Vec2::default();
        }
        // bulge = before x chord / divisor.
        let grad_cross = grad / divisor;
        let grad_divisor = -grad_cross * before.cross(chord) / divisor;
        let mut grad_before = -chord.perp() * grad_cross;
        let mut grad_chord = before.perp() * grad_cross;
        if length + before.dot(chord) > length * T::of(LEAST_DIVISOR) {
            grad_before += chord * grad_divisor;
            grad_chord += (chord / length + before) * grad_divisor;
        } else {
            grad_chord += chord / length * (grad_divisor * T::of(LEAST_DIVISOR));
        }
        sink.add_end(0, -grad_chord);
        sink.add_end(1, grad_chord);
        grad_before
    }
}
