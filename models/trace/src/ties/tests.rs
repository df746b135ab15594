//! Numbers that were on a grid come back exactly; numbers that were not stay.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{Cap, Join, PathRing, Segment, Stroke};
use proptest::prelude::*;

use super::classes::classes;
use super::numbers::{Number, SIGMA};
use super::tie;
use crate::layers::{Form, Layer, Layers};
use crate::outline::{Outline, OutlineShape};
use crate::ruler::Ruler;

const SIDE: usize = 256;
const RULER: Ruler = Ruler { extent: SIDE as f64 };

fn drawing(forms: Vec<Form>) -> Layers {
    let layers = forms
        .into_iter()
        .map(|form| Layer { color: [0.0; 3], form, faces: Vec::new(), heap: None, bits: 0.0 })
        .collect();
    Layers { background: [1.0; 3], layers }
}

fn filled(shapes: Vec<OutlineShape>) -> Form {
    Form::Filled(
        shapes.into_iter().map(|shape| Outline { shape, bits: 0.0, misfit: 0.0, covariance: Vec::new() }).collect(),
    )
}

fn rectangle(sides: [f64; 4]) -> OutlineShape {
    let [left, top, right, bottom] = sides;
    let center = Vec2::new(0.5 * (left + right), 0.5 * (top + bottom));
    OutlineShape::Rectangle { center, size: [right - left, bottom - top], corner_radius: 0.0, angle: 0.0 }
}

fn sides(shape: &OutlineShape) -> [f64; 4] {
    let OutlineShape::Rectangle { center, size: [width, height], .. } = *shape else { panic!("no rectangle") };
    [center.x - 0.5 * width, center.y - 0.5 * height, center.x + 0.5 * width, center.y + 0.5 * height]
}

fn shapes(layers: &Layers) -> Vec<&OutlineShape> {
    let outlines = |layer| match layer {
        &Layer { form: Form::Filled(ref outlines), .. } => outlines.iter().map(|outline| &outline.shape).collect(),
        _ => Vec::new(),
    };
    layers.layers.iter().flat_map(outlines).collect()
}

/// The middle of a frame of 18 units of 24 with corners of 2 units, as an artist's pen draws it, in units.
fn frame() -> PathRing<f64> {
    let bulge = (core::f64::consts::PI / 8.0).tan();
    let (line, arc) = (Segment::Line, Segment::Arc { bulge });
    PathRing {
        points: vec![[5., 3.], [19., 3.], [21., 5.], [21., 19.], [19., 21.], [5., 21.], [3., 19.], [3., 5.]],
        segments: vec![line, arc, line, arc, line, arc, line, arc],
    }
}

fn scaled(mut ring: PathRing<f64>, scale: f64) -> PathRing<f64> {
    ring.points.iter_mut().flatten().for_each(|value| *value *= scale);
    ring
}

fn stroke(ring: PathRing<f64>, width: f64) -> Form {
    Form::Stroked(Stroke { rings: vec![ring], width, cap: Cap::Round, join: Join::Round })
}

#[test]
fn equal_numbers_are_one_class() {
    let numbers = [10.03, 50.0, 9.98, 10.01, 50.4].map(|value| Number { value, sigma: 0.03 });
    let counts: Vec<usize> = classes(numbers.to_vec(), &RULER).iter().map(|class| class.count).collect();
    assert_eq!(counts, [3, 1, 1]);
}

#[test]
fn nothing_to_tie_is_nothing() {
    assert_eq!(tie(&mut drawing(Vec::new()), [SIDE; 2]), None);
}

#[test]
fn points_between_lines_and_arcs_slide_to_the_grid() {
    let unit = SIDE as f64 / 24.0;
    let mut ring = scaled(frame(), unit);
    // Where a line ends and an arc begins cannot be seen: the radius is a little off, and the arc tangent to the lines.
    let (corner, radius) = (21.0 * unit, 2.0 * unit + 0.2);
    ring.points[1][0] = corner - radius;
    ring.points[2][1] = 3.0 * unit + radius;
    let mut layers = drawing(vec![stroke(ring, 2.0 * unit + 0.05)]);
    let step = tie(&mut layers, [SIDE; 2]).expect("a grid");
    assert!(((unit / step).log2() % 1.0).abs() < 1e-9, "step {step}, unit {unit}");
    let Form::Stroked(stroke) = &layers.layers[0].form else { panic!("no stroke") };
    let wanted = scaled(frame(), unit);
    for (point, wanted) in stroke.rings[0].points.iter().zip(&wanted.points) {
        assert!((0..2).all(|k| (point[k] - wanted[k]).abs() < 1e-9), "{point:?} {wanted:?}");
    }
    for (segment, wanted) in stroke.rings[0].segments.iter().zip(&wanted.segments) {
        if let (Segment::Arc { bulge }, Segment::Arc { bulge: wanted }) = (segment, wanted) {
            assert!((bulge - wanted).abs() < 1e-9);
        }
    }
    assert!((stroke.width - 2.0 * unit).abs() < 1e-9);
}

