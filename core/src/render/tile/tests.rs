use alloc::vec;
use alloc::vec::Vec;

use super::{Window, pixel_range};
use crate::dims::ImageSize;
use crate::render::{HardRenderer, RenderError, Renderer as _};
use crate::scene::Drawing;
use crate::shape::Rings;

#[test]
fn ranges_hold_the_integers_between() {
    assert_eq!(pixel_range(-3.5, 2.5, 8), Some((0, 2)));
    assert_eq!(pixel_range(1.0, 7.0, 8), Some((1, 7)));
    assert_eq!(pixel_range(6.1, 1e30, 8), Some((7, 7)));
    assert_eq!(pixel_range(2.1, 2.9, 8), None);
    assert_eq!(pixel_range(-2.0, -0.1, 8), None);
    assert_eq!(pixel_range(7.5, 9.0, 8), None);
}

#[test]
fn windows_are_made_of_chunks_of_the_image() {
    let size = ImageSize::new(40, 30).unwrap();
    // Columns 18 to 33 lie in chunks 1 and 2, rows 3 to 8 are 6.
    let window = Window::around(&[[20.0, 5.0], [31.0, 6.0]], 2.0, size).unwrap();
    assert_eq!(window, Window { left_chunk: 1, chunks: 2, top: 3, rows: 6 });
    assert_eq!((window.left(), window.width()), (16, 32));
    assert_eq!(Window::around(&[[-9.0, 5.0], [-3.0, 6.0]], 2.0, size), None);
    assert_eq!(Window::around::<f64>(&[], 2.0, size), None);
}

#[test]
fn rings_belong_to_their_objects() {
    // Two frames of one pixel around a hole of one pixel, side by side; the break that names the first vertex of the second
    // object is a ring without vertices.
    let square =
        |left: f64, side: f64| [[left, left], [left + side, left], [left + side, left + side], [left, left + side]];
    let frame: Vec<_> = square(0.0, 0.75).into_iter().chain(square(0.25, 0.25)).collect();
    let moved: Vec<_> = frame.iter().map(|v| [v[0] + 1.0, v[1]]).collect();
    let mut drawing = Drawing::default();
    drawing.push_rings(Rings { vertices: &frame, breaks: &[4, 8], first: 0 }, [1.0; 3], 1.0);
    drawing.push_rings(Rings { vertices: &moved, breaks: &[104], first: 100 }, [1.0; 3], 1.0);
    assert_eq!(drawing.breaks, [4, 8, 12]);
    let size = ImageSize::new(8, 4).unwrap();
    let mut coverage = vec![9.0; 2 * size.pixels()];
    HardRenderer::default().object_coverage(&drawing, size, &mut Default::default(), &mut coverage).unwrap();
    let mut expected = vec![0.0; 2 * size.pixels()];
    for (row, column) in [(0, 0), (0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1), (2, 2)] {
        expected[row * 8 + column] = 1.0;
        expected[size.pixels() + row * 8 + column + 4] = 1.0;
    }
    assert_eq!(coverage, expected);
}

#[test]
fn breaks_out_of_order_are_refused() {
    let size = ImageSize::new(4, 4).unwrap();
    let refused = |breaks: &[usize]| {
        let mut drawing = Drawing::<f64>::default();
        drawing.push(&[[0.1, 0.1], [0.9, 0.1], [0.5, 0.9]], [1.0; 3], 1.0);
        drawing.breaks = breaks.to_vec();
        HardRenderer::default().render(&drawing, size, &mut Default::default(), &mut [0.0; 48])
    };
    assert_eq!(refused(&[0, 1, 1, 3]), Ok(()));
    assert_eq!(refused(&[2, 1]), Err(RenderError::Breaks { index: 1, start: 1, least: 2, most: 3 }));
    assert_eq!(refused(&[4]), Err(RenderError::Breaks { index: 0, start: 4, least: 0, most: 3 }));
}
