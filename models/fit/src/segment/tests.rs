use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Image, ImageSize};

use super::flat::FlatMap;
use super::region::{Region, measure};
use super::rim::{Rim, sample};
use super::transition::{SoftScratch, Transition, find};
use super::{EdgeKind, SegmentOptions, Segmentation};

/// An image from the color of each (column, row).
fn paint(width: usize, height: usize, color: impl Fn(usize, usize) -> [f64; 3]) -> Image<f64> {
    let pixels: Vec<f64> = (0..width * height).flat_map(|i| color(i % width, i / width)).collect();
    Image::from_interleaved(ImageSize::new(width, height).unwrap(), &pixels).unwrap()
}

fn regions(image: &Image<f64>) -> (FlatMap, Vec<Region<f64>>) {
    let (mut map, mut regions) = (FlatMap::default(), Vec::new());
    map.label(&image.view(), 0.0085, 4);
    measure(&image.view(), &map, 0.0, &mut regions, &mut Vec::new());
    (map, regions)
}

fn assert_near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}

#[test]
fn pixels_beside_a_step_are_not_flat() {
    // Black | white: columns 2 and 3 have a neighbor of the other color.
    let image = paint(6, 4, |x, _| [if x < 3 { 0.0 } else { 1.0 }; 3]);
    let (map, regions) = regions(&image);
    assert_eq!(map.region_count, 2);
    assert_eq!(&map.labels[..12], &[1, 1, 0, 0, 2, 2, 1, 1, 0, 0, 2, 2]);
    let left = regions[0];
    // Centers x = 0.5, 1.5 in 4 rows y = 0.5 .. 3.5: sum x = 4 (0.5 + 1.5), sum y = 2 (0.5 + 1.5 + 2.5 + 3.5),
    // sum xx = 4 (0.25 + 2.25), sum xy = 2 x 8, sum yy = 2 (0.25 + 2.25 + 6.25 + 12.25).
    assert_eq!((left.pixels, left.bounds), (8, [0, 0, 2, 4]));
    for (sum, expected) in left.sums.into_iter().zip([8.0, 16.0, 10.0, 16.0, 42.0]) {
        assert_near(sum, expected, 1e-12);
    }
    // Two pixels in the first and the last row, one in the two between.
    assert_eq!((left.border, left.color, regions[1].color), (6, [0.0; 3], [1.0; 3]));
}

#[test]
fn small_regions_are_soft_and_colors_are_medians() {
    // Three pixels in a corner are fewer than four; a seam of 0.005 down one column is outvoted.
    let image = paint(9, 9, |x, y| if x == 4 && y > 0 { [0.505; 3] } else { [0.5; 3] });
    let (map, found) = regions(&image);
    assert_eq!((map.region_count, found[0].pixels, found[0].color), (1, 81, [0.5; 3]));
    let image = paint(4, 1, |x, _| [if x < 3 { 0.0 } else { 1.0 }; 3]);
    assert_eq!(regions(&image).0.region_count, 0);
}

#[test]
fn one_region_may_bend() {
    // A U of black around white: its two arms are joined by the last run of all.
    let image = paint(15, 15, |x, y| [if (5..10).contains(&x) && y < 10 { 1.0 } else { 0.0 }; 3]);
    let (map, found) = regions(&image);
    assert_eq!(map.region_count, 2);
    assert_eq!(map.labels[0], map.labels[14]);
    // White: columns 6 to 8, rows 0 to 8. Black: two arms of 4 x 11 (the rows down to the one above the bend's own) and
    // rows 11 to 14; row 10 has the pixels below the white ones soft.
    assert_eq!((found[1].pixels, found[0].pixels), (27, 2 * 4 * 10 + 5 + 5 + 4 * 15));
}

#[test]
fn soft_pixels_lie_along_the_line_between_two_colors() {
    let ramp = [0.0, 0.0, 0.0, 0.25, 0.75, 1.0, 1.0, 1.0];
    let image = paint(8, 4, |x, _| [ramp[x], 0.5 * ramp[x], 0.2]);
    let (map, found) = regions(&image);
    let mut transitions: Vec<Transition<f64>> = Vec::new();
    find(&image.view(), &map, &found, 0.012, &mut SoftScratch::default(), &mut transitions);
    assert_eq!(transitions.len(), 16);
    for (transition, weight) in transitions.iter().zip([0.0, 0.25, 0.75, 1.0].into_iter().cycle()) {
        assert_eq!(transition.pair, [0, 1]);
        assert_near(transition.weight, weight, 1e-12);
    }
    // A color off the line belongs to no pair.
    let image = paint(8, 4, |x, _| [ramp[x], 0.5 * ramp[x], if x == 3 { 0.25 } else { 0.2 }]);
    let (map, found) = regions(&image);
    find(&image.view(), &map, &found, 0.012, &mut SoftScratch::default(), &mut transitions);
    assert_eq!(transitions.len(), 12);
}

