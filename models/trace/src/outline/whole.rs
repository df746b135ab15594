//! Whole outlines of few numbers, fitted to all samples.

use alloc::vec::Vec;
use core::f64::consts::PI;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::behind;
use super::conic;
use super::figure::{Figure, MOST_NUMBERS, as_f64};
use super::solve::spoiled_chi2;
use super::track::{LEAST_COSINE, Track};
use super::{Outline, OutlineShape};
use crate::ruler::Ruler;
use crate::tuning;

/// Samples that a figure is first held against: enough for its numbers, and few, since most are refused.
const FIRST_LOOKS: usize = 48;
/// Steps of a fit.
const STEPS: usize = 8;
/// Mean squared misfit of samples below which a picture is exact: renderers that round their coverage have a half to two.
const EXACT: f64 = 0.1;
/// Second derivative of an outline along a window, 1/px, from which on the position in its middle is not known to a thousandth of a pixel.
const MOST_BEND: f64 = 0.5 * tuning::MOST_BEND;
/// Step of differences, pixels and radians.
const STEP: f64 = 1e-6;

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
        let trial = Trial { track, ruler, figure, free, renderer: tuning::RENDERER_SIGMA };
        best = trial.run(start, limit).filter(|found| found.misfit < most).or(best);
    }
    best
}

/// The cheapest whole outline about along a path that costs less than `most` bits.
pub(super) fn fit(track: &Track, path: &PathRing<f64>, most: f64, ruler: &Ruler) -> Option<Outline> {
    let mut best: Option<Outline> = None;
    for (figure, start, free) in starts(track, path) {
        let most = best.as_ref().map_or(most, |best| best.bits + best.misfit);
        let trial = Trial { track, ruler, figure, free, renderer: tuning::RENDERER_SIGMA };
        best = trial.run(start, most).or(best);
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

/// A figure on trial.
#[derive(Clone, Copy)]
struct Trial<'a> {
    track: &'a Track,
    ruler: &'a Ruler,
    figure: Figure,
    free: [bool; MOST_NUMBERS],
    /// What renderers are off by, pixels.
    renderer: f64,
}

/// Normal equations of a figure's numbers; those that are not free keep to themselves.
struct Equations {
    normal: [[f64; MOST_NUMBERS]; MOST_NUMBERS],
    right: [f64; MOST_NUMBERS],
    chi2: f64,
}

impl Trial<'_> {
    /// The outline if it costs less than `most` bits.
    fn run(&self, start: [f64; MOST_NUMBERS], most: f64) -> Option<Outline> {
        let few = self.track.len().div_ceil(FIRST_LOOKS);
        // A few samples tell whether all can be met; with much room before the fit, and some after.
        let bits = |equations: &Equations| self.ruler.misfit(equations.chi2) * as_f64(few);
        self.equations(&start, few).filter(|first| bits(first) < 20.0 * most)?;
        let (numbers, first) = self.descend(start, few)?;
        if bits(&first) > 2.0 * most {
            return None;
        }
        let (numbers, equations) = if few > 1 { self.descend(numbers, 1)? } else { (numbers, first) };
        let misfit = self.ruler.misfit(equations.chi2);
        let factor = cholesky(&equations.normal, 0.0)?;
        let lever = 0.5 * numbers[2].abs();
        let mut bits = tuning::OUTLINE_PIECE_BITS;
        for k in (0..self.figure.number_count()).filter(|&k| self.free[k]) {
            let lever = if self.figure.angle() == Some(k) { lever } else { 1.0 };
            let sigma = lever / factor[k][k];
            // What is not determined is not known to be this figure.
            if sigma > 0.5 {
                return None;
            }
            bits += self.ruler.number(sigma);
        }
        if bits + misfit >= most {
            return None;
        }
        let (numbers, deviations) = self.polish(numbers, &equations).unwrap_or((numbers, Vec::new()));
        Some(Outline { shape: self.shape(&numbers)?, bits, misfit, deviations })
    }

    /// The numbers by the doubt of the samples alone, if they are not off by what renderers are off by, and the deviations of the numbers.
    fn polish(&self, numbers: [f64; MOST_NUMBERS], found: &Equations) -> Option<([f64; MOST_NUMBERS], Vec<f64>)> {
        if matches!(self.figure, Figure::Polygon { .. } | Figure::Star { .. }) {
            return None;
        }
        let variance =
            |equations: &Equations| equations.chi2 / (as_f64(self.track.len()) - as_f64(self.count_free())).max(1.0);
        let exact = Trial { renderer: 0.0, ..*self };
        let polished = (variance(found) < EXACT && self.renderer > 0.0).then(|| exact.descend(numbers, 1)).flatten();
        let (numbers, found) = polished.as_ref().map_or((numbers, found), |(numbers, found)| (*numbers, found));
        let factor = cholesky(&found.normal, 0.0)?;
        let deviation = |k: usize| {
            if !self.free[k] {
                return 0.0;
            }
            let unit: [f64; MOST_NUMBERS] = core::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
            (solve(&factor, unit)[k] * variance(found)).sqrt()
        };
        Some((numbers, (0..self.figure.number_count()).map(deviation).collect()))
    }

    /// How many numbers are free.
    fn count_free(&self) -> usize {
        self.free[..self.figure.number_count()].iter().filter(|&&is_free| is_free).count()
    }

    /// Gauss-Newton on every `every`-th sample.
    fn descend(&self, start: [f64; MOST_NUMBERS], every: usize) -> Option<([f64; MOST_NUMBERS], Equations)> {
        let mut numbers = start;
        let mut now = self.equations(&numbers, every)?;
        let mut damping = 1e-6;
        for _ in 0..STEPS {
            let change = solve(&cholesky(&now.normal, damping)?, now.right);
            let mut next: [f64; MOST_NUMBERS] = core::array::from_fn(|k| numbers[k] + change[k]);
            if self.figure == Figure::Rectangle {
                next[4] = next[4].clamp(0.0, 0.5 * next[2].min(next[3]).max(0.0));
            }
            match self.equations(&next, every).filter(|then| then.chi2 < now.chi2) {
                Some(then) => {
                    let gain = now.chi2 - then.chi2;
                    (numbers, now, damping) = (next, then, damping * 0.1);
                    if gain < 0.1 {
                        break;
                    }
                }
                None if damping > 1.0 => break,
                None => damping = (damping * 1e3).max(1e-3),
            }
        }
        Some((numbers, now))
    }

    fn equations(&self, numbers: &[f64; MOST_NUMBERS], every: usize) -> Option<Equations> {
        let count = self.figure.number_count();
        let corners = self.figure.corners(numbers);
        let mut equations =
            Equations { normal: [[0.0; MOST_NUMBERS]; MOST_NUMBERS], right: [0.0; MOST_NUMBERS], chi2: 0.0 };
        for sample in self.track.samples.iter().step_by(every) {
            let sigma = if self.renderer > 0.0 { sample.sigma } else { Track::own_sigma(sample) };
            let (distance, normal) = self.figure.distance(numbers, sample.point);
            if self.renderer <= 0.0 && self.figure.bend(numbers, sample) > MOST_BEND {
                continue;
            }
            let scale = 1.0 / (normal.dot(sample.axis).abs().max(LEAST_COSINE) * sigma);
            let misfit = distance * scale;
            if corners.iter().any(|&corner| sample.holds(corner)) {
                equations.chi2 += (misfit * misfit).min(spoiled_chi2());
                continue;
            }
            let far = misfit.abs() / tuning::OUTLINE_HUBER;
            let weight = 1.0 / far.max(1.0);
            equations.chi2 += misfit * misfit * weight * (2.0 - weight);
            let mut slopes = [0.0; MOST_NUMBERS];
            for k in (0..count).filter(|&k| self.free[k]) {
                let mut moved = *numbers;
                moved[k] += STEP;
                slopes[k] = (self.figure.distance(&moved, sample.point).0 - distance) * scale / STEP;
            }
            for i in 0..count {
                for j in 0..=i {
                    equations.normal[i][j] += weight * slopes[i] * slopes[j];
                }
                equations.right[i] -= weight * slopes[i] * misfit;
            }
        }
        for k in (0..MOST_NUMBERS).filter(|&k| k >= count || !self.free[k]) {
            equations.normal[k][k] = 1.0;
        }
        equations.chi2.is_finite().then_some(equations)
    }

    fn shape(&self, numbers: &[f64; MOST_NUMBERS]) -> Option<OutlineShape> {
        let [x, y, a, b, c, d] = *numbers;
        let center = Vec2::new(x, y);
        let good = numbers.iter().all(|number| number.is_finite()) && a > 0.0;
        let shape = match self.figure {
            Figure::Circle => OutlineShape::Circle { center, radius: a },
            Figure::Ellipse => OutlineShape::Ellipse { center, radii: [a, b], angle: c },
            Figure::Rectangle => OutlineShape::Rectangle { center, size: [a, b], corner_radius: c, angle: d },
            Figure::Polygon { sides } => OutlineShape::RegularPolygon { center, sides, radius: a, angle: b },
            Figure::Star { points } => OutlineShape::Star { center, points, radii: [a, b], angle: c },
        };
        let positive = matches!(self.figure, Figure::Circle | Figure::Polygon { .. }) || b > 0.0;
        (good && positive).then_some(shape)
    }
}

