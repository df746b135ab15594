//! What boundaries enclose: area, centroid, second moments.

use alloc::vec::Vec;

use num_traits::Float;

use super::arc::sweep;
use super::measure::GAUSS;
use super::{Boundary, Piece};
use crate::contour::{contains, signed_area};
use crate::geometry::{Bounds, Vec2};
use crate::real::Real;
use crate::shape::resolve::resolve;
use crate::shape::{FillRule, Outline, Rings, ShapeError};

/// Area, centroid and second moments of what a shape encloses.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments<T> {
    /// Not negative.
    pub area: T,
    /// The mean position; 0 if there is no area.
    pub centroid: [T; 2],
    /// The mean of x x, x y and y y from the centroid. For an ellipse a quarter of its squared radii along its axes, so that the
    /// ellipse of the same moments has twice the square roots of the matrix's eigenvalues as radii.
    pub covariance: [T; 3],
}

/// The axes of an ellipse, as full lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Axes<T> {
    /// The length of the longer axis.
    pub major: T,
    /// The length of the shorter axis.
    pub minor: T,
    /// The direction of the longer axis: radians from +x toward +y, in (-pi/2, pi/2\]; meaningless where both are equal.
    pub angle: T,
}

/// Integrals of 1, x, y, x x, x y, y y over what a ring encloses, negative if it turns from +y to +x.
type Integrals = [f64; 6];

/// How close polygons follow a boundary while it is found out which of its rings are holes, per size of the boundary.
const TOLERANCE: f64 = 1e-5;

/// How far areas may be apart per square of the size for rings to count as not crossing.
const SAME_AREA: f64 = 1e-9;

impl<T: Real> Boundary<T> {
    /// Area, centroid and second moments of the inside.
    ///
    /// Exact, to all digits, if the rings do not cross themselves and each other; else those of polygons within a
    /// hundred-thousandth of the size. Computed in f64 whatever `T`.
    ///
    /// # Errors
    /// As [`Self::flatten`].
    pub fn moments(&self) -> Result<Moments<T>, ShapeError> {
        let pieces = self.pieces.iter().map(Piece::cast).collect();
        let wide = Boundary::<f64> { pieces, breaks: self.breaks.clone(), fill: self.fill };
        let Some(bounds) = wide.bounds() else { return Ok(Moments::default()) };
        let size = Float::max(bounds.size().x, bounds.size().y);
        let integrals = wide.integrals(&bounds, size)?;
        let moments = Moments::of(integrals, bounds.center().to_array());
        let all = [moments.area].into_iter().chain(moments.centroid).chain(moments.covariance);
        if !all.into_iter().all(|value| T::of(value).is_finite()) {
            return Err(ShapeError::TooLarge);
        }
        Ok(Moments {
            area: T::of(moments.area),
            centroid: moments.centroid.map(T::of),
            covariance: moments.covariance.map(T::of),
        })
    }
}

impl Boundary<f64> {
    /// Integrals over the inside, from the middle of the box.
    fn integrals(&self, bounds: &Bounds<f64>, size: f64) -> Result<Integrals, ShapeError> {
        let origin = bounds.center();
        let mut raw = Outline::default();
        self.flatten_rings(size * TOLERANCE, &mut raw)?;
        let mut resolved = Outline::default();
        resolve(raw.rings(), self.fill)?.append(&raw.vertices, &mut resolved);
        let signs = signs(raw.rings(), self.fill);
        let area = |rings: Rings<'_, f64>| rings.iter().map(signed_area).collect::<Vec<_>>();
        let together: f64 = area(raw.rings()).iter().zip(&signs).map(|(area, sign)| area * sign).sum();
        let mut sums = Integrals::default();
        let mut add = |sign: f64, integrals: Integrals| {
            sums.iter_mut().zip(integrals).for_each(|(sum, value)| *sum += sign * value);
        };
        let true_area: f64 = area(resolved.rings()).iter().sum();
        if Float::abs(together - true_area) <= SAME_AREA * size * size {
            for (ring, &sign) in self.rings().zip(&signs) {
                ring.iter().for_each(|piece| add(sign, piece.integrals(origin)));
            }
        } else {
            for ring in resolved.rings().iter() {
                for (&from, &to) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                    add(1.0, Piece::Line { from: from.into(), to: to.into() }.integrals(origin));
                }
            }
        }
        Ok(sums)
    }
}

