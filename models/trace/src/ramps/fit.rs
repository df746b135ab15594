//! The ramp that explains pixels, if one does.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::STEP;
use super::course::{self, Course};
use super::profile::{Profile, difference};
use crate::elimination::solve;
use crate::partition::Color;

/// What a ramp may miss of a pixel: rounding, of the picture and of who painted it.
pub(super) const TOLERANCE: f64 = 1.6 * STEP as f64;
/// Share of the pixels that it may miss by more.
const SPARE: f64 = 0.02;
/// Pixels that are looked at to find a course: more say no more.
const LOOKED_AT: usize = 4096;
/// Steps of a refinement.
const STEPS: usize = 6;

/// A place, and its color.
pub(super) type Sample = ([f64; 2], Color);

/// Where colors change, and how.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) course: Course,
    pub(super) profile: Profile,
}

impl Fitted {
    /// The color of a place.
    pub(super) fn color(&self, point: [f64; 2]) -> Color {
        let way = self.course.way(point);
        let (first, last) = (self.profile.places[0].0, self.profile.places[self.profile.places.len() - 1].0);
        self.profile.at(way.clamp(first, last)).0
    }

    /// The color of a place, up to two pixels beyond what was seen as the ramp goes on there.
    pub(super) fn color_beyond(&self, point: [f64; 2]) -> Color {
        let way = self.course.way(point);
        let (first, last) = (self.profile.places[0].0, self.profile.places[self.profile.places.len() - 1].0);
        self.profile.at(way.clamp(first - 2.0, last + 2.0)).0
    }
}

/// The ramp of samples: along a line if that explains them, else in circles, else in ellipses.
pub(super) fn fit(samples: &[Sample]) -> Option<Fitted> {
    let few = thinned(samples);
    let values = principal(&few)?;
    // About 0, and of about 1: squares of pixels are large.
    let (mean, size) = extent(&few);
    let normal = |[x, y]: [f64; 2]| [(x - mean[0]) / size, (y - mean[1]) / size];
    let placed = || few.iter().zip(&values).map(|(&(point, _), &value)| (normal(point), value));
    let center = |is_circle| match course::center(placed(), is_circle)? {
        Course::Center { center: [x, y], stretch, is_circle } => {
            Some(Course::Center { center: [mean[0] + size * x, mean[1] + size * y], stretch, is_circle })
        }
        line @ Course::Line { .. } => Some(line),
    };
    let tries: [&dyn Fn() -> Option<Course>; 3] = [&|| course::line(placed()), &|| center(true), &|| center(false)];
    tries.iter().find_map(|course| along(course()?, samples, &few, &[samples.len()]))
}

/// The ramp along a course near `course`, if it explains the samples, those of each part: of both up to each of `ends`.
pub(super) fn along(course: Course, samples: &[Sample], few: &[Sample], ends: &[usize]) -> Option<Fitted> {
    let course = refined(course, few);
    let profile = Profile::of(samples.iter().map(|&(point, color)| (course.way(point), color)));
    if !profile.is_connected(6.0) {
        return None;
    }
    let fitted = Fitted { course, profile: profile.simplified(f64::from(STEP)) };
    let is_missed = |&&(point, color): &&Sample| difference(fitted.color(point), color) > TOLERANCE;
    let is_explained = |part: &[Sample]| part.iter().filter(is_missed).count() as f64 <= SPARE * part.len() as f64;
    let mut from = 0;
    ends.iter().all(|&end| is_explained(&samples[core::mem::replace(&mut from, end)..end])).then_some(fitted)
}

/// As many of the samples as are looked at.
pub(super) fn thinned(samples: &[Sample]) -> Vec<Sample> {
    samples.iter().step_by(samples.len().div_ceil(LOOKED_AT).max(1)).copied().collect()
}

