//! How well a line or a circle explains samples, from their moments alone: adding a sample and asking take constant time.

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Weighted sums of the powers of x, y and z = x^2 + y^2 of points, around an origin beside them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments {
    w: f64,
    x: f64,
    y: f64,
    z: f64,
    xx: f64,
    xy: f64,
    yy: f64,
    xz: f64,
    yz: f64,
    zz: f64,
}

/// The same of the deviations from the mean: covariances.
struct Central {
    xx: f64,
    xy: f64,
    yy: f64,
    xz: f64,
    yz: f64,
    zz: f64,
}

/// A circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Circle {
    pub(super) center: Vec2<f64>,
    pub(super) radius: f64,
}

impl Moments {
    /// Takes in a point, relative to the origin.
    pub(super) fn add(&mut self, point: Vec2<f64>, weight: f64) {
        let (x, y, z) = (point.x, point.y, point.length_squared());
        let (wx, wy, wz) = (weight * x, weight * y, weight * z);
        self.w += weight;
        self.x += wx;
        self.y += wy;
        self.z += wz;
        self.xx += wx * x;
        self.xy += wx * y;
        self.yy += wy * y;
        self.xz += wx * z;
        self.yz += wy * z;
        self.zz += wz * z;
    }

    /// Least sum of squared distances to a straight line, by weight.
    pub(super) fn line_chi2(&self) -> f64 {
        let (xx, xy, yy) = self.scatter();
        let (half_sum, half_difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        // The smaller eigenvalue.
        (half_sum - (half_difference * half_difference + xy * xy).sqrt()).max(0.0)
    }

    fn scatter(&self) -> (f64, f64, f64) {
        let (x, y) = (self.x / self.w, self.y / self.w);
        (self.xx - self.x * x, self.xy - self.x * y, self.yy - self.y * y)
    }

    fn central(&self) -> Central {
        let inverse = 1.0 / self.w;
        let (x, y, z) = (self.x * inverse, self.y * inverse, self.z * inverse);
        let (xx, xy, yy) = (self.xx * inverse - x * x, self.xy * inverse - x * y, self.yy * inverse - y * y);
        let (xz, yz, zz) = (self.xz * inverse - x * z, self.yz * inverse - y * z, self.zz * inverse - z * z);
        // z counts from the mean of the points from here on: z' = z - 2 mean . point + constant.
        Central {
            xx,
            xy,
            yy,
            xz: xz - 2.0 * (x * xx + y * xy),
            yz: yz - 2.0 * (x * xy + y * yy),
            zz: zz - 4.0 * (x * xz + y * yz) + 4.0 * (x * x * xx + 2.0 * x * y * xy + y * y * yy),
        }
    }

    /// Least sum of squared distances to a circle or line, by weight, to first order in the distances.
    ///
    /// *Source*: Taubin's fit; Newton's method for the least root of its characteristic polynomial, which is the mean squared
    /// distance (Chernov, Circular and Linear Regression, 2010, section 5.10).
    pub(super) fn circle_chi2(&self) -> f64 {
        self.w * self.central().least_root()
    }

    /// The circle of [`Self::circle_chi2`]; none if it is a line.
    pub(super) fn circle(&self) -> Option<Circle> {
        let central = self.central();
        let root = central.least_root();
        let Central { xx, xy, yy, xz, yz, .. } = central;
        let mean_z = xx + yy;
        let determinant = root * root - root * mean_z + xx * yy - xy * xy;
        let offset = Vec2::new(xz * (yy - root) - yz * xy, yz * (xx - root) - xz * xy) / (2.0 * determinant);
        let circle = Circle {
            center: Vec2::new(self.x, self.y) / self.w + offset,
            radius: (offset.length_squared() + mean_z).sqrt(),
        };
        (circle.center.is_finite() && circle.radius.is_finite()).then_some(circle)
    }
}

impl Central {
    /// Mean squared distance from the circle of Taubin's fit.
    fn least_root(&self) -> f64 {
        let Self { xx, xy, yy, xz, yz, zz: var_z } = *self;
        let mean_z = xx + yy;
        let cov = xx * yy - xy * xy;
        let a3 = 4.0 * mean_z;
        let a2 = -3.0 * mean_z * mean_z - (var_z + mean_z * mean_z);
        let a1 = var_z * mean_z + 4.0 * cov * mean_z - xz * xz - yz * yz;
        let a0 = xz * (xz * yy - yz * xy) + yz * (yz * xx - xz * xy) - var_z * cov;
        let mut root = 0.0;
        let mut value = a0;
        for _ in 0..20 {
            let slope = a1 + root * (2.0 * a2 + 3.0 * a3 * root);
            let next = root - value / slope;
            let next_value = a0 + next * (a1 + next * (a2 + next * a3));
            if !next.is_finite() || next_value.abs() >= value.abs() {
                break;
            }
            let small = (next - root).abs() <= 1e-9 * next.abs();
            (root, value) = (next, next_value);
            if small {
                break;
            }
        }
        root.max(0.0)
    }
}
