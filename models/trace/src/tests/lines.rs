//! Lines that meet, cross and lie side by side, as in charts.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::shape::{AnyShape, Cap, FillRule, Join, Path, PathRing, Rectangle, Segment, Stroke};
use dvp_core::{Image, ImageSize, ImageView};

use proptest::prelude::*;

use super::{BLUE, RED, WHITE, error, found, object, paint, paint_at, rectangle, scene};

/// A line of a pen with flat ends, points in pixels.
fn line(points: &[[f64; 2]], width: f64, color: [f32; 3]) -> dvp_core::Object<f32> {
    let rings = vec![PathRing::polyline(points.to_vec())];
    let stroke = Stroke { rings, width, cap: Cap::Butt, join: Join::Miter { limit: 4.0 } };
    object(AnyShape::Stroke(stroke), [0.0; 2], 0.0, color)
}

/// Finds a scene of lines again: as many strokes, of the same colors from back to front, and of the same width.
fn are_found(lines: Vec<dvp_core::Object<f32>>, width: f64) {
    let picture = paint(&scene(WHITE, lines.clone()));
    let found = found(&picture);
    assert_eq!(found.objects.len(), lines.len(), "{:?}", found.objects);
    for line in &lines {
        let near = |color: [f32; 3]| color.iter().zip(line.color()).all(|(a, b)| (a - b).abs() < 0.01);
        let again = found.objects.iter().find(|object| near(object.color())).unwrap();
        // A straight one is a rectangle as well.
        let across = match &again.shape {
            AnyShape::Stroke(stroke) => stroke.width,
            AnyShape::Rectangle(rectangle) => rectangle.size[0].min(rectangle.size[1]),
            other => panic!("{other:?}"),
        };
        let pixels = f64::from(across) * f64::from(again.pose.scale) * super::SIZE as f64;
        assert!((pixels - width).abs() < 0.2, "{pixels}");
    }
    assert!(error(&picture, &found) < 4e-3, "{}", error(&picture, &found));
}

const GREEN: [f32; 3] = [0.2, 0.6, 0.3];

#[test]
fn lines_that_cross_at_a_small_angle_stay_whole() {
    let red = [[12.0, 38.0], [50.0, 47.0], [86.0, 60.0]];
    let blue = [[12.0, 56.0], [50.0, 49.0], [86.0, 38.0]];
    are_found(vec![line(&red, 3.4, RED), line(&blue, 3.4, BLUE)], 3.4);
}

#[test]
fn lines_that_start_side_by_side_are_found_to_their_ends() {
    // What is seen of the first one's start is its lower side.
    let red = [[12.0, 41.0], [40.0, 47.0], [86.0, 66.0]];
    let blue = [[12.0, 38.0], [30.0, 36.0], [86.0, 14.0]];
    let green = [[12.0, 62.0], [50.0, 30.0], [86.0, 34.0]];
    are_found(vec![line(&red, 4.0, RED), line(&green, 4.0, GREEN), line(&blue, 4.0, BLUE)], 4.0);
}

#[test]
fn a_line_that_columns_and_rows_read_is_one() {
    // At 45 degrees for a while, and less steep beyond: columns read all of it, rows its middle.
    let red = [[10.0, 30.0], [24.0, 36.0], [62.0, 74.0], [86.0, 82.0]];
    let blue = [[12.0, 70.0], [84.0, 30.0]];
    are_found(vec![line(&red, 4.0, RED), line(&blue, 4.0, BLUE)], 4.0);
}

#[test]
fn upright_edges_on_whole_pixels_are_known_as_well_as_others() {
    // No mixed pixel at all, but no stairs either: what renderers without mixtures make of such a picture says nothing of its edges.
    let field = |k: usize, color| object(rectangle(40.0, 40.0), [28.0 + 40.0 * k as f64, 48.0], 0.0, color);
    let picture = paint(&scene(WHITE, vec![field(0, RED), field(1, BLUE)]));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 2);
    assert!(found.edge.law == dvp_core::render::EdgeLaw::Area && found.edge == dvp_core::render::EdgeProfile::area());
    assert!(error(&picture, &found) < 1e-4, "{}", error(&picture, &found));
}

