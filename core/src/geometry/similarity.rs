//! Similarities of the plane: turns, growth, shifts, and with them a reflection.

use super::Vec2;
use crate::real::Real;

/// A map of the plane that keeps shapes: first a reflection at the x axis if there is one, then a turn and growth about
/// the origin, then a shift.
///
/// Poses, turns about a point and reflections at a line are special cases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity<T> {
    /// Where (1, 0) goes before the shift: scale x (cosine, sine) of the turn.
    pub turn: Vec2<T>,
    /// Where the origin goes.
    pub translation: Vec2<T>,
    /// Whether y changes its sign first.
    pub reflected: bool,
}

impl<T: Real> Similarity<T> {
    /// Leaves every point where it is.
    #[must_use]
    pub fn identity() -> Self {
        let zero = T::zero();
        Self { turn: Vec2::new(T::one(), zero), translation: Vec2::new(zero, zero), reflected: false }
    }

    /// The turn by `angle` (radians from +x toward +y) about `center`.
    #[must_use]
    pub fn turn_about(center: Vec2<T>, angle: T) -> Self {
        Self { turn: Vec2::from_angle(angle), ..Self::identity() }.keeping(center)
    }

    /// The reflection at the line through `center` in the direction of `angle` (radians).
    #[must_use]
    pub fn reflection(center: Vec2<T>, angle: T) -> Self {
        Self { turn: Vec2::from_angle(angle + angle), reflected: true, ..Self::identity() }.keeping(center)
    }

    /// The same turn and reflection, shifted so that `center` stays where it is.
    fn keeping(self, center: Vec2<T>) -> Self {
        Self { translation: center - self.direction(center), ..self }
    }

    /// Where a point goes.
    #[inline(always)]
    #[must_use]
    pub fn point(&self, point: Vec2<T>) -> Vec2<T> {
        self.direction(point) + self.translation
    }

    /// Where a direction goes: as a point does, but for the shift.
    #[inline(always)]
    #[must_use]
    pub fn direction(&self, direction: Vec2<T>) -> Vec2<T> {
        let direction = if self.reflected { Vec2::new(direction.x, -direction.y) } else { direction };
        direction.turned(self.turn)
    }

    /// The map that undoes this one; none if everything goes to one point.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        let squared = self.turn.length_squared();
        if squared == T::zero() {
            return None;
        }
        // 1 / (a + ib) = (a - ib) / (a^2 + b^2); after a reflection the conjugate of that.
        let y = if self.reflected { self.turn.y } else { -self.turn.y };
        let linear = Self { turn: Vec2::new(self.turn.x, y) / squared, ..*self };
        Some(Self { translation: -linear.direction(self.translation), ..linear })
    }

    /// This map and then `next`.
    #[must_use]
    pub fn then(&self, next: &Self) -> Self {
        Self {
            turn: next.direction(self.turn),
            translation: next.point(self.translation),
            reflected: self.reflected != next.reflected,
        }
    }

    /// The factor by which lengths grow.
    #[must_use]
    pub fn scale(&self) -> T {
        self.turn.length()
    }

    /// The angle of the turn, radians in (-pi, pi]; of a reflection twice that of its axis.
    #[must_use]
    pub fn angle(&self) -> T {
        self.turn.angle()
    }

    /// The one point that stays where it is; none for shifts, reflections and the identity (up to a turn of 1e-3).
    #[must_use]
    pub fn fixed_point(&self) -> Option<Vec2<T>> {
        // c = a c + t, so c = t / (1 - a).
        let rest = Vec2::new(T::one(), T::zero()) - self.turn;
        let squared = rest.length_squared();
        (!self.reflected && squared > T::of(1e-6))
            .then(|| self.translation.turned(Vec2::new(rest.x, -rest.y)) / squared)
    }
}
