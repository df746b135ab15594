//! Things painted edge to edge: what is behind both shows through along their seam, so neither goes on behind the other.

use alloc::vec;
use alloc::vec::Vec;

use super::{RED, WHITE, error, found, object, paint, rectangle, scene};

const TEAL: [f32; 3] = [0.13, 0.66, 0.52];
const BLUE: [f32; 3] = [0.1, 0.2, 0.7];

#[test]
fn fields_of_one_color_across_corners_are_no_sheet_behind_the_others() {
    // A square of teal behind four fields of other colors would be shorter.
    let rows = [
        [[0.27, 0.75, 0.44], [0.28, 0.14, 0.46], TEAL],
        [[0.25, 0.27, 0.53], TEAL, [0.16, 0.47, 0.56]],
        [TEAL, [0.74, 0.87, 0.15], TEAL],
    ];
    let field = |k: usize| {
        let [x, y] = [k % 3, k / 3].map(|k| 18.3 + 25.4 * k as f64 + 4.2);
        object(rectangle(25.4, 25.4), [x, y], 0.0, rows[k / 3][k % 3])
    };
    let picture = paint(&scene(WHITE, (0..9).map(field).collect()));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 9);
    // Nine fields, some with a part of another one behind them, are off by 4e-3.
    let error = error(&picture, &found);
    assert!(error < 2e-4, "{error}");
}

#[test]
fn seams_are_painted_as_they_were() {
    let half = |side: f64, color| {
        let (sine, cosine) = 0.3_f64.sin_cos();
        object(rectangle(30.0, 50.0), [48.2 + side * 15.0 * cosine, 47.7 + side * 15.0 * sine], 0.3, color)
    };
    let picture = paint(&scene(WHITE, [half(-1.0, RED), half(1.0, BLUE)].into_iter().collect::<Vec<_>>()));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 2);
    // Without white that shows through the seam it is 4e-4.
    let error = error(&picture, &found);
    assert!(error < 2e-4, "{error}");
}

#[test]
fn a_page_that_is_seen_nowhere_else_shows_through_seams() {
    // A flag of three fields, over white: where two meet up to a quarter of a pixel is white.
    let colors = [[0.0, 0.6, 0.0], [1.0, 0.85, 0.05], RED];
    let field = |k: usize| {
        let [left, right] = [k, k + 1].map(|k| [0.0, 32.2, 63.6, 96.0][k]);
        object(rectangle(right - left, 96.0), [0.5 * (left + right), 48.0], 0.0, colors[k])
    };
    let picture = paint(&scene(WHITE, (0..3).map(field).collect()));
    let found = found(&picture);
    // One of them is the background.
    assert_eq!(found.objects.len(), 2, "{:?}", found.objects);
    // What is white of two columns of 96, where nothing shows through any more: a quarter at most, in each channel by less than one.
    let error = error(&picture, &found);
    assert!(error < 2.0 * 0.25 / 96.0, "{error}");
}

#[test]
fn what_is_seen_nowhere_else_and_is_no_page_shows_through_no_seam() {
    // Blue under yellow, as large: its edge shows at every edge of yellow, and white explains some of these pixels.
    let field = |color| object(rectangle(40.0, 30.0), [47.3, 46.1], 0.5, color);
    let picture = paint(&scene([0.43, 0.65, 0.27], vec![field([0.0, 0.32, 0.7]), field([1.0, 0.85, 0.27])]));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 1, "{:?}", found.objects);
}

#[test]
fn a_line_along_an_edge_is_no_seam() {
    // The frame of a chart ends where its fields do. Of what shows in two pixels one alone may look like white and blue with a little orange between.
    let field = |[top, bottom]: [f64; 2], color| {
        object(rectangle(40.7, bottom - top), [50.35, 0.5 * (top + bottom)], 0.0, color)
    };
    let [orange, blue] =
        [[221.0, 132.0, 82.0], [76.0, 114.0, 176.0]].map(|color| color.map(|value: f32| value / 255.0));
    let frame = object(rectangle(0.47, 80.0), [70.88, 48.0], 0.0, [0.0; 3]);
    let picture = paint(&scene(WHITE, vec![field([8.0, 45.3], orange), field([45.3, 88.0], blue), frame]));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 3, "{:?}", found.objects);
    // Where the fields end is hidden under the line: a tenth of a pixel along its 80 pixels is 5e-4.
    let error = error(&picture, &found);
    assert!(error < 6e-4, "{error}");
}
