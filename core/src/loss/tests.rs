use alloc::vec;
use alloc::vec::Vec;

use super::{ImagePair, Loss, LossError, Pyramid, Ssim, outline_length};
use crate::dims::ImageSize;
use crate::image::{Image, ImageView};
use crate::render::PixelLoss;

fn size(width: usize, height: usize) -> ImageSize {
    ImageSize::new(width, height).unwrap()
}

fn value<L>(loss: &L, size: ImageSize, a: &[f64], b: &[f64]) -> Result<f64, LossError>
where
    L: for<'a> Loss<f64, Input<'a> = ImagePair<'a, f64>, Grad = [f64]>,
{
    let pair = ImagePair::new(ImageView::new(size, a)?, ImageView::new(size, b)?)?;
    loss.value(pair, &mut L::Scratch::default())
}

#[test]
fn pixel_losses_of_two_pixels() {
    // Differences 0.5, 0, -0.25, 0, 0, 0: sum of sizes 0.75, of squares 0.3125, over 6 values.
    let a = [0.5, 0.0, 0.25, 0.0, 0.0, 1.0];
    let b = [0.0, 0.0, 0.5, 0.0, 0.0, 1.0];
    let mae = value(&PixelLoss::Mae, size(2, 1), &a, &b).unwrap();
    let mse = value(&PixelLoss::Mse, size(2, 1), &a, &b).unwrap();
    assert!((mae - 0.125).abs() < 1e-15 && (mse - 0.3125 / 6.0).abs() < 1e-15);
}

#[test]
fn ssim_of_constant_images_is_their_luminance_term() {
    // Without variance SSIM = (2 a b + C1) / (a^2 + b^2 + C1): (0.16 + 1e-4) / (0.04 + 0.16 + 1e-4).
    let a = vec![0.2; 3 * 13 * 12];
    let b = vec![0.4; 3 * 13 * 12];
    let loss = value(&Ssim::default(), size(13, 12), &a, &b).unwrap();
    assert!((loss - (1.0 - 0.1601 / 0.2001)).abs() < 1e-12, "{loss}");
}

#[test]
fn ssim_refuses_images_below_its_window() {
    let a = vec![0.0; 3 * 10 * 12];
    let outcome = value(&Ssim::default(), size(10, 12), &a, &a);
    assert_eq!(outcome, Err(LossError::SmallerThanWindow { size: size(10, 12), window: 11 }));
}

#[test]
fn pyramid_of_an_odd_row() {
    // Red differences 1, 0, 2 in a row of three: MAE 3/9 = 1/3. Halved: (0.5, 2), MAE 2.5/6. Mean of both: 0.375.
    let mut a = vec![0.0; 9];
    a[..3].copy_from_slice(&[1.0, 0.0, 2.0]);
    let loss = value(&Pyramid::new(PixelLoss::Mae, 2).unwrap(), size(3, 1), &a, &[0.0; 9]).unwrap();
    assert!((loss - 0.375).abs() < 1e-15, "{loss}");
    assert_eq!(Pyramid::new(PixelLoss::Mae, 0), Err(LossError::Zero { what: "pyramid levels" }));
}

#[test]
fn images_of_different_sizes_are_refused() {
    let (a, b) = (Image::<f32>::zeros(size(2, 2)), Image::zeros(size(2, 3)));
    let outcome = ImagePair::new(a.view(), b.view()).map(|_| ());
    assert_eq!(outcome, Err(LossError::Sizes { image: size(2, 2), target: size(2, 3) }));
}

#[test]
fn outline_length_counts_the_closing_edge() {
    // A right triangle with sides 3, 4, 5.
    assert!((outline_length(&[[0.0, 0.0], [3.0, 0.0], [3.0, 4.0]]) - 12.0_f64).abs() < 1e-15);
    assert!(outline_length::<f64>(&Vec::new()).abs() < 1e-15);
}
