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

use dvp_core::geometry::DisjointSets;
use dvp_core::image::distance;
use dvp_core::sort;

use super::flat::{Flats, NONE, Noise, index};
use super::{Color, Partition};
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

/// Rounds in which regions come apart.
const MOST_PARTINGS: usize = 4;

/// Takes apart regions that flat blocks lead across a faint edge, step by step, since coders smooth such edges: what is of one color lies near
/// its mean.
pub(super) fn part(pixels: &[[f32; 3]], [width, _]: [usize; 2], flats: &mut Flats, noise: &Noise) {
    let weights = noise.weights().map(f64::from);
    let weighted = |color: Color| -> Color { core::array::from_fn(|c| color[c] * weights[c]) };
    for _ in 0..MOST_PARTINGS {
        let means: Vec<Color> = flats.means.iter().map(|&(mean, _)| weighted(mean)).collect();
        let is_off = |i: usize| {
            let mean = means.get(flats.regions[i] as usize);
            mean.is_some_and(|&mean| distance(mean, weighted(pixels[i].map(f64::from))) > f64::from(noise.flat))
        };
        let off: Vec<usize> = (0..pixels.len()).filter(|&i| is_off(i)).collect();
        if !part_off(pixels, width, flats, &off, noise.fewest) {
            return;
        }
    }
}

/// Makes regions of their own of pixels (rising) that are not of the color of theirs, where enough of them are side by side; whether there are such.
fn part_off(pixels: &[[f32; 3]], width: usize, flats: &mut Flats, off: &[usize], fewest: usize) -> bool {
    let mut place = vec![NONE; pixels.len()];
    let mut sets = DisjointSets::default();
    for &i in off {
        place[i] = sets.push();
        let beside = [(i % width > 0).then(|| i - 1), i.checked_sub(width)];
        for other in beside.into_iter().flatten().filter(|&other| flats.regions[other] == flats.regions[i]) {
            if place[other] != NONE {
                sets.unite(place[other], place[i]);
            }
        }
    }
    let mut parts: Vec<Vec<usize>> = vec![Vec::new(); off.len()];
    for &i in off {
        parts[sets.root(place[i]) as usize].push(i);
    }
    parts.retain(|part| part.len() >= fewest);
    for part in &parts {
        let (old, new) = (flats.regions[part[0]] as usize, index(flats.means.len()));
        let mut sum: Color = [0.0; 3];
        for &i in part {
            flats.regions[i] = new;
            sum.iter_mut().zip(pixels[i]).for_each(|(total, value)| *total += f64::from(value));
        }
        let count = part.len();
        let (mean, had) = &mut flats.means[old];
        // A region of which nothing is left has no pixel that its color could be wrong for, and goes with the stains.
        let left = (*had - count).max(1) as f64;
        *mean = core::array::from_fn(|c| (mean[c] * *had as f64 - sum[c]) / left);
        *had -= count;
        flats.means.push((sum.map(|total| total / count as f64), count));
    }
    !parts.is_empty()
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

/// Gives colors of which nothing is flat the mean of what lies inside of their faces.
///
/// *Why*: such a color is that of the pixel that stood out most. Where a face has an inside, and no two by two pixels of it are alike, it is a pattern, as
/// of a picture of few colors whose dots stand for others: what its dots are on the mean was drawn.
pub(super) fn color_patterns(partition: &mut Partition) {
    let [width, height] = partition.size;
    let mut flat = vec![0; partition.palette.len()];
    partition.faces.iter().for_each(|face| flat[face.color] += face.flat);
    let mut sums = vec![([0.0; 3], 0); partition.palette.len()];
    for y in 1..height.saturating_sub(1) {
        for i in y * width + 1..(y + 1) * width - 1 {
            let label = partition.labels[i];
            let Some(color) = partition.faces.get(label as usize).map(|face| face.color) else { continue };
            let is_inside =
                || (0..3).all(|row| (0..3).all(|k| partition.labels[i + row * width + k - width - 1] == label));
            if flat[color] == 0 && is_inside() {
                let (sum, count): &mut ([f64; 3], usize) = &mut sums[color];
                sum.iter_mut().zip(partition.pixels[i]).for_each(|(sum, value)| *sum += f64::from(value));
                *count += 1;
            }
        }
    }
    for (color, (sum, count)) in partition.palette.iter_mut().zip(sums) {
        if count >= tuning::CODED_THIN {
            *color = sum.map(|sum| sum / count as f64);
        }
    }
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
