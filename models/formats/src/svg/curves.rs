//! Closed polygons that stand for smooth curves to lines and cubics, as few as a tolerance allows.
//!
//! *Source*: P. J. Schneider, An algorithm for automatically fitting digitized curves, Graphics Gems (1990): least squares
//! for the lengths of the two tangents, a few Newton steps on the parameters, and a split at the worst point.
//!
//! *Why not kurbo's `fit_to_bezpath`*: on outlines of 64 vertices it is as accurate at as many bytes, and takes more than twice
//! as long; its optimal splits take five hundred times as long.

use dvp_core::geometry::Vec2;
use dvp_core::shape::Piece;

/// A vertex where the outline turns by more than 35 degrees is a corner: no curve passes smoothly through it.
const CORNER_COS: f64 = 0.82;
/// Newton rounds on the parameters of a piece.
const ROUNDS: usize = 4;
/// Vertices closer than this are one.
const SAME: f64 = 1e-9;

type Point = Vec2<f64>;
type Cubic = [Point; 4];

fn unit(vector: Point) -> Point {
    vector.normalized().unwrap_or_default()
}

/// The lines and cubics around the closed polygon, its vertices within `tolerance` of them; both in the polygon's units.
pub(super) fn smooth(polygon: &[Point], tolerance: f64) -> Vec<Piece<f64>> {
    let mut ring = polygon.to_vec();
    ring.dedup_by(|a, b| (*a - *b).length() < SAME);
    if let [first, .., last] = ring[..]
        && (first - last).length() < SAME
    {
        ring.pop();
    }
    let count = ring.len();
    if count < 3 {
        return Vec::new();
    }
    let corners: Vec<usize> = (0..count).filter(|&i| is_corner(&ring, i)).collect();
    let start = corners.first().copied().unwrap_or(0);
    // The runs between corners; without a corner two, through smooth stops.
    let halves = if corners.is_empty() { vec![count / 2] } else { Vec::new() };
    let ends = corners.iter().skip(1).map(|&corner| corner - start).chain(halves).chain([count]);
    let mut fit = Fit { tolerance, pieces: Vec::new() };
    let mut from = 0;
    for to in ends {
        let run: Vec<Point> = (from..=to).map(|i| ring[(start + i) % count]).collect();
        let tangents = if corners.is_empty() {
            [direction(&ring, start + from), -direction(&ring, start + to)]
        } else {
            end_tangents(&run)
        };
        fit.run(&run, tangents);
        from = to;
    }
    fit.pieces
}

/// Vertex `i`, the one before and the one after it.
fn around(ring: &[Point], i: usize) -> [Point; 3] {
    let count = ring.len();
    [i + count - 1, i, i + 1].map(|i| ring[i % count])
}

fn is_corner(ring: &[Point], i: usize) -> bool {
    let [before, here, after] = around(ring, i);
    unit(here - before).dot(unit(after - here)) < CORNER_COS
}

/// The direction in which the outline passes vertex `i`.
fn direction(ring: &[Point], i: usize) -> Point {
    let [before, _, after] = around(ring, i);
    unit(after - before)
}

/// Directions into the run at its two ends.
fn end_tangents(run: &[Point]) -> [Point; 2] {
    let last = run.len() - 1;
    [unit(run[1] - run[0]), unit(run[last - 1] - run[last])]
}

struct Fit {
    tolerance: f64,
    pieces: Vec<Piece<f64>>,
}

impl Fit {
    /// Appends pieces along `run`; `ends` are the directions into it at its ends.
    fn run(&mut self, run: &[Point], ends: [Point; 2]) {
        let last = run.len() - 1;
        if is_straight(run, self.tolerance) {
            self.pieces.push(Piece::Line { from: run[0], to: run[last] });
            return;
        }
        let mut parameters = chord_lengths(run);
        let mut worst = (f64::INFINITY, 1);
        for _ in 0..ROUNDS {
            let cubic = least_squares(run, &parameters, ends);
            worst = farthest(&cubic, run, &parameters);
            if worst.0 <= self.tolerance {
                self.pieces.push(Piece::Cubic(cubic));
                return;
            }
            for (u, &point) in parameters.iter_mut().zip(run) {
                *u = nearer(&cubic, point, *u);
            }
        }
        let split = worst.1.clamp(1, last - 1);
        let tangent = unit(run[split + 1] - run[split - 1]);
        self.run(&run[..=split], [ends[0], -tangent]);
        self.run(&run[split..], [tangent, ends[1]]);
    }
}

