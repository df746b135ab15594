//! The ramp that explains pixels, if one does.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::STEP;
use super::course::{self, Course, Way};
use super::profile::{Profile, difference};
use crate::elimination::solve;
use crate::partition::Color;
use crate::tuning::LEAST_RAMP_STEPS;

/// What a ramp may miss of a pixel: rounding, of the picture and of who painted it.
pub(super) const TOLERANCE: f64 = 1.6 * STEP as f64;
/// Share of the pixels that it may miss by more.
const SPARE: f64 = 0.02;
/// What of the way from one end of the colors to the other is looked at for a first course.
const CHANGING: core::ops::Range<f64> = 0.04..0.96;
/// How far behind the middle of the last pixel in full there are edges, pixels.
const BEYOND: f64 = 1.5;
/// How far stops may miss the mean colors along the way, steps.
const EXACT_STEPS: f64 = 1.0;
/// What a ramp that does not explain a part may leave of its squares.
const NEARLY_LEFT: f64 = 0.8;
/// How far its stops may miss the mean colors, steps: less is not seen beside what it leaves.
const NEARLY_STEPS: f64 = 4.0;
/// What a course may miss before it is refined, of 1, in the mean of squares.
const FAR: f64 = 0.06;
/// Pixels that are looked at to find a course: more say no more.
const LOOKED_AT: usize = 1024;
/// Steps of a refinement.
const STEPS: usize = 12;

/// A place, and its color.
pub(super) type Sample = ([f64; 2], Color);

/// Where colors change, and how.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) course: Course,
    way: Way,
    pub(super) profile: Profile,
}

impl Fitted {
    /// The ramp along a course, with as many stops as explain the mean colors within `tolerance`.
    pub(super) fn of(course: Course, samples: &[Sample], tolerance: f64) -> Self {
        Self { course, way: course.way(), profile: measured(&course.way(), samples).simplified(tolerance) }
    }

    /// The ramp with the stops that more samples of it tell, from one end of them to the other.
    pub(super) fn of_more(&self, samples: &[Sample], is_exact: bool) -> Self {
        let steps = if is_exact { EXACT_STEPS } else { NEARLY_STEPS };
        let mut more = Self::of(self.course, samples, steps * f64::from(STEP));
        let least = if matches!(self.course, Course::Center { .. }) { 0.0 } else { f64::NEG_INFINITY };
        more.profile.reach(BEYOND, least);
        more
    }

    /// Whether it misses no more of the samples than a few.
    pub(super) fn explains(&self, samples: &[Sample]) -> bool {
        explain(|point| self.color_beyond(point), samples)
    }

    /// Whether samples change along its course.
    pub(super) fn goes_on(&self, samples: &[Sample]) -> bool {
        Self::of(self.course, samples, EXACT_STEPS * f64::from(STEP)).explains(samples)
    }

    /// Sum of the squares that it misses.
    pub(super) fn squares(&self, samples: &[Sample]) -> f64 {
        samples.iter().map(|&(point, color)| square(self.color(point), color)).sum()
    }

    /// The color of a place.
    pub(super) fn color(&self, point: [f64; 2]) -> Color {
        let way = self.way.to(point);
        let (first, last) = (self.profile.places[0].0, self.profile.places[self.profile.places.len() - 1].0);
        self.profile.at(way.clamp(first, last)).0
    }

    /// The color of a place, up to two pixels beyond what was seen as the ramp goes on there.
    pub(super) fn color_beyond(&self, point: [f64; 2]) -> Color {
        let way = self.way.to(point);
        let (first, last) = (self.profile.places[0].0, self.profile.places[self.profile.places.len() - 1].0);
        self.profile.at(way.clamp(first - 2.0, last + 2.0)).0
    }
}

/// The ramp of samples: along a line if that explains them, else in circles, else in ellipses. If none does, the nearest of them, where it is
/// near enough.
pub(super) fn fit(samples: &[Sample], is_exact: bool) -> Option<Fitted> {
    let few = thinned(samples);
    let values = principal(&few)?;
    // About 0, and of about 1: squares of pixels are large.
    let (mean, size) = extent(&few);
    let normal = |[x, y]: [f64; 2]| [(x - mean[0]) / size, (y - mean[1]) / size];
    // Before the first stop and behind the last nothing changes, and nothing says where it does.
    let changing = || few.iter().zip(&values).filter(|(_, value)| CHANGING.contains(*value));
    let placed = || changing().map(|(&(point, _), &value)| (normal(point), value));
    let center = |is_circle| {
        let ([x, y], stretch) = course::center(placed(), is_circle)?;
        Some(Course::Center { center: [mean[0] + size * x, mean[1] + size * y], stretch, is_circle })
    };
    let tries: [&dyn Fn() -> Option<Course>; 3] = [&|| course::line(placed()), &|| center(true), &|| center(false)];
    let sound = |course: &dyn Fn() -> Option<Course>| course().filter(Course::is_sound);
    // What changes in a few pixels only is no ramp.
    let changes = |fitted: &Fitted| fitted.profile.range() >= f64::from(LEAST_RAMP_STEPS * STEP);
    if is_exact {
        return tries
            .into_iter()
            .find_map(|course| along(sound(course)?, samples, &few, &[samples.len()]).filter(changes));
    }
    let nearest = tries.into_iter().filter_map(|course| {
        let fitted = Fitted::of(refined(sound(course)?, &few), samples, NEARLY_STEPS * f64::from(STEP));
        Some((fitted.squares(&few), fitted))
    });
    let (left, fitted) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (left <= NEARLY_LEFT * squares_of_flat(&few)).then_some(fitted).filter(changes)
}

