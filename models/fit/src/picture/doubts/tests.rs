//! What has run together, and what that is worth where two fits are compared.

use alloc::vec::Vec;

use dvp_core::shape::{AnyShape, Path, PathRing};
use dvp_core::{Image, ImageSize};

use super::super::likelier::is_likelier;
use super::super::{Known, PictureScratch, fit_picture};
use super::*;
use crate::{Fit, FitOptions, Fitter};

/// The fit of disks (middle, radius) on white, 64 x 64 pixels of 8 by 8 places.
fn fit(disks: &[([f32; 2], f32)]) -> Fit<f32> {
    let size = ImageSize::new(64, 64).unwrap();
    let is_covered = |x: f32, y: f32| disks.iter().any(|&([a, b], r)| (x - a).powi(2) + (y - b).powi(2) < r * r);
    let share = |i: usize| {
        let [x, y] = [i % 64, i / 64].map(|at| at as f32);
        let places = (0..64).map(|k| [x + (0.5 + (k % 8) as f32) / 8.0, y + (0.5 + (k / 8) as f32) / 8.0]);
        places.filter(|&[x, y]| is_covered(x, y)).count() as f32 / 64.0
    };
    let pixels: Vec<f32> = (0..64 * 64).flat_map(|i| [1.0, 0.8, 0.6].map(|change| 1.0 - change * share(i))).collect();
    let image = Image::from_interleaved(size, &pixels).unwrap();
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    fit_picture(&fitter, image.view(), &Known::default(), &mut PictureScratch::default()).unwrap()
}

/// The objects that have run together with others, and how much of them is seen.
fn merged(fit: &Fit<f32>) -> Vec<(usize, usize, f64)> {
    let merged = fit.ambiguity.iter().filter_map(|ambiguity| match *ambiguity {
        Ambiguity::Merged { object, other, visible } => Some((object, other, visible)),
        _ => None,
    });
    merged.collect()
}

#[test]
fn what_has_run_together_is_said() {
    let pair = fit(&[([22.3, 30.2], 10.0), ([36.1, 33.4], 10.0)]);
    let [(0, 1, one), (1, 0, other)] = merged(&pair)[..] else { panic!("{:?}", pair.ambiguity) };
    // Half the angle of what is hidden has the cosine of half the distance over the radius.
    let hidden = (0.5 * 13.8_f64.hypot(3.2) / 10.0).acos() / core::f64::consts::PI;
    assert!((one + hidden - 1.0).abs() < 0.03 && (other + hidden - 1.0).abs() < 0.03, "{one} {other} {hidden}");
    let apart = fit(&[([16.3, 30.2], 10.0), ([46.1, 33.4], 10.0)]);
    assert_eq!((apart.scene.objects.len(), merged(&apart).len()), (2, 0));
}

#[test]
fn many_things_of_few_numbers_are_no_more_than_their_outline() {
    let pair = fit(&[([22.3, 30.2], 10.0), ([36.1, 33.4], 10.0)]);
    // The same in one outline of many numbers, twice as near.
    let mut outline = Fit { loss: 0.5 * pair.loss, ambiguity: Vec::new(), ..pair.clone() };
    let points = (0..64).map(|k| [(0.1 * k as f32).cos(), (0.1 * k as f32).sin()]).collect();
    let path = Path { rings: Vec::from([PathRing::polygon(points)]), ..Path::default() };
    outline.scene.objects.truncate(1);
    outline.scene.objects[0].shape = AnyShape::Path(path);
    assert!(is_likelier(&pair, &outline, 2.0, 2.0));
    // Things that are many by themselves are more.
    assert!(!is_likelier(&Fit { ambiguity: Vec::new(), ..pair }, &outline, 2.0, 2.0));
}
