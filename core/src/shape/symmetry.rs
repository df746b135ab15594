//! Rotational symmetry of an outline, from its descriptors.

use super::Efd;
use crate::real::Real;

/// Relative amplitude below which a frequency does not count: 2 % of the strongest, 0.7 px on the largest MDS-HR object.
pub const SYMMETRY_TOLERANCE: f64 = 0.02;

/// Harmonics that the reference system's rule looks at.
pub const REFERENCE_SYMMETRY_HARMONICS: usize = 5;

/// Norm above which a harmonic counts in the reference system's rule.
pub const REFERENCE_SYMMETRY_THRESHOLD: f64 = 0.075;

/// Which turns map an outline on itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Symmetry {
    /// Turns by multiples of 2 pi / k; 1 if only full turns do.
    Finite(usize),
    /// Every turn: a circle, or a point.
    Continuous,
}

impl<T: Real> Efd<T> {
    /// The symmetry of the outline, exact up to frequencies weaker than `tolerance` times the strongest one.
    ///
    /// With x + i y = sum c_m e^(i m t) over signed frequencies m, a turn by 2 pi / k maps the outline on itself, its
    /// parameter shifted, if and only if all m are equal modulo k. So k is the greatest common divisor of the
    /// differences m - m_0, m_0 the strongest frequency (1 or -1 with the direction of travel, unless the outline
    /// runs around several times: divisors that k shares with m_0 are repetitions, not turns, and are taken out).
    /// One frequency alone is a circle. Outlines that are symmetric as sets of points but not in their parameter are not
    /// seen; arc length, the parameter of [`Efd::from_contour`], is symmetric whenever the outline is.
    #[must_use]
    #[inline(never)]
    pub fn symmetry(&self, tolerance: T) -> Symmetry {
        let spectrum = || {
            (1_i32..).zip(&self.rows).flat_map(|(n, &[a, b, c, d])| {
                // 2 c_n = (a + d) + i (c - b), 2 c_-n = (a - d) + i (c + b)
                [(n, (a + d).hypot(c - b)), (-n, (a - d).hypot(c + b))]
            })
        };
        let strongest = spectrum().fold((0, T::zero()), |best, next| if next.1 > best.1 { next } else { best });
        let significant = spectrum().filter(|&(_, amplitude)| amplitude > tolerance * strongest.1);
        let differences = significant.map(|(m, _)| m.abs_diff(strongest.0) as usize);
        match differences.fold(0, gcd) {
            0 => Symmetry::Continuous,
            k => Symmetry::Finite(k / gcd(k, strongest.0.unsigned_abs() as usize)),
        }
    }

    /// The symmetry order by the rule of the reference system: the greatest common divisor of n + 1 over the harmonics,
    /// among the first `harmonic_count`, whose norm is above `threshold`; the first one counts only if the norms of (a_1, b_1) and
    /// (c_1, d_1) differ by more than that. 1 if none counts, for a circle too.
    ///
    /// Right for the heart, the square and the ellipse of MDS-HR; kept for comparison. [`Self::symmetry`] is the exact
    /// rule. The reference takes [`REFERENCE_SYMMETRY_HARMONICS`] and [`REFERENCE_SYMMETRY_THRESHOLD`].
    #[must_use]
    pub fn reference_symmetry_order(&self, harmonic_count: usize, threshold: T) -> usize {
        let counts = |n: usize, [a, b, c, d]: [T; 4]| {
            let (x, y) = (a.hypot(b), c.hypot(d));
            let size = if n == 1 { (x - y).abs() } else { x.hypot(y) };
            size > threshold
        };
        let rows = (1_usize..).zip(&self.rows).take(harmonic_count);
        rows.filter(|&(n, &row)| counts(n, row)).map(|(n, _)| n + 1).fold(0, gcd).max(1)
    }
}

/// Greatest common divisor; gcd(0, n) = n.
#[must_use]
pub fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