/// The ramp along a course near `course`, if it explains the samples, those of each part: of both up to each of `ends`.
pub(super) fn along(course: Course, samples: &[Sample], few: &[Sample], ends: &[usize]) -> Option<Fitted> {
    // Nothing that is so far off comes near.
    if missed(&course, few).0 > FAR * FAR * few.len() as f64 {
        return None;
    }
    let course = refined(course, few);
    let way = course.way();
    let profile = measured(&way, samples);
    // Stops explain no more than what they are for.
    if !profile.is_connected(6.0) || !explain(|point| profile.at(way.to(point)).0, samples) {
        return None;
    }
    let fitted = Fitted::of(course, samples, EXACT_STEPS * f64::from(STEP));
    let mut from = 0;
    ends.iter().all(|&end| fitted.explains(&samples[core::mem::replace(&mut from, end)..end])).then_some(fitted)
}

/// Whether colors miss no more of the samples than a few.
fn explain(shown: impl Fn([f64; 2]) -> Color, samples: &[Sample]) -> bool {
    let missed = samples.iter().filter(|&&(point, color)| difference(shown(point), color) > TOLERANCE).count();
    missed as f64 <= SPARE * samples.len() as f64
}

/// The mean colors along a course.
fn measured(way: &Way, samples: &[Sample]) -> Profile {
    Profile::of(samples.iter().map(|&(point, color)| (way.to(point), color)))
}

/// The squares that the measured profile along a course misses, and that profile.
fn missed(course: &Course, samples: &[Sample]) -> (f64, Profile) {
    let way = course.way();
    let profile = measured(&way, samples);
    let squares = samples.iter().map(|&(point, color)| square(profile.at(way.to(point)).0, color));
    (squares.sum::<f64>(), profile)
}

/// Sum of the squares that the mean color misses.
fn squares_of_flat(samples: &[Sample]) -> f64 {
    let count = samples.len().max(1) as f64;
    let mean: Color = core::array::from_fn(|c| samples.iter().map(|(_, color)| color[c]).sum::<f64>() / count);
    samples.iter().map(|&(_, color)| square(mean, color)).sum()
}

fn square(a: Color, b: Color) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum()
}

/// As many of the samples as are looked at.
pub(super) fn thinned(samples: &[Sample]) -> Vec<Sample> {
    samples.iter().step_by(samples.len().div_ceil(LOOKED_AT).max(1)).copied().collect()
}

/// The course along which the measured profile is nearest to the samples, by Gauss-Newton steps. What a number changes alike for all
/// samples at one way is the profile's to change.
fn refined(mut course: Course, samples: &[Sample]) -> Course {
    let (mut error, mut profile) = missed(&course, samples);
    for _ in 0..STEPS {
        let numbers = course.numbers();
        let by = 1e-4;
        let turned: [Way; 4] = core::array::from_fn(|k| course.moved(k.min(numbers - 1), by).way());
        let own_way = course.way();
        let slopes = samples.iter().map(|&(point, _)| {
            let way = own_way.to(point);
            core::array::from_fn(|k| if k < numbers { (turned[k].to(point) - way) / by } else { 0.0 })
        });
        let slopes: Vec<[f64; 4]> = slopes.collect();
        let means: [Profile; 2] = [0, 2].map(|first| {
            let placed = samples.iter().zip(&slopes);
            Profile::of(placed.map(|(&(point, _), own)| (own_way.to(point), [own[first], own[first + 1], 0.0])))
        });
        let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
        for (&(point, color), own) in samples.iter().zip(&slopes) {
            let way = own_way.to(point);
            let (found, slope) = profile.at(way);
            let means = [means[0].at(way).0, means[1].at(way).0];
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
        // The whole step, or the first part of it that gains.
        let parts =
            [1.0, 0.5, 0.25, 0.125].map(|part| (0..numbers).fold(course, |course, k| course.moved(k, part * step[k])));
        let tried = parts.into_iter().filter(Course::is_sound).map(|next| (next, missed(&next, samples)));
        let Some((next, (lower, its))) = tried.into_iter().find(|(_, (lower, _))| *lower < error) else { break };
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
