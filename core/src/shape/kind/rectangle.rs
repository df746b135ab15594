//! Rectangles around the origin, with round corners or without.

use alloc::string::String;
use alloc::vec::Vec;

use super::{PoseFreedom, Shape, check_positive, shape_of_numbers};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{Boundary, Piece, PieceGrad};
use crate::shape::{Flattening, Outline, ShapeError};

/// tan(pi / 8): the bulge of a quarter circle.
const QUARTER: f64 = core::f64::consts::SQRT_2 - 1.0;

/// The corners, in the order of the outline: from +x +y by way of -x +y.
const CORNERS: [[f64; 2]; 4] = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];

/// A rectangle around the origin, its sides along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle<T> {
    /// Width, along x, and height, along y.
    pub size: [T; 2],
    /// Radius of the quarter circles at the corners; held to at most half the shorter side. 0 for sharp corners.
    pub corner_radius: T,
}

impl<T: Real> Rectangle<T> {
    /// A rectangle.
    ///
    /// # Errors
    /// [`ShapeError::NotPositive`] if a side is not, or the corner radius is negative.
    pub fn new(size: [T; 2], corner_radius: T) -> Result<Self, ShapeError> {
        size.into_iter().try_for_each(|side| check_positive("side", side))?;
        if corner_radius < T::zero() || !corner_radius.is_finite() {
            return Err(ShapeError::NotPositive { what: "corner radius" });
        }
        Ok(Self { size, corner_radius })
    }

    /// The corner radius as it is drawn: at most half the shorter side, at least 0.
    #[must_use]
    pub fn held_radius(&self) -> T {
        self.corner_radius.min(self.size[0].abs().min(self.size[1].abs()) * T::of(0.5)).max(T::zero())
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        let half = Vec2::new(self.size[0], self.size[1]) * T::of(0.5);
        let mut boundary = Boundary::default();
        let radius = self.held_radius();
        if radius <= T::zero() {
            boundary.push_polygon(&CORNERS.map(|[x, y]| Vec2::new(half.x * T::of(x), half.y * T::of(y))));
            return Ok(boundary);
        }
        // A side of negative length mirrors the outline.
        let sign = [half.x.signum(), half.y.signum()];
        let inner = Vec2::new(half.x - radius * sign[0], half.y - radius * sign[1]);
        let bulge = T::of(QUARTER) * sign[0] * sign[1];
        let ends = CORNERS.map(|corner| arc_ends(corner, half, inner));
        for (&[from, to], [next, _]) in ends.iter().zip(ends.iter().cycle().skip(1)) {
            boundary.pieces.push(Piece::Arc { from, to, bulge });
            boundary.pieces.push(Piece::Line { from: to, to: *next });
        }
        Ok(boundary)
    }

    fn boundary_vjp(&self, grads: &[PieceGrad<T>]) -> [T; 3] {
        let (zero, half) = (T::zero(), T::of(0.5));
        let (mut grad_half, mut grad_inner) = (Vec2::default(), Vec2::default());
        let radius = self.held_radius();
        if radius <= zero {
            for (grad, [x, y]) in grads.iter().zip(CORNERS) {
                grad_half += Vec2::new(grad.points[0].x * T::of(x), grad.points[0].y * T::of(y));
            }
            return [grad_half.x * half, grad_half.y * half, zero];
        }
        for (pair, corner) in grads.chunks(2).zip(CORNERS) {
            let [x, y] = corner.map(T::of);
            let [arc, line] = [0, 1].map(|k| pair.get(k).copied().unwrap_or_default());
            // An arc ends where the line after it starts.
            let mut ends = [arc.points[0], arc.points[1] + line.points[0]];
            if turns_to_y(corner) {
                ends.reverse();
            }
            let [beside, below] = ends;
            grad_half += Vec2::new(beside.x * x, below.y * y);
            grad_inner += Vec2::new(below.x * x, beside.y * y);
        }
        let grad_side = (grad_half + grad_inner) * half;
        let mut grads = [grad_side.x, grad_side.y, zero];
        let grad_radius = -(grad_inner.x * self.size[0].signum() + grad_inner.y * self.size[1].signum());
        let shorter = usize::from(self.size[1].abs() < self.size[0].abs());
        if self.corner_radius <= self.size[shorter].abs() * half {
            grads[2] = grad_radius;
        } else {
            grads[shorter] += grad_radius * half * self.size[shorter].signum();
        }
        grads
    }
}

/// Whether the arc at a corner leads from the side along y to the side along x; at the other two it is the other way.
fn turns_to_y([x, y]: [f64; 2]) -> bool {
    x * y < 0.0
}

/// Start and end of the arc at a corner; `half` the sides' halves, `inner` those without the radius.
fn arc_ends<T: Real>(corner: [f64; 2], half: Vec2<T>, inner: Vec2<T>) -> [Vec2<T>; 2] {
    let [x, y] = corner.map(T::of);
    let beside = Vec2::new(half.x * x, inner.y * y);
    let below = Vec2::new(inner.x * x, half.y * y);
    if turns_to_y(corner) { [below, beside] } else { [beside, below] }
}

shape_of_numbers!(Rectangle, "rectangle", RIGID, rectangle:
    "size[0]" => rectangle.size[0], "size[1]" => rectangle.size[1], "corner_radius" => rectangle.corner_radius);
