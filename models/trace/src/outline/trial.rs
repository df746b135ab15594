//! Figures on trial: fitted to samples, priced, and how well their numbers are known.

use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::bent::unbent;
use super::figure::{Figure, MOST_NUMBERS, Placed, as_f64};
use super::solve::{huber, robust, spoiled_chi2};
use super::track::{LEAST_COSINE, Track};
use super::{Outline, OutlineShape};
use crate::ruler::Ruler;
use crate::sample::{STRAIGHTENED_NOISE, Sample};
use crate::tuning;

/// Samples that a figure is first held against: enough for its numbers, and few, since most are refused.
const FIRST_LOOKS: usize = 48;
/// Steps of a fit.
const STEPS: usize = 8;
/// Mean squared misfit of samples below which a picture is exact: renderers that round their coverage have a half to two.
const EXACT: f64 = 0.1;
/// Step of differences, pixels and radians.
const STEP: f64 = 1e-6;

/// A figure on trial.
#[derive(Clone, Copy)]
pub(super) struct Trial<'a> {
    pub(super) samples: &'a [Sample],
    pub(super) ruler: &'a Ruler,
    pub(super) figure: Figure,
    pub(super) free: [bool; MOST_NUMBERS],
    /// What renderers are off by, pixels.
    pub(super) renderer: f64,
}

/// Normal equations of a figure's numbers; those that are not free keep to themselves.
struct Equations {
    normal: [[f64; MOST_NUMBERS]; MOST_NUMBERS],
    right: [f64; MOST_NUMBERS],
    chi2: f64,
    /// How many samples are in it.
    count: usize,
}

/// What a sample is missed by.
struct Missed {
    /// Pixels.
    distance: f64,
    /// 1 / sigma, along the normal of the figure.
    scale: f64,
    /// In sigmas.
    misfit: f64,
    /// 0 if its window holds a corner: then it tells of both sides.
    weight: f64,
    /// What it adds to the sum of squares.
    chi2: f64,
}

