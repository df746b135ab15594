//! Known boundaries, seen through windows of pixels, and found again.

mod windows;

use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::PI;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
use proptest::prelude::*;

use super::{OutlineShape, fit_closed, fit_open};
use crate::ruler::Ruler;
use crate::sample::{RingSamples, Sample};
use windows::{Random, deviation, pieces, ring_samples, samples};

const RULER: Ruler = Ruler { extent: 128.0 };
/// tan(pi / 8): the bulge of a quarter circle.
const QUARTER: f64 = core::f64::consts::SQRT_2 - 1.0;

/// What the samples of a ring are taken for.
fn outline(ring: &PathRing<f64>, noise: f64, seed: u64) -> OutlineShape {
    fit_closed(&ring_samples(ring, noise, noise, seed), &RULER).unwrap().shape
}

fn path(shape: OutlineShape) -> PathRing<f64> {
    match shape {
        OutlineShape::Path(ring) => ring,
        other => panic!("not a path: {other:?}"),
    }
}

fn mapped(ring: &PathRing<f64>, map: impl Fn(Vec2<f64>) -> Vec2<f64>) -> PathRing<f64> {
    let map = |point: [f64; 2]| map(point.into()).to_array();
    let segment = |segment: &Segment<f64>| match *segment {
        Segment::Cubic { controls } => Segment::Cubic { controls: controls.map(map) },
        other => other,
    };
    PathRing {
        points: ring.points.iter().map(|&point| map(point)).collect(),
        segments: ring.segments.iter().map(segment).collect(),
    }
}

/// A rectangle around `center` whose corners are quarter circles.
fn rounded(center: Vec2<f64>, size: [f64; 2], radius: f64, angle: f64) -> PathRing<f64> {
    let [w, h] = size.map(|side| 0.5 * side);
    let (x, y) = (w - radius, h - radius);
    let points = vec![[-x, -h], [x, -h], [w, -y], [w, y], [x, h], [-x, h], [-w, y], [-w, -y]];
    let segments = [Segment::Line, Segment::Arc { bulge: QUARTER }].into_iter().cycle().take(8).collect();
    mapped(&PathRing { points, segments }, |point| center + point.turned(Vec2::from_angle(angle)))
}

fn arrow() -> Vec<[f64; 2]> {
    vec![[20.2, 50.1], [70.4, 50.1], [70.4, 25.3], [118.7, 64.2], [70.4, 103.6], [70.4, 78.3], [20.2, 78.3]]
}

/// A smooth leaf with two sharp tips.
fn leaf() -> PathRing<f64> {
    PathRing {
        points: vec![[20.3, 100.2], [110.1, 30.4]],
        segments: vec![
            Segment::Cubic { controls: [[20.3, 50.0], [60.0, 30.4]] },
            Segment::Cubic { controls: [[110.1, 80.0], [70.0, 100.2]] },
        ],
    }
}

fn assert_corners(found: &PathRing<f64>, wanted: &[[f64; 2]], most: f64) {
    assert_eq!(found.points.len(), wanted.len(), "{found:?}");
    for &corner in wanted {
        let distances = found.points.iter().map(|&point| (Vec2::from(point) - corner.into()).length());
        let nearest = distances.fold(f64::INFINITY, f64::min);
        assert!(nearest < most, "{nearest} px from {corner:?}");
    }
}

#[test]
fn too_few_samples_say_nothing() {
    let sample = Sample::new(Vec2::new(1.0, 2.0), Vec2::new(1.0, 0.0), 0.02);
    let broken = Sample { point: Vec2::new(f64::NAN, 0.0), ..sample };
    let samples =
        vec![sample, sample, broken, Sample { sigma: f64::NAN, ..sample }, Sample { axis: Vec2::default(), ..sample }];
    assert_eq!(fit_open(&samples, &RULER), None);
    assert_eq!(fit_closed(&RingSamples { runs: vec![samples], closed: true }, &RULER), None);
    assert_eq!(fit_closed(&RingSamples::default(), &RULER), None);
}

#[test]
fn lines_of_an_arrow_come_back_with_sharp_corners() {
    let arrow = arrow();
    let found = path(outline(&PathRing::polygon(arrow.clone()), 0.01, 1));
    assert!(found.segments.iter().all(|segment| *segment == Segment::Line));
    assert_corners(&found, &arrow, 0.03);
    // Five of its sides lie along the axes, to the last bit.
    let next = found.points.iter().cycle().skip(1);
    let straight = found
        .points
        .iter()
        .zip(next)
        .filter(|(a, b)| (0..2).any(|axis| a[axis].to_bits() == b[axis].to_bits()))
        .count();
    assert_eq!(straight, 5);
}

