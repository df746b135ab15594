//! What blocks become, and that more regions are nearer.

use super::*;
use crate::picture::{Known, fit_picture};
use crate::{FitOptions, Fitter};

#[test]
fn blocks_become_their_means_and_those_at_the_border_are_smaller() {
    let size = ImageSize::new(5, 3).unwrap();
    let image = Image::from_planar(size, (0..45).map(|i| i as f32 / 64.0).collect()).unwrap();
    let small = shrunk(&image.view(), 2).unwrap();
    assert_eq!([small.size().width(), small.size().height()], [3, 2]);
    let means: Vec<f32> = small.view().channel(0).iter().map(|value| value * 64.0).collect();
    assert_eq!(means, [3.0, 5.0, 6.5, 10.5, 12.5, 14.0]);
    assert_eq!(shrunk(&image.view(), 1).unwrap(), image);
}

#[test]
fn what_is_not_flat_is_cut_into_as_many_regions_as_may_be() {
    // Folds of a cloth, and a ball with a highlight on it.
    let wave = |x: f32, y: f32| 0.5 + 0.3 * (0.11 * x + 0.05 * y).sin() + 0.1 * (0.31 * y - 0.13 * x).sin();
    let color = |x: usize, y: usize| {
        let (x, y) = (x as f32, y as f32);
        let ball = 1.0 - (x - 60.0).hypot(y - 40.0) / 30.0;
        if ball > 0.0 { [0.3 + 0.7 * ball, 0.1 + 0.5 * ball * ball, 0.2] } else { [wave(x, y), 0.4, 1.0 - wave(y, x)] }
    };
    let pixels: Vec<f32> = (0..96 * 96).flat_map(|i| color(i % 96, i / 96)).collect();
    let image = Image::from_interleaved(ImageSize::new(96, 96).unwrap(), &pixels).unwrap();
    let mut before = f32::INFINITY;
    for most in [4, 20, 60] {
        let known = Known::default().with_flat(true);
        let fitter = Fitter::new(FitOptions::default().with_max_objects(most)).unwrap();
        let found = fit_picture(&fitter, image.view(), &known, &mut PictureScratch::default()).unwrap();
        assert_eq!(found.stop, StopReason::NotFlat);
        assert!(found.scene.objects.len() <= most, "{} of {most}", found.scene.objects.len());
        assert!(found.loss < 0.8 * before, "{} of {before} with {most}", found.loss);
        before = found.loss;
    }
    assert!(before < 0.04, "{before}");
}
