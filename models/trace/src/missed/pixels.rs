//! Pixels that differ, and which of them touch.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::ImageView;
use dvp_core::geometry::DisjointSets;

/// Pixels that are compared at once.
const STRETCH: usize = 256;

/// The three channels of the pixels `within` an image.
#[must_use]
pub fn channels<'a>(image: &ImageView<'a, f32>, within: &Range<usize>) -> [&'a [f32]; 3] {
    [0, 1, 2].map(|c| &image.channel(c)[within.clone()])
}

/// The pixels (indices, ascending) some channel of which differs by more than `step` between two images, both given by as many pixels from `first` on.
#[must_use]
#[inline(never)]
pub fn differing(one: [&[f32]; 3], other: [&[f32]; 3], step: f32, first: usize) -> Vec<usize> {
    let pairs = [0, 1, 2].map(|c| (one[c], other[c]));
    let count = one[0].len();
    let mut found = Vec::new();
    // Most stretches are alike: they are compared as a whole.
    for start in (0..count).step_by(STRETCH) {
        let stretch = start..(start + STRETCH).min(count);
        let off = pairs.map(|(one, other)| {
            let values = one[stretch.clone()].iter().zip(&other[stretch.clone()]);
            values.fold(false, |is_off, (one, other)| is_off | ((one - other).abs() > step))
        });
        if off.contains(&true) {
            let is_off = |&i: &usize| pairs.iter().any(|(one, other)| (one[i] - other[i]).abs() > step);
            found.extend(stretch.filter(is_off).map(|i| first + i));
        }
    }
    found
}

/// Which of some pixels (indices, ascending, of a picture with so many columns) touch, across corners too: the number of its part for each, from 0.
#[must_use]
#[inline(never)]
pub fn touching(pixels: &[usize], width: usize) -> Vec<u32> {
    let mut sets = DisjointSets::default();
    let mut parts: Vec<u32> = Vec::with_capacity(pixels.len());
    // The first pixel of the row above that may touch.
    let mut above = 0;
    for (k, &i) in pixels.iter().enumerate() {
        let (x, part) = (i % width, sets.push());
        parts.push(part);
        if x > 0 && k > 0 && pixels[k - 1] + 1 == i {
            sets.unite(parts[k - 1], part);
        }
        let Some(over) = i.checked_sub(width) else { continue };
        while pixels[above] + usize::from(x > 0) < over {
            above += 1;
        }
        let beside = (above..k).take_while(|&k| pixels[k] <= over + usize::from(x + 1 < width));
        beside.for_each(|k| _ = sets.unite(parts[k], part));
    }
    let mut number = vec![u32::MAX; sets.len()];
    let mut count = 0;
    for part in &mut parts {
        let number = &mut number[sets.root(*part) as usize];
        if *number == u32::MAX {
            (*number, count) = (count, count + 1);
        }
        *part = *number;
    }
    parts
}
