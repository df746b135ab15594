//! Light that is uneven: a microscope is brighter in the middle, a lamp stands on one side. All that is seen changes with it.
//!
//! In: a picture. Out: a surface of second degree that most of it lies on ([`Light`]), and the picture without it.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::scene::ColorRamp;
use dvp_core::{Image, ImageView, sort};

use super::course::{Course, centered};
use super::fit::{Fitted, Sample};
use super::profile::difference;
use super::{STEP, in_scene_units};
use crate::elimination::solve;
use crate::noise::ROUNDED;
use crate::partition::Color;
use crate::tuning::{LEAST_LIGHT, LEAST_LIGHT_NOISES};

/// Places along the shorter side at which a picture is looked at: several hundreds for every number.
const PLACES: usize = 48;
/// How far colors may be from the first guess, of 1, and by how much less from every next one.
const FIRST_WIDTH: f64 = 0.5;
const NARROWER: f64 = 0.7;
/// Rounds until the width is that of noise, and a few more; rounds where it is from the beginning.
const ROUNDS: usize = 20;
const FLAT_ROUNDS: usize = 5;
/// Deviations of the noise within which a place shows the surface, and its least share of the places.
const NEAR: f64 = 3.0;
const LEAST_SHARE: f64 = 0.5;
/// What rounding leaves of the difference of two means, of 1.
const ROUNDING: f64 = 0.25 / 255.0;
/// Least deviation of what a surface explains, of 1: rounding, twice, and what bends a little more than a surface of second degree.
const LEAST_NOISE: f64 = 1.0 / 255.0;
/// Distance of pixels of one thing at which they are compared, pixels: the further, the more the light changes.
const APART: usize = 8;
/// How much more than noise differs from the background what is a thing, of 1.
const ALIKE: f64 = 8.0 / 255.0;
/// Darkest light that others are divided by, of 1.
const DARKEST: f64 = 0.02;

/// How light meets the things that lie in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Effect {
    /// It comes on top of them: haze, fluorescence from out of focus.
    Added,
    /// They reflect it, or let it through.
    Multiplied,
}

/// Uneven light, and the picture in even light.
#[derive(Clone, Debug)]
pub struct Light {
    /// The picture as it would be in even light.
    pub image: Image<f32>,
    /// What paints the background: a ramp near to the surface, its points in scene units.
    pub ramp: ColorRamp<f32>,
    surface: Surface,
    /// Its mean: the background in even light.
    mean: Color,
    effect: Effect,
}

/// A color as a polynomial of second degree of the place.
#[derive(Clone, Copy, Debug)]
struct Surface {
    middle: [f64; 2],
    size: f64,
    numbers: [[f64; 6]; 3],
}

impl Light {
    /// The light of a picture whose noise has the standard deviation `noise`; none if it is even, if most of the picture does not show it, or if things
    /// stand in front of it.
    #[must_use]
    #[inline(never)]
    pub fn of(image: &ImageView<'_, f32>, noise: f64) -> Option<Self> {
        // Cameras, which leave noise, see light on everything.
        let is_noisy = noise > ROUNDED;
        let noise = noise.max(LEAST_NOISE);
        let places = places(image);
        let surface = Surface::of(&places, noise, image)?;
        let shown =
            places.iter().filter(|(point, color)| difference(surface.at(*point), *color) < NEAR * noise).count();
        let colors: Vec<Sample> = places.iter().map(|&(point, _)| (point, surface.at(point))).collect();
        let count = places.len() as f64;
        let mean: Color = core::array::from_fn(|c| colors.iter().map(|(_, color)| color[c]).sum::<f64>() / count);
        let squares = |c: usize| colors.iter().map(|(_, color)| (color[c] - mean[c]).powi(2)).sum::<f64>() / count;
        let change = (0..3).map(squares).fold(0.0, f64::max).sqrt();
        if (shown as f64) < LEAST_SHARE * count || change < LEAST_LIGHT.max(LEAST_LIGHT_NOISES * noise) {
            return None;
        }
        let effect = effect(image, &surface, noise, is_noisy)?;
        let ramp = in_scene_units(&surface.ramp(&colors), surface.middle, image.size().unit_px() as f64);
        let mut light = Self { image: Image::zeros(image.size()), ramp, surface, mean, effect };
        let (width, pixels) = (image.size().width(), image.size().pixels());
        for i in 0..pixels {
            let even = light.even(image.pixel(i).map(f64::from), center(i, width));
            even.iter().enumerate().for_each(|(c, &value)| light.image.data_mut()[c * pixels + i] = value as f32);
        }
        Some(light)
    }

