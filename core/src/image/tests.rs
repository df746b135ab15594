use alloc::vec;

use super::{Image, ImageError, RgbaImage, RgbaView};
use crate::dims::ImageSize;

/// Two pixels: straight (1, 0.5, 0) at alpha 1/2, and a clear one whose file says green.
const STRAIGHT: [f64; 8] = [1.0, 0.5, 0.0, 0.5, 0.0, 1.0, 0.0, 0.0];

fn size() -> ImageSize {
    ImageSize::new(2, 1).unwrap()
}

#[test]
fn straight_colors_are_multiplied_and_divided() {
    let image = RgbaImage::from_straight(size(), &STRAIGHT).unwrap();
    assert_eq!(image.data(), [0.5, 0.0, 0.25, 0.0, 0.0, 0.0, 0.5, 0.0]);
    assert_eq!(image.view().channel(3), [0.5, 0.0]);
    // What cannot be seen is forgotten.
    assert_eq!(image.to_straight(), [1.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn the_ground_shines_through() {
    let image = RgbaImage::from_straight(size(), &STRAIGHT).unwrap();
    // Half of (1, 0.5, 0) and half of (0.2, 0.4, 0.6), and the ground itself.
    let expected = [0.6, 0.2, 0.45, 0.4, 0.3, 0.6];
    let found = image.on([0.2, 0.4, 0.6]);
    assert!(found.data().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
    assert_eq!(RgbaImage::transparent(size()).on([0.25; 3]), Image::from_planar(size(), vec![0.25; 6]).unwrap());
}

#[test]
fn data_that_are_no_image_are_refused() {
    let mut data = vec![0.0_f64; 8];
    assert_eq!(RgbaView::premultiplied(size(), &data[..6]).unwrap_err(), ImageError::Length { expected: 8, len: 6 });
    assert_eq!(RgbaImage::from_straight(size(), &data[..6]).unwrap_err(), ImageError::Length { expected: 8, len: 6 });
    data[3] = f64::NAN;
    assert_eq!(RgbaImage::from_straight(size(), &data).unwrap_err(), ImageError::NotFinite { index: 3 });
    assert_eq!(RgbaImage::from_premultiplied(size(), data).unwrap_err(), ImageError::NotFinite { index: 3 });
}
