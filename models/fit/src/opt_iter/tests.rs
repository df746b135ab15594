use alloc::vec;
use alloc::vec::Vec;

use dvp_core::{Image, ImageSize};

use super::background::BackgroundStart;
use super::blob::BlobFinder;

/// 8 x 4, white; red 4 x 1 at row 1 from column 1, green 2 x 2 at its right end from column 5 on.
fn image() -> Image<f64> {
    let size = ImageSize::new(8, 4).unwrap();
    let mut image = Image::from_planar(size, vec![1.0; 96]).unwrap();
    for (x, y, color) in [(1, 1, 0), (2, 1, 0), (3, 1, 0), (4, 1, 0), (5, 1, 1), (6, 1, 1), (5, 2, 1), (6, 2, 1)] {
        for channel in 0..3 {
            image.data_mut()[channel * 32 + y * 8 + x] = if channel == color { 0.9 } else { 0.0 };
        }
    }
    image
}

#[test]
#[expect(clippy::float_cmp, reason = "a pixel is copied or left alone")]
fn touching_colors_are_two_blobs() {
    let image = image();
    let mut painted = vec![1.0; 96];
    // The green square is explained a little better: its red channel is right.
    for index in [13, 14, 21, 22] {
        painted[index] = 0.0;
    }
    let mut finder = BlobFinder::new();
    let blob = finder.largest(image.view(), &painted).unwrap();
    assert_eq!(blob.pixels, 4);
    // Hidden is the green square only: red 0, green and blue white.
    let mut focused = image.data().to_vec();
    finder.hide_others(&painted, &mut focused);
    let changed: Vec<usize> = (0..96).filter(|&i| focused[i] != image.data()[i]).collect();
    assert_eq!(changed, [45, 46, 53, 54, 77, 78, 85, 86]);
    // Columns 1..=4 of row 1, in units of 4 pixels: (2.5 + 0.5) / 4, (1 + 0.5) / 4.
    assert_eq!((blob.center, blob.orientation), ([0.75, 0.375], 0.0));
    assert!((blob.color[0] - 0.9).abs() < 1e-12 && blob.color[1].abs() < 1e-12);
    // 4 pixels of (0.1 + 1 + 1) / 3.
    assert!((blob.error - 2.8).abs() < 1e-12, "{}", blob.error);
}

#[test]
fn long_axis_of_a_diagonal() {
    let size = ImageSize::new(6, 6).unwrap();
    let mut image = Image::<f32>::zeros(size);
    for i in 0..5 {
        image.data_mut()[i * 6 + i] = 1.0;
        image.data_mut()[i * 6 + i + 1] = 1.0;
    }
    let blob = BlobFinder::new().largest(image.view(), &[0.0; 108]).unwrap();
    // y down, so that the angle is positive. Variances 2.25 along x and 2 along y, covariance 2: atan2(4, 0.25) / 2.
    assert!((blob.orientation - 0.754_188_9).abs() < 1e-6, "{blob:?}");
}

#[test]
fn explained_images_have_no_blob() {
    let image = image();
    assert_eq!(BlobFinder::new().largest(image.view(), image.data()), None);
}

#[test]
#[expect(clippy::float_cmp, reason = "a median is one of the values")]
fn background_start() {
    // 24 of 32 pixels are white.
    let mut image = image();
    assert_eq!(BackgroundStart::Median.color(image.view()), [1.0; 3]);
    assert_eq!(BackgroundStart::Mode.color(image.view()), [1.0; 3]);
    // 12 of the white ones become 12 colors: white has no majority any more, but is still the most frequent color.
    for (i, pixel) in (16..20).chain(24..32).enumerate() {
        let shade = (i % 4) as f64 / 10.0;
        for channel in 0..3 {
            image.data_mut()[channel * 32 + pixel] = if channel == i / 4 { shade } else { 0.2 };
        }
    }
    // Red, in order: five of 0, one of 0.1, nine of 0.2, then 0.3 in place 16. No pixel has that color.
    assert_eq!(BackgroundStart::Median.color(image.view()), [0.3, 0.3, 0.2]);
    assert_eq!(BackgroundStart::Mode.color(image.view()), [1.0; 3]);
}
