use alloc::vec::Vec;

use dvp_core::{Image, ImageSize};

use super::{RobustScratch, RobustSettings, read_flat};
use crate::segment::flat::FlatMap;

const SIDE: usize = 64;

fn paint(color: impl Fn(usize, usize) -> [f64; 3]) -> Image<f64> {
    let pixels: Vec<f64> = (0..SIDE * SIDE).flat_map(|i| color(i % SIDE, i / SIDE)).collect();
    Image::from_interleaved(ImageSize::new(SIDE, SIDE).unwrap(), &pixels).unwrap()
}

/// A disk of radius 20 with an edge 4 px soft, on another color.
fn soft_disk() -> Image<f64> {
    paint(|x, y| {
        let off = [x, y].map(|v| f64::from(u32::try_from(v).unwrap()) - 31.5);
        let share = ((22.0 - off[0].hypot(off[1])) / 4.0).clamp(0.0, 1.0);
        [0.2 + 0.6 * share, 0.7 - 0.4 * share, 0.5]
    })
}

#[test]
fn a_noisy_disk_is_one_region_on_another() {
    let mut image = soft_disk();
    // Values of a generator with Knuth's constants, one of three each: a standard deviation of 0.05.
    let mut state = 1_u64;
    for value in image.data_mut() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *value += 0.05 * 1.5_f64.sqrt() * (f64::from(u32::try_from(state >> 33).unwrap() % 3) - 1.0);
    }
    let (mut scratch, mut map) = (RobustScratch::default(), FlatMap::default());
    read_flat(&image.view(), RobustSettings::of(0.05), usize::MAX, &mut scratch, &mut map);
    assert_eq!(map.region_count, 2);
    let at = |x: usize, y: usize| map.labels[y * SIDE + x];
    assert_eq!([at(1, 1), at(62, 62), at(32, 32), at(18, 32)], [1, 1, 2, 2]);
    // Half covered pixels belong to neither.
    assert_eq!([at(52, 32), at(32, 11)], [0, 0]);
}
