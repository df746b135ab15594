//! Descriptors to cubic Bezier curves.

use core::f64::consts::TAU;
use core::fmt::Write;

/// Halvings of the first intervals at most; 4 x 2^8 curves are more than any outline needs.
const MAX_DEPTH: usize = 8;

/// A closed smooth outline given by its elliptic Fourier descriptors.
pub(super) struct Curve<'a> {
    pub(super) rows: &'a [[f64; 4]],
}

impl Curve<'_> {
    /// The point at parameter t in [0, 1].
    pub(super) fn point(&self, t: f64) -> [f64; 2] {
        self.sum(t, |_, [a, b, c, d], sin, cos| [a * cos + b * sin, c * cos + d * sin])
    }

    /// Its derivative by t.
    fn velocity(&self, t: f64) -> [f64; 2] {
        self.sum(t, |n, [a, b, c, d], sin, cos| [TAU * n * (b * cos - a * sin), TAU * n * (d * cos - c * sin)])
    }

    fn sum(&self, t: f64, term: impl Fn(f64, [f64; 4], f64, f64) -> [f64; 2]) -> [f64; 2] {
        let mut n = 0.0;
        let mut total = [0.0; 2];
        for &row in self.rows {
            n += 1.0;
            let (sin, cos) = (TAU * n * t).sin_cos();
            let [x, y] = term(n, row, sin, cos);
            total = [total[0] + x, total[1] + y];
        }
        total
    }

    /// SVG path data that stays within `tolerance` of the outline; both in the outline's units.
    ///
    /// Each piece is the cubic that shares both end points and velocities with the outline (its error falls with the
    /// fourth power of the piece's length); pieces are halved until they are good enough.
    pub(super) fn path_data(&self, tolerance: f64) -> String {
        // Rounding may take a fifth of the tolerance.
        let decimals = (2.5 / tolerance).log10().ceil().clamp(0.0, 12.0);
        let mut data = String::from("M");
        write_point(&mut data, self.point(0.0), decimals);
        for quarter in [0.0, 0.25, 0.5, 0.75] {
            self.piece(quarter, 0.25, MAX_DEPTH, tolerance * 0.8, decimals, &mut data);
        }
        data.push('Z');
        data
    }

    fn piece(&self, t: f64, length: f64, depth: usize, tolerance: f64, decimals: f64, data: &mut String) {
        let (start, end) = (self.point(t), self.point(t + length));
        let (v0, v1) = (self.velocity(t), self.velocity(t + length));
        let control = |p: [f64; 2], v: [f64; 2], s: f64| [p[0] + v[0] * s, p[1] + v[1] * s];
        let cubic = [start, control(start, v0, length / 3.0), control(end, v1, -length / 3.0), end];
        if depth > 0 && !self.is_close(&cubic, t, length, tolerance) {
            self.piece(t, length / 2.0, depth - 1, tolerance, decimals, data);
            self.piece(t + length / 2.0, length / 2.0, depth - 1, tolerance, decimals, data);
        } else {
            data.push('C');
            for (i, point) in cubic[1..].iter().enumerate() {
                if i > 0 {
                    data.push(' ');
                }
                write_point(data, *point, decimals);
            }
        }
    }

    /// Compares at equal parameters, which bounds the distance of the curves; four samples per wave of the highest
    /// harmonic, so that none hides between them.
    fn is_close(&self, cubic: &[[f64; 2]; 4], t: f64, length: f64, tolerance: f64) -> bool {
        let waves = 2.0 + length * self.rows.iter().map(|_| 1.0).sum::<f64>();
        let step = 0.25 / waves;
        let mut u = step;
        while u < 1.0 {
            let v = 1.0 - u;
            let weights = [v * v * v, 3.0 * v * v * u, 3.0 * v * u * u, u * u * u];
            let there = self.point(t + length * u);
            let axis = |i: usize| weights.iter().zip(cubic).map(|(w, p)| w * p[i]).sum::<f64>() - there[i];
            if axis(0).hypot(axis(1)) > tolerance {
                return false;
            }
            u += step;
        }
        true
    }
}

fn write_point(data: &mut String, [x, y]: [f64; 2], decimals: f64) {
    data.push_str(&short(x, decimals));
    data.push(',');
    data.push_str(&short(y, decimals));
}

/// A number with at most `decimals` decimals, without idle zeros: -.5, 12, .031.
pub(super) fn short(value: f64, decimals: f64) -> String {
    let unit = 10f64.powf(decimals);
    let rounded = (value * unit).round() / unit;
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = write!(text, "{}", if rounded == 0.0 { 0.0 } else { rounded });
    if let Some(rest) = text.strip_prefix("0.") {
        format!(".{rest}")
    } else if let Some(rest) = text.strip_prefix("-0.") {
        format!("-.{rest}")
    } else {
        text
    }
}
