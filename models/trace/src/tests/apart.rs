//! What is one thing, and what is two.

use super::edges::hard;
use super::*;
use crate::partition::{Partition, Reading};

const CYAN: [f32; 3] = [0.0, 1.0, 1.0];
const BLACK: [f32; 3] = [0.0; 3];

/// A place, squares (columns and rows from there on), and their color.
type Piece<'a> = ([usize; 2], &'a [[usize; 2]], [f32; 3]);

/// Pieces of squares of five pixels, on black.
fn pieces(pieces: &[Piece<'_>]) -> Image<f32> {
    hard(|at| {
        let covers = |&&([x, y], cells, _): &&Piece<'_>| {
            cells.iter().any(|&[column, row]| {
                let [left, top] = [x + 5 * column, y + 5 * row].map(|at| at as f64);
                (left..left + 5.0).contains(&at[0]) && (top..top + 5.0).contains(&at[1])
            })
        };
        pieces.iter().find(covers).map_or(BLACK, |&(_, _, color)| color)
    })
}

#[test]
fn pieces_that_touch_in_a_corner_are_two_things_but_squares_of_a_sprite_are_one() {
    for color in [CYAN, RED] {
        let upper: &[[usize; 2]] = &[[0, 0], [1, 0], [1, 1], [1, 2]];
        let lower: &[[usize; 2]] = &[[1, 0], [1, 1], [1, 2], [0, 2]];
        let picture = pieces(&[([40, 30], upper, color), ([45, 45], lower, color)]);
        assert_eq!(found(&picture).objects.len(), 2);
        let as_squares = trace(&picture.view(), &Known::default().with_squares(true)).unwrap().scene;
        assert_eq!(as_squares.objects.len(), 1);
    }
}

/// A whole bar, and a piece of its color whose arm ends at what lies between them.
fn bar_and_piece(color: [f32; 3]) -> Image<f32> {
    let bar: &[[usize; 2]] = &[[0, 0], [0, 1], [0, 2], [0, 3]];
    let between: &[[usize; 2]] = &[[0, 0], [1, 0], [0, 1], [0, 2]];
    let piece: &[[usize; 2]] = &[[0, 0], [1, 0], [2, 0], [1, 1]];
    pieces(&[([39, 33], bar, color), ([44, 36], between, [1.0, 0.0, 0.0]), ([49, 31], piece, color)])
}

#[test]
fn a_whole_thing_of_a_color_that_many_have_is_no_part_of_another() {
    assert_eq!(found(&bar_and_piece(CYAN)).objects.len(), 3);
    // Of a color that nothing else has it is.
    assert_eq!(found(&bar_and_piece([0.21, 0.63, 0.67])).objects.len(), 2);
}

/// A triangle whose sides rise at 45 degrees, with an opening and its corners cut off, as high as a quarter of `size`; upside down if that is negative.
fn triangle(size: f64) -> AnyShape<f64> {
    let ring =
        |points: &[[f64; 2]]| PathRing::polygon(points.iter().map(|&[x, y]| [x * size.abs(), y * size]).collect());
    let outer = ring(&[
        [-0.0078, -0.1172],
        [0.0078, -0.1172],
        [0.2188, 0.0938],
        [0.2188, 0.1172],
        [-0.2188, 0.1172],
        [-0.2188, 0.0938],
    ]);
    let opening = ring(&[[-0.0078, -0.0234], [-0.0859, 0.0547], [0.0859, 0.0547], [0.0078, -0.0234]]);
    AnyShape::Path(Path { rings: vec![outer, opening], fill: FillRule::EvenOdd })
}

/// As many things are found as were painted, and they are like them.
fn assert_found(background: [f32; 3], things: Vec<Object<f32>>) {
    let count = things.len();
    let picture = paint(&scene(background, things));
    let found = found(&picture);
    assert_eq!(found.objects.len(), count, "{:?}", found.objects);
    assert!(error(&picture, &found) < 2e-3, "{}", error(&picture, &found));
}

#[test]
fn a_sliver_at_45_degrees_goes_around_nothing() {
    let behind = object(triangle(-84.113), [51.4, 63.86], 0.0, [0.216, 0.633, 0.667]);
    let front = object(triangle(-78.586), [49.19, 60.21], 0.0, [0.313, 0.223, 0.412]);
    assert_found([0.632, 0.602, 0.695], vec![behind, front]);
}

#[test]
fn a_sliver_that_is_seen_in_pieces_is_one() {
    let behind = object(triangle(-84.011), [50.38, 55.85], 0.0, [0.427, 0.275, 0.197]);
    let front = object(triangle(-85.112), [47.62, 56.97], 0.0, [0.781, 0.351, 0.856]);
    assert_found([0.815, 0.023, 0.307], vec![behind, front]);
}

#[test]
fn what_the_border_cuts_off_has_no_color_of_its_own() {
    // Numbers in pixels of a picture of 64: below the front triangle a row and a half of the one behind it is left.
    let size = ImageSize::new(64, 64).unwrap();
    let per_pixel = SIZE as f64 / 64.0;
    let thing =
        |scale: f64, at: [f64; 2], color| object(triangle(scale * per_pixel), at.map(|v| v * per_pixel), 0.0, color);
    let other = thing(68.65, [41.02, 30.04], [0.249, 0.376, 0.687]);
    let behind = thing(79.666, [20.43, 54.34], [0.992, 0.604, 0.29]);
    let front = thing(94.468, [36.66, 51.07], [0.123, 0.211, 0.269]);
    let picture = paint_at(&scene([0.958, 0.322, 0.176], vec![other, behind, front]), size);
    let partition = Partition::of(&picture.view(), Reading::default()).unwrap();
    assert_eq!(partition.palette.len(), 4, "{:?}", partition.palette);
    assert_eq!(found(&picture).objects.len(), 3);
}

#[test]
fn what_goes_along_all_of_a_border_is_a_line() {
    // Of a color that two things elsewhere would mix to.
    let mixed = [0.45, 0.15, 0.4];
    let line = object(rectangle(2.0 * SIZE as f64, 2.0), [48.0, 0.0], 0.0, mixed);
    let things = [(28.0, RED), (68.0, BLUE)].map(|(x, color)| object(rectangle(30.0, 30.0), [x, 50.0], 0.0, color));
    let found = found(&paint(&scene(WHITE, things.into_iter().chain([line]).collect())));
    let is_line = |object: &Object<f32>| object.color().iter().zip(mixed).all(|(a, b)| (a - b).abs() < 0.01);
    assert!(found.objects.len() == 3 && found.objects.iter().any(is_line), "{:?}", found.objects);
}
