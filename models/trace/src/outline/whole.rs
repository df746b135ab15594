//! Whole outlines of few numbers, fitted to all samples.

use alloc::vec::Vec;
use core::f64::consts::PI;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::Outline;
use super::behind;
use super::conic;
use super::figure::{Figure, MOST_NUMBERS, as_f64};
use super::track::Track;
use super::trial::Trial;
use crate::ruler::Ruler;
use crate::tuning;

/// A circle, an ellipse or an upright rectangle that misses the samples by so little that no path can be shorter: its path has two numbers
/// more, or costs as much.
pub(super) fn fit_plain(track: &Track, ruler: &Ruler) -> Option<Outline> {
    if track.hidden.contains(&true) {
        return None;
    }
    let mut starts = Vec::new();
    rounds(track, &mut starts);
    upright(track, 0.0, false, &mut starts);
    let most = 2.0 * ruler.number(track.sigma);
    let mut best: Option<Outline> = None;
    for (figure, start, free) in starts {
        let limit = best.as_ref().map_or(f64::INFINITY, |best| best.bits + best.misfit);
        // What misses more by far is given up early.
        let limit = limit.min(most + as_f64(figure.number_count()) * ruler.number(0.0) + tuning::OUTLINE_PIECE_BITS);
        let trial = Trial { samples: &track.samples, ruler, figure, free, renderer: tuning::RENDERER_SIGMA };
        best = trial.run(start, limit).filter(|found| found.misfit < most).or(best);
    }
    best
}

/// The cheapest whole outline about along a path that costs less than `most` bits.
pub(super) fn fit(track: &Track, path: &PathRing<f64>, most: f64, ruler: &Ruler) -> Option<Outline> {
    cheapest(starts(track, path), track, most, ruler, &|_| true)
}

/// The cheapest circle or ellipse that may be.
pub(super) fn fit_round(track: &Track, most: f64, ruler: &Ruler, may_be: &dyn Fn(&Outline) -> bool) -> Option<Outline> {
    let mut starts = Vec::new();
    rounds(track, &mut starts);
    cheapest(starts, track, most, ruler, may_be)
}

/// The cheapest of figures that may be and costs less than `most` bits.
fn cheapest(
    starts: Vec<Start>,
    track: &Track,
    most: f64,
    ruler: &Ruler,
    may_be: &dyn Fn(&Outline) -> bool,
) -> Option<Outline> {
    let mut best: Option<Outline> = None;
    for (figure, start, free) in starts {
        let most = best.as_ref().map_or(most, |best| best.bits + best.misfit);
        let trial = Trial { samples: &track.samples, ruler, figure, free, renderer: tuning::RENDERER_SIGMA };
        best = trial.run(start, most).filter(may_be).or(best);
    }
    best
}

/// A figure, its numbers to start from, and how many of them, of the first, are free.
pub(super) type Start = (Figure, [f64; MOST_NUMBERS], [bool; MOST_NUMBERS]);

fn starts(track: &Track, ring: &PathRing<f64>) -> Vec<Start> {
    let mut starts = Vec::new();
    if ring.segments.iter().any(|segment| !matches!(segment, Segment::Line)) {
        rounds(track, &mut starts);
    }
    rectangles(track, ring, &mut starts);
    polygons(ring, &mut starts);
    if track.hidden.contains(&true) {
        behind::starts(ring, &mut starts);
    }
    starts
}

/// Circles and ellipses.
fn rounds(track: &Track, starts: &mut Vec<Start>) {
    let all = [true; MOST_NUMBERS];
    if let Some(circle) = track.moments(0..track.len()).circle() {
        let center = circle.center + track.point(0);
        starts.push((Figure::Circle, [center.x, center.y, circle.radius, 0.0, 0.0, 0.0], all));
    }
    if let Some([x, y, a, b, angle]) = conic::ellipse(track) {
        let upright = if angle.sin().abs() < 0.5f64.sqrt() { [a, b] } else { [b, a] };
        starts.push((
            Figure::Ellipse,
            [x, y, upright[0], upright[1], 0.0, 0.0],
            [true, true, true, true, false, false],
        ));
        starts.push((Figure::Ellipse, [x, y, a, b, angle, 0.0], all));
    }
}

