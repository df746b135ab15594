use alloc::vec;
use alloc::vec::Vec;

use dvp_core::{Image, ImageSize};
use proptest::prelude::*;

use super::*;

fn picture(width: usize, height: usize, color: impl Fn(usize, usize) -> [f32; 3]) -> Image<f32> {
    let pixels: Vec<[f32; 3]> = (0..width * height).map(|i| color(i % width, i / width)).collect();
    Image::from_interleaved(ImageSize::new(width, height).unwrap(), pixels.as_flattened()).unwrap()
}

#[test]
fn what_is_of_one_color_is_one_region_and_faint_texture_none() {
    // Three stripes with a texture of a hundredth of the scale.
    let color = |x: usize, y: usize| {
        [[0.2; 3], [0.8, 0.4, 0.2], [0.5; 3]][x / 10].map(|v| v + ((x * 7 + y * 13) % 5) as f32 * 0.005)
    };
    let image = picture(30, 24, color);
    let found = regions(&image.view(), 256, 0.0);
    assert_eq!(found.count, 3);
    assert!((0..30 * 24).all(|i| found.labels[i] as usize == (i % 30) / 10));
}

#[test]
fn no_more_regions_than_asked_for_and_those_of_least_contrast_go_first() {
    let color = |x: usize, _: usize| [[0.1_f32; 3], [0.3; 3], [0.9; 3]][x / 8];
    let image = picture(24, 16, color);
    let found = regions(&image.view(), 2, 0.0);
    assert_eq!(found.count, 2);
    assert_eq!(found.labels[0], found.labels[8]);
    assert!((found.image.view().pixel(0)[0] - 0.2).abs() < 1e-6, "the mean of both");
    assert_eq!(regions(&image.view(), 1, 0.0).count, 1);
}

#[test]
fn regions_merge_in_the_order_of_what_it_costs() {
    // Quarters of 32 x 32 pixels at 0, 0.1, 0.5 and 0.6, boundaries of 32 px + 8: merging 0 with 0.1 adds
    // 3 x 0.1^2 x 512 / 40 = 0.384 per px, merging the pairs (0.05 with 0.55, boundary 64 + 8) adds
    // 3 x 0.5^2 x 1024 / 72 = 10.7.
    let image = picture(64, 64, |x, y| [[0.0, 0.1, 0.5, 0.6][x / 32 + 2 * (y / 32)]; 3]);
    let view = image.view();
    let regions = |worth: f64, most: usize| {
        merged_zones([&view, &view], 1e-3, (worth / BOUNDARY_PRICE, most), None, &mut Vec::new())
    };
    assert_eq!(regions(0.37, usize::MAX), 4);
    assert_eq!(regions(0.39, usize::MAX), 2);
    assert_eq!(regions(10.6, usize::MAX), 2);
    assert_eq!(regions(10.8, usize::MAX), 1);
    // What costs nothing is free of charge, and ends all the same.
    assert_eq!([regions(0.0, usize::MAX), regions(0.0, 3), regions(0.0, 1), regions(f64::INFINITY, 4)], [4, 3, 1, 1]);
}

#[test]
fn what_a_coder_leaves_beside_an_edge_is_a_halo_and_a_large_thing_none() {
    // A strip of a quarter of the contrast beside an edge, and a field of the same difference in a corner.
    let color = |x: usize, y: usize| {
        let is_field = x < 24 && y < 24;
        [if x >= 40 {
            1.0
        } else if x >= 38 || is_field {
            0.25
        } else {
            0.0
        }; 3]
    };
    let image = picture(64, 64, color);
    let view = image.view();
    let halo = Halo { share: 2.0, pixels: 256.0, width_px: 8.0, color: 0.03 };
    let mut labels = Vec::new();
    let count = |halo, labels: &mut Vec<u32>| merged_zones([&view, &view], 1e-3, (1e-9, usize::MAX), halo, labels);
    assert_eq!(count(None, &mut labels), 4);
    assert_eq!(count(Some(halo), &mut labels), 3);
    let at = |x: usize, y: usize| labels[y * 64 + x];
    assert!(at(39, 50) == at(30, 50) && at(5, 5) != at(30, 50) && at(60, 50) != at(30, 50));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the picture is: regions are no more than asked for, hang together, and have the mean of their pixels.
    #[test]
    fn regions_hang_together_and_have_the_mean_color(
        (width, height, values) in (1..12_usize, 1..12_usize).prop_flat_map(|(width, height)| {
            (Just(width), Just(height), prop::collection::vec(0.0..1.0_f32, 3 * width * height))
        }),
        most in 1..20_usize,
        noise in 0.0..0.2_f64,
    ) {
        let image = picture(width, height, |x, y| core::array::from_fn(|c| values[3 * (y * width + x) + c]));
        let found = regions(&image.view(), most, noise);
        prop_assert!(found.count <= most && found.count > 0);
        let mut sums = vec![([0.0_f64; 3], 0.0); found.count];
        for (i, &label) in found.labels.iter().enumerate() {
            let (sum, pixels) = &mut sums[label as usize];
            (0..3).for_each(|c| sum[c] += f64::from(image.view().pixel(i)[c]));
            *pixels += 1.0;
        }
        for (i, &label) in found.labels.iter().enumerate() {
            let (sum, pixels) = sums[label as usize];
            prop_assert!((0..3).all(|c| (sum[c] / pixels - f64::from(found.image.view().pixel(i)[c])).abs() < 1e-5));
        }
        // From the first pixel of each region all others are reached.
        let mut reached = vec![false; width * height];
        for region in 0..found.count as u32 {
            let mut open: Vec<usize> = found.labels.iter().position(|&label| label == region).into_iter().collect();
            while let Some(i) = open.pop() {
                if reached[i] || found.labels[i] != region {
                    continue;
                }
                reached[i] = true;
                let (x, y) = (i % width, i / width);
                open.extend((x > 0).then(|| i - 1));
                open.extend((x + 1 < width).then_some(i + 1));
                open.extend((y > 0).then(|| i - width));
                open.extend((y + 1 < height).then_some(i + width));
            }
        }
        prop_assert!(reached.iter().all(|&is_reached| is_reached));
    }
}