#[test]
fn what_stands_on_a_line_does_not_run_along_it() {
    // Fields with edges over a base line: between two of them there is no room for a window across it.
    let corners = |k: usize| [10.6, 25.2, 39.8, 54.4, 69.0].map(|x| x + 4.0)[k];
    let field = |k: usize| object(rectangle(10.1, 34.0), [corners(k) + 5.05, 65.0], 0.0, BLUE);
    let edge = |k: usize| {
        let [low, high] = [corners(k), corners(k) + 10.1];
        line(&[[low, 82.0], [low, 48.0], [high, 48.0], [high, 82.0]], 0.47, [0.0; 3])
    };
    let base = line(&[[6.2, 82.0], [91.7, 82.0]], 0.47, [0.0; 3]);
    let objects = (0..5).flat_map(|k| [field(k), edge(k)]).chain([base]).collect();
    let found = found(&paint(&scene(WHITE, objects)));
    let fields = found.objects.iter().filter(|object| object.color()[2] > 0.5 && object.color()[0] < 0.5);
    assert_eq!(fields.count(), 5, "{:?}", found.objects);
}

#[test]
fn circles_at_the_ends_of_a_line_keep_their_radii() {
    // Two notes: where a pen draws them in one go a circle ends beside its start, and the distance between both tells no radius.
    let at = |x: f64, y: f64| [4.0 * x, 4.0 * y];
    let stems = PathRing::polyline(vec![at(9.0, 18.0), at(9.0, 5.0), at(21.0, 3.0), at(21.0, 16.0)]);
    let head = |x: f64, y: f64| PathRing {
        points: vec![at(x - 3.0, y), at(x + 3.0, y)],
        segments: vec![Segment::Arc { bulge: 1.0 }; 2],
    };
    let rings = vec![stems, head(6.0, 18.0), head(18.0, 16.0)];
    let notes = AnyShape::Stroke(Stroke { rings, width: 8.0, cap: Cap::Round, join: Join::Round });
    // Where it failed: at a size at which the head is drawn in one go with the stem.
    let picture =
        paint_at(&scene(WHITE, vec![object(notes, [0.0; 2], 0.0, [0.0; 3])]), ImageSize::new(256, 256).unwrap());
    let found = found(&picture);
    let missed = error(&picture, &found);
    assert!(missed < 2e-4, "{missed}: {:?}", found.objects);
}

#[test]
fn a_line_of_the_background_s_color_cuts_nothing_in_two() {
    // A box as in box plots: its median ends in the middle of its edge, and is as white as what it lies on.
    let black = [0.0; 3];
    let [left, right, top, bottom] = [14.3, 81.9, 20.6, 75.2];
    let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
    let edge = Stroke {
        rings: vec![PathRing::polygon(corners.to_vec())],
        width: 2.4,
        cap: Cap::Butt,
        join: Join::Miter { limit: 4.0 },
    };
    let objects = vec![
        object(rectangle(right - left, bottom - top), [0.5 * (left + right), 0.5 * (top + bottom)], 0.0, BLUE),
        object(AnyShape::Stroke(edge), [0.0; 2], 0.0, black),
        line(&[[left, 44.7], [right, 44.7]], 3.5, WHITE),
    ];
    let picture = paint(&scene(WHITE, objects));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 3, "{:?}", found.objects);
    let whole = found.objects.iter().find(|object| (object.color()[2] - BLUE[2]).abs() < 0.01).unwrap();
    let AnyShape::Rectangle(rectangle) = &whole.shape else { panic!("{:?}", whole.shape) };
    let height = f64::from(rectangle.size[1] * whole.pose.scale) * super::SIZE as f64;
    // Its sides lie anywhere under the edge.
    assert!((height - (bottom - top)).abs() < 2.4, "{height}");
    assert!(error(&picture, &found) < 1e-3, "{}", error(&picture, &found));
}

