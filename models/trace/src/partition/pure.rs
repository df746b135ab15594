//! Pictures of squares of one color, and of regions of one color: no pixel is mixed, so each has a color of the palette.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::image::distance;
use dvp_core::sort;

use super::flat::Noise;
use super::mix::Mixed;
use super::{Color, NoPartition};

/// Every pixel by itself, of no more than `most` colors. These come by falling area; what differs from one of them by rounding has that.
pub(super) fn mixed(pixels: &[[f32; 3]], noise: &Noise, most: usize) -> Result<Mixed, NoPartition> {
    let key = |pixel: &[f32; 3]| pixel.map(f32::to_bits);
    let mut counts: BTreeMap<[u32; 3], usize> = BTreeMap::new();
    pixels.iter().for_each(|pixel| *counts.entry(key(pixel)).or_default() += 1);
    let mut order: Vec<([u32; 3], usize)> = counts.into_iter().collect();
    sort::descending(&mut order, |&(_, count)| count as f64);
    let (mut palette, mut number): (Vec<Color>, BTreeMap<[u32; 3], u16>) = Default::default();
    for (bits, _) in order {
        let color = bits.map(|bits| f64::from(f32::from_bits(bits)));
        let known = palette.iter().position(|known| distance(*known, color) <= f64::from(noise.flat));
        let at = known.unwrap_or(palette.len());
        if at == most {
            return Err(NoPartition::TooManyColors);
        }
        if known.is_none() {
            palette.push(color);
        }
        number.insert(bits, at as u16);
    }
    Ok(Mixed {
        colors: pixels.iter().map(|pixel| number[&key(pixel)]).collect(),
        shares: vec![1.0; pixels.len()],
        is_flat: vec![true; pixels.len()],
        palette,
        unexplained: 0.0,
        noise: f64::from(noise.mixed),
    })
}
