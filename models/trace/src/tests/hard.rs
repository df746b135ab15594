//! Pictures without a mixed pixel: what is at the middle of a pixel is a fact.

use dvp_core::Vec2;
use dvp_core::render::EdgeProfile;

use super::edges::hard;
use super::*;
use crate::partition::{Partition, Reading};

/// Whether a heart of about this size, at an angle, covers a point.
fn is_heart([x, y]: [f64; 2], [cx, cy]: [f64; 2], size: f64, angle: f64) -> bool {
    let at = (Vec2::new(x - cx, y - cy) / size).turned(Vec2::from_angle(-angle));
    let (u, v) = (at.x, -at.y);
    (u * u + v * v - 1.0).powi(3) < u * u * v.powi(3)
}

/// Pixels of a picture that what is found shows otherwise at their middles.
fn wrong(picture: &Image<f32>, found: &Scene<f32>) -> usize {
    let basis = OutlineBasis::new(64, 1).unwrap();
    let mut drawing = Drawing::default();
    found.draw(&basis, &mut drawing).unwrap();
    let unit = SIZE as f32;
    let covers = |object: usize, [x, y]: [f32; 2]| {
        let rings = drawing.rings(object);
        let edges = rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let crossed =
            edges.filter(|&(p, q)| (p[1] > y) != (q[1] > y) && x < p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]));
        crossed.count() % 2 == 1
    };
    let is_wrong = |&i: &usize| {
        let at = [(i % SIZE) as f32 + 0.5, (i / SIZE) as f32 + 0.5].map(|x| x / unit);
        let shown = (0..found.objects.len()).rev().find(|&object| covers(object, at));
        let color = shown.map_or(found.background, |object| found.objects[object].color());
        (0..3).any(|c| (picture.data()[c * SIZE * SIZE + i] - color[c]).abs() > 0.01)
    };
    (0..SIZE * SIZE).filter(is_wrong).count()
}

#[test]
fn the_middle_of_every_pixel_is_on_the_right_side() {
    for k in 0..6 {
        let angle = 0.2 + 0.37 * f64::from(k);
        let turned = |[x, y]: [f64; 2], [cx, cy]: [f64; 2]| {
            Vec2::new(x - cx, y - cy).turned(Vec2::from_angle(-angle)).to_array()
        };
        let color = |at: [f64; 2]| {
            let [u, v] = turned(at, [30.3, 61.8]);
            let [a, b] = turned(at, [62.1, 55.4]);
            match () {
                () if u.abs() < 9.3 && v.abs() < 9.3 => RED,
                () if (a / 8.7).hypot(b / 5.1) < 1.0 => [0.9, 0.8, 0.1],
                () if is_heart(at, [55.2, 34.9], 13.4, angle) => BLUE,
                () => WHITE,
            }
        };
        let picture = hard(color);
        let found = found(&picture);
        assert_eq!(found.objects.len(), 3, "{:?}", found.objects);
        assert!(wrong(&picture, &found) <= 1, "{} pixels at {angle}", wrong(&picture, &found));
    }
}

/// A picture of squares of five pixels: letters are colors, dots the background.
fn board(rows: &[&str]) -> Image<f32> {
    hard(|[x, y]| {
        let [column, row] = [x - 20.0, y - 20.0].map(|at| (at / 5.0).floor());
        let inside = row >= 0.0 && column >= 0.0;
        let letter = inside.then(|| rows.get(row as usize)?.as_bytes().get(column as usize)).flatten();
        match letter {
            Some(b'r') => RED,
            Some(b'b') => BLUE,
            _ => WHITE,
        }
    })
}

#[test]
fn what_is_seen_whole_is_no_part_of_something_behind() {
    // Both red pieces touch the blue one and are seen whole: of each of their sides something is free.
    let picture = board(&["r....", "rrr..", "..b..", "..b..", "..bb.", ".rr..", "rr..."]);
    let found = found(&picture);
    assert_eq!(found.objects.len(), 3, "{:?}", found.objects);
    // A bar that another one crosses is one bar: of the sides at the other nothing is seen.
    let crossed =
        trace(&board(&["...b...", "...b...", "rrrbrrr", "rrrbrrr", "...b...", "...b..."]).view(), &Known::default());
    assert_eq!(crossed.unwrap().scene.objects.len(), 2);
}

#[test]
fn what_a_pen_has_drawn_is_whole_where_its_ends_are_seen() {
    // The red hook at the border is as wide as a pen everywhere, and the blue piece touches it at a corner.
    let is_in = |[x, y]: [f64; 2], [left, top, right, bottom]: [f64; 4]| {
        (left..right).contains(&x) && (top..bottom).contains(&y)
    };
    let red = [[3.0, 0.0, 8.0, 10.0], [3.0, 5.0, 18.0, 10.0], [5.0, 23.0, 15.0, 28.0], [0.0, 28.0, 10.0, 33.0]];
    let blue = [[15.0, 10.0, 20.0, 25.0], [15.0, 20.0, 25.0, 25.0]];
    let picture = hard(|at| match () {
        () if red.iter().any(|&place| is_in(at, place)) => RED,
        () if blue.iter().any(|&place| is_in(at, place)) => BLUE,
        () => WHITE,
    });
    let found = found(&picture);
    assert_eq!(found.objects.len(), 3, "{:?}", found.objects);
}

#[test]
fn fields_with_a_gap_between_are_not_cut() {
    // The upper piece ends a pixel beside the lower one, two pixels lower than that begins: around there four fields seem to meet.
    let is_upper = |[x, y]: [f64; 2]| (44.0..54.0).contains(&x) && (30.0..41.0).contains(&y);
    let is_lower = |[x, y]: [f64; 2]| (33.0..43.0).contains(&x) && (39.0..49.0).contains(&y);
    let picture = hard(|at| if is_upper(at) || is_lower(at) { RED } else { WHITE });
    let partition = Partition::of(&picture.view(), Reading::default()).unwrap();
    let areas: Vec<usize> = partition.faces.iter().map(|face| face.area).collect();
    assert_eq!(areas[1..], [110, 100], "{areas:?}");
}

#[test]
fn upright_sides_among_stairs_are_exact() {
    // Modules of three pixels, as of a code to be read by machines, beside a disk whose edge is stairs.
    let module = |x: f64, y: f64| ((x * 7.0 + y * 13.0 + x * y * 5.0) * 0.618).fract() < 0.5;
    let picture = hard(|[x, y]| {
        let [column, row] = [x - 9.0, y - 9.0].map(|at| (at / 3.0).floor());
        let is_inside = (0.0..15.0).contains(&column) && (0.0..15.0).contains(&row);
        let is_disk = (x - 76.0).hypot(y - 76.0) < 14.0;
        if is_inside && module(column, row) || is_disk { BLUE } else { WHITE }
    });
    let found = found(&picture);
    assert!(found.edge.law != EdgeProfile::<f32>::area().law, "not read as hard: {:?}", found.edge);
    assert!(wrong(&picture, &found) <= 2, "{} pixels", wrong(&picture, &found));
}
