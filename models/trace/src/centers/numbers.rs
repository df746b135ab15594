//! Outlines as numbers, and as the polygons that these make.

use alloc::vec::Vec;
use core::f64::consts::PI;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::outline::OutlineShape;

/// Farthest that polygons may be from curves, pixels: far less than an outline is held away from the middles of pixels.
const FLAT: f64 = 0.008;
/// How far a middle is, pixels, does not matter beyond.
pub(super) const FAR: f64 = 3.0;
/// Most points of an ellipse or an arc: steps that lead astray make larger ones than there are pictures.
const MOST_POINTS: f64 = 1024.0;
/// Steps of a cubic.
const CUBIC_STEPS: usize = 12;

/// A number of an outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    pub(super) value: f64,
    /// How far, pixels, the outline moves about for a change of 1.
    pub(super) lever: f64,
    /// The curves that change with it, as [`curves`] has them; the same twice if it is one.
    pub(super) curves: [usize; 2],
}

/// The numbers that may change.
pub(super) fn numbers(shape: &OutlineShape) -> Vec<Number> {
    let OutlineShape::Path(ring) = shape else {
        let of_figure = |(value, lever)| Number { value, lever, curves: [0; 2] };
        return of_figure_with_levers(shape).into_iter().map(of_figure).collect();
    };
    let mut numbers = Vec::new();
    let count = ring.segments.len();
    for (k, segment) in ring.segments.iter().enumerate() {
        let mut push = |value: f64, lever: f64, other: usize| numbers.push(Number { value, lever, curves: [other, k] });
        ring.points[k].into_iter().for_each(|value| push(value, 1.0, (k + count - 1) % count));
        match segment {
            Segment::Arc { bulge } => push(*bulge, 0.5 * (end(ring, k) - ring.points[k].into()).length(), k),
            Segment::Cubic { controls } => controls.as_flattened().iter().for_each(|&value| push(value, 0.5, k)),
            Segment::Line | Segment::SmoothArc | Segment::SmoothCubic { .. } => (),
        }
    }
    numbers
}

/// The numbers of a figure, with their levers.
fn of_figure_with_levers(shape: &OutlineShape) -> Vec<(f64, f64)> {
    let at = |center: Vec2<f64>, rest: &[(f64, f64)]| [&[(center.x, 1.0), (center.y, 1.0)], rest].concat();
    match *shape {
        OutlineShape::Circle { center, radius } => at(center, &[(radius, 1.0)]),
        OutlineShape::Ellipse { center, radii: [a, b], angle } => {
            at(center, &[(a, 1.0), (b, 1.0), (angle, (a - b).abs().max(1.0))])
        }
        OutlineShape::Rectangle { center, size: [width, height], corner_radius, angle } => {
            let free = [(width, 0.5), (height, 0.5), (angle, 0.5 * width.hypot(height)), (corner_radius, 0.4)];
            at(center, if corner_radius > 0.0 { &free } else { &free[..3] })
        }
        OutlineShape::RegularPolygon { center, radius, angle, .. } => at(center, &[(radius, 1.0), (angle, radius)]),
        OutlineShape::Star { center, radii: [a, b], angle, .. } => at(center, &[(a, 1.0), (b, 1.0), (angle, a)]),
        OutlineShape::Path(_) => Vec::new(),
    }
}

/// The outline with other numbers, in the same order.
pub(super) fn with_numbers(shape: &OutlineShape, numbers: &[f64]) -> OutlineShape {
    let mut next = numbers.iter().copied();
    let mut next = || next.next().unwrap_or_default();
    let mut shape = shape.clone();
    match &mut shape {
        OutlineShape::Circle { center, radius } => {
            *center = Vec2::new(next(), next());
            *radius = next();
        }
        OutlineShape::Ellipse { center, radii, angle } => {
            *center = Vec2::new(next(), next());
            *radii = [next(), next()];
            *angle = next();
        }
        OutlineShape::Rectangle { center, size, corner_radius, angle } => {
            *center = Vec2::new(next(), next());
            *size = [next(), next()];
            *angle = next();
            if *corner_radius > 0.0 {
                *corner_radius = next().clamp(0.0, 0.5 * size[0].min(size[1]).max(0.0));
            }
        }
        OutlineShape::RegularPolygon { center, radius, angle, .. } => {
            *center = Vec2::new(next(), next());
            *radius = next();
            *angle = next();
        }
        OutlineShape::Star { center, radii, angle, .. } => {
            *center = Vec2::new(next(), next());
            *radii = [next(), next()];
            *angle = next();
        }
        OutlineShape::Path(ring) => {
            for (point, segment) in ring.points.iter_mut().zip(&mut ring.segments) {
                *point = [next(), next()];
                match segment {
                    Segment::Arc { bulge } => *bulge = next(),
                    Segment::Cubic { controls } => controls.as_flattened_mut().iter_mut().for_each(|x| *x = next()),
                    Segment::Line | Segment::SmoothArc | Segment::SmoothCubic { .. } => (),
                }
            }
        }
    }
    shape
}

/// Where segment `k` ends.
fn end(ring: &PathRing<f64>, k: usize) -> Vec2<f64> {
    ring.points[(k + 1) % ring.points.len()].into()
}