impl Trial<'_> {
    /// The outline if it costs less than `most` bits.
    pub(super) fn run(&self, start: [f64; MOST_NUMBERS], most: f64) -> Option<Outline> {
        let few = self.samples.len().div_ceil(FIRST_LOOKS);
        // A few samples tell whether all can be met; with much room before the fit, and some after.
        let bits = |chi2: f64| self.ruler.misfit(chi2) * as_f64(few);
        let first = bits(self.chi2(&start, few));
        if first.is_nan() || first >= 20.0 * most {
            return None;
        }
        let (numbers, first) = self.descend(start, few)?;
        if bits(first.chi2) > 2.0 * most {
            return None;
        }
        let (numbers, equations) = if few > 1 { self.descend(numbers, 1)? } else { (numbers, first) };
        let misfit = self.ruler.misfit(equations.chi2);
        let factor = cholesky(&equations.normal, 0.0)?;
        let lever = 0.5 * numbers[2].abs();
        let mut bits = tuning::OUTLINE_PIECE_BITS;
        for k in (0..self.figure.number_count()).filter(|&k| self.free[k]) {
            let lever = if self.figure.angle() == Some(k) { lever } else { 1.0 };
            let sigma = lever / factor[k][k];
            // What is not determined is not known to be this figure.
            if sigma > 0.5 {
                return None;
            }
            bits += self.ruler.number(sigma);
        }
        if bits + misfit >= most {
            return None;
        }
        let (numbers, covariance) = self.polish(numbers).unwrap_or((numbers, Vec::new()));
        Some(Outline { shape: self.shape(&numbers)?, bits, misfit, covariance })
    }

    /// The numbers by the doubt of the samples alone, if they are not off by what renderers are off by, and the covariance of the numbers.
    fn polish(&self, numbers: [f64; MOST_NUMBERS]) -> Option<([f64; MOST_NUMBERS], Vec<f64>)> {
        if matches!(self.figure, Figure::Polygon { .. } | Figure::Star { .. }) {
            return None;
        }
        let known = |renderer: f64, samples: &[Sample], numbers: [f64; MOST_NUMBERS]| {
            let (numbers, found) = Trial { renderer, samples, ..*self }.descend(numbers, 1)?;
            // Samples miss by more than the windows that they are made of, from which the numbers are known: a figure follows them over many windows.
            let variance = found.chi2 / (as_f64(found.count) - as_f64(self.count_free())).max(1.0);
            Some((numbers, variance, self.covariance(&found, variance / STRAIGHTENED_NOISE)?))
        };
        // What bends leave in the windows goes first: it would hide that a picture is exact.
        let unbent = |numbers: &[f64; MOST_NUMBERS]| unbent(self.figure, numbers, self.samples);
        let first = unbent(&numbers).and_then(|samples| known(self.renderer, &samples, numbers));
        let (numbers, _, covariance) = match first {
            Some(first) if first.1 < EXACT => {
                unbent(&first.0).and_then(|samples| known(0.0, &samples, first.0)).unwrap_or(first)
            }
            Some(first) => first,
            None => known(self.renderer, self.samples, numbers)?,
        };
        Some((numbers, covariance))
    }

    /// Covariance of the numbers, row by row, where samples have this variance in their sigmas.
    fn covariance(&self, found: &Equations, variance: f64) -> Option<Vec<f64>> {
        let factor = cholesky(&found.normal, 0.0)?;
        let count = self.figure.number_count();
        let row = |k: usize| {
            let unit: [f64; MOST_NUMBERS] = core::array::from_fn(|i| if i == k { variance } else { 0.0 });
            let row = solve(&factor, unit);
            (0..count).map(move |i| if self.free[k] && self.free[i] { row[i] } else { 0.0 })
        };
        Some((0..count).flat_map(row).collect())
    }

    /// How many numbers are free.
    fn count_free(&self) -> usize {
        self.free[..self.figure.number_count()].iter().filter(|&&is_free| is_free).count()
    }

    /// Gauss-Newton on every `every`-th sample.
    fn descend(&self, start: [f64; MOST_NUMBERS], every: usize) -> Option<([f64; MOST_NUMBERS], Equations)> {
        let mut numbers = start;
        let mut now = self.equations(&numbers, every)?;
        let mut damping = 1e-6;
        for _ in 0..STEPS {
            let change = solve(&cholesky(&now.normal, damping)?, now.right);
            let mut next: [f64; MOST_NUMBERS] = core::array::from_fn(|k| numbers[k] + change[k]);
            if self.figure == Figure::Rectangle {
                next[4] = next[4].clamp(0.0, 0.5 * next[2].min(next[3]).max(0.0));
            }
            match self.equations(&next, every).filter(|then| then.chi2 < now.chi2) {
                Some(then) => {
                    let gain = now.chi2 - then.chi2;
                    (numbers, now, damping) = (next, then, damping * 0.1);
                    if gain < 0.1 {
                        break;
                    }
                }
                None if damping > 1.0 => break,
                None => damping = (damping * 1e3).max(1e-3),
            }
        }
        Some((numbers, now))
    }

    /// Sum of what every `every`-th sample is missed by.
    fn chi2(&self, numbers: &[f64; MOST_NUMBERS], every: usize) -> f64 {
        let (placed, corners) = (self.figure.placed(numbers), self.figure.corners(numbers));
        let held = self.samples.iter().step_by(every).map(|sample| self.miss(&placed, &corners, sample));
        held.map(|missed| missed.chi2).sum()
    }

    /// What a sample is missed by.
    fn miss(&self, placed: &Placed, corners: &[Vec2<f64>], sample: &Sample) -> Missed {
        let sigma = if self.renderer > 0.0 { sample.sigma } else { Track::own_sigma(sample) };
        let (distance, normal) = placed.distance(sample.point);
        let scale = 1.0 / (normal.dot(sample.axis).abs().max(LEAST_COSINE) * sigma);
        let misfit = distance * scale;
        if corners.iter().any(|&corner| sample.holds(corner)) {
            return Missed { distance, scale, misfit, weight: 0.0, chi2: (misfit * misfit).min(spoiled_chi2()) };
        }
        let weight = robust(misfit);
        Missed { distance, scale, misfit, weight, chi2: huber(misfit) }
    }

    fn equations(&self, numbers: &[f64; MOST_NUMBERS], every: usize) -> Option<Equations> {
        let count = self.figure.number_count();
        let (placed, corners) = (self.figure.placed(numbers), self.figure.corners(numbers));
        let moved: [Placed; MOST_NUMBERS] = core::array::from_fn(|k| {
            let mut moved = *numbers;
            moved[k] += STEP;
            self.figure.placed(&moved)
        });
        let mut equations =
            Equations { normal: [[0.0; MOST_NUMBERS]; MOST_NUMBERS], right: [0.0; MOST_NUMBERS], chi2: 0.0, count: 0 };
        for sample in self.samples.iter().step_by(every) {
            equations.count += 1;
            let Missed { distance, scale, misfit, weight, chi2 } = self.miss(&placed, &corners, sample);
            equations.chi2 += chi2;
            if weight == 0.0 {
                continue;
            }
            let mut slopes = [0.0; MOST_NUMBERS];
            for k in (0..count).filter(|&k| self.free[k]) {
                slopes[k] = (moved[k].distance(sample.point).0 - distance) * scale / STEP;
            }
            for i in 0..count {
                for j in 0..=i {
                    equations.normal[i][j] += weight * slopes[i] * slopes[j];
                }
                equations.right[i] -= weight * slopes[i] * misfit;
            }
        }
        for k in (0..MOST_NUMBERS).filter(|&k| k >= count || !self.free[k]) {
            equations.normal[k][k] = 1.0;
        }
        equations.chi2.is_finite().then_some(equations)
    }

    fn shape(&self, numbers: &[f64; MOST_NUMBERS]) -> Option<OutlineShape> {
        let [x, y, a, b, c, d] = *numbers;
        let center = Vec2::new(x, y);
        let good = numbers.iter().all(|number| number.is_finite()) && a > 0.0;
        let shape = match self.figure {
            Figure::Circle => OutlineShape::Circle { center, radius: a },
            Figure::Ellipse => OutlineShape::Ellipse { center, radii: [a, b], angle: c },
            Figure::Rectangle => OutlineShape::Rectangle { center, size: [a, b], corner_radius: c, angle: d },
            Figure::Polygon { sides } => OutlineShape::RegularPolygon { center, sides, radius: a, angle: b },
            Figure::Star { points } => OutlineShape::Star { center, points, radii: [a, b], angle: c },
        };
        let positive = matches!(self.figure, Figure::Circle | Figure::Polygon { .. }) || b > 0.0;
        (good && positive).then_some(shape)
    }
}

