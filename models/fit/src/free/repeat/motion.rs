//! Turns and reflections, and the symmetries made of them.

use alloc::vec::Vec;

use dvp_core::Real;

use crate::Completion;

/// v -> m v + t, where m is a turn or a reflection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<T> {
    pub(super) m: [[T; 2]; 2],
    t: [T; 2],
}

impl<T: Real> Motion<T> {
    pub(super) fn turn(angle: T, center: [T; 2]) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self::about([[cos, -sin], [sin, cos]], center)
    }

    /// At the line through `center` at half of `angle`.
    pub(super) fn reflection(angle: T, center: [T; 2]) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self::about([[cos, sin], [sin, -cos]], center)
    }

    fn about(m: [[T; 2]; 2], center: [T; 2]) -> Self {
        Self { m, t: [0, 1].map(|c| center[c] - m[c][0] * center[0] - m[c][1] * center[1]) }
    }

    pub(super) fn carry(&self, [x, y]: [T; 2]) -> [T; 2] {
        [0, 1].map(|c| self.m[c][0] * x + self.m[c][1] * y + self.t[c])
    }

    /// Turns and reflections are undone by their transposes.
    pub(super) fn back(&self, [x, y]: [T; 2]) -> [T; 2] {
        let (x, y) = (x - self.t[0], y - self.t[1]);
        [0, 1].map(|c| self.m[0][c] * x + self.m[1][c] * y)
    }
}

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
    pub(super) fn motions(&self) -> Vec<Motion<T>> {
        match *self {
            Self::Turn { order, center } => {
                let step = T::of(core::f64::consts::TAU) / T::of_usize(order);
                (1..order).map(|i| Motion::turn(step * T::of_usize(i), center)).collect()
            }
            Self::Mirror { angle, center } => Vec::from([Motion::reflection(angle, center)]),
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
pub(super) fn axis_normal<T: Real>(motion: &Motion<T>) -> [T; 2] {
    // The axis is at half the angle of m.
    let half = motion.m[1][0].atan2(motion.m[0][0]) * T::of(0.5);
    let (sin, cos) = half.sin_cos();
    [-sin, cos]
}