/// By what the signed integrals over each ring have to be multiplied to add up to those over the inside, if the rings do not
/// cross: whether the inside of the ring is filled, less whether the outside is, times the direction in which it turns.
fn signs(rings: Rings<'_, f64>, fill: FillRule) -> Vec<f64> {
    let turns: Vec<i32> = rings.iter().map(|ring| if signed_area(ring) < 0.0 { -1 } else { 1 }).collect();
    let all: Vec<&[[f64; 2]]> = rings.iter().collect();
    let sign = |(k, ring): (usize, &&[[f64; 2]])| {
        let Some(&first) = ring.first() else { return 0.0 };
        let around = all.iter().zip(&turns).enumerate().filter(|&(j, (other, _))| j != k && contains(other, first));
        let outside: i32 = around.map(|(_, (_, turn))| turn).sum();
        let filled = [outside, outside + turns[k]].map(|winding| i32::from(fill.is_inside(winding)));
        f64::from((filled[1] - filled[0]) * turns[k])
    };
    all.iter().enumerate().map(sign).collect()
}

impl Piece<f64> {
    /// Its part of the integrals over a ring, by Green's theorem: each integral is one over dy or dx along the ring. Exact for
    /// lines and cubics, to all digits for arcs of at most an eighth of a turn, into which longer ones are cut.
    fn integrals(&self, origin: Vec2<f64>) -> Integrals {
        let turn = match *self {
            Self::Arc { bulge, .. } => Float::abs(sweep(bulge)),
            Self::Ellipse { .. } => core::f64::consts::TAU,
            Self::Line { .. } | Self::Cubic(_) => 0.0,
        };
        let parts = (turn / core::f64::consts::FRAC_PI_4).to_count() + 1;
        let mut sums = Integrals::default();
        for part in 0..parts {
            for [at, weight] in GAUSS {
                let t = (f64::of_usize(part) + at) / f64::of_usize(parts);
                let (Vec2 { x, y }, velocity) = (self.point(t) - origin, self.velocity(t));
                let [dx, dy] = [velocity.x, velocity.y].map(|value| value * weight / f64::of_usize(parts));
                let values = [
                    (x * dy - y * dx) / 2.0,
                    x * x * dy / 2.0,
                    -y * y * dx / 2.0,
                    x * x * x * dy / 3.0,
                    x * x * y * dy / 2.0,
                    -y * y * y * dx / 3.0,
                ];
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
            }
        }
        sums
    }
}

impl<T: Real> Moments<T> {
    /// The axes of the ellipse with the same second moments: four times the standard deviation along each.
    #[must_use]
    pub fn axes(&self) -> Axes<T> {
        let [xx, xy, yy] = self.covariance;
        let half = T::of(0.5);
        let (mean, apart) = ((xx + yy) * half, ((xx - yy) * half).hypot(xy));
        let length = |variance: T| T::of(4.0) * variance.max(T::zero()).sqrt();
        Axes { major: length(mean + apart), minor: length(mean - apart), angle: half * (xy + xy).atan2(xx - yy) }
    }
}

impl Moments<f64> {
    /// From integrals, seen from `origin`.
    fn of([area, x, y, xx, xy, yy]: Integrals, origin: [f64; 2]) -> Self {
        if area <= 0.0 {
            return Self::default();
        }
        let mean = [x / area, y / area];
        let covariance = [xx / area - mean[0] * mean[0], xy / area - mean[0] * mean[1], yy / area - mean[1] * mean[1]];
        Self { area, centroid: [origin[0] + mean[0], origin[1] + mean[1]], covariance }
    }
}