/// Corners of rectangles in quarters of units, most of them on whole units.
fn on_grid() -> impl Strategy<Value = Vec<[u32; 4]>> {
    let number = prop_oneof![4 => (1_u32..23).prop_map(|n| 4 * n), 1 => (2_u32..46).prop_map(|n| 2 * n)];
    proptest::collection::vec([number.clone(), number.clone(), number.clone(), number], 4..10)
}

fn noise() -> impl Strategy<Value = Vec<f64>> {
    // Sums of three even ones have nearly a Gaussian's distribution, of standard deviation 1.
    proptest::collection::vec([-1.0..1.0, -1.0..1.0, -1.0..1.0_f64].prop_map(|v| v.iter().sum::<f64>()), 40)
}

proptest! {
    #[test]
    fn numbers_on_a_grid_come_back(corners in on_grid(), noise in noise()) {
        let unit = SIDE as f64 / 24.0;
        let truth: Vec<[f64; 4]> = corners.iter().map(|&[a, b, c, d]| {
            [a.min(c), b.min(d), a.max(c) + 4, b.max(d) + 4].map(|quarters| 0.25 * unit * f64::from(quarters))
        }).collect();
        let noisy = truth.iter().enumerate().map(|(k, sides)| {
            rectangle([0, 1, 2, 3].map(|side| sides[side] + 0.02 * noise[4 * k + side]))
        });
        let mut layers = drawing(vec![filled(noisy.collect())]);
        let step = tie(&mut layers, [SIDE; 2]);
        prop_assert!(step.is_some());
        for (shape, truth) in shapes(&layers).iter().zip(&truth) {
            let found = sides(shape);
            prop_assert!((0..4).all(|k| (found[k] - truth[k]).abs() < 1e-6), "{:?} {:?} step {:?}", found, truth, step);
        }
    }

    #[test]
    fn no_number_moves_beyond_its_doubt(corners in proptest::collection::vec([1.0..120.0, 1.0..120.0, 130.0..250.0, 130.0..250.0_f64], 1..12)) {
        let mut layers = drawing(vec![filled(corners.iter().map(|&sides| rectangle(sides)).collect())]);
        tie(&mut layers, [SIDE; 2]);
        for (shape, truth) in shapes(&layers).iter().zip(&corners) {
            let found = sides(shape);
            prop_assert!((0..4).all(|k| (found[k] - truth[k]).abs() <= 2.0 * SIGMA + 1e-9));
        }
    }
}

/// Random numbers are on no grid: at most one in 200 moves at all, beside those that happen to be equal.
#[test]
fn random_numbers_stay() {
    let mut state = 1_u64;
    let mut random = |low: f64, high: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    let (mut moved, mut all, mut grids) = (0, 0, 0);
    for drawing_size in (0..400).map(|k| 1 + k % 12) {
        let truth: Vec<[f64; 4]> = (0..drawing_size)
            .map(|_| [random(1.0, 120.0), random(1.0, 120.0), random(130.0, 250.0), random(130.0, 250.0)])
            .collect();
        let mut layers = drawing(vec![filled(truth.iter().map(|&sides| rectangle(sides)).collect())]);
        grids += usize::from(tie(&mut layers, [SIDE; 2]).is_some());
        for (shape, truth) in shapes(&layers).iter().zip(&truth) {
            let found = sides(shape);
            moved += (0..4).filter(|&k| (found[k] - truth[k]).abs() > 1e-9).count();
            all += 4;
        }
    }
    assert!(grids <= 2, "{grids} grids of 400");
    assert!(200 * moved <= all, "{moved} of {all} moved");
}

#[test]
fn rings_of_two_arcs_are_circles() {
    let unit = SIDE as f64 / 24.0;
    let ring = |x: f64, y: f64, radius: f64, angle: f64| {
        let arm = Vec2::from_angle(angle) * radius;
        let center = Vec2::new(x, y);
        PathRing {
            points: vec![(center - arm).to_array(), (center + arm).to_array()],
            segments: vec![Segment::Arc { bulge: 1.0 }; 2],
        }
    };
    let round = |x: f64, y: f64, radius: f64| {
        stroke(ring(x * unit + 0.03, y * unit - 0.02, radius * unit + 0.05, 0.01), 2.0 * unit)
    };
    let mut layers =
        drawing(vec![round(12.0, 12.0, 10.0), round(6.0, 9.0, 3.0), round(17.5, 8.0, 2.0), round(15.0, 20.0, 1.5)]);
    assert!(tie(&mut layers, [SIDE; 2]).is_some());
    let Form::Stroked(first) = &layers.layers[0].form else { panic!("no stroke") };
    for (point, wanted) in first.rings[0].points.iter().zip([[2.0 * unit, 12.0 * unit], [22.0 * unit, 12.0 * unit]]) {
        assert!((0..2).all(|k| (point[k] - wanted[k]).abs() < 1e-9), "{point:?} {wanted:?}");
    }
}

