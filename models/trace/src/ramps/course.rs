//! Where the colors of a ramp change: along a line, or away from a center.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::scene::RampKind;

use crate::elimination::solve;

/// Logarithm of the root of the ratio of an ellipse's axes: 1 : 20.
const MOST_STRETCH: f64 = 1.5;

/// Which way colors change.
#[derive(Clone, Copy, Debug)]
pub(super) enum Course {
    /// Along a line at this angle.
    Line { angle: f64 },
    /// Away from a center, alike on every ellipse that is the image of a circle under the inverse of the symmetric matrix
    /// exp(\[\[a, b\], \[b, -a\]\]), a and b the `stretch`; on circles if both are 0.
    Center { center: [f64; 2], stretch: [f64; 2], is_circle: bool },
}

/// A course made ready: affine functions of a point, the first of which is the way, or the length of both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    rows: [[f64; 3]; 2],
    is_centered: bool,
}

impl Way {
    /// Way to a point from the beginning, pixels; of ellipses the mean of their axes.
    pub(super) fn to(&self, [x, y]: [f64; 2]) -> f64 {
        let [u, v] = self.rows.map(|[a, b, c]| a * x + b * y + c);
        if self.is_centered { (u * u + v * v).sqrt() } else { u }
    }
}

impl Course {
    /// The course made ready.
    pub(super) fn way(&self) -> Way {
        match *self {
            Self::Line { angle } => Way { rows: [[angle.cos(), angle.sin(), 0.0], [0.0; 3]], is_centered: false },
            Self::Center { center: [x, y], stretch, .. } => {
                Way { rows: matrix(stretch).map(|[a, b]| [a, b, -a * x - b * y]), is_centered: true }
            }
        }
    }

    /// Whether its numbers are those of something that people draw: ellipses that are so long are lines.
    pub(super) fn is_sound(&self) -> bool {
        match self {
            Self::Line { angle } => angle.is_finite(),
            Self::Center { center, stretch, .. } => {
                center.iter().all(|value| value.is_finite()) && stretch[0].hypot(stretch[1]) <= MOST_STRETCH
            }
        }
    }

    /// How many numbers it has.
    pub(super) fn numbers(&self) -> usize {
        match self {
            Self::Line { .. } => 1,
            Self::Center { is_circle: true, .. } => 2,
            Self::Center { .. } => 4,
        }
    }

    /// Moved by `by` along one of its numbers: radians, pixels, and shares of the stretch.
    pub(super) fn moved(mut self, number: usize, by: f64) -> Self {
        match &mut self {
            Self::Line { angle } => *angle += by,
            Self::Center { center, stretch, .. } => match number {
                0 | 1 => center[number] += by,
                _ => stretch[number - 2] += by,
            },
        }
        self
    }

    /// As a scene has it, the offset 0 where the way is `from` (0 about a center) and 1 where it is `to`; pixels.
    pub(super) fn kind(&self, [from, to]: [f64; 2], near: [f64; 2]) -> RampKind<f64> {
        match *self {
            Self::Line { angle } => {
                // On the line through what is painted, so that the points lie there.
                let (cos, sin) = (angle.cos(), angle.sin());
                let across = near[1] * cos - near[0] * sin;
                let point = |way: f64| [way * cos - across * sin, way * sin + across * cos];
                RampKind::Linear([point(from), point(to)])
            }
            Self::Center { center: [x, y], stretch, .. } => {
                // The inverse of exp(S) is exp(-S).
                let [[a, b], [c, d]] = matrix(stretch.map(|v| -v));
                RampKind::Radial([[x, y], [x + to * a, y + to * c], [x + to * b, y + to * d]])
            }
        }
    }
}

/// exp(\[\[a, b\], \[b, -a\]\]), whose determinant is 1.
fn matrix([a, b]: [f64; 2]) -> [[f64; 2]; 2] {
    let size = a.hypot(b);
    let (cosh, slope) = (size.cosh(), if size > 1e-9 { size.sinh() / size } else { 1.0 });
    [[cosh + slope * a, slope * b], [slope * b, cosh - slope * a]]
}

/// The line along which a value changes most, by the plane nearest to it.
pub(super) fn line(samples: impl Iterator<Item = ([f64; 2], f64)>) -> Option<Course> {
    let (mut matrix, mut right) = ([[0.0; 3]; 3], [0.0; 3]);
    for ([x, y], value) in samples {
        add(&mut matrix, &mut right, [x, y, 1.0], value);
    }
    let [a, b, _] = solve(matrix, right)?;
    Some(Course::Line { angle: b.atan2(a) })
}

/// The center from which a value changes in proportion to the distance, in circles or ellipses, and the stretch of these.
///
/// With value u = c + |M (p - center)|, the square u^2 is 2 c u plus a polynomial of the point of second degree: linear in all that is
/// not known, but for one condition between them, which is left to the refinement.
pub(super) fn center(samples: impl Iterator<Item = ([f64; 2], f64)>, is_circle: bool) -> Option<([f64; 2], [f64; 2])> {
    let (mut matrix, mut right) = ([[0.0; 7]; 7], [0.0; 7]);
    for ([x, y], u) in samples {
        let squares = if is_circle { [x * x + y * y, 0.0, 0.0] } else { [x * x, x * y, y * y] };
        add(&mut matrix, &mut right, [u, x, y, 1.0, squares[0], squares[1], squares[2]], u * u);
    }
    let [_, p, q, _, xx, xy, yy] = if is_circle {
        (matrix[5][5], matrix[6][6]) = (1.0, 1.0);
        solve(matrix, right).map(|[c, p, q, r, xx, ..]| [c, p, q, r, xx, 0.0, xx])?
    } else {
        solve(matrix, right)?
    };
    if xx <= 0.0 {
        return None;
    }
    centered([p, q, xx, xy, yy])
}

/// The center of a polynomial p x + q y + xx x^2 + xy x y + yy y^2, and the stretch of the ellipses around it on which it is the same; none if these are no
/// ellipses.
pub(super) fn centered([p, q, xx, xy, yy]: [f64; 5]) -> Option<([f64; 2], [f64; 2])> {
    let determinant = xx * yy - 0.25 * xy * xy;
    if determinant.is_nan() || determinant <= 0.0 {
        return None;
    }
    // Where both slopes of the polynomial are 0.
    let center = [(0.25 * xy * q - 0.5 * yy * p) / determinant, (0.25 * xy * p - 0.5 * xx * q) / determinant];
    // The form is exp(2 S) times a factor, of determinant 1 without it.
    let factor = determinant.sqrt().copysign(xx);
    let [a, b, d] = [xx / factor, 0.5 * xy / factor, yy / factor];
    let cosh = 0.5 * (a + d);
    let twice = cosh.max(1.0).acosh();
    let share = if twice > 1e-9 { 0.5 * twice / twice.sinh() } else { 0.5 };
    Some((center, [share * 0.5 * (a - d), share * b]))
}

fn add<const N: usize>(matrix: &mut [[f64; N]; N], right: &mut [f64; N], row: [f64; N], value: f64) {
    for i in 0..N {
        for j in 0..N {
            matrix[i][j] += row[i] * row[j];
        }
        right[i] += row[i] * value;
    }
}