/// A filled polygon, points in pixels.
fn polygon(points: &[[f64; 2]], color: [f32; 3]) -> dvp_core::Object<f32> {
    let rings = vec![PathRing::polygon(points.to_vec())];
    object(AnyShape::Path(Path { rings, fill: FillRule::EvenOdd }), [0.0; 2], 0.0, color)
}

/// Two triangles side by side along a line at 45 degrees, `gap` pixels of a row between them, which is of some color too where that is said.
fn triangles(left: f64, gap: f64, between: Option<[f32; 3]>) -> Vec<dvp_core::Object<f32>> {
    let [top, bottom, right] = [30.0, 52.0, left + gap];
    let strip = [[left, top], [right, top], [right + 22.0, bottom], [left + 22.0, bottom]];
    let mut objects: Vec<_> = between.map(|color| polygon(&strip, color)).into_iter().collect();
    objects.push(polygon(&[[left, top], [left + 22.0, bottom], [left - 22.0, bottom]], GREEN));
    objects.push(polygon(&[[right, top], [right + 22.0, bottom], [right + 44.0, top]], RED));
    objects
}

#[test]
fn a_line_at_45_degrees_is_no_ring() {
    // Columns and rows read the same stretch, and one leads back along the other.
    let mut objects = triangles(24.5, 0.375, Some(BLUE));
    objects.push(object(super::circle(8.0), [76.0, 76.0], 0.0, BLUE));
    let found = found(&paint(&scene(WHITE, objects)));
    assert_eq!(found.objects.len(), 4, "{:?}", found.objects);
}

#[test]
fn a_gap_thinner_than_a_pixel_is_no_line() {
    let found = found(&paint(&scene(BLUE, triangles(24.0, 0.375, None))));
    assert_eq!(found.objects.len(), 2, "{:?}", found.objects);
}

/// Color and width, pixels, of the strokes that were found.
fn pens(found: &dvp_core::Scene<f32>) -> Vec<([f32; 3], f64)> {
    let pen = |object: &dvp_core::Object<f32>| match &object.shape {
        AnyShape::Stroke(stroke) => {
            Some((object.color(), f64::from(stroke.width * object.pose.scale) * super::SIZE as f64))
        }
        _ => None,
    };
    found.objects.iter().filter_map(pen).collect()
}

/// How far a color is from another one.
fn away(one: [f32; 3], other: [f32; 3]) -> f32 {
    one.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

const BLACK: [f32; 3] = [0.0; 3];

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// A gray line that is nowhere full shows as much as a hairline of the black that is seen beside it; where it passes between pixels tells them apart.
    #[test]
    fn lines_have_the_color_that_makes_them_smooth(gray in 0.4..0.75_f32, width in 0.7..1.3_f64, shift in 0.0..1.0_f64, rise in 6.0..30.0_f64) {
        let gray = [gray; 3];
        let bar = object(rectangle(30.0, 12.0), [40.0, 84.0], 0.0, BLACK);
        let points = [[8.0, 12.0 + shift], [46.0, 12.0 + shift + 0.4 * rise], [88.0, 12.0 + shift + rise]];
        let found = found(&paint(&scene(WHITE, vec![bar, line(&points, width, gray)])));
        let pens = pens(&found);
        prop_assert_eq!(pens.len(), 1, "{:?}", found.objects);
        prop_assert!(away(pens[0].0, gray) < 0.08, "{:?} for {gray:?}", pens[0]);
        prop_assert!((pens[0].1 - width).abs() < 0.2, "{:?} for {width}", pens[0]);
    }

    /// Lines along the picture's axes tell nothing: one between two rows of pixels looks gray, and as wide as both. It has the color of those that show
    /// as much.
    #[test]
    fn the_sides_of_a_frame_are_of_one_color(top in 10.0..11.0_f64, wide in 60.0..61.0_f64, high in 60.0..61.0_f64) {
        // Its left side lies in the middle of pixels, and shows most of the black.
        let left = 10.5;
        let [right, bottom] = [left + wide, top + high];
        let side = |from: [f64; 2], to: [f64; 2]| line(&[from, to], 0.9, BLACK);
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]];
        let objects = (0..4).map(|k| side(corners[k], corners[(k + 1) % 4])).collect();
        let found = found(&paint(&scene(WHITE, objects)));
        for object in &found.objects {
            prop_assert!(away(object.color(), BLACK) < 0.12, "{object:?}");
        }
    }
}