    /// The color in even light of what is seen in `color` at a point (px).
    fn even(&self, color: Color, point: [f64; 2]) -> Color {
        let here = self.surface.at(point);
        core::array::from_fn(|c| match self.effect {
            Effect::Added => color[c] - here[c] + self.mean[c],
            Effect::Multiplied => color[c] * self.mean[c] / here[c].max(DARKEST),
        })
    }

    /// What is seen at a point (px) of what has `color` in even light; as it is, not held between 0 and 1.
    #[must_use]
    pub fn seen(&self, color: Color, point: [f64; 2]) -> Color {
        let here = self.surface.at(point);
        core::array::from_fn(|c| match self.effect {
            Effect::Added => color[c] + here[c] - self.mean[c],
            Effect::Multiplied => color[c] * here[c] / self.mean[c].max(DARKEST),
        })
    }

    /// Direction in which light grows at a point (px), per pixel, summed over the channels.
    #[must_use]
    pub fn slope(&self, point: [f64; 2]) -> [f64; 2] {
        let sum = |by: [f64; 2]| self.surface.at([point[0] + by[0], point[1] + by[1]]).iter().sum::<f64>();
        [[0.5, 0.0], [0.0, 0.5]].map(|by| sum(by) - sum(by.map(|v| -v)))
    }
}

impl Surface {
    /// The surface that most places show: from their median on, by squares that count less the further off they are, in the end those of noise alone
    /// (Tukey's biweight).
    fn of(places: &[Sample], noise: f64, image: &ImageView<'_, f32>) -> Option<Self> {
        let sides = [image.size().width(), image.size().height()].map(|side| 0.5 * side as f64);
        let mut surface = Self { middle: sides, size: sides[0].max(sides[1]), numbers: [[0.0; 6]; 3] };
        for (c, numbers) in surface.numbers.iter_mut().enumerate() {
            let mut values: Vec<f64> = places.iter().map(|(_, color)| color[c]).collect();
            numbers[0] = sort::median(&mut values)?;
        }
        // Where most is of one color already, there is no way to go.
        let is_near = |(point, color): &&Sample| difference(surface.at(*point), *color) < NEAR * noise;
        let is_flat = places.iter().filter(is_near).count() as f64 >= LEAST_SHARE * places.len() as f64;
        let (mut width, rounds) = if is_flat { (NEAR * noise, FLAT_ROUNDS) } else { (FIRST_WIDTH, ROUNDS) };
        for _ in 0..rounds {
            let (mut matrix, mut right) = ([[0.0; 6]; 6], [[0.0; 6]; 3]);
            for &(point, color) in places {
                let share = difference(surface.at(point), color) / width;
                let weight = (1.0 - share * share).max(0.0).powi(2);
                let row = surface.row(point);
                for i in 0..6 {
                    for j in 0..6 {
                        matrix[i][j] += weight * row[i] * row[j];
                    }
                    right.iter_mut().zip(color).for_each(|(right, value)| right[i] += weight * row[i] * value);
                }
            }
            for (numbers, right) in surface.numbers.iter_mut().zip(right) {
                *numbers = solve(matrix, right)?;
            }
            width = (NARROWER * width).max(NEAR * noise);
        }
        Some(surface)
    }