/// The lower factor of a matrix with its diagonal multiplied by 1 + `damping`.
fn cholesky(normal: &[[f64; MOST_NUMBERS]; MOST_NUMBERS], damping: f64) -> Option<[[f64; MOST_NUMBERS]; MOST_NUMBERS]> {
    let mut factor = [[0.0; MOST_NUMBERS]; MOST_NUMBERS];
    for i in 0..MOST_NUMBERS {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| factor[i][k] * factor[j][k]).sum();
            if i == j {
                let value = normal[i][i] * (1.0 + damping) - sum;
                factor[i][i] = (value > 0.0 && value.is_finite()).then(|| value.sqrt())?;
            } else {
                factor[i][j] = (normal[i][j] - sum) / factor[j][j];
            }
        }
    }
    Some(factor)
}

fn solve(factor: &[[f64; MOST_NUMBERS]; MOST_NUMBERS], mut x: [f64; MOST_NUMBERS]) -> [f64; MOST_NUMBERS] {
    for i in 0..MOST_NUMBERS {
        let sum: f64 = (0..i).map(|k| factor[i][k] * x[k]).sum();
        x[i] = (x[i] - sum) / factor[i][i];
    }
    for i in (0..MOST_NUMBERS).rev() {
        let sum: f64 = (i + 1..MOST_NUMBERS).map(|k| factor[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / factor[i][i];
    }
    x
}
