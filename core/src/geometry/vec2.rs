//! Points and directions of the plane.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::real::Real;

/// A point or a direction: x right, y down.
///
/// Slices of vertices stay `[T; 2]`, the layout that vector units, files and frameworks read; this type is for the
/// arithmetic. Both convert into each other at no cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec2<T> {
    /// To the right.
    pub x: T,
    /// Downward.
    pub y: T,
}

impl<T: Real> Vec2<T> {
    /// A point or direction of these components.
    #[inline(always)]
    #[must_use]
    pub const fn new(x: T, y: T) -> Self {
        Self { x, y }
    }

    /// The direction at `angle` radians from +x toward +y, of length 1.
    #[inline]
    #[must_use]
    pub fn from_angle(angle: T) -> Self {
        let (y, x) = angle.sin_cos();
        Self { x, y }
    }

    /// The components as the vertices of an outline hold them.
    #[inline(always)]
    #[must_use]
    pub const fn to_array(self) -> [T; 2] {
        [self.x, self.y]
    }

    /// x x' + y y'.
    #[inline(always)]
    #[must_use]
    pub fn dot(self, other: Self) -> T {
        self.x * other.x + self.y * other.y
    }

    /// x y' - y x': positive if `other` lies a turn from +x toward +y further on, by less than half a turn.
    #[inline(always)]
    #[must_use]
    pub fn cross(self, other: Self) -> T {
        self.x * other.y - self.y * other.x
    }

    /// A quarter turn from +x to +y: (-y, x).
    #[inline(always)]
    #[must_use]
    pub fn perp(self) -> Self {
        Self { x: -self.y, y: self.x }
    }

    /// Turned by the angle whose cosine and sine are the components of `turn`, and made longer by its length: the
    /// product of complex numbers.
    #[inline(always)]
    #[must_use]
    pub fn turned(self, turn: Self) -> Self {
        Self { x: self.x * turn.x - self.y * turn.y, y: self.x * turn.y + self.y * turn.x }
    }

    /// x^2 + y^2.
    #[inline(always)]
    #[must_use]
    pub fn length_squared(self) -> T {
        self.dot(self)
    }

    /// sqrt(x^2 + y^2). Lengths beyond the square root of what T holds are infinite.
    #[inline(always)]
    #[must_use]
    pub fn length(self) -> T {
        self.length_squared().sqrt()
    }

    /// Radians from +x toward +y, in (-pi, pi]; 0 for the zero vector.
    #[inline]
    #[must_use]
    pub fn angle(self) -> T {
        self.y.atan2(self.x)
    }

    /// The same direction with length 1; none for the zero vector.
    #[inline]
    #[must_use]
    pub fn normalized(self) -> Option<Self> {
        let length = self.length();
        (length > T::zero()).then(|| self / length)
    }

    /// The point `share` of the way to `other`.
    #[inline(always)]
    #[must_use]
    pub fn lerp(self, other: Self, share: T) -> Self {
        self + (other - self) * share
    }

    /// Whether both components are finite.
    #[inline]
    #[must_use]
    pub fn is_finite(self) -> bool {
        self.x.is_finite() && self.y.is_finite()
    }
}

impl<T> From<[T; 2]> for Vec2<T> {
    #[inline(always)]
    fn from([x, y]: [T; 2]) -> Self {
        Self { x, y }
    }
}

impl<T> From<Vec2<T>> for [T; 2] {
    #[inline(always)]
    fn from(vector: Vec2<T>) -> Self {
        [vector.x, vector.y]
    }
}

impl<T: Real> Add for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y }
    }
}

impl<T: Real> Sub for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y }
    }
}

impl<T: Real> Neg for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y }
    }
}

impl<T: Real> Mul<T> for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self { x: self.x * factor, y: self.y * factor }
    }
}

impl<T: Real> Div<T> for Vec2<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, divisor: T) -> Self {
        Self { x: self.x / divisor, y: self.y / divisor }
    }
}

impl<T: Real> AddAssign for Vec2<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Real> SubAssign for Vec2<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