/// A rectangle of the mixed pictures: columns, rows, color.
type Rectangle = ([usize; 2], [usize; 2], [f64; 3]);

const BACKGROUND: [f64; 3] = [0.1, 0.9, 0.2];

/// Hard rectangles; where they overlap, the mean of their colors.
fn blended(side: usize, rectangles: &[Rectangle]) -> Image<f64> {
    paint(side, side, |x, y| {
        let inside = |&&(columns, rows, _): &&Rectangle| {
            (columns[0]..columns[1]).contains(&x) && (rows[0]..rows[1]).contains(&y)
        };
        let colors: Vec<[f64; 3]> = rectangles.iter().filter(inside).map(|r| r.2).collect();
        if colors.is_empty() {
            return BACKGROUND;
        }
        let count = if colors.len() == 1 {
            1.0
        } else if colors.len() == 2 {
            2.0
        } else {
            3.0
        };
        core::array::from_fn(|c| colors.iter().map(|color| color[c]).sum::<f64>() / count)
    })
}

fn read(image: &Image<f64>) -> Segmentation<f64> {
    let mut segmentation = Segmentation::default();
    assert!(segmentation.read(&image.view(), &SegmentOptions::default()));
    segmentation.interpret(Compositing::Blend);
    segmentation
}

/// Object with that color, to which the rectangle's pixels belong.
fn object_of(segmentation: &Segmentation<f64>, color: [f64; 3]) -> u32 {
    let near = |found: [f64; 3]| (0..3).all(|c| (found[c] - color[c]).abs() < 1e-9);
    let at = segmentation.segments().iter().position(|segment| near(segment.color));
    u32::try_from(at.expect("an object of that color")).unwrap()
}

#[test]
fn an_overlap_of_two_is_no_object() {
    let parts = [([3, 15], [3, 15], [0.8, 0.2, 0.1]), ([9, 21], [9, 21], [0.2, 0.3, 0.9])];
    let found = read(&blended(24, &parts));
    assert_eq!((found.segments().len(), found.background()), (2, BACKGROUND));
    let [a, b] = parts.map(|part| object_of(&found, part.2));
    for (x, y, covers) in
        [(5, 5, [true, false]), (12, 12, [true, true]), (18, 18, [false, true]), (1, 1, [false, false])]
    {
        assert_eq!([a, b].map(|k| found.covers(y * 24 + x, k)), covers.map(Some), "at {x}, {y}");
    }
}

#[test]
fn an_overlap_of_three_is_no_object() {
    let parts = [
        ([2, 26], [2, 22], [0.9, 0.1, 0.0]),
        ([14, 38], [2, 22], [0.1, 0.2, 0.8]),
        ([8, 32], [12, 38], [0.5, 0.6, 0.3]),
    ];
    let found = read(&blended(40, &parts));
    assert_eq!(found.segments().len(), 3);
    let objects = parts.map(|part| object_of(&found, part.2));
    let at = |x: usize, y: usize| objects.map(|k| found.covers(y * 40 + x, k) == Some(true));
    assert_eq!(at(20, 17), [true; 3]);
    assert_eq!(at(20, 6), [true, true, false]);
    assert_eq!(at(11, 17), [true, false, true]);
    assert_eq!(at(29, 17), [false, true, true]);
}

#[test]
fn an_object_inside_another_shows_the_mean() {
    let parts = [([4, 28], [4, 28], [0.8, 0.2, 0.1]), ([10, 20], [10, 20], [0.2, 0.4, 0.9])];
    let found = read(&blended(32, &parts));
    assert_eq!(found.segments().len(), 2);
    // 2 x mean - host is the color that is seen nowhere.
    let [host, inner] = parts.map(|part| object_of(&found, part.2));
    assert_eq!([host, inner].map(|k| found.covers(15 * 32 + 15, k)), [Some(true); 2]);
    assert_eq!([host, inner].map(|k| found.covers(6 * 32 + 6, k)), [Some(true), Some(false)]);
}

