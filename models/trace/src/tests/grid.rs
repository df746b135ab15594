//! Pictures of upright things on whole pixels: no pixel is mixed, and every crack is known exactly.

use super::edges::hard;
use super::*;

/// A picture on black: cells of `side` pixels of a color, their upper left corners in pixels.
fn cells(side: f64, cells: &[(f64, f64, [f32; 3])]) -> Image<f32> {
    hard(|[x, y]| {
        let is_in = |&&(left, top, _): &&(f64, f64, [f32; 3])| {
            (left..left + side).contains(&x) && (top..top + side).contains(&y)
        };
        cells.iter().rev().find(is_in).map_or([0.0; 3], |&(_, _, color)| color)
    })
}

/// Asserts that so many things are found, each pixel in its color: one that is wrong is an error of 3e-5 at least.
fn is_exact(picture: &Image<f32>, objects: usize) {
    let found = found(picture);
    assert_eq!(found.objects.len(), objects, "{:?}", found.objects);
    assert!(error(picture, &found) < 3e-5, "{}: {:?}", error(picture, &found), found.objects);
}

#[test]
fn sides_shorter_than_a_window_reaches_keep_their_corners() {
    // A stem of five pixels on another one, three pixels to the right.
    let stem = |left: f64, top: f64| (left, top, RED);
    for beside in [2.0, 3.0, 4.0] {
        let picture = cells(
            5.0,
            &[stem(15.0, 40.0), stem(20.0, 40.0), stem(25.0, 40.0), stem(20.0, 45.0), stem(20.0 + beside, 50.0)],
        );
        is_exact(&picture, 1);
    }
}

#[test]
fn things_that_are_one_pixel_off_one_another_are_not_uneven() {
    let l = |left: f64, top: f64, color| [(left, top, color), (left, top + 5.0, color), (left + 5.0, top + 5.0, color)];
    let column = |left: f64, top: f64| [0.0, 1.0, 2.0, 3.0].map(|k| (left, top + 5.0 * k, [1.0, 0.0, 1.0]));
    // A column, and beside it two pieces that begin one pixel from where it does and from one another.
    let all = [&l(31.0, 30.0, BLUE)[..], &column(30.0, 40.0), &l(35.0, 47.0, RED)].concat();
    is_exact(&cells(5.0, &all), 3);
}

#[test]
fn stairs_beside_smooth_edges_are_slanted() {
    // A square that a renderer without smooth edges drew over a smooth disk.
    let disk = paint(&scene(WHITE, vec![object(circle(20.0), [30.0, 32.0], 0.0, BLUE)]));
    let is_in = |[x, y]: [f64; 2]| {
        let at = dvp_core::Vec2::new(x - 64.0, y - 62.0).turned(dvp_core::Vec2::from_angle(-0.3));
        at.x.abs() < 16.0 && at.y.abs() < 16.0
    };
    let square = hard(|at| if is_in(at) { RED } else { WHITE });
    let pixels = disk.data().iter().zip(square.data());
    let picture = Image::from_planar(size(), pixels.map(|(&disk, &square)| disk.min(square)).collect()).unwrap();
    let found = found(&picture);
    let [_, square] = &found.objects[..] else { panic!("{:?}", found.objects) };
    let corners = match &square.shape {
        AnyShape::Path(path) => path.rings.iter().map(|ring| ring.points.len()).sum(),
        _ => 4,
    };
    assert!(corners < 12, "{corners}: {square:?}");
}
