//! Pictures of upright things on whole pixels: no pixel is mixed, and every crack is known exactly.

use super::edges::hard;
use super::*;
use crate::partition::{Partition, Reading};

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
    // A stem of five pixels on another one, a few pixels to the right.
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
    // A piece on a column, a pixel to the right of it, and another one beside the column: their boundaries step from one to the other.
    let piece = |cells: &[[f64; 2]], color| cells.iter().map(|&[x, y]| (x, y, color)).collect::<Vec<_>>();
    let upper = piece(&[[31.0, 35.0], [36.0, 35.0], [41.0, 35.0], [36.0, 40.0]], BLUE);
    let column = piece(&[[35.0, 45.0], [35.0, 50.0], [35.0, 55.0], [35.0, 60.0]], [1.0, 0.0, 1.0]);
    let beside = piece(&[[40.0, 52.0], [40.0, 57.0], [45.0, 57.0], [50.0, 57.0]], RED);
    let picture = cells(5.0, &[upper, column, beside].concat());
    let partition = Partition::of(&picture.view(), Reading::default()).unwrap();
    let rings = crate::boundary::rings(&partition);
    let samples = rings.iter().flatten().flat_map(|ring| &ring.steps).filter_map(|step| step.sample);
    let widest = samples.map(|sample| sample.sigma).fold(0.0, f64::max);
    assert!(widest < 0.01, "{widest}");
    assert_eq!(found(&picture).objects.len(), 3);
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

#[test]
fn gaps_between_things_of_a_color_are_no_lines() {
    // An angle over a bar, a pixel apart: a line in the color of the background over one thing would explain them, too.
    let angle = [(40.0, 30.0, RED), (40.0, 35.0, RED), (45.0, 35.0, RED), (50.0, 35.0, RED)];
    let bar = [(36.0, 41.0, RED), (41.0, 41.0, RED), (46.0, 41.0, RED), (51.0, 41.0, RED)];
    let picture = cells(5.0, &[angle, bar].concat());
    is_exact(&picture, 2);
    let strokes = found(&picture).objects.iter().filter(|object| matches!(object.shape, AnyShape::Stroke(_))).count();
    assert_eq!(strokes, 0);
}

#[test]
fn things_that_pass_one_another_leave_the_background_whole() {
    // The corners of two pieces are three pixels apart: near enough for fields that meet, but for the way between them.
    let left = [(20.0, 60.0, RED), (20.0, 65.0, RED), (25.0, 65.0, RED), (20.0, 70.0, RED)];
    let right = [(28.0, 53.0, BLUE), (33.0, 53.0, BLUE), (38.0, 53.0, BLUE), (33.0, 58.0, BLUE)];
    let picture = cells(5.0, &[left, right].concat());
    let partition = Partition::of(&picture.view(), Reading::default()).unwrap();
    assert_eq!(partition.faces.len(), 3);
    is_exact(&picture, 2);
}

#[test]
fn single_steps_make_no_stairs() {
    // A piece that goes on a pixel further down: its outline steps twice, but not on one side.
    let column = |left: f64, top: f64, color| [0.0, 5.0, 10.0].map(|down| (left, top + down, color));
    let picture = cells(5.0, &[column(20.0, 20.0, RED), column(25.0, 21.0, RED)].concat());
    let partition = Partition::of(&picture.view(), Reading::default()).unwrap();
    assert!(!partition.is_hard);
    assert_eq!(found(&picture).objects.len(), 1);
}