fn is_straight(run: &[Point], tolerance: f64) -> bool {
    let chord = run[run.len() - 1] - run[0];
    // Around an outline with one corner a run ends where it begins, in no direction.
    let Some(direction) = chord.normalized() else { return false };
    run.len() == 2
        || run.iter().all(|&point| {
            let offset = point - run[0];
            let length = offset.dot(direction);
            (0.0..=chord.length()).contains(&length) && offset.cross(direction).abs() <= tolerance
        })
}

/// Lengths along the run as shares of the whole.
fn chord_lengths(run: &[Point]) -> Vec<f64> {
    let mut length = 0.0;
    let mut lengths = vec![0.0];
    lengths.extend(run.windows(2).map(|pair| {
        length += (pair[1] - pair[0]).length();
        length
    }));
    lengths.iter().map(|l| l / length).collect()
}

fn weights(u: f64) -> [f64; 4] {
    let v = 1.0 - u;
    [v * v * v, 3.0 * v * v * u, 3.0 * v * u * u, u * u * u]
}

fn at(cubic: &Cubic, u: f64) -> Point {
    weights(u).iter().zip(cubic).fold(Point::default(), |sum, (&w, &p)| sum + p * w)
}

/// The cubic with the given ends and end directions that is nearest to the points at their parameters.
fn least_squares(run: &[Point], parameters: &[f64], ends: [Point; 2]) -> Cubic {
    let (first, last) = (run[0], run[run.len() - 1]);
    let mut normal = [[0.0; 2]; 2];
    let mut right = [0.0; 2];
    for (&point, &u) in run.iter().zip(parameters) {
        let [w0, w1, w2, w3] = weights(u);
        let columns = [ends[0] * w1, ends[1] * w2];
        let rest = point - first * (w0 + w1) - last * (w2 + w3);
        for i in 0..2 {
            right[i] += columns[i].dot(rest);
            for j in 0..2 {
                normal[i][j] += columns[i].dot(columns[j]);
            }
        }
    }
    let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
    let chord = (last - first).length();
    let solved = [
        (right[0] * normal[1][1] - right[1] * normal[0][1]) / determinant,
        (right[1] * normal[0][0] - right[0] * normal[1][0]) / determinant,
    ];
    // Backward tangents, or longer ones than the run, would make loops; a third of the chord is always sane.
    let run_length: f64 = run.windows(2).map(|pair| (pair[1] - pair[0]).length()).sum();
    let is_sane = solved.iter().all(|&length| length > 1e-3 * chord) && solved[0] + solved[1] < run_length;
    let lengths = if is_sane { solved } else { [chord / 3.0; 2] };
    [first, first + ends[0] * lengths[0], last + ends[1] * lengths[1], last]
}

/// The largest distance of a point from the curve at its parameter, and which point.
fn farthest(cubic: &Cubic, run: &[Point], parameters: &[f64]) -> (f64, usize) {
    let distances = run.iter().zip(parameters).map(|(&point, &u)| (at(cubic, u) - point).length());
    distances.enumerate().fold((0.0, 0), |worst, (i, d)| if d > worst.0 { (d, i) } else { worst })
}

/// A Newton step toward the parameter of the curve point nearest to `point`.
fn nearer(cubic: &Cubic, point: Point, u: f64) -> f64 {
    let v = 1.0 - u;
    let [p, q, r] = [cubic[1] - cubic[0], cubic[2] - cubic[1], cubic[3] - cubic[2]];
    let slope = (p * (v * v) + q * (2.0 * v * u) + r * (u * u)) * 3.0;
    let bend = ((q - p) * v + (r - q) * u) * 6.0;
    let gap = at(cubic, u) - point;
    let curvature = slope.length_squared() + gap.dot(bend);
    if curvature > 0.0 { (u - gap.dot(slope) / curvature).clamp(0.0, 1.0) } else { u }
}
