#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use alloc::vec;
use alloc::vec::Vec;

use super::*;
use crate::ImageSize;

/// A mask from rows of X and dots.
fn mask(rows: &[&str]) -> (Vec<bool>, ImageSize) {
    let size = ImageSize::new(rows[0].len(), rows.len()).unwrap();
    (rows.iter().flat_map(|row| row.bytes()).map(|byte| byte == b'X').collect(), size)
}

#[test]
fn a_pixel_is_a_unit_square() {
    let (mask, size) = mask(&["...", ".X.", "..."]);
    let borders = trace_mask::<f64>(&mask, size, Connectivity::Four).unwrap();
    assert_eq!(borders, [[[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0]]]);
    assert_eq!(signed_area(&borders[0]), 1.0);
}

#[test]
fn a_hole_runs_the_other_way() {
    let (mask, size) = mask(&["XXXXX", "X...X", "XXX.X", "XXXXX"]);
    let borders = trace_mask::<f64>(&mask, size, Connectivity::Four).unwrap();
    // The hole is an L of 4 pixels with 6 corners; its floor at y = 2 has two of them.
    assert_eq!(borders[0], [[0.0, 0.0], [5.0, 0.0], [5.0, 4.0], [0.0, 4.0]]);
    assert_eq!(borders[1].iter().filter(|v| v[1] == 2.0).count(), 2);
    assert_eq!(borders[1].len(), 6);
    assert_eq!([signed_area(&borders[0]), signed_area(&borders[1])], [20.0, -4.0]);
    assert_eq!(perimeter(&borders[1]), 10.0);
}

#[test]
fn corners_join_or_part() {
    let (mask, size) = mask(&["X.", ".X"]);
    assert_eq!(trace_mask::<f32>(&mask, size, Connectivity::Four).unwrap().len(), 2);
    assert_eq!(trace_mask::<f32>(&mask, size, Connectivity::Eight).unwrap().len(), 1);
    assert_eq!(label(&mask, size, Connectivity::Four).unwrap().labels, [1, 0, 0, 2]);
    assert_eq!(label(&mask, size, Connectivity::Eight).unwrap().labels, [1, 0, 0, 1]);
}

#[test]
fn labels_that_meet_late_are_one() {
    let (mask, size) = mask(&["X.X.X", "X.XXX", "XXX..", "....X"]);
    let components = label(&mask, size, Connectivity::Four).unwrap();
    assert_eq!(components.sizes, [10, 1]);
    assert_eq!(components.labels[4], 1);
    assert_eq!(components.labels[19], 2);
}

#[test]
fn a_level_is_met_between_centers() {
    // One pixel of 1 among zeros at level 1/4: the crossing is 3/4 of the way to each neighbor; at the right, the image ends.
    let size = ImageSize::new(2, 3).unwrap();
    let field = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
    let lines = trace_level::<f64>(&field, size, 0.25, Connectivity::Four).unwrap();
    assert_eq!(lines, [[[1.5, 0.75], [2.0, 1.5], [1.5, 2.25], [0.75, 1.5]]]);
    let strange = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.0, 0.25, 0.0];
    for line in trace_level(&strange, size, 0.25, Connectivity::Eight).unwrap() {
        assert!(line.iter().flatten().all(|value| value.is_finite()), "{line:?}");
    }
}

#[test]
fn points_at_equal_distances() {
    let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let points = resample(&square, 8);
    let expected = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
    assert_eq!(points, expected);
    assert_eq!(resample::<f64>(&[], 3), Vec::<[f64; 2]>::new());
    assert_eq!(resample(&[[1.0, 2.0]], 2), vec![[1.0, 2.0]; 2]);
}

#[test]
fn even_odd() {
    // A star drawn in one line: its middle is wound twice, so outside.
    let star: Vec<[f64; 2]> = (0..5)
        .map(|i| num_traits::Float::sin_cos(f64::from(i) * 0.8 * core::f64::consts::PI))
        .map(|(s, c)| [c, s])
        .collect();
    assert!(!contains(&star, [0.0, 0.0]));
    assert!(contains(&star, [0.7, 0.0]));
    assert!(!contains(&star, [2.0, 0.0]));
    assert!(!contains::<f64>(&[], [0.0, 0.0]));
}

#[test]
fn a_grid_of_another_size_is_refused() {
    let size = ImageSize::new(2, 2).unwrap();
    let refused = ContourError::Length { expected: 4, len: 3 };
    assert_eq!(label(&[true; 3], size, Connectivity::Four), Err(refused));
    assert_eq!(trace_mask::<f32>(&[true; 3], size, Connectivity::Four), Err(refused));
    assert_eq!(trace_level(&[0.0; 3], size, 0.5, Connectivity::Four), Err(refused));
}