/// The course along which the measured profile is nearest to the samples, by Gauss-Newton steps. What a number changes alike for all
/// samples at one way is the profile's to change.
fn refined(mut course: Course, samples: &[Sample]) -> Course {
    let missed = |course: &Course| {
        let profile = Profile::of(samples.iter().map(|&(point, color)| (course.way(point), color)));
        let squares = samples.iter().map(|&(point, color)| {
            let found = profile.at(course.way(point)).0;
            found.iter().zip(color).map(|(a, b)| (a - b).powi(2)).sum::<f64>()
        });
        (squares.sum::<f64>(), profile)
    };
    let (mut error, mut profile) = missed(&course);
    for _ in 0..STEPS {
        let numbers = course.numbers();
        let by = 1e-4;
        let turned: [Course; 4] = core::array::from_fn(|k| course.moved(k.min(numbers - 1), by));
        let slopes = |point: [f64; 2]| -> [f64; 4] {
            let way = course.way(point);
            core::array::from_fn(|k| if k < numbers { (turned[k].way(point) - way) / by } else { 0.0 })
        };
        let means: [Profile; 2] = [0, 2].map(|first| {
            Profile::of(samples.iter().map(|&(point, _)| {
                let own = slopes(point);
                (course.way(point), [own[first], own[first + 1], 0.0])
            }))
        });
        let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
        for &(point, color) in samples {
            let way = course.way(point);
            let (found, slope) = profile.at(way);
            let means = [means[0].at(way).0, means[1].at(way).0];
            let own = slopes(point);
            let own: [f64; 4] = core::array::from_fn(|k| own[k] - means[k / 2][k % 2]);
            for c in 0..3 {
                for i in 0..4 {
                    for j in 0..4 {
                        matrix[i][j] += slope[c] * slope[c] * own[i] * own[j];
                    }
                    right[i] += slope[c] * own[i] * (color[c] - found[c]);
                }
            }
        }
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] = if i < numbers { row[i] * (1.0 + 1e-6) + 1e-12 } else { 1.0 };
        }
        let Some(step) = solve(matrix, right) else { break };
        let next = (0..numbers).fold(course, |course, k| course.moved(k, step[k]));
        let (lower, its) = missed(&next);
        if !(lower < error) {
            break;
        }
        let gain = (error - lower) / error.max(1e-12);
        (course, error, profile) = (next, lower, its);
        if gain < 1e-3 {
            break;
        }
    }
    course
}

/// The color of each sample along the direction in which colors differ most, from 0 to 1; none if they do not differ.
fn principal(samples: &[Sample]) -> Option<Vec<f64>> {
    let count = samples.len().max(1) as f64;
    let mut mean = [0.0; 3];
    for (_, color) in samples {
        mean.iter_mut().zip(color).for_each(|(sum, value)| *sum += value / count);
    }
    let mut axis = [1.0, 0.7, 0.4];
    for _ in 0..16 {
        let mut next = [0.0; 3];
        for (_, color) in samples {
            let along: f64 = (0..3).map(|c| axis[c] * (color[c] - mean[c])).sum();
            (0..3).for_each(|c| next[c] += along * (color[c] - mean[c]));
        }
        let length = next.iter().map(|v| v * v).sum::<f64>().sqrt();
        if length <= 0.0 {
            return None;
        }
        axis = next.map(|v| v / length);
    }
    let values: Vec<f64> =
        samples.iter().map(|(_, color)| (0..3).map(|c| axis[c] * (color[c] - mean[c])).sum()).collect();
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (high > low).then(|| values.iter().map(|value| (value - low) / (high - low)).collect())
}

/// The mean of the places, and half of their larger extent.
fn extent(samples: &[Sample]) -> ([f64; 2], f64) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (point, _) in samples {
        for i in 0..2 {
            low[i] = low[i].min(point[i]);
            high[i] = high[i].max(point[i]);
        }
    }
    let size = 0.5 * (high[0] - low[0]).max(high[1] - low[1]);
    ([0, 1].map(|i| 0.5 * (low[i] + high[i])), size.max(1.0))
}
