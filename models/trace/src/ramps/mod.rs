//! Colors that change steadily from place to place: found in a picture, and leveled there, so that what is left is a drawing of flat colors.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`level`]: what is found, and the picture without it |
//! | `edge` | whether the edges of a picture are wide |
//! | `smooth` | parts of a picture in which colors change steadily |
//! | `course` | along a line, or away from a center |
//! | `profile` | which color is reached after which way |
//! | `fit` | the course and profile that explain pixels |
//! | `grow` | parts that are of one ramp, and pixels beside them |
//! | `mix` | pixels between leveled parts |
//! | `light` | [`Light`]: what changes under everything |

mod course;
mod edge;
mod fit;
mod grow;
mod light;
mod mix;
mod profile;
mod smooth;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::scene::ColorRamp;
use dvp_core::{Image, ImageView};

use crate::partition::Color;
use crate::tuning::MARKERS_APART;

pub use edge::{are_wide, clear_share};
use fit::Fitted;
pub use light::Light;

/// A step of the 256 that a channel of most pictures has.
const STEP: f32 = 1.0 / 255.0;

/// A picture without its ramps.
#[derive(Clone, Debug)]
pub struct Leveled {
    /// The picture, every ramp in one color of its own.
    pub image: Image<f32>,
    /// What was taken out.
    pub ramps: Vec<LeveledRamp>,
}

/// A ramp that was taken out of a picture.
#[derive(Clone, Debug)]
pub struct LeveledRamp {
    /// The color that stands for it.
    pub color: [f32; 3],
    /// The ramp, its points in scene units.
    pub ramp: ColorRamp<f32>,
    /// Whether it explains all of its pixels; else it is the one that is nearest to them.
    pub is_exact: bool,
}

/// The picture without its ramps; none if it has none, or if its edges are wide.
#[must_use]
pub fn level(image: &ImageView<'_, f32>) -> Option<Leveled> {
    if !smooth::may_change(image) || are_wide(image) {
        return None;
    }
    let (width, count) = (image.size().width(), image.size().pixels());
    let pixels: Vec<[f32; 3]> = (0..count).map(|i| image.pixel(i)).collect();
    let regions = grow::regions(&pixels, width, smooth::Smooth::of(&pixels, width));
    if regions.ramps.is_empty() {
        return None;
    }
    let markers = markers(&regions);
    let leveled = mix::leveled(&pixels, width, &regions, &markers);
    let unit = image.size().unit_px() as f64;
    let ramps = regions.ramps.iter().zip(&markers).map(|(region, color)| LeveledRamp {
        color: color.map(|value| value as f32),
        ramp: in_scene_units(&region.fitted, region.near, unit),
        is_exact: region.is_exact,
    });
    let ramps = ramps.collect();
    let flat: Vec<f32> = leveled.into_iter().flatten().collect();
    Some(Leveled { image: Image::from_interleaved(image.size(), &flat).ok()?, ramps })
}

/// A color for each ramp: its mean, moved until it is clearly another one than those of the flat parts and of the other ramps.
fn markers(regions: &grow::Regions) -> Vec<Color> {
    let mut taken: Vec<Color> = regions.flat_colors.clone();
    let mut markers = Vec::new();
    for region in &regions.ramps {
        let mean = region.mean;
        // Brighter or darker by more and more, whichever is free first.
        let shifts = (0..32).flat_map(|k: u32| [1.0, -1.0].map(|sign| 0.5 * sign * f64::from(k) * MARKERS_APART));
        let shifted = shifts.map(|shift| mean.map(|value| (value + shift).clamp(0.0, 1.0)));
        let is_free = |color: &Color| taken.iter().all(|other| profile::difference(*other, *color) >= MARKERS_APART);
        let color = shifted.into_iter().find(is_free).unwrap_or(mean);
        taken.push(color);
        markers.push(color);
    }
    markers
}

/// A ramp as a scene has it, `near` a point that it paints.
fn in_scene_units(fitted: &Fitted, near: [f64; 2], unit: f64) -> ColorRamp<f32> {
    let places = &fitted.profile.places;
    let is_centered = matches!(fitted.course, course::Course::Center { .. });
    let ends = [if is_centered { 0.0 } else { places[0].0 }, places[places.len() - 1].0];
    let mut kind = fitted.course.kind(ends, near);
    kind.points_mut().as_flattened_mut().iter_mut().for_each(|value| *value /= unit);
    ColorRamp { kind: kind.cast(), stops: fitted.profile.stops(ends) }
}
