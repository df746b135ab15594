//! Whether a fit doubts itself: its covariance, ambiguities, stop reason and unexplained rest as yes or no.

use core::f64::consts::PI;

use dvp_core::{Object, Real};

use crate::{Ambiguity, Fit, StopReason};

/// A standard deviation of the position, in radii of the object, or of the logarithm of its size, that is wide: either makes
/// the object agree with the true one to an IoU of 0.9 only.
const WIDE_POSITION: f64 = 0.08;
const WIDE_SIZE: f64 = 0.05;

/// Of a picture that a scene explains, less is left.
const UNEXPLAINED: f64 = 0.01;

/// What a fit says against itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Doubts {
    /// A position or a size is uncertain: either alone may bring the object below an IoU of 0.9.
    pub pose: bool,
    /// An object is cropped, hidden in part, merged with another one, or may have another shape. Symmetry alone is no doubt.
    pub ambiguity: bool,
    /// The optimization stopped before it was done, or the picture is not flat. Descents by Adam take all their steps, and
    /// say nothing by it.
    pub stop: bool,
    /// More than a hundredth of the picture's variance is explained neither by the scene nor by noise.
    pub unexplained: bool,
}

impl Doubts {
    /// Whether there is one.
    #[must_use]
    pub fn any(self) -> bool {
        self.pose || self.ambiguity || self.stop || self.unexplained
    }
}

impl<T: Real> Fit<T> {
    /// What the fit says against itself, as yes or no. `dvp stability` counts how often it is right.
    #[must_use]
    pub fn doubts(&self) -> Doubts {
        let is_wide = |(block, object): (&[T; 16], &Object<T>)| {
            let [x, y, size] = [0, 5, 10].map(|k| block[k].as_f64().max(0.0));
            let (scale, area) = (object.pose.scale.as_f64(), object.efd.signed_area().as_f64());
            let squared_radius = scale * scale * area.abs() / PI;
            x.max(y) > WIDE_POSITION * WIDE_POSITION * squared_radius || size > WIDE_SIZE * WIDE_SIZE
        };
        let is_open = |ambiguity: &Ambiguity| !matches!(ambiguity, Ambiguity::Symmetry { .. });
        Doubts {
            pose: self.covariance.iter().zip(&self.scene.objects).any(is_wide),
            ambiguity: self.ambiguity.iter().any(is_open),
            stop: match self.stop {
                StopReason::Converged | StopReason::Empty => false,
                StopReason::StepLimit => !self.covariance.is_empty(),
                StopReason::Stalled | StopReason::NotFlat => true,
            },
            unexplained: self.unexplained > UNEXPLAINED,
        }
    }
}
