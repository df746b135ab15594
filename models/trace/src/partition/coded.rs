//! Pictures that a coder of photographs (JPEG) has changed.
//!
//! Such coders keep brightness well and color badly: color is stored at half the resolution and in coarser steps. Measured on 210 icons, emoji
//! and flags (JPEG of quality 80, 4:2:0), pixels across an edge are off by 5 levels of brightness and 13 of each color difference (root mean
//! square), those four pixels away by 2 and 2. Brightness and color differences are therefore weighted such that both are
//! off by about as much, and everything that compares colors works on these.

use alloc::vec;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::sort;

use super::Color;
use super::flat::{Flats, NONE};
use super::palette::distance;
use crate::tuning;

/// Shares of red, green and blue in brightness (ITU-R BT.601, as JFIF has it).
const LUMA: [f64; 3] = [0.299, 0.587, 0.114];
/// What makes the differences of blue and of red to brightness as long as those of JFIF.
const DIFFERENCES: [f64; 2] = [0.564, 0.713];

/// Brightness, and weighted differences of blue and red to it.
pub(super) fn weighted(pixel: [f32; 3]) -> [f32; 3] {
    let [red, green, blue] = pixel.map(f64::from);
    let luma = LUMA[0] * red + LUMA[1] * green + LUMA[2] * blue;
    let [of_blue, of_red] = DIFFERENCES.map(|factor| factor * tuning::CODED_COLOR_WEIGHT);
    [luma, of_blue * (blue - luma), of_red * (red - luma)].map(|value| value as f32)
}

/// The color that [`weighted`] makes this of.
pub(super) fn as_rgb([luma, of_blue, of_red]: Color) -> Color {
    let [blue_factor, red_factor] = DIFFERENCES.map(|factor| factor * tuning::CODED_COLOR_WEIGHT);
    let (blue, red) = (luma + of_blue / blue_factor, luma + of_red / red_factor);
    [red, (luma - LUMA[0] * red - LUMA[2] * blue) / LUMA[1], blue]
}

/// Leaves regions that the colors of larger ones nearby explain to mixtures: stains beside edges.
pub(super) fn dissolve(pixels: &[[f32; 3]], [width, height]: [usize; 2], flats: &mut Flats) {
    let mut of_region: Vec<Vec<usize>> = vec![Vec::new(); flats.means.len()];
    for (i, &region) in flats.regions.iter().enumerate().filter(|&(_, &region)| region != NONE) {
        let list = &mut of_region[region as usize];
        // Larger ones stay whatever lies beside them.
        if list.len() <= tuning::CODED_MOST_STAIN {
            list.push(i);
        }
    }
    let mut small: Vec<usize> =
        (0..of_region.len()).filter(|&k| flats.means[k].1 <= tuning::CODED_MOST_STAIN).collect();
    sort::descending(&mut small, |&region| flats.means[region].1 as f64);
    let mut is_kept: Vec<bool> = flats.means.iter().map(|&(_, count)| count > tuning::CODED_MOST_STAIN).collect();
    let mut near: Vec<u32> = Vec::new();
    for region in small {
        near.clear();
        for &i in &of_region[region] {
            let (x, y) = (i % width, i / width);
            let reach = tuning::CODED_REACH;
            for row in y.saturating_sub(reach)..(y + reach + 1).min(height) {
                let columns = row * width + x.saturating_sub(reach)..row * width + (x + reach + 1).min(width);
                for &other in &flats.regions[columns] {
                    if other != NONE && is_kept[other as usize] && !near.contains(&other) {
                        near.push(other);
                    }
                }
            }
        }
        let misfit = |&i: &usize| {
            let pixel = pixels[i].map(f64::from);
            let away = near.iter().map(|&other| distance(flats.means[other as usize].0, pixel));
            (away.fold(f64::INFINITY, f64::min) / tuning::CODED_SIGMA).powi(2)
        };
        let chi2 = of_region[region].iter().map(misfit).sum::<f64>() / tuning::CODED_ALIKE;
        is_kept[region] = 0.5 * core::f64::consts::LOG2_E * chi2 > tuning::SPECK_BITS;
    }
    flats.keep(&is_kept);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn weighted_colors_are_the_same_colors(pixel in prop::array::uniform3(0.0f32..1.0)) {
            let back = as_rgb(weighted(pixel).map(f64::from));
            for c in 0..3 {
                prop_assert!((back[c] - f64::from(pixel[c])).abs() < 1e-5, "{back:?} instead of {pixel:?}");
            }
        }
    }
}
