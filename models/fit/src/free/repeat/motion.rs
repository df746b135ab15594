//! Symmetries of an outline: the turns and reflections that repeat it.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::geometry::{Similarity, Vec2};

use crate::Completion;

/// What repeats the outline.
#[derive(Clone, Copy, Debug)]
pub(super) enum Symmetry<T> {
    Turn {
        order: usize,
        center: [T; 2],
    },
    /// At the line through a point, at half of an angle.
    Mirror {
        angle: T,
        center: [T; 2],
    },
}

impl<T: Real> Symmetry<T> {
    pub(super) fn motions(&self) -> Vec<Similarity<T>> {
        match *self {
            Self::Turn { order, center } => {
                let step = T::of(core::f64::consts::TAU) / T::of_usize(order);
                (1..order).map(|i| Similarity::turn_about(center.into(), step * T::of_usize(i))).collect()
            }
            Self::Mirror { angle, center } => Vec::from([Similarity::reflection(center.into(), angle * T::of(0.5))]),
        }
    }

    pub(super) fn completion(&self) -> Completion {
        match *self {
            Self::Turn { order, .. } => Completion::Rotation { order },
            Self::Mirror { .. } => Completion::Mirror,
        }
    }

    pub(super) fn center(&self) -> [T; 2] {
        match *self {
            Self::Turn { center, .. } | Self::Mirror { center, .. } => center,
        }
    }

    /// With the center moved, and an axis turned.
    pub(super) fn moved(&self, [x, y, turn]: [T; 3]) -> Self {
        match *self {
            Self::Turn { order, center } => Self::Turn { order, center: [center[0] + x, center[1] + y] },
            Self::Mirror { angle, center } => {
                Self::Mirror { angle: angle + turn, center: [center[0] + x, center[1] + y] }
            }
        }
    }
}

/// Unit vector across the axis of a reflection.
pub(super) fn axis_normal<T: Real>(reflection: &Similarity<T>) -> Vec2<T> {
    // The axis is at half the angle of the map.
    Vec2::from_angle(reflection.angle() * T::of(0.5)).perp()
}