/// Upright and along the longest line of the path; sharp, and round if the path has arcs or curves.
fn rectangles(track: &Track, ring: &PathRing<f64>, starts: &mut Vec<Start>) {
    let lines = edges(ring).filter(|(segment, _)| matches!(segment, Segment::Line)).map(|(_, chord)| chord);
    let Some(longest) = lines.max_by(|a, b| a.length_squared().total_cmp(&b.length_squared())) else {
        return;
    };
    let round = ring.segments.iter().any(|segment| !matches!(segment, Segment::Line));
    if !round && ring.segments.len() > 8 {
        return;
    }
    let quarters = (longest.angle() / (0.5 * PI)).round();
    let angle = longest.angle() - quarters * 0.5 * PI;
    upright(track, 0.0, false, starts);
    upright(track, angle, true, starts);
}

/// Rectangles at an angle, which is free if it `turns`: sharp, and round.
fn upright(track: &Track, angle: f64, turns: bool, starts: &mut Vec<Start>) {
    let turn = Vec2::from_angle(-angle);
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for sample in &track.samples {
        let local = sample.point.turned(turn).to_array();
        low = core::array::from_fn(|axis| low[axis].min(local[axis]));
        high = core::array::from_fn(|axis| high[axis].max(local[axis]));
    }
    let [width, height] = [high[0] - low[0], high[1] - low[1]];
    let center = Vec2::new(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])).turned(Vec2::from_angle(angle));
    // What the corners take away of the area, (4 - pi) radius^2, tells the radius of a rectangle that is seen whole.
    let missing = (width * height - area(track).abs()) / (4.0 - PI);
    let most = 0.5 * width.min(height);
    let radius = if missing > 0.0 { missing.sqrt().min(0.98 * most) } else { 0.0 };
    for (radius, is_round) in [(radius, true), (0.0, false)] {
        starts.push((
            Figure::Rectangle,
            [center.x, center.y, width, height, radius, angle],
            [true, true, true, true, is_round, turns],
        ));
    }
}

fn polygons(ring: &PathRing<f64>, starts: &mut Vec<Start>) {
    let count = ring.points.len();
    if ring.segments.iter().any(|segment| !matches!(segment, Segment::Line)) || count < 3 || count == 4 {
        return;
    }
    let points: Vec<Vec2<f64>> = ring.points.iter().map(|&point| point.into()).collect();
    let center = points.iter().fold(Vec2::default(), |sum, &point| sum + point) / as_f64(count);
    let arms: Vec<Vec2<f64>> = points.iter().map(|&point| point - center).collect();
    let mean = |every: usize, first: usize| {
        arms.iter().skip(first).step_by(every).map(|arm| arm.length()).sum::<f64>() * as_f64(every) / as_f64(count)
    };
    let mut push = |figure: Figure, radii: &[f64], first: usize, sector: f64| {
        // Artists let a corner or the middle of a side point along an axis.
        let free = arms[first].angle();
        let step = 0.25 * sector;
        let upright = (free / step).round() * step;
        for (angle, is_free) in [(upright, false), (free, true)] {
            let mut numbers = [center.x, center.y, 0.0, 0.0, 0.0, 0.0];
            numbers[2..2 + radii.len()].copy_from_slice(radii);
            numbers[2 + radii.len()] = angle;
            let mut mask = [true; MOST_NUMBERS];
            mask[2 + radii.len()] = is_free;
            starts.push((figure, numbers, mask));
        }
    };
    push(Figure::Polygon { sides: count }, &[mean(1, 0)], 0, 2.0 * PI / as_f64(count));
    if count >= 6 && count.is_multiple_of(2) {
        let first = usize::from(mean(2, 0) < mean(2, 1));
        push(
            Figure::Star { points: count / 2 },
            &[mean(2, first), mean(2, 1 - first)],
            first,
            4.0 * PI / as_f64(count),
        );
    }
}

/// Segments and their chords.
fn edges(ring: &PathRing<f64>) -> impl Iterator<Item = (&Segment<f64>, Vec2<f64>)> {
    let next = ring.points.iter().cycle().skip(1);
    let chords = ring.points.iter().zip(next).map(|(&from, &to)| Vec2::from(to) - Vec2::from(from));
    ring.segments.iter().zip(chords)
}

/// Area of the polygon through the samples.
fn area(track: &Track) -> f64 {
    let origin = track.point(0);
    let points = (0..track.len()).map(|k| track.point(k) - origin);
    0.5 * points.clone().zip(points.skip(1)).map(|(a, b)| a.cross(b)).sum::<f64>()
}