/// A crescent: the long arc of one circle and the short one of another that lies nearly as the other arc of the first would.
#[test]
fn long_arcs_stay_long() {
    let ends = [[146.05, 127.41], [146.05, 64.59]];
    let ring = PathRing {
        points: ends.to_vec(),
        segments: vec![Segment::Arc { bulge: 1.2092 }, Segment::Arc { bulge: -0.826 }],
    };
    let Form::Filled(outlines) = filled(vec![OutlineShape::Path(ring), rectangle([48.0, 48.0, 208.0, 144.0])]) else {
        panic!()
    };
    let mut layers = drawing(vec![Form::Filled(outlines)]);
    tie(&mut layers, [256, 192]);
    let OutlineShape::Path(found) = shapes(&layers)[0] else { panic!("no path") };
    let Segment::Arc { bulge } = found.segments[0] else { panic!("no arc") };
    assert!(bulge > 1.1, "{bulge}");
}

/// Things along the border of the picture, on no grid, that were fitted a little within it, as some of them could be seen to be.
#[test]
fn what_ends_beside_the_border_ends_there() {
    let side = SIDE as f64;
    let ring = |left: f64, right: f64, off: f64| PathRing {
        points: vec![[left, off], [right, off], [right, side - off], [left, side - off]],
        segments: vec![Segment::Line; 4],
    };
    let rings =
        [ring(13.71, 31.18, 0.04), ring(57.43, 88.92, 0.05), ring(120.37, 151.66, 0.06), ring(190.05, 217.59, 0.07)];
    let shapes = rings.into_iter().map(|ring| filled(vec![OutlineShape::Path(ring)])).collect();
    let mut layers = drawing(shapes);
    tie(&mut layers, [SIDE; 2]);
    for layer in &layers.layers {
        let Form::Filled(outlines) = &layer.form else { panic!("no outline") };
        let OutlineShape::Path(ring) = &outlines[0].shape else { panic!("no path") };
        let ys: Vec<f64> = ring.points.iter().map(|point| point[1]).collect();
        assert_eq!(ys, [0.0, 0.0, side, side]);
    }
}

/// A corner cut off by an arc, either way round, and bars: alone, and further off than what is drawn may move elsewhere.
#[test]
fn a_side_along_the_border_lies_on_it() {
    let side = SIDE as f64;
    let arc = Segment::Arc { bulge: 0.3 };
    let corner = PathRing {
        points: vec![[0.17, 140.3], [0.12, side - 0.15], [119.4, side - 0.11]],
        segments: vec![Segment::Line, Segment::Line, arc],
    };
    let back = PathRing {
        points: vec![[119.4, side - 0.11], [0.12, side - 0.15], [0.17, 140.3]],
        segments: vec![Segment::Line, Segment::Line, Segment::Arc { bulge: -0.3 }],
    };
    let rounded =
        OutlineShape::Rectangle { center: Vec2::new(80.0, 45.2), size: [60.0, 89.8], corner_radius: 9.0, angle: 0.0 };
    // Nobody drew it to end there, and of a strip one side does.
    let [apart, strip] = [[150.0, 0.6, 180.0, 90.0], [200.0, 0.1, 240.0, 0.45]].map(rectangle);
    let [corner, back] = [corner, back].map(OutlineShape::Path);
    let mut layers = drawing(vec![filled(vec![corner, back, rounded, apart, strip])]);
    tie(&mut layers, [SIDE; 2]);
    let [OutlineShape::Path(corner), OutlineShape::Path(back), rounded, apart, strip] = shapes(&layers)[..] else {
        panic!("no path")
    };
    let expected = [[0.0, 140.3], [0.0, side], [119.4, side]];
    assert_eq!(corner.points, expected);
    assert!(back.points.iter().eq(expected.iter().rev()), "{back:?}");
    assert!(sides(rounded)[1].abs() < 1e-9, "{rounded:?}");
    assert!((sides(apart)[1] - 0.6).abs() < 0.1, "{apart:?}");
    let [_, top, _, bottom] = sides(strip);
    assert!(top.abs() < 1e-9 && (bottom - 0.45).abs() < 0.1, "{strip:?}");
}
