//! The way back from exact pieces to the numbers of a ring.

use alloc::vec;
use alloc::vec::Vec;

use super::path::{PathRing, Segment};
use super::path_pieces::{LEAST_DIVISOR, bulge_divisor};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::ShapeError;
use crate::shape::curve::{PieceGrad, sweep};

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

    /// Adds the gradient of the vector from start to end.
    fn add_chord(&mut self, grad: Vec2<T>) {
        self.add_end(0, -grad);
        self.add_end(1, grad);
    }

    /// Adds the gradient of the point whose coordinates are the segment's own numbers `first` and the next.
    fn add_control(&mut self, first: usize, grad: Vec2<T>) {
        self.numbers[first] += grad.x;
        self.numbers[first + 1] += grad.y;
    }
}

impl<T: Real> PathRing<T> {
    /// Adds the gradient of the ring's numbers, given that of its pieces: of the segments, and of the line that closes an
    /// open ring.
    pub(super) fn pieces_vjp(&self, grads: &[PieceGrad<T>], grad_numbers: &mut [T]) -> Result<(), ShapeError> {
        let (first, order) = self.order()?;
        let mut before = vec![first; self.segments.len()];
        for (k, next) in order.clone().zip(order.clone().skip(1)) {
            before[next] = self.arrival(k, before[k]);
        }
        let starts: Vec<usize> = self
            .segments
            .iter()
            .scan(0, |start, segment| {
                *start += segment.number_count();
                Some(*start - segment.number_count())
            })
            .collect();
        let (points, numbers) = grad_numbers.split_at_mut(2 * self.points.len());
        let points = points.as_chunks_mut::<2>().0;
        let mut of_segment = |k: usize, add: &mut dyn FnMut(SegmentGrad<'_, T>) -> Vec2<T>| {
            let ends = [k, if k + 1 < self.points.len() { k + 1 } else { 0 }];
            add(SegmentGrad { points, ends, numbers: &mut numbers[starts[k]..][..self.segments[k].number_count()] })
        };
        // Of the direction in which the segment at hand arrives, from the one after it.
        let mut grad_arrival = Vec2::default();
        for k in order.clone().rev() {
            let grad = grads.get(k).copied().unwrap_or_default();
            grad_arrival = of_segment(k, &mut |mut sink| {
                let grad_before = self.arrival_vjp(k, before[k], grad_arrival, &mut sink);
                grad_before + self.piece_vjp(k, before[k], &grad, &mut sink)
            });
        }
        if let (true, Some(k)) = (self.is_closed(), order.last()) {
            of_segment(k, &mut |mut sink| self.arrival_vjp(k, Vec2::default(), grad_arrival, &mut sink));
        }
        if let (false, Some(point), Some(grad)) = (self.is_closed(), points.last_mut(), grads.get(self.segments.len()))
        {
            *point = (Vec2::from(*point) + grad.points[0]).to_array();
            points[0] = (Vec2::from(points[0]) + grad.points[1]).to_array();
        }
        Ok(())
    }

    /// Returns the gradient of the direction before.
    fn piece_vjp(&self, k: usize, before: Vec2<T>, grad: &PieceGrad<T>, sink: &mut SegmentGrad<'_, T>) -> Vec2<T> {
        let [from, to] = self.ends(k);
        sink.add_end(0, grad.points[0]);
        match self.segments[k] {
            Segment::Line => sink.add_end(1, grad.points[1]),
            Segment::Arc { .. } => {
                sink.add_end(1, grad.points[1]);
                sink.numbers[0] += grad.bulge;
            }
            Segment::SmoothArc => {
                sink.add_end(1, grad.points[1]);
                return smooth_bulge_vjp(before, to - from, grad.bulge, sink);
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

    /// Returns the gradient of the direction before.
    fn arrival_vjp(&self, k: usize, before: Vec2<T>, grad: Vec2<T>, sink: &mut SegmentGrad<'_, T>) -> Vec2<T> {
        let two = T::of(2.0);
        let direction = self.arriving(k);
        let (mut grad_direction, mut grad_before) = (grad, Vec2::default());
        match self.segments[k] {
            Segment::Arc { bulge } => {
                let turn = Vec2::from_angle(sweep(bulge) * T::of(0.5));
                sink.numbers[0] += grad.dot(direction.turned(turn).perp()) * two / (T::one() + bulge * bulge);
                grad_direction = grad.turned(Vec2::new(turn.x, -turn.y));
            }
            Segment::SmoothArc => {
                grad_direction = (grad * before.dot(direction) + before * grad.dot(direction)) * two;
                grad_before = direction * (two * grad.dot(direction)) - grad;
            }
            _ => {}
        }
        let approaches = self.approaches(k);
        let Some(which) = approaches.iter().position(|vector| vector.length() > T::zero()) else { return grad_before };
        let grad_vector = (grad_direction - direction * direction.dot(grad_direction)) / approaches[which].length();
        match (&self.segments[k], which) {
            (Segment::Cubic { .. }, 0 | 1) => {
                sink.add_end(1, grad_vector);
                sink.add_control(2 - 2 * which, -grad_vector);
            }
            (Segment::SmoothCubic { .. }, 0) => {
                sink.add_end(1, grad_vector);
                sink.add_control(1, -grad_vector);
            }
            _ => sink.add_chord(grad_vector),
        }
        grad_before
    }
}

/// The way back of the bulge of a smooth arc.
fn smooth_bulge_vjp<T: Real>(before: Vec2<T>, chord: Vec2<T>, grad: T, sink: &mut SegmentGrad<'_, T>) -> Vec2<T> {
    let length = chord.length();
    let divisor = bulge_divisor(before, chord);
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
    sink.add_chord(grad_chord);
    grad_before
}
