//! The way back of `pose`: gradients of a posed outline to gradients of pose and unit outline.

use super::Pose;
use crate::diff_op::{add_scaled, atan2_vjp};
use crate::real::Real;

/// Gradient of a scalar with respect to a [`Pose`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseGrad<T> {
    /// With respect to `translation`.
    pub translation: [T; 2],
    /// With respect to `scale`.
    pub scale: T,
    /// With respect to `rotation`, per radian.
    pub rotation: T,
}

impl<T: Real> Pose<T> {
    /// Adds to `grad` and `grad_unit` the gradient of sum(grad_outline x transform(unit)) with respect to the pose and
    /// the unit outline.
    ///
    /// *Dimensions*: the three slices have one length; what is longer is not read.
    pub fn transform_vjp(
        &self,
        unit: &[[T; 2]],
        grad_outline: &[[T; 2]],
        grad: &mut PoseGrad<T>,
        grad_unit: &mut [[T; 2]],
    ) {
        let (sin, cos) = self.rotation.sin_cos();
        for ((&[x, y], &[gx, gy]), grad_point) in unit.iter().zip(grad_outline).zip(grad_unit) {
            // The gradient in the frame of the unit outline, before the scale.
            let (hx, hy) = (cos * gx + sin * gy, cos * gy - sin * gx);
            grad.translation[0] += gx;
            grad.translation[1] += gy;
            grad.scale += hx * x + hy * y;
            grad.rotation += self.scale * (hy * x - hx * y);
            grad_point[0] += self.scale * hx;
            grad_point[1] += self.scale * hy;
        }
    }
}

/// Adds to `grad_pair` the gradient of grad_rotation x [`rotation_from_pair`](super::rotation_from_pair); nothing at
/// (0, 0), where there is none.
pub fn rotation_from_pair_vjp<T: Real>(pair: [T; 2], grad_rotation: T, grad_pair: &mut [T; 2]) {
    add_scaled(grad_pair, &atan2_vjp(pair, grad_rotation), T::one());
}
