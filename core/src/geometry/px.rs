//! Pixels and scene units, told apart by type.

use super::Vec2;
use crate::dims::ImageSize;
use crate::real::Real;

/// A length or a point in pixels. Plain numbers and points are in scene units, of which the shorter side of an image is
/// one; a pixel (row r, column c) covers \[c, c + 1\] x \[r, r + 1\] pixels, its center is at (c + 1/2, r + 1/2).
///
/// # Examples
/// ```
/// use dvp_core::{ImageSize, Vec2, geometry::Px};
/// let size = ImageSize::new(200, 100)?;
/// assert_eq!(Px::of_length(0.25, size), Px(25.0));
/// assert_eq!(Px(Vec2::new(50.0, 100.0)).to_scene(size), Vec2::new(0.5, 1.0));
/// # Ok::<(), dvp_core::dims::SizeError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Px<V>(pub V);

impl<T: Real> Px<T> {
    /// A length in scene units as pixels of an image of `size`.
    #[inline]
    #[must_use]
    pub fn of_length(length: T, size: ImageSize) -> Self {
        Self(length * T::of_usize(size.unit_px()))
    }

    /// The length in scene units.
    #[inline]
    #[must_use]
    pub fn to_scene_length(self, size: ImageSize) -> T {
        self.0 / T::of_usize(size.unit_px())
    }
}

impl<T: Real> Px<Vec2<T>> {
    /// A point in scene units as pixels of an image of `size`.
    #[inline]
    #[must_use]
    pub fn of_point(point: Vec2<T>, size: ImageSize) -> Self {
        Self(point * T::of_usize(size.unit_px()))
    }

    /// The point in scene units.
    #[inline]
    #[must_use]
    pub fn to_scene(self, size: ImageSize) -> Vec2<T> {
        self.0 / T::of_usize(size.unit_px())
    }
}