    /// The ramp that is nearest to its colors at places: along a line, or about a center if it has one and that is nearer by more than is seen.
    fn ramp(&self, colors: &[Sample]) -> Fitted {
        let [x, y, xx, xy, yy] = [1, 2, 3, 4, 5].map(|k| self.numbers.iter().map(|numbers| numbers[k]).sum::<f64>());
        let center = centered([x, y, xx, xy, yy]).map(|([x, y], stretch)| Course::Center {
            center: [self.middle[0] + self.size * x, self.middle[1] + self.size * y],
            stretch,
            is_circle: false,
        });
        let along = |course: Course| {
            let fitted = Fitted::of(course, colors, f64::from(STEP));
            (fitted.squares(colors), fitted)
        };
        let line = along(Course::Line { angle: y.atan2(x) });
        let unseen = 0.25 * f64::from(STEP * STEP) * colors.len() as f64;
        let center = center.filter(|course| line.0 > unseen && course.is_sound()).map(along);
        match center {
            Some(center) if center.0 < line.0 => center.1,
            _ => line.1,
        }
    }

    fn row(&self, point: [f64; 2]) -> [f64; 6] {
        let [x, y] = [0, 1].map(|c| (point[c] - self.middle[c]) / self.size);
        [1.0, x, y, x * x, x * y, y * y]
    }

    fn at(&self, point: [f64; 2]) -> Color {
        let row = self.row(point);
        self.numbers.map(|numbers| numbers.iter().zip(row).map(|(number, term)| number * term).sum())
    }
}

/// What the light does to things in front of the background: that which leaves their pixels most alike; none if they are alike as they are.
fn effect(image: &ImageView<'_, f32>, surface: &Surface, noise: f64, is_noisy: bool) -> Option<Effect> {
    let (width, height) = (image.size().width(), image.size().height());
    // Means over three by three pixels have a third of the noise.
    let mean = |i: usize| -> Color {
        let around =
            [i - width - 1, i - width, i - width + 1, i - 1, i, i + 1, i + width - 1, i + width, i + width + 1];
        core::array::from_fn(|c| around.iter().map(|&i| f64::from(image.channel(c)[i])).sum::<f64>() / 9.0)
    };
    let seen = |i: usize| {
        let (color, light) = (mean(i), surface.at(center(i, width)));
        (difference(color, light) > NEAR * noise + ALIKE).then_some((color, light))
    };
    let alike = 2.0 / 9.0 * noise * noise + ROUNDING * ROUNDING;
    let mut missed = [0.0; 3];
    for (x, y) in (1..height.saturating_sub(1)).flat_map(|y| (1..width.saturating_sub(1)).map(move |x| (x, y))) {
        let Some(here) = seen(y * width + x) else { continue };
        for (x, y) in [(x + APART, y), (x, y + APART)] {
            if x + 1 >= width || y + 1 >= height {
                continue;
            }
            let Some(there) = seen(y * width + x) else { continue };
            for c in 0..3 {
                let (by, light) = (there.0[c] - here.0[c], there.1[c] - here.1[c]);
                let share = (there.0[c] + here.0[c]) / (there.1[c] + here.1[c]).max(2.0 * DARKEST);
                // What is of two things, or at an edge, says nothing.
                for (missed, by) in missed.iter_mut().zip([by, by - light, by - share * light]) {
                    *missed += by * by / (by * by + alike);
                }
            }
        }
    }
    let [none, added, multiplied] = missed;
    let is_none = !is_noisy && none > 0.0 && none <= added.min(multiplied);
    (!is_none).then_some(if multiplied < added { Effect::Multiplied } else { Effect::Added })
}

/// Places of a picture with their colors.
fn places(image: &ImageView<'_, f32>) -> Vec<Sample> {
    let (width, height) = (image.size().width(), image.size().height());
    let step = (width.min(height) / PLACES).max(1);
    let rows = (step / 2..height).step_by(step);
    let indices = rows.flat_map(|y| (step / 2..width).step_by(step).map(move |x| y * width + x));
    indices.map(|i| (center(i, width), image.pixel(i).map(f64::from))).collect()
}

/// The middle of a pixel.
fn center(i: usize, width: usize) -> [f64; 2] {
    [(i % width) as f64 + 0.5, (i / width) as f64 + 0.5]
}
