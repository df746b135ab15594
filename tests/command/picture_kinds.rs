//! Every kind of picture file gives the same colors.

use std::path::Path;

use dvp::format::{BitDepth, Picture, read_picture};
use image::{DynamicImage, GrayAlphaImage, ImageBuffer, Luma, LumaA, Rgb, Rgba, RgbaImage};

use crate::raw_png::RawPng;

/// 16 x 12 pixels, the left half of one color and the right half of another.
fn halves<P: image::Pixel + 'static>(left: P, right: P) -> ImageBuffer<P, Vec<P::Subpixel>> {
    ImageBuffer::from_fn(16, 12, |x, _| if x < 8 { left } else { right })
}

fn read(folder: &Path, name: &str, picture: &DynamicImage) -> Picture<f64> {
    let path = folder.join(name);
    picture.save(&path).unwrap();
    read_picture(&path, 16 * 12).unwrap()
}

/// Largest difference of a channel in the middle of the two halves.
fn error(picture: &Picture<f64>, left: [f64; 3], right: [f64; 3]) -> f64 {
    let image = &picture.image;
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
        let read = read(folder.path(), name, &picture);
        let worst = error(&read, left, right);
        assert!(worst < 1e-12, "{name}: {worst}");
        assert!(!read.transparent && read.visible && read.bits == BitDepth::Eight, "{name}");
    }
    // JPEG is lossy: a few steps of 1/255 away from the boundary.
    let worst = error(&read(folder.path(), "a.jpg", &picture), left, right);
    assert!(worst < 0.06, "jpg: {worst}");
    // A palette, and an alpha that is full everywhere.
    let read = read(folder.path(), "a.gif", &picture.to_rgba8().into());
    let worst = error(&read, left, right);
    assert!(worst < 1e-12 && !read.transparent, "gif: {worst}");
}

#[test]
fn what_is_transparent_is_put_over_a_color_that_is_far_from_what_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let judge = |left: [u8; 4], right: [u8; 4], seen: [[f64; 3]; 2]| {
        let picture: RgbaImage = halves(Rgba(left), Rgba(right));
        let read = read(folder.path(), "a.png", &picture.into());
        let worst = error(&read, seen[0], seen[1]);
        assert!(worst < 1e-12, "{left:?}, {right:?}: {worst}, {:?}", read.image.view().pixel(100));
        (read.transparent, read.visible)
    };
    // White is farthest from black, black from white, cyan from red. What cannot be seen has no say.
    assert_eq!(judge([0, 0, 0, 255], [9, 9, 9, 0], [[0.0; 3], [1.0; 3]]), (true, true));
    assert_eq!(judge([255, 255, 255, 255], [255, 255, 255, 0], [[1.0; 3], [0.0; 3]]), (true, true));
    assert_eq!(judge([255, 0, 0, 255], [0, 255, 255, 0], [[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]]), (true, true));
    // Alpha 51 is a fifth: 0.2 * 0 + 0.8 * 1, however opaque the rest is.
    assert_eq!(judge([0, 0, 0, 51], [9, 9, 9, 0], [[0.8; 3], [1.0; 3]]), (true, true));
    // Of a faint rim little of its color is left: cyan, of alpha 51, is no reason against cyan.
    assert_eq!(judge([255, 0, 0, 255], [0, 255, 255, 51], [[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]]), (true, true));
    // As far from black as from white: one level of each kind.
    let step = 1.0 / 255.0;
    assert_eq!(judge([0, 0, 0, 254], [255; 4], [[step, 0.0, 0.5 * step], [1.0; 3]]), (true, true));
    assert_eq!(judge([7, 8, 9, 0], [1, 2, 3, 0], [[1.0; 3]; 2]), (true, false));
    assert_eq!(judge([0, 51, 255, 255], [255, 0, 0, 255], [[0.0, 0.2, 1.0], [1.0, 0.0, 0.0]]), (false, true));
}

#[test]
fn gray_is_three_equal_channels() {
    let folder = tempfile::tempdir().unwrap();
    let picture: GrayAlphaImage = halves(LumaA([255, 255]), LumaA([51, 255]));
    let read_8 = read(folder.path(), "a.png", &picture.into());
    assert!(error(&read_8, [1.0; 3], [0.2; 3]) < 1e-12 && !read_8.transparent);
    for name in ["b.png", "b.tiff"] {
        let picture = DynamicImage::from(halves(Luma([0u16]), Luma([13_107u16])));
        let read = read(folder.path(), name, &picture);
        let worst = error(&read, [0.0; 3], [0.2; 3]);
        assert!(worst < 1e-12 && read.bits == BitDepth::Sixteen, "{name}: {worst}");
    }
}

/// Reads the halves again from a file of a kind that our encoder does not write.
fn read_raw<const N: usize>(folder: &Path, png: &RawPng<'_>, left: [u16; N], right: [u16; N]) -> Picture<f64> {
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
    // The second entry is a fifth there: 0.2 color + 0.8 yellow, which is farthest from the third.
    let chunks = [palette, (b"tRNS", &[255, 51])];
    let png = RawPng { size: [16, 12], depth: 8, kind: 3, interlaced: false, chunks: &chunks };
    let worst = error(&read_raw(folder.path(), &png, [1], [2]), [1.0, 0.8, 0.04], right);
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
            // Yellow is farthest from the blue of the left half.
            let worst = error(&read_raw(folder.path(), &png, opaque, clear), seen_left, [1.0, 1.0, 0.0]);
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
    let picture = read_picture(&misnamed, 16 * 12).unwrap();
    assert!(error(&picture, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]) < 1e-12);
}
