//! Lengths, points and boxes of pieces.

use super::arc::{sinc, sweep};
use super::cubic::derivatives;
use super::{Boundary, Piece};
use crate::geometry::{Bounds, Vec2};
use crate::real::Real;

/// Points and weights of the quadrature of Gauss with 8 points on \[0, 1\]: exact for polynomials up to degree 15.
pub(super) const GAUSS: [[f64; 2]; 8] = [
    [0.019_855_071_751_231_9, 0.050_614_268_145_188_1],
    [0.101_666_761_293_186_6, 0.111_190_517_226_687_2],
    [0.237_233_795_041_835_5, 0.156_853_322_938_943_6],
    [0.408_282_678_752_175_1, 0.181_341_891_689_181],
    [0.591_717_321_247_825, 0.181_341_891_689_181],
    [0.762_766_204_958_164_5, 0.156_853_322_938_943_6],
    [0.898_333_238_706_813_4, 0.111_190_517_226_687_2],
    [0.980_144_928_248_768_1, 0.050_614_268_145_188_1],
];

/// Halvings of a cubic until its length is taken as it is.
const DEEPEST: u32 = 16;

impl<T: Real> Boundary<T> {
    /// The length of all rings.
    #[must_use]
    pub fn perimeter(&self) -> T {
        self.pieces.iter().map(Piece::length).sum()
    }

    /// The smallest upright box around the rings; none if there are none.
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds<T>> {
        let mut bounds = Bounds::of(self.pieces.iter().map(Piece::from))?;
        self.pieces.iter().for_each(|piece| piece.extend(&mut bounds));
        Some(bounds)
    }
}

impl<T: Real> Piece<T> {
    /// Its length: exact for lines, arcs and ellipses, to all digits for cubics without cusps.
    #[must_use]
    pub fn length(&self) -> T {
        match *self {
            Self::Line { from, to } => (to - from).length(),
            Self::Arc { from, to, bulge } => (to - from).length() / sinc(sweep(bulge) * T::of(0.5)).abs(),
            Self::Ellipse { axes, .. } => ellipse_length(axes[0].length(), axes[1].length()),
            Self::Cubic(points) => {
                let speed = |t: T| derivatives(&points, t)[1].length();
                let whole = integral(&speed, T::zero(), T::one());
                refined(&speed, [T::zero(), T::one()], whole, whole * T::epsilon() * T::of(4.0), DEEPEST)
            }
        }
    }

    /// The point at `t`, 0 at the start and 1 at the end: in proportion to the length of lines and arcs, to the angle of ellipses,
    /// a cubic's own parameter.
    #[must_use]
    pub fn point(&self, t: T) -> Vec2<T> {
        match *self {
            Self::Line { from, to } => from.lerp(to, t),
            Self::Arc { from, to, bulge } => {
                let half = sweep(bulge) * T::of(0.5);
                let ratio = t * sinc(t * half) / sinc(half);
                from + (to - from).turned(Vec2::from_angle((t - T::one()) * half) * ratio)
            }
            Self::Ellipse { center, axes } => {
                let direction = Vec2::from_angle(T::of(core::f64::consts::TAU) * t);
                center + axes[0] * direction.x + axes[1] * direction.y
            }
            Self::Cubic(points) => derivatives(&points, t)[0],
        }
    }

    /// The derivative of [`Self::point`].
    #[must_use]
    pub fn velocity(&self, t: T) -> Vec2<T> {
        match *self {
            Self::Line { from, to } => to - from,
            Self::Arc { from, to, bulge } => {
                let sweep = sweep(bulge);
                let half = T::of(0.5);
                (to - from).turned(Vec2::from_angle(sweep * (t - half))) / sinc(sweep * half)
            }
            Self::Ellipse { axes, .. } => {
                let tau = T::of(core::f64::consts::TAU);
                let direction = Vec2::from_angle(tau * t);
                (axes[1] * direction.x - axes[0] * direction.y) * tau
            }
            Self::Cubic(points) => derivatives(&points, t)[1],
        }
    }

