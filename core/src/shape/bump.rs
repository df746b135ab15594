//! What a curved piece is more than its chord, and its exact integrals with cosines and sines.

use num_traits::Float;

/// The difference of a piece and its chord over u, -1 at its start and 1 at its end:
/// `even` E(u) + `odd` O(u), with E an even and O an odd function that are 0 at both ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bump {
    even: [f64; 2],
    odd: [f64; 2],
    profile: Profile,
}

#[derive(Clone, Copy, Debug)]
enum Profile {
    /// E = 1 - u^2, O = u (1 - u^2).
    Cubic,
    /// E = (cos a u - cos a) / sin a, O = sin a u / sin a - u, a half the sweep.
    Arc { half_sweep: f64 },
}

/// Half a sweep below which an arc is taken as the parabola that it all but is: off by less than a twentieth of its third power of half the chord, while the
/// formula of the arc loses as many digits as its inverse has.
const SMALLEST_ARC: f64 = 1e-4;

impl Bump {
    /// That of a cubic Bezier curve.
    pub(super) fn of_cubic([p, q, r, s]: [[f64; 2]; 4]) -> Self {
        // From the points at thirds of the chord to the control points.
        let first = [0, 1].map(|i| q[i] - (2.0 * p[i] + s[i]) / 3.0);
        let second = [0, 1].map(|i| r[i] - (p[i] + 2.0 * s[i]) / 3.0);
        let even = [0, 1].map(|i| 0.375 * (first[i] + second[i]));
        let odd = [0, 1].map(|i| 0.375 * (second[i] - first[i]));
        Self { even, odd, profile: Profile::Cubic }
    }

    /// That of a circular arc by its chord and sweep, with u in proportion to the angle.
    pub(super) fn of_arc(chord: [f64; 2], sweep: f64) -> Self {
        let half_sweep = sweep / 2.0;
        let half = chord.map(|value| value / 2.0);
        // Away from the center: half the chord turned back by a quarter.
        let out = [half[1], -half[0]];
        if Float::abs(half_sweep) < SMALLEST_ARC {
            let even = out.map(|value| value * half_sweep / 2.0);
            let odd = half.map(|value| value * half_sweep * half_sweep / 6.0);
            return Self { even, odd, profile: Profile::Cubic };
        }
        Self { even: out, odd: half, profile: Profile::Arc { half_sweep } }
    }

    /// The mean over u.
    pub(super) fn mean(&self) -> [f64; 2] {
        let even = self.integrals(0.0).0 / 2.0;
        self.even.map(|value| value * even)
    }

    /// Adds (1 / pi) x the integrals of the bump x cos(n phi), sin(n phi) to row n, for phi from `phase` - `half_width` to `phase` +
    /// `half_width`.
    pub(super) fn add(&self, phase: f64, half_width: f64, rows: &mut [[f64; 4]]) {
        let (sin_1, cos_1) = Float::sin_cos(phase);
        let (mut sin, mut cos) = (sin_1, cos_1);
        let mut frequency = half_width;
        for row in rows {
            let (even, odd) = self.integrals(frequency);
            let scale = half_width * core::f64::consts::FRAC_1_PI;
            for axis in 0..2 {
                let (with_cos, with_sin) = (self.even[axis] * even * scale, self.odd[axis] * odd * scale);
                row[2 * axis] += cos * with_cos - sin * with_sin;
                row[2 * axis + 1] += sin * with_cos + cos * with_sin;
            }
            (sin, cos) = (sin * cos_1 + cos * sin_1, cos * cos_1 - sin * sin_1);
            frequency += half_width;
        }
    }

    /// The integrals of E(u) cos(w u) and O(u) sin(w u) from -1 to 1.
    fn integrals(&self, w: f64) -> (f64, f64) {
        match self.profile {
            Profile::Cubic => (4.0 * bessel_ratio(1, w), 4.0 * w * bessel_ratio(2, w)),
            Profile::Arc { half_sweep } => {
                let (sin, cos) = Float::sin_cos(half_sweep);
                let (below, above) = (bessel_ratio(0, w - half_sweep), bessel_ratio(0, w + half_sweep));
                let even = (below + above - 2.0 * cos * bessel_ratio(0, w)) / sin;
                (even, (below - above) / sin - 2.0 * w * bessel_ratio(1, w))
            }
        }
    }
}

/// j_n(x) / x^n, j_n the spherical Bessel function: sin(x) / x for n = 0, (sin(x) - x cos(x)) / x^3 for 1,
/// ((3 - x^2) sin(x) - 3 x cos(x)) / x^5 for 2.
fn bessel_ratio(n: u8, x: f64) -> f64 {
    let square = x * x;
    if square < 4.0 {
        // sum (-x^2 / 2)^k / (k! (2 n + 2 k + 1)!!).
        let order = f64::from(2 * n + 1);
        let mut term = [1.0, 1.0 / 3.0, 1.0 / 15.0][usize::from(n.min(2))];
        let mut sum = term;
        for k in 1..14 {
            let k = f64::from(k);
            term *= -square / (2.0 * k * (order + 2.0 * k));
            sum += term;
        }
        return sum;
    }
    let (sin, cos) = Float::sin_cos(x);
    match n {
        0 => sin / x,
        1 => (sin - x * cos) / (square * x),
        _ => ((3.0 - square) * sin - 3.0 * x * cos) / (square * square * x),
    }
}
