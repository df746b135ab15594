//! The colors of a picture: those of its flat regions, equal ones taken together.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::image::distance;
use dvp_core::sort;

use super::flat::{Flats, Noise};
use super::{Color, NoPartition};
use crate::tuning;

/// The colors, and which of them each flat region has.
#[derive(Clone, Debug)]
pub(super) struct Palette {
    pub(super) colors: Vec<Color>,
    /// Color of every flat region.
    pub(super) of_region: Vec<usize>,
}

impl Palette {
    /// Colors by falling area; a region whose color is that of a larger one but for noise shares its entry.
    pub(super) fn of(flats: &Flats, noise: &Noise) -> Result<Self, NoPartition> {
        let mut order: Vec<usize> = (0..flats.means.len()).collect();
        sort::descending(&mut order, |&region| flats.means[region].1 as f64);
        let mut colors: Vec<(Color, f64)> = Vec::new();
        let mut of_region = vec![0; flats.means.len()];
        for region in order {
            let (mean, count) = flats.means[region];
            let weighted = |color: Color| core::array::from_fn(|c| color[c] * f64::from(noise.weights()[c]));
            let is_known =
                |(color, _): &(Color, f64)| distance(weighted(*color), weighted(mean)) <= f64::from(noise.flat);
            let known = colors.iter().position(is_known);
            of_region[region] = known.unwrap_or(colors.len());
            match known {
                None if colors.len() == tuning::MOST_COLORS => return Err(NoPartition::TooManyColors),
                None => colors.push((mean, count as f64)),
                Some(k) => {
                    let (color, weight) = &mut colors[k];
                    let share = count as f64 / (*weight + count as f64);
                    for (old, new) in color.iter_mut().zip(mean) {
                        *old += share * (new - *old);
                    }
                    *weight += count as f64;
                }
            }
        }
        Ok(Self { colors: colors.into_iter().map(|(color, _)| color).collect(), of_region })
    }
}
