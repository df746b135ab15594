//! Invariants of exact coverage.

use dvp_core::render::{ExactArea, HardMask};
use dvp_core::{ImageSize, Real};
use dvp_tests::coverage::coverage;
use dvp_tests::strategy;
use proptest::prelude::*;

const SIDE: usize = 24;

fn size() -> ImageSize {
    ImageSize::new(SIDE, SIDE).unwrap()
}

fn exact(outline: &[[f64; 2]]) -> Vec<f64> {
    coverage(ExactArea, outline, size()).unwrap()
}

/// Area of a simple polygon.
fn area(outline: &[[f64; 2]]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>().abs() / 2.0
}

/// Largest difference between two planes.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Coverage by counting 32 x 32 samples in each pixel.
fn supersampled(outline: &[[f64; 2]]) -> Vec<f64> {
    const FINE: usize = 32;
    let fine: Vec<_> = outline.iter().map(|v| v.map(|x| x * 32.0)).collect();
    let samples = coverage(HardMask, &fine, ImageSize::new(SIDE * FINE, SIDE * FINE).unwrap()).unwrap();
    let mut mean = vec![0.0; SIDE * SIDE];
    for (i, sample) in samples.iter().enumerate() {
        mean[i / (SIDE * FINE) / FINE * SIDE + i % (SIDE * FINE) / FINE] += sample / 1024.0;
    }
    mean
}

proptest! {
    #[test]
    fn agrees_with_supersampling(star in strategy::star_px()) {
        let (exact, sampled) = (exact(&star), supersampled(&star));
        // An edge that crosses a pixel is off by at most half a sample per line of 32 samples, 1/64 of the pixel; up to
        // 24 edges can meet in one pixel, but their errors are independent.
        prop_assert!(largest(&exact, &sampled) < 4.0 / 64.0, "{}", largest(&exact, &sampled));
        let mean = exact.iter().zip(&sampled).map(|(e, s)| e - s).sum::<f64>() / 576.0;
        prop_assert!(mean.abs() < 5e-4, "mean error {mean}");
    }

    #[test]
    fn sums_to_the_area(star in strategy::star_px()) {
        let sum: f64 = exact(&star).iter().sum();
        prop_assert!((sum - area(&star)).abs() < 1e-10, "{sum} instead of {}", area(&star));
    }

    #[test]
    fn parts_outside_the_image_do_not_matter(star in strategy::star_px(), shift in prop::array::uniform2(-20_i8..20)) {
        let moved: Vec<_> = star.iter().map(|v| [v[0] + f64::from(shift[0]), v[1] + f64::from(shift[1])]).collect();
        let (there, here) = (exact(&moved), exact(&star));
        for (i, &found) in there.iter().enumerate() {
            let from = |at: usize, shift: i8| usize::try_from(i32::try_from(at).unwrap() - i32::from(shift)).ok();
            let expected = match (from(i / SIDE, shift[1]), from(i % SIDE, shift[0])) {
                (Some(row), Some(column)) if row < SIDE && column < SIDE => here[row * SIDE + column],
                _ => 0.0,
            };
            prop_assert!((found - expected).abs() < 1e-12, "pixel {i}: {found} instead of {expected}");
        }
    }

    #[test]
    fn direction_and_start_do_not_matter(outline in strategy::wild_outline(), start in any::<prop::sample::Index>()) {
        let expected = exact(&outline);
        let mut turned = outline.clone();
        turned.rotate_left(start.index(outline.len()));
        turned.reverse();
        // Far vertices (up to 2^29 px) leave 1e-7 of a pixel to the position of an edge.
        prop_assert!(largest(&exact(&turned), &expected) < 1e-5);
    }

    #[test]
    fn stays_in_range(outline in strategy::wild_outline()) {
        prop_assert!(exact(&outline).iter().all(|p| (0.0..=1.0).contains(p)));
        let single: Vec<_> = outline.iter().map(|v| v.map(|x| f32::of(x.clamp(-1e30, 1e30)))).collect();
        let single = coverage(ExactArea, &single, size()).unwrap();
        prop_assert!(single.iter().all(|p| (0.0..=1.0).contains(p)));
    }

    #[test]
    fn single_precision_agrees(star in strategy::star_px()) {
        let rounded: Vec<_> = star.iter().map(|v| v.map(f32::of)).collect();
        let exactly: Vec<_> = rounded.iter().map(|v| v.map(f64::from)).collect();
        let single = coverage(ExactArea, &rounded, size()).unwrap();
        let widened: Vec<_> = single.iter().map(|&p| f64::from(p)).collect();
        prop_assert!(largest(&widened, &exact(&exactly)) < 2e-5);
    }
}

#[test]
fn one_pixel_holds_its_area() {
    let size = ImageSize::new(1, 1).unwrap();
    let found = coverage(ExactArea, &[[0.25, -3.0], [0.75, -3.0], [0.75, 9.0], [0.25, 9.0_f64]], size).unwrap();
    assert!((found[0] - 0.5).abs() < 1e-12, "{found:?}");
}
