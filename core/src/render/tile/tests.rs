use super::{Window, pixel_range};
use crate::dims::ImageSize;

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