/// Hard rectangles in painter's order, with their opacity.
fn stacked(side: usize, rectangles: &[(Rectangle, f64)]) -> Image<f64> {
    paint(side, side, |x, y| {
        rectangles.iter().fold(BACKGROUND, |below, &((columns, rows, color), opacity)| {
            let inside = (columns[0]..columns[1]).contains(&x) && (rows[0]..rows[1]).contains(&y);
            let share = if inside { opacity } else { 0.0 };
            core::array::from_fn(|c| below[c] + share * (color[c] - below[c]))
        })
    })
}

fn read_over(image: &Image<f64>) -> Segmentation<f64> {
    let mut segmentation = read(image);
    segmentation.interpret(Compositing::Over);
    segmentation
}

#[test]
fn an_overlap_tells_the_opacity_of_what_is_in_front() {
    // Red at 0.6 over blue: 0.4 blue + 0.6 red is seen in the overlap, 0.4 ground + 0.6 red beside it.
    let (blue, red) = ([0.1, 0.2, 0.9], [0.9, 0.1, 0.0]);
    let found = read_over(&stacked(40, &[(([4, 24], [4, 24], blue), 1.0), (([14, 34], [14, 34], red), 0.6)]));
    assert_eq!(found.segments().len(), 2);
    let [under, over] = [blue, red].map(|color| object_of(&found, color));
    let confidence = |object: u32| found.segments()[object as usize].confidence;
    assert_near(confidence(under), 1.0, 0.0);
    assert_near(confidence(over), 0.6, 1e-9);
    assert_eq!([under, over].map(|k| found.covers(19 * 40 + 19, k)), [Some(true); 2]);
    assert_eq!(found.borders()[0].front, Some(over));
}

#[test]
fn the_background_seen_through_an_object_is_an_object_on_it() {
    let disk = [0.2, 0.3, 0.9];
    let hole = [(([4, 28], [4, 28], disk), 1.0), (([10, 22], [10, 22], BACKGROUND), 1.0)];
    let image = stacked(32, &hole);
    let found = read_over(&image);
    assert_eq!(found.segments().len(), 2);
    let [ring, hole] = [disk, BACKGROUND].map(|color| object_of(&found, color));
    assert_eq!(found.borders().iter().map(|border| border.front).collect::<Vec<_>>(), [Some(hole)]);
    // The ring goes on behind the hole.
    assert!(found.may_be_hidden(16 * 32 + 16, ring));
    let evidence = read(&image).evidence();
    assert!(evidence.direct > 0 && evidence.mean == 0, "{evidence:?}");
}

#[test]
fn what_has_no_flat_pixel_is_found() {
    // A line of two pixels, a dot of 3 x 3, and a stroke that is flat (4 pixels wide) but in its middle (2 pixels).
    let (line, dot, stroke) = ([0.9, 0.1, 0.1], [0.1, 0.1, 0.9], [0.0, 0.0, 0.0]);
    let image = stacked(
        48,
        &[
            (([4, 44], [6, 8], line), 1.0),
            (([20, 23], [14, 17], dot), 1.0),
            (([4, 16], [24, 28], stroke), 1.0),
            (([16, 30], [25, 27], stroke), 1.0),
            (([30, 44], [24, 28], stroke), 1.0),
        ],
    );
    let found = read_over(&image);
    let pixels = [line, dot, stroke].map(|color| found.segments()[object_of(&found, color) as usize].pixels);
    assert_eq!(found.segments().len(), 3);
    assert_eq!(pixels[..2], [80, 9]);
    // A ramp to the edge of a region is no thin region.
    let ramp = [0.0, 0.0, 0.0, 0.0, 0.3, 0.8, 1.0, 1.0, 1.0, 1.0];
    assert_eq!(read_over(&paint(10, 10, |x, _| [ramp[x]; 3])).segments().len(), 1);
}

#[test]
fn only_the_middle_of_a_coded_edge_counts_in_full() {
    let edge = EdgeKind::Profile(EdgeProfile::reference());
    let transition = Transition { pixel: [3, 4], pair: [0, 1], weight: 0.5, step: false };
    let weight = |coverage: f64, coded: bool| {
        let rim = Rim { object: 0, others: 0, coverage, contrast: 0.8 };
        sample(&rim, &transition, &edge, ImageSize::new(128, 128).unwrap(), 0.02, coded).unwrap().weight
    };
    assert_near(weight(0.5, true), weight(0.5, false), 1e-12);
    // Half coverage is at 1.43 px, nine tenths at 1.07 px: there a sample that says as much in a clean picture is good to 0.36 px.
    let share = weight(0.9, true) / weight(0.9, false);
    assert!(share < 0.2, "{share}");
}
