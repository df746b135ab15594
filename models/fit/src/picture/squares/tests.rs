//! Codes of square modules come out exactly.

use alloc::vec::Vec;

use super::*;
use crate::paint::Canvas;
use crate::picture::{Known, PictureScratch, fit_picture};
use crate::{FitOptions, Fitter};

#[test]
fn codes_that_machines_read_are_no_noise() {
    // 31 x 31 modules of two colors, in any of which the next one may be of either: as noise, there is nothing left of them.
    let module = |x: usize, y: usize| (x * x * 7 + y * y * 13 + x * y * 31 + x * 5 + y * 3) % 11 < 5;
    let is_dark = |x: usize, y: usize| (2..29).contains(&x) && (2..29).contains(&y) && module(x, y);
    for times in [1, 3] {
        let side = 31 * times;
        let color = |i: usize| if is_dark(i % side / times, i / side / times) { [0.0; 3] } else { [1.0; 3] };
        let pixels: Vec<f32> = (0..side * side).flat_map(color).collect();
        let shown = Image::from_interleaved(ImageSize::new(side, side).unwrap(), &pixels).unwrap();
        let fitter = Fitter::new(FitOptions::default()).unwrap();
        let found =
            fit_picture(&fitter, shown.view(), &Known::default(), &mut PictureScratch::default()).unwrap().scene;
        let painted = Canvas::default().paint(&found, shown.size()).unwrap().0.clone();
        let missed = painted.data().iter().zip(shown.data()).filter(|(a, b)| (*a - *b).abs() > 0.1).count();
        assert_eq!(missed, 0, "of {} values, {times} times", shown.data().len());
    }
}