    /// Grows a box until the piece is inside.
    fn extend(&self, bounds: &mut Bounds<T>) {
        bounds.include(self.from());
        bounds.include(self.to());
        match *self {
            Self::Line { .. } => {}
            Self::Arc { from, to, bulge } => {
                // Where the tangent, which turns by the sweep in equal measure, is along an axis.
                let (sweep, quarter) = (sweep(bulge), T::of(core::f64::consts::FRAC_PI_2));
                let start = (to - from).angle() - sweep * T::of(0.5);
                let (first, last) = (start.min(start + sweep), start.max(start + sweep));
                let mut axis = (first / quarter).ceil();
                // A sweep is less than a whole turn.
                for _ in 0..4 {
                    let t = (axis * quarter - start) / sweep;
                    if axis * quarter < last && t > T::zero() && t < T::one() {
                        bounds.include(self.point(t));
                    }
                    axis += T::one();
                }
            }
            Self::Ellipse { center, axes } => {
                let reach = Vec2::new(axes[0].x.hypot(axes[1].x), axes[0].y.hypot(axes[1].y));
                bounds.include(center - reach);
                bounds.include(center + reach);
            }
            Self::Cubic(points) => {
                for axis in [Vec2::new(T::one(), T::zero()), Vec2::new(T::zero(), T::one())] {
                    // The derivative of a coordinate: of the differences p, q, r of neighbors, in the basis of Bernstein.
                    let [p, q, r] = [0, 1, 2].map(|k| (points[k + 1] - points[k]).dot(axis));
                    for t in roots(p - q - q + r, T::of(2.0) * (q - p), p).into_iter().flatten() {
                        if t > T::zero() && t < T::one() {
                            bounds.include(self.point(t));
                        }
                    }
                }
            }
        }
    }
}

/// The roots of a t^2 + b t + c, without loss of digits.
fn roots<T: Real>(a: T, b: T, c: T) -> [Option<T>; 2] {
    let discriminant = b * b - T::of(4.0) * a * c;
    if discriminant < T::zero() {
        return [None; 2];
    }
    let q = (b + discriminant.sqrt() * b.signum()) * T::of(-0.5);
    [q / a, c / q].map(|root| root.is_finite().then_some(root))
}

/// The perimeter of an ellipse, by the arithmetic-geometric mean.
fn ellipse_length<T: Real>(first: T, second: T) -> T {
    let (half, two) = (T::of(0.5), T::of(2.0));
    let (mut a, mut b) = (first.max(second), first.min(second));
    if b <= T::zero() {
        return T::of(4.0) * a;
    }
    // 2 pi (a^2 - sum 2^(n - 1) c_n^2) / mean, c_n half the distance of the means before, in units of the longer radius.
    let unit = a;
    (a, b) = (T::one(), b / unit);
    let mut sum = T::one() - (T::one() - b * b) * half;
    let mut power = half;
    // The number of right digits doubles each time.
    for _ in 0..MOST_MEANS {
        let c = (a - b) * half;
        (a, b) = ((a + b) * half, (a * b).sqrt());
        power *= two;
        sum -= power * c * c;
    }
    T::of(core::f64::consts::TAU) * unit * sum / a
}

/// Means until both agree to all digits, for axes up to 10^300 apart.
const MOST_MEANS: usize = 14;

/// The integral of `f` from `start` to `end`.
pub(super) fn integral<T: Real>(f: &dyn Fn(T) -> T, start: T, end: T) -> T {
    GAUSS.iter().map(|&[at, weight]| T::of(weight) * f(start + (end - start) * T::of(at))).sum::<T>() * (end - start)
}

/// The same by halves, until they agree with the `whole`.
fn refined<T: Real>(f: &dyn Fn(T) -> T, [start, end]: [T; 2], whole: T, tolerance: T, depth: u32) -> T {
    let middle = (start + end) * T::of(0.5);
    let (left, right) = (integral(f, start, middle), integral(f, middle, end));
    let is_off = (left + right - whole).abs() > tolerance;
    if depth == 0 || !is_off {
        return left + right;
    }
    refined(f, [start, middle], left, tolerance, depth - 1) + refined(f, [middle, end], right, tolerance, depth - 1)
}
