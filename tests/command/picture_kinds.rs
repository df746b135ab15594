//! Every kind of picture file gives the same colors.

use std::path::Path;

use dvp::format::read_picture;
use dvp_core::Image;
use image::{DynamicImage, GrayAlphaImage, ImageBuffer, Luma, LumaA, Rgb, Rgba, RgbaImage};

use crate::raw_png::RawPng;

/// 16 x 12 pixels, the left half of one color and the right half of another.
fn halves<P: image::Pixel + 'static>(left: P, right: P) -> ImageBuffer<P, Vec<P::Subpixel>> {
    ImageBuffer::from_fn(16, 12, |x, _| if x < 8 { left } else { right })
}

fn read(folder: &Path, name: &str, picture: &DynamicImage) -> Image<f64> {
    let path = folder.join(name);
    picture.save(&path).unwrap();
    read_picture(&path, 16 * 12).unwrap()
}

/// Largest difference of a channel in the middle of the two halves.
fn error(image: &Image<f64>, left: [f64; 3], right: [f64; 3]) -> f64 {
    assert_eq!((image.size().width(), image.size().height()), (16, 12));
    let pairs = [(6 * 16 + 3, left), (6 * 16 + 12, right)];
    let channels = pairs.into_iter().flat_map(|(i, color)| image.view().pixel(i).into_iter().zip(color));
    channels.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn eight_bit_files_agree() {
    let folder = tempfile::tempdir().unwrap();
    let picture = DynamicImage::from(halves(Rgb([200u8, 40, 10]), Rgb([0u8, 255, 128])));
    let [left, right] = [[200.0, 40.0, 10.0], [0.0, 255.0, 128.0]].map(|color| color.map(|v: f64| v / 255.0));
    for name in ["a.png", "a.bmp", "a.webp", "a.ppm", "a.tiff"] {
        let worst = error(&read(folder.path(), name, &picture), left, right);
        assert!(worst < 1e-12, "{name}: {worst}");
    }
    // JPEG is lossy: a few steps of 1/255 away from the boundary.
    let worst = error(&read(folder.path(), "a.jpg", &picture), left, right);
    assert!(worst < 0.06, "jpg: {worst}");
    // A palette, with a transparent entry: over white in f32.
    let worst = error(&read(folder.path(), "a.gif", &picture.to_rgba8().into()), left, right);
    assert!(worst < 1e-6, "gif: {worst}");
}

#[test]
fn transparency_is_put_over_white_and_gray_is_three_equal_channels() {
    let folder = tempfile::tempdir().unwrap();
    // Alpha 51 is a fifth: 0.2 * 0 + 0.8 * 1.
    let picture: RgbaImage = halves(Rgba([0, 0, 0, 51]), Rgba([9, 9, 9, 0]));
    let worst = error(&read(folder.path(), "a.png", &picture.into()), [0.8; 3], [1.0; 3]);
    assert!(worst < 1e-6, "rgba: {worst}");
    let picture: GrayAlphaImage = halves(LumaA([255, 255]), LumaA([51, 255]));
    let worst = error(&read(folder.path(), "b.png", &picture.into()), [1.0; 3], [0.2; 3]);
    assert!(worst < 1e-6, "gray with alpha: {worst}");
    let picture = DynamicImage::from(halves(Luma([0u16]), Luma([13_107u16])));
    let worst = error(&read(folder.path(), "c.png", &picture), [0.0; 3], [0.2; 3]);
    assert!(worst < 1e-6, "16 bits: {worst}");
}

/// Reads the halves again from a file of a kind that our encoder does not write.
fn read_raw<const N: usize>(folder: &Path, png: &RawPng<'_>, left: [u16; N], right: [u16; N]) -> Image<f64> {
    let path = folder.join("raw.png");
    std::fs::write(&path, png.encode(|x, _| if x < 8 { left } else { right })).unwrap();
    read_picture(&path, 16 * 12).unwrap()
}

#[test]
fn palettes_are_their_colors() {
    let folder = tempfile::tempdir().unwrap();
    let palette: (&[u8; 4], &[u8]) = (b"PLTE", &[9, 9, 9, 255, 0, 51, 0, 102, 204]);
    let [left, right] = [[1.0, 0.0, 0.2], [0.0, 0.4, 0.8]];
    for (depth, interlaced) in [(2, false), (4, false), (8, false), (8, true)] {
        let png = RawPng { size: [16, 12], depth, kind: 3, interlaced, chunks: &[palette] };
        let worst = error(&read_raw(folder.path(), &png, [1], [2]), left, right);
        assert!(worst < 1e-12, "{depth} bits, interlaced {interlaced}: {worst}");
    }
    // The second entry is a fifth there: 0.2 color + 0.8 white.
    let chunks = [palette, (b"tRNS", &[255, 51])];
    let png = RawPng { size: [16, 12], depth: 8, kind: 3, interlaced: false, chunks: &chunks };
    let worst = error(&read_raw(folder.path(), &png, [1], [2]), [1.0, 0.8, 0.84], right);
    assert!(worst < 1e-6, "{worst}");
}

#[test]
fn every_depth_of_gray_and_color_fills_the_range() {
    let folder = tempfile::tempdir().unwrap();
    let gray = |depth: u8| (1_u16.checked_shl(depth.into()).map_or(u16::MAX, |steps| steps - 1), [depth, 0]);
    for (most, [depth, kind]) in [1, 2, 4, 8, 16].map(gray) {
        for interlaced in [false, true] {
            let png = RawPng { size: [16, 12], depth, kind, interlaced, chunks: &[] };
            let worst = error(&read_raw(folder.path(), &png, [most], [0]), [1.0; 3], [0.0; 3]);
            assert!(worst < 1e-7, "gray of {depth} bits, interlaced {interlaced}: {worst}");
        }
    }
    for (depth, step) in [(8, 1), (16, 257)] {
        let [left, right] = [[51, 0, 255], [255, 102, 0]].map(|color: [u16; 3]| color.map(|v| v * step));
        let (seen_left, seen_right) = ([0.2, 0.0, 1.0], [1.0, 0.4, 0.0]);
        for interlaced in [false, true] {
            let png = RawPng { size: [16, 12], depth, kind: 2, interlaced, chunks: &[] };
            let worst = error(&read_raw(folder.path(), &png, left, right), seen_left, seen_right);
            assert!(worst < 1e-7, "RGB of {depth} bits, interlaced {interlaced}: {worst}");
            let png = RawPng { kind: 6, ..png };
            let [opaque, clear] = [(left, 255), (right, 0)].map(|([r, g, b], alpha)| [r, g, b, alpha * step]);
            let worst = error(&read_raw(folder.path(), &png, opaque, clear), seen_left, [1.0; 3]);
            assert!(worst < 1e-7, "RGBA of {depth} bits, interlaced {interlaced}: {worst}");
        }
        let png = RawPng { size: [16, 12], depth, kind: 4, interlaced: false, chunks: &[] };
        let worst = error(&read_raw(folder.path(), &png, [0, 51 * step], [51 * step, 255 * step]), [0.8; 3], [0.2; 3]);
        assert!(worst < 1e-6, "gray with alpha of {depth} bits: {worst}");
    }
}

#[test]
fn the_content_decides_not_the_name() {
    let folder = tempfile::tempdir().unwrap();
    let picture = DynamicImage::from(halves(Rgb([255u8, 0, 0]), Rgb([0u8, 0, 255])));
    let png = folder.path().join("a.png");
    picture.save(&png).unwrap();
    let misnamed = folder.path().join("a.jpg");
    std::fs::rename(&png, &misnamed).unwrap();
    let image = read_picture(&misnamed, 16 * 12).unwrap();
    assert!(error(&image, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]) < 1e-12);
}