#[test]
fn the_border_of_a_card_has_its_own_color() {
    // Between two light colors a dark one explains it as well, much thinner, and goes on where the border bends too much for windows across it.
    let round = |width, height, corner_radius| AnyShape::Rectangle(Rectangle { size: [width, height], corner_radius });
    let [page, border, text] =
        [[245, 246, 248], [217, 220, 225], [48, 52, 59]].map(|rgb| rgb.map(|c| c as f32 / 255.0));
    let objects = vec![
        object(round(75.0, 63.0, 5.5), [48.0, 40.0], 0.0, border),
        object(round(73.0, 61.0, 4.5), [48.0, 40.0], 0.0, WHITE),
        object(rectangle(22.0, 9.0), [36.0, 30.5], 0.0, text),
        object(rectangle(40.0, 8.0), [48.0, 84.0], 0.0, border),
    ];
    // Painted as renderers do that count four by four places in a pixel.
    let fine = paint_at(&scene(page, objects), ImageSize::new(768, 768).unwrap());
    let picture = counted(fine.view(), [page, border, text, WHITE]);
    let found = found(&picture);
    let dark = found.objects.iter().filter(|object| object.color()[0] < 0.5).count();
    assert_eq!(dark, 1, "{:?}", found.objects);
    assert!(error(&picture, &found) < 1e-3, "{}", error(&picture, &found));
}

/// A quarter of a picture's size: the mean of four by four pixels, each of which is of one of some colors.
fn counted(fine: ImageView<'_, f32>, colors: [[f32; 3]; 4]) -> Image<f32> {
    let [width, height] = [fine.size().width(), fine.size().height()];
    let nearest = |i: usize| {
        let off = |color: &[f32; 3]| (0..3).map(|c| (color[c] - fine.channel(c)[i]).powi(2)).sum::<f32>();
        *colors.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap()
    };
    let mean = |i: usize, c: usize| {
        let [x, y] = [i % (width / 4), i / (width / 4)];
        let places = (0..16).map(|k| nearest((4 * y + k / 4) * width + 4 * x + k % 4)[c]);
        (places.sum::<f32>() / 16.0 * 255.0).round() / 255.0
    };
    let pixels: Vec<[f32; 3]> = (0..width * height / 16).map(|i| [0, 1, 2].map(|c| mean(i, c))).collect();
    Image::from_interleaved(ImageSize::new(width / 4, height / 4).unwrap(), pixels.as_flattened()).unwrap()
}

#[test]
fn a_hairline_that_two_pixels_share_lies_where_they_say() {
    // .13 of the pixels before x = 20 are covered, and .34 behind.
    let sides = [20.105, 76.105];
    let frame = vec![[sides[0], sides[0]], [sides[1], sides[0]], [sides[1], sides[1]], [sides[0], sides[1]]];
    let stroke =
        Stroke { rings: vec![PathRing::polygon(frame)], width: 0.47, cap: Cap::Butt, join: Join::Miter { limit: 4.0 } };
    let picture = paint(&scene(WHITE, vec![object(AnyShape::Stroke(stroke), [0.0; 2], 0.0, [0.0; 3])]));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 1, "{:?}", found.objects);
    // Else it would lie in the middle of what is covered, .13 pixels beside.
    assert!(error(&picture, &found) < 2e-4, "{}", error(&picture, &found));
}
