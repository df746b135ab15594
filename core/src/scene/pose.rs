//! Poses: a unit outline in, the outline of an object out, in scene units.

use super::Pose;
use crate::geometry::{Similarity, Vec2};
use crate::real::Real;

impl<T: Real> Pose<T> {
    /// The pose that leaves every point where it is.
    #[must_use]
    pub fn identity() -> Self {
        Self { translation: [T::zero(); 2], scale: T::one(), rotation: T::zero() }
    }

    /// Where a point of the unit outline goes: scale R(rotation) point + translation.
    #[must_use]
    pub fn transform_point(&self, point: T::Vec2) -> T::Vec2 {
        let Vec2 { x, y } = self.similarity().point(T::xy(point).into());
        T::vec2(x, y)
    }

    /// The pose that undoes this one; none if the scale is 0.
    #[must_use]
    pub fn inverse(&self) -> Option<Self> {
        if self.scale == T::zero() {
            return None;
        }
        let scale = self.scale.recip();
        let (sin, cos) = self.rotation.sin_cos();
        let [x, y] = self.translation;
        let translation = [-scale * (cos * x + sin * y), -scale * (cos * y - sin * x)];
        Some(Self { translation, scale, rotation: -self.rotation })
    }

    /// The pose as a map of the plane.
    #[must_use]
    pub fn similarity(&self) -> Similarity<T> {
        Similarity { turn: Vec2::from(self.columns()), translation: self.translation.into(), reflected: false }
    }

    /// Moves the points of a unit outline to their place, in place. *Derivative*:
    /// [`transform_vjp`](Self::transform_vjp).
    pub fn transform(&self, outline: &mut [[T; 2]]) {
        let map = self.similarity();
        for point in outline {
            *point = map.point(Vec2::from(*point)).to_array();
        }
    }

    /// scale cos, scale sin.
    fn columns(&self) -> [T; 2] {
        let (sin, cos) = self.rotation.sin_cos();
        [self.scale * cos, self.scale * sin]
    }
}

/// The angle of the reference system's pair (sin a, cos a), of any length: atan2(pair\[0\], pair\[1\]).
///
/// *Units*: radians in (-pi, pi\]. *Derivative*: [`rotation_from_pair_vjp`](super::rotation_from_pair_vjp); not
/// differentiable at (0, 0), where it is 0.
#[must_use]
pub fn rotation_from_pair<T: Real>(pair: [T; 2]) -> T {
    pair[0].atan2(pair[1])
}