/// The outline as a polygon.
pub(super) fn polygon(shape: &OutlineShape) -> Vec<Vec2<f64>> {
    let ellipse = |center: Vec2<f64>, [a, b]: [f64; 2], angle: f64| {
        let step = 2.0 * (1.0 - FLAT / a.max(b).max(1.0)).acos();
        let count = (2.0 * PI / step).ceil().min(MOST_POINTS);
        let turn = Vec2::from_angle(angle);
        let at = |k: usize| {
            let (sin, cos) = (2.0 * PI * k as f64 / count).sin_cos();
            center + Vec2::new(a * cos, b * sin).turned(turn)
        };
        (0..count as usize).map(at).collect()
    };
    match *shape {
        OutlineShape::Circle { center, radius } => ellipse(center, [radius; 2], 0.0),
        OutlineShape::Ellipse { center, radii, angle } => ellipse(center, radii, angle),
        OutlineShape::Path(ref ring) => polygon_of(ring),
        _ => polygon_of(&shape.ring()),
    }
}

fn polygon_of(ring: &PathRing<f64>) -> Vec<Vec2<f64>> {
    let mut points = Vec::new();
    (0..ring.segments.len()).for_each(|k| push(ring, k, &mut points));
    points
}

/// The curves of an outline, each as points from its start to its end.
pub(super) type Curves = Vec<Vec<Vec2<f64>>>;

/// The curves of a path; a figure is one.
pub(super) fn curves(shape: &OutlineShape) -> Curves {
    let count = if let OutlineShape::Path(ring) = shape { ring.segments.len() } else { 1 };
    (0..count).map(|k| curve(shape, k)).collect()
}

/// One of them.
pub(super) fn curve(shape: &OutlineShape, k: usize) -> Vec<Vec2<f64>> {
    if let OutlineShape::Path(ring) = shape {
        let mut points = Vec::new();
        push(ring, k, &mut points);
        points.push(end(ring, k));
        return points;
    }
    let mut points = polygon(shape);
    points.extend(points.first().copied());
    points
}

/// The points of curve `k` but for its end.
fn push(ring: &PathRing<f64>, k: usize, points: &mut Vec<Vec2<f64>>) {
    let (from, to) = (Vec2::from(ring.points[k]), end(ring, k));
    points.push(from);
    match ring.segments[k] {
        Segment::Arc { bulge } if bulge.abs() > 1e-6 => {
            let sweep = 4.0 * bulge.atan();
            let center = from.lerp(to, 0.5) + (to - from).perp() * (0.5 / (0.5 * sweep).tan());
            let radius = (from - center).length();
            let step = 2.0 * (1.0 - FLAT / radius.max(1.0)).acos();
            let count = (sweep.abs() / step).ceil().clamp(1.0, MOST_POINTS);
            let at = |i: usize| center + (from - center).turned(Vec2::from_angle(sweep * i as f64 / count));
            points.extend((1..count as usize).map(at));
        }
        Segment::Cubic { controls } => {
            let [a, b] = controls.map(Vec2::from);
            let at = |i: usize| {
                let t = i as f64 / CUBIC_STEPS as f64;
                let s = 1.0 - t;
                from * (s * s * s) + a * (3.0 * s * s * t) + b * (3.0 * s * t * t) + to * (t * t * t)
            };
            points.extend((1..CUBIC_STEPS).map(at));
        }
        _ => (),
    }
}

/// The outline, a path, with its curve `k` cut in two at its middle.
pub(super) fn cut(ring: &PathRing<f64>, k: usize) -> PathRing<f64> {
    let mut ring = ring.clone();
    let (from, to) = (Vec2::from(ring.points[k]), end(&ring, k));
    let (middle, halves) = match ring.segments[k] {
        Segment::Arc { bulge } => {
            // Half of the sweep on either side; the middle lies half the chord times the bulge beside it.
            let half = (0.5 * bulge.atan()).tan();
            (from.lerp(to, 0.5) - (to - from).perp() * (0.5 * bulge), [Segment::Arc { bulge: half }; 2])
        }
        Segment::Cubic { controls } => {
            let [a, b] = controls.map(Vec2::from);
            let (first, between, last) = (from.lerp(a, 0.5), a.lerp(b, 0.5), b.lerp(to, 0.5));
            let (before, behind) = (first.lerp(between, 0.5), between.lerp(last, 0.5));
            let half = |controls: [Vec2<f64>; 2]| Segment::Cubic { controls: controls.map(Vec2::to_array) };
            (before.lerp(behind, 0.5), [half([first, before]), half([behind, last])])
        }
        segment => (from.lerp(to, 0.5), [segment; 2]),
    };
    ring.points.insert(k + 1, middle.to_array());
    ring.segments.splice(k..=k, halves);
    ring
}

/// Square of the distance of a point from a line between two others; that of the box around it if it is far.
pub(super) fn square(from: Vec2<f64>, to: Vec2<f64>, point: Vec2<f64>) -> f64 {
    let beyond = |from: f64, to: f64, at: f64| (from.min(to) - at).max(at - from.max(to)).max(0.0);
    let (across, down) = (beyond(from.x, to.x, point.x), beyond(from.y, to.y, point.y));
    let far = across * across + down * down;
    if far >= FAR * FAR {
        return far;
    }
    let (chord, offset) = (to - from, point - from);
    let share = (offset.dot(chord) / chord.length_squared().max(1e-300)).clamp(0.0, 1.0);
    (offset - chord * share).length_squared()
}

/// How far a point is from the nearest of the lines between points.
pub(super) fn distance(line: &[Vec2<f64>], point: Vec2<f64>) -> f64 {
    let lines = line.windows(2).map(|pair| square(pair[0], pair[1], point));
    lines.fold(f64::INFINITY, f64::min).sqrt()
}
