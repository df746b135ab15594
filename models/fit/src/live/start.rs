//! The path that a shape starts as.

use alloc::vec::Vec;
use core::f64::consts::TAU;

use dvp_core::geometry::{Px, Vec2};
use dvp_core::shape::{FillRule, Path, PathRing, Segment};
use dvp_core::{ImageSize, Object, Paint, Pose, Real};

use crate::opt_iter::blob::Blob;

/// As what a shape starts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PathStart {
    /// A circle of this radius around the pixel of the blob that is nearest to the blob's center.
    Circle(Px<f64>),
    /// The ellipse with the blob's center and second moments.
    Ellipse,
}

impl PathStart {
    /// The opaque object, of `segment_count` cubics (at least 2), that begins to explain `blob`.
    pub(super) fn object<T: Real>(self, blob: &Blob<T>, segment_count: usize, size: ImageSize) -> Object<T> {
        let (center, axes) = match self {
            Self::Circle(radius) => {
                let radius = T::of(radius.to_scene_length(size));
                (blob.inside, [Vec2::new(radius, T::zero()), Vec2::new(T::zero(), radius)])
            }
            Self::Ellipse => {
                let axis = Vec2::from_angle(blob.orientation);
                (blob.center, [axis * blob.half_axes[0], axis.perp() * blob.half_axes[1]])
            }
        };
        let ring = ellipse(center.into(), axes, segment_count.max(2));
        let path = Path { rings: [ring].into(), fill: FillRule::EvenOdd };
        Object { shape: path.into(), pose: Pose::identity(), paint: Paint::Flat(blob.color), confidence: T::one() }
    }
}

/// The ellipse `center` + `axes[0]` cos t + `axes[1]` sin t as a closed ring of cubics, which touch it at their ends and in their
/// middles.
fn ellipse<T: Real>(center: Vec2<T>, axes: [Vec2<T>; 2], segment_count: usize) -> PathRing<T> {
    let angle = TAU / f64::of_usize(segment_count);
    let handle = T::of(4.0 / 3.0 * num_traits::Float::tan(angle / 4.0));
    let at = |k: usize| {
        let direction = Vec2::<T>::from_angle(T::of(angle * f64::of_usize(k % segment_count)));
        let place = |v: Vec2<T>| axes[0] * v.x + axes[1] * v.y;
        (center + place(direction), place(direction.perp()) * handle)
    };
    let cubic = |k: usize| {
        let [(from, out), (to, back)] = [at(k), at(k + 1)];
        Segment::Cubic { controls: [(from + out).to_array(), (to - back).to_array()] }
    };
    PathRing {
        points: (0..segment_count).map(|k| at(k).0.to_array()).collect(),
        segments: (0..segment_count).map(cubic).collect::<Vec<_>>(),
    }
}