/// The lower factor of a matrix with its diagonal multiplied by 1 + `damping`.
fn cholesky(normal: &[[f64; MOST_NUMBERS]; MOST_NUMBERS], damping: f64) -> Option<[[f64; MOST_NUMBERS]; MOST_NUMBERS]> {
    let mut factor = [[0.0; MOST_NUMBERS]; MOST_NUMBERS];
    for i in 0..MOST_NUMBERS {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
            if i == j {
                let value = normal[i][i] * (1.0 + damping) - sum;
                factor[i][i] = (value > 0.0 && value.is_finite()).then(|| value.sqrt())?;
            } else {
                factor[i][j] = (normal[i][j] - sum) / factor[j][j];
            }
        }
    }
    Some(factor)
}

fn solve(factor: &[[f64; MOST_NUMBERS]; MOST_NUMBERS], mut x: [f64; MOST_NUMBERS]) -> [f64; MOST_NUMBERS] {
    for i in 0..MOST_NUMBERS {
        let sum: f64 = (0..i).map(|k| factor[i][k] * x[k]).sum();
        x[i] = (x[i] - sum) / factor[i][i];
    }
    for i in (0..MOST_NUMBERS).rev() {
        let sum: f64 = (i + 1..MOST_NUMBERS).map(|k| factor[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / factor[i][i];
    }
    x
}
