//! A cubic through a stretch of samples, by least squares.

use core::ops::Range;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::figure::as_f64;
use super::track::{LEAST_COSINE, Track};

/// Most samples that a trial of a cubic looks at: two for each of its numbers.
const MOST_LOOKS: usize = 16;
/// Steps of the fit, each with the samples' parameters found anew.
const STEPS: usize = 6;

/// Mean squared misfit, in variances, that is not met any more after two steps: 20 sigmas.
const HOPELESS: f64 = 400.0;

/// Bernstein polynomials of degree 3.
pub(super) fn basis(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Point and velocity of a cubic.
pub(super) fn at(cubic: &[Vec2<f64>; 4], t: f64) -> (Vec2<f64>, Vec2<f64>) {
    let [a, b, c, d] = *cubic;
    let s = 1.0 - t;
    let (ab, bc, cd) = (a * s + b * t, b * s + c * t, c * s + d * t);
    let (abc, bcd) = (ab * s + bc * t, bc * s + cd * t);
    (abc * s + bcd * t, (bcd - abc) * 3.0)
}

/// The direction of a vector, without the care for overflow that [`Vec2::normalized`] takes: it is asked for at every sample.
pub(super) fn unit(vector: Vec2<f64>) -> Option<Vec2<f64>> {
    let square = vector.length_squared();
    (square > 0.0 && square.is_finite()).then(|| vector / square.sqrt())
}

/// A better parameter of the point of the cubic that is nearest to `point`.
pub(super) fn nearer(cubic: &[Vec2<f64>; 4], point: Vec2<f64>, t: f64) -> f64 {
    let (place, velocity) = at(cubic, t);
    let speed = velocity.length_squared();
    if speed > 0.0 { (t + (point - place).dot(velocity) / speed).clamp(0.0, 1.0) } else { t }
}

/// The cubic that is closest to samples `range`, and its sum of squared misfits, each by its variance; none if no plain one is.
pub(super) fn fit(track: &Track, range: Range<usize>) -> Option<([Vec2<f64>; 4], f64)> {
    let count = range.len();
    let looks = count.min(MOST_LOOKS);
    if looks < 7 {
        return None;
    }
    let index = |k: usize| (range.start + k * (count - 1) / (looks - 1)) % track.len();
    let mut parameters = [0.0; MOST_LOOKS];
    for k in 1..looks {
        parameters[k] = parameters[k - 1] + (track.point(index(k)) - track.point(index(k - 1))).length();
    }
    let length = parameters[looks - 1];
    parameters[..looks].iter_mut().for_each(|t| *t /= length);
    let ends = [track.point(index(0)), track.point(index(looks - 1))];
    let mut cubic = start(ends, (0..looks).map(|k| (track.point(index(k)), parameters[k])))?;
    let anchor = track.sigma.powi(-2);
    let damping = (8.0 / length).powi(2);
    let mut chi2 = f64::INFINITY;
    for step in 0..=STEPS {
        // Normal equations of the eight coordinates; the ends are held to their samples as a sample would.
        let mut normal = [[0.0; 9]; 8];
        for axis in 0..2 {
            for (corner, end) in [(0, ends[0]), (3, ends[1])] {
                let row = 2 * corner + axis;
                normal[row][row] += anchor;
                normal[row][8] += anchor * (end.to_array()[axis] - cubic[corner].to_array()[axis]);
            }
            // Along a curve that is nearly straight the control points are hardly determined: held back from far steps.
            normal[2 + axis][2 + axis] += damping;
            normal[4 + axis][4 + axis] += damping;
        }
        let before = chi2;
        chi2 = 0.0;
        for (k, t) in parameters[..looks].iter_mut().enumerate() {
            let sample = &track.samples[index(k)];
            *t = nearer(&cubic, sample.point, *t);
            let (place, velocity) = at(&cubic, *t);
            let across = unit(velocity)?.perp();
            let cosine = across.dot(sample.axis).abs().max(LEAST_COSINE);
            let across = across / (cosine * sample.sigma);
            let misfit = (sample.point - place).dot(across);
            chi2 += misfit * misfit;
            let share = basis(*t);
            let row: [f64; 8] = core::array::from_fn(|i| share[i / 2] * across.to_array()[i % 2]);
            for i in 0..8 {
                for j in 0..=i {
                    normal[i][j] += row[i] * row[j];
                }
                normal[i][8] += row[i] * misfit;
            }
        }
        let hopeless = step >= 2 && chi2 > HOPELESS * as_f64(looks);
        if step == STEPS || chi2 > 0.9 * before || hopeless {
            break;
        }
        let change = solve(&mut normal)?;
        for (corner, delta) in cubic.iter_mut().zip(change.chunks_exact(2)) {
            *corner += Vec2::new(delta[0], delta[1]);
        }
    }
    // A control polygon much longer than the walk belongs to a curve that turns back; of a half circle it is half as long again.
    let reach: f64 = cubic.windows(2).map(|ends| (ends[1] - ends[0]).length()).sum();
    let scale = as_f64(count) / as_f64(looks);
    (chi2.is_finite() && reach < 1.6 * length).then_some((cubic, chi2 * scale))
}

/// The cubic between `ends` whose control points fit best at given parameters.
fn start(ends: [Vec2<f64>; 2], samples: impl Iterator<Item = (Vec2<f64>, f64)>) -> Option<[Vec2<f64>; 4]> {
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    let (mut ra, mut rb) = (Vec2::default(), Vec2::default());
    for (point, t) in samples {
        let [first, a, b, last] = basis(t);
        let rest = point - ends[0] * first - ends[1] * last;
        aa += a * a;
        ab += a * b;
        bb += b * b;
        ra += rest * a;
        rb += rest * b;
    }
    let determinant = aa * bb - ab * ab;
    let controls = [(ra * bb - rb * ab) / determinant, (rb * aa - ra * ab) / determinant];
    controls.iter().all(|control| control.is_finite()).then(|| [ends[0], controls[0], controls[1], ends[1]])
}

/// Solves eight equations by Cholesky's method: the lower triangle and, last, the right-hand side.
fn solve(normal: &mut [[f64; 9]; 8]) -> Option<[f64; 8]> {
    for i in 0..8 {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| normal[i][k] * normal[j][k]).sum();
            let value = normal[i][j] - sum;
            if i == j {
                // A trace of damping: a coordinate that nothing determines stays where it is.
                let value = value + 1e-9 * normal[i][i] + 1e-12;
                normal[i][i] = (value > 0.0).then(|| value.sqrt())?;
            } else {
                normal[i][j] = value / normal[j][j];
            }
        }
    }
    let mut x = [0.0; 8];
    for i in 0..8 {
        let sum: f64 = (0..i).map(|k| normal[i][k] * x[k]).sum();
        x[i] = (normal[i][8] - sum) / normal[i][i];
    }
    for i in (0..8).rev() {
        let sum: f64 = (i + 1..8).map(|k| normal[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / normal[i][i];
    }
    Some(x)
}