#[test]
fn a_smooth_curve_needs_as_few_cubics_as_drew_it() {
    let found = path(outline(&leaf(), 0.005, 1));
    assert!(matches!(found.segments.as_slice(), [Segment::Cubic { .. }, Segment::Cubic { .. }]), "{found:?}");
    assert!(deviation(&pieces(&found), &pieces(&leaf())) < 0.03);
}

#[test]
fn a_hidden_corner_is_where_its_sides_meet() {
    let ring = PathRing::polygon(vec![[20.2, 30.1], [90.4, 30.1], [110.3, 95.2], [20.2, 110.7]]);
    let all = samples(&ring, 0.01, 0.01, 3);
    let seen = |sample: &&Sample| (sample.point - Vec2::new(110.3, 95.2)).length() > 12.0;
    let gap = all.iter().position(|sample| !seen(&sample)).unwrap();
    let mut rest = all[gap..].to_vec();
    rest.extend_from_slice(&all[..gap]);
    let run: Vec<Sample> = rest.iter().filter(seen).copied().collect();
    let found = path(fit_closed(&RingSamples { runs: vec![run], closed: false }, &RULER).unwrap().shape);
    assert_corners(&found, &ring.points, 0.1);
}

#[test]
fn half_a_circle_is_enough_for_a_circle() {
    let circle = PathRing { points: vec![[90.2, 60.3], [30.2, 60.3]], segments: vec![Segment::Arc { bulge: 1.0 }; 2] };
    let run: Vec<Sample> = samples(&circle, 0.01, 0.01, 3).into_iter().filter(|sample| sample.point.y > 55.0).collect();
    match fit_closed(&RingSamples { runs: vec![run], closed: false }, &RULER).unwrap().shape {
        OutlineShape::Circle { center, radius } => {
            assert!((center - Vec2::new(60.2, 60.3)).length() < 0.02 && (radius - 30.0).abs() < 0.02);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_open_line_keeps_its_pieces() {
    let ring = PathRing { points: vec![[20.3, 20.2], [80.1, 20.2], [100.1, 40.2], [100.1, 100.7]], segments: vec![] };
    let segments = vec![Segment::Line, Segment::Arc { bulge: QUARTER }, Segment::Line];
    let ring = PathRing { segments, ..ring };
    let open = windows::samples_of(&pieces(&ring)[..3], false, 0.01, 0.01, 1);
    let found = fit_open(&open, &RULER).unwrap().path;
    assert_eq!(found.points.len(), 4);
    assert!(matches!(found.segments.as_slice(), [Segment::Line, Segment::Arc { .. }, Segment::Line]));
    assert!((Vec2::from(found.points[1]) - Vec2::new(80.1, 20.2)).length() < 0.5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn circles_come_back(x in 50.0_f64..70.0, y in 50.0_f64..70.0, radius in 4.0_f64..45.0, seed: u64) {
        let arcs = vec![Segment::Arc { bulge: 1.0 }; 2];
        let ring = PathRing { points: vec![[x + radius, y], [x - radius, y]], segments: arcs };
        match outline(&ring, 0.005, seed) {
            OutlineShape::Circle { center, radius: found } => {
                prop_assert!((center - Vec2::new(x, y)).length() < 0.01 && (found - radius).abs() < 0.01);
            }
            other => prop_assert!(false, "{:?}", other),
        }
    }

    #[test]
    fn rectangles_come_back(w in 30.0_f64..80.0, h in 30.0_f64..80.0, radius in 4.0_f64..12.0, angle in -0.7_f64..0.7, turned: bool, seed: u64) {
        let angle = if turned { angle } else { 0.0 };
        let ring = rounded(Vec2::new(60.3, 61.1), [w, h], radius, angle);
        let shape = outline(&ring, 0.005, seed);
        prop_assert!(matches!(shape, OutlineShape::Rectangle { .. }), "{:?}", shape);
        if let OutlineShape::Rectangle { center, size, corner_radius, .. } = shape {
            let same = |sides: [f64; 2]| (sides[0] - w).abs() < 0.02 && (sides[1] - h).abs() < 0.02;
            prop_assert!(same(size) || same([size[1], size[0]]), "{:?}", size);
            prop_assert!((corner_radius - radius).abs() < 0.1, "{}", corner_radius);
            prop_assert!((center - Vec2::new(60.3, 61.1)).length() < 0.01);
        }
    }

    #[test]
    fn walks_and_turns_do_not_matter(start in 0_usize..200, quarters in 0_u32..4, mirror: bool) {
        let turn = Vec2::from_angle(0.5 * PI * f64::from(quarters));
        let map = |point: Vec2<f64>| {
            let around = (point - Vec2::new(64.0, 64.0)).turned(turn);
            Vec2::new(if mirror { -around.x } else { around.x }, around.y) + Vec2::new(64.0, 64.0)
        };
        let mut run = samples(&leaf(), 0.0, 0.02, 1);
        for sample in &mut run {
            let tip = map(sample.point + sample.axis);
            sample.point = map(sample.point);
            sample.axis = tip - sample.point;
        }
        if mirror {
            run.reverse();
        }
        let count = run.len();
        run.rotate_left(start % count);
        let found = fit_closed(&RingSamples { runs: vec![run], closed: true }, &RULER).unwrap();
        let found = path(found.shape);
        prop_assert!(found.segments.len() <= 3, "{:?}", found);
        prop_assert!(deviation(&pieces(&found), &pieces(&mapped(&leaf(), map))) < 0.05);
    }

    #[test]
    fn nothing_is_wrecked(seed: u64, count in 3_usize..9, noise in 0.005..0.4) {
        // Corners at random bearings: no side passes the middle.
        let mut random = Random(seed);
        let corner = |k: usize| {
            let bearing = 2.0 * PI * (k as f64 + random.between(-0.3, 0.3)) / count as f64;
            (Vec2::new(64.0, 64.0) + Vec2::from_angle(bearing) * random.between(25.0, 60.0)).to_array()
        };
        let ring = PathRing::polygon((0..count).map(corner).collect());
        let found = fit_closed(&ring_samples(&ring, noise, noise, seed), &RULER).unwrap();
        prop_assert!(found.bits.is_finite() && found.misfit.is_finite());
        if let OutlineShape::Path(found) = found.shape {
            let off = deviation(&pieces(&found), &pieces(&ring));
            prop_assert!(off < 1.0 + 5.0 * noise, "{} px: {:?}", off, found);
        }
    }

    #[test]
    fn no_samples_break_it(
        points in proptest::collection::vec((0.0..64.0, 0.0..64.0, 0.0..7.0, 0.0..0.5), 0..60),
        closed: bool,
    ) {
        let sample = |&(x, y, angle, sigma): &(f64, f64, f64, f64)| {
            Sample::new(Vec2::new(x, y), Vec2::from_angle(angle), sigma)
        };
        let run: Vec<Sample> = points.iter().map(sample).collect();
        if let Some(open) = fit_open(&run, &RULER) {
            prop_assert!(open.bits.is_finite() && open.misfit.is_finite());
        }
        if let Some(found) = fit_closed(&RingSamples { runs: vec![run], closed }, &RULER) {
            prop_assert!(found.bits.is_finite() && found.misfit.is_finite());
        }
    }
}

/// Samples in the middle of every pixel of the sides of an upright polygon, exact.
fn exact(points: &[[f64; 2]]) -> Vec<Sample> {
    let next = points.iter().cycle().skip(1);
    let side = |(&from, &to): (&[f64; 2], &[f64; 2])| {
        let (from, to) = (Vec2::from(from), Vec2::from(to));
        let (along, count) = ((to - from).normalized().unwrap(), (to - from).length().round() as usize);
        let sample = move |k: usize| {
            let sample = Sample::new(from + along * (k as f64 + 0.5), along.perp(), 0.002);
            Sample { is_exact: true, ..sample }
        };
        (0..count).map(sample).collect::<Vec<_>>()
    };
    points.iter().zip(next).flat_map(side).collect()
}

#[test]
fn upright_sides_that_are_exact_are_a_polygon_with_these_sides() {
    let corners = [[10.0, 10.0], [40.0, 10.0], [40.0, 11.0], [20.0, 11.0], [20.0, 50.0], [10.0, 50.0]];
    let run = exact(&corners);
    let found = fit_closed(&RingSamples { runs: vec![run.clone()], closed: true }, &RULER).unwrap();
    let mut points = path(found.shape).points;
    let first = points.iter().position(|&point| point == corners[0]).unwrap();
    points.rotate_left(first);
    assert_eq!(points, corners);
    assert_eq!(found.misfit, 0.0);
    // The lower end is hidden: its sides go on to where they meet.
    let hidden = |sample: &Sample| sample.point.y > 45.0 && sample.point.x < 15.0;
    let start = run.iter().rposition(hidden).unwrap() + 1;
    let seen: Vec<Sample> =
        run.iter().cycle().skip(start).take(run.len()).filter(|sample| !hidden(sample)).copied().collect();
    let found = fit_closed(&RingSamples { runs: vec![seen], closed: false }, &RULER).unwrap();
    let mut points = path(found.shape).points;
    let first = points.iter().position(|&point| point == corners[0]).unwrap();
    points.rotate_left(first);
    assert_eq!(points, corners);
}
