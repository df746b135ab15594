//! Closed polygons to lines and cubic Bezier curves, as few as a tolerance allows.
//!
//! *Source*: P. J. Schneider, An algorithm for automatically fitting digitized curves, Graphics Gems (1990): least squares
//! for the lengths of the two tangents, a few Newton steps on the parameters, and a split at the worst point.

use core::fmt::Write;

/// A vertex where the outline turns by more than 35 degrees is a corner: no curve passes smoothly through it.
const CORNER_COS: f64 = 0.82;
/// Newton rounds on the parameters of a piece.
const ROUNDS: usize = 4;

type Point = [f64; 2];

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

fn along(a: Point, direction: Point, length: f64) -> Point {
    [a[0] + direction[0] * length, a[1] + direction[1] * length]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn norm(a: Point) -> f64 {
    a[0].hypot(a[1])
}

fn unit(a: Point) -> Point {
    let length = norm(a);
    if length > 0.0 { [a[0] / length, a[1] / length] } else { a }
}

/// SVG path data that passes every vertex of the closed polygon within `tolerance`; both in the polygon's units.
pub(super) fn path_data(polygon: &[Point], tolerance: f64) -> String {
    // Rounding may take a fifth of the tolerance.
    let decimals = (2.5 / tolerance).log10().ceil().clamp(0.0, 12.0);
    let mut pen = Pen { data: String::from("M"), decimals, tolerance: tolerance * 0.8 };
    let mut ring = polygon.to_vec();
    ring.dedup_by(|a, b| norm(minus(*a, *b)) < 1e-9);
    if ring.len() > 1 && norm(minus(ring[0], ring[ring.len() - 1])) < 1e-9 {
        ring.pop();
    }
    let count = ring.len();
    let corners: Vec<usize> = (0..count).filter(|&i| is_corner(&ring, i)).collect();
    let start = corners.first().copied().unwrap_or(0);
    pen.point(ring.get(start).copied().unwrap_or_default());
    // The runs between corners; without a corner two, through smooth stops.
    let halves = if corners.is_empty() && count > 2 { vec![count / 2] } else { Vec::new() };
    let inner = corners.iter().skip(1).map(|&corner| corner - start).chain(halves);
    let mut from = 0;
    for to in inner.chain((count > 1).then_some(count)) {
        let run: Vec<Point> = (from..=to).map(|i| ring[(start + i) % count]).collect();
        let ends = if corners.is_empty() && count > 2 {
            [smooth_tangent(&ring, from), smooth_tangent(&ring, to).map(core::ops::Neg::neg)]
        } else {
            end_tangents(&run)
        };
        pen.fit(&run, ends);
        from = to;
    }
    pen.data.push('Z');
    pen.data
}

/// The direction in which the outline passes a vertex.
fn smooth_tangent(ring: &[Point], i: usize) -> Point {
    let count = ring.len();
    unit(minus(ring[(i + 1) % count], ring[(i + count - 1) % count]))
}

fn is_corner(ring: &[Point], i: usize) -> bool {
    let count = ring.len();
    let before = unit(minus(ring[i], ring[(i + count - 1) % count]));
    let after = unit(minus(ring[(i + 1) % count], ring[i]));
    dot(before, after) < CORNER_COS
}

/// Directions into the run at its two ends.
fn end_tangents(run: &[Point]) -> [Point; 2] {
    let last = run.len() - 1;
    [unit(minus(run[1], run[0])), unit(minus(run[last - 1], run[last]))]
}

struct Pen {
    data: String,
    decimals: f64,
    tolerance: f64,
}

impl Pen {
    /// Draws through `run`, which starts at the pen; `ends` are the directions into it at its ends.
    fn fit(&mut self, run: &[Point], ends: [Point; 2]) {
        let last = run.len() - 1;
        if is_straight(run, self.tolerance) {
            self.data.push('L');
            self.point(run[last]);
            return;
        }
        let mut parameters = chord_lengths(run);
        let mut worst = (f64::INFINITY, 1);
        for _ in 0..ROUNDS {
            let cubic = least_squares(run, &parameters, ends);
            worst = farthest(&cubic, run, &parameters);
            if worst.0 <= self.tolerance {
                self.data.push('C');
                for (i, point) in cubic[1..].iter().enumerate() {
                    if i > 0 {
                        self.data.push(' ');
                    }
                    self.point(*point);
                }
                return;
            }
            for (u, &point) in parameters.iter_mut().zip(run) {
                *u = nearer(&cubic, point, *u);
            }
        }
        let split = worst.1.clamp(1, last - 1);
        let tangent = unit(minus(run[split + 1], run[split - 1]));
        self.fit(&run[..=split], [ends[0], [-tangent[0], -tangent[1]]]);
        self.fit(&run[split..], [tangent, ends[1]]);
    }

    fn point(&mut self, [x, y]: Point) {
        // Writing to a String cannot fail.
        let _ = write!(self.data, "{},{}", short(x, self.decimals), short(y, self.decimals));
    }
}

fn is_straight(run: &[Point], tolerance: f64) -> bool {
    let chord = minus(run[run.len() - 1], run[0]);
    let direction = unit(chord);
    run.len() == 2
        || run.iter().all(|&point| {
            let from = minus(point, run[0]);
            let length = dot(from, direction);
            (0.0..=norm(chord)).contains(&length) && norm(minus(from, along([0.0; 2], direction, length))) <= tolerance
        })
}

/// Lengths along the run as shares of the whole.
fn chord_lengths(run: &[Point]) -> Vec<f64> {
    let mut length = 0.0;
    let mut lengths = vec![0.0];
    lengths.extend(run.windows(2).map(|pair| {
        length += norm(minus(pair[1], pair[0]));
        length
    }));
    lengths.iter().map(|l| l / length).collect()
}

fn weights(u: f64) -> [f64; 4] {
    let v = 1.0 - u;
    [v * v * v, 3.0 * v * v * u, 3.0 * v * u * u, u * u * u]
}

fn at(cubic: &[Point; 4], u: f64) -> Point {
    weights(u).iter().zip(cubic).fold([0.0; 2], |sum, (&w, &p)| along(sum, p, w))
}

/// The cubic with the given ends and end directions that is nearest to the points at their parameters.
fn least_squares(run: &[Point], parameters: &[f64], ends: [Point; 2]) -> [Point; 4] {
    let (first, last) = (run[0], run[run.len() - 1]);
    let mut normal = [[0.0; 2]; 2];
    let mut right = [0.0; 2];
    for (&point, &u) in run.iter().zip(parameters) {
        let [w0, w1, w2, w3] = weights(u);
        let columns = [ends[0].map(|t| t * w1), ends[1].map(|t| t * w2)];
        let rest = minus(point, along(first.map(|v| v * (w0 + w1)), last, w2 + w3));
        for i in 0..2 {
            right[i] += dot(columns[i], rest);
            for j in 0..2 {
                normal[i][j] += dot(columns[i], columns[j]);
            }
        }
    }
    let determinant = normal[0][0] * normal[1][1] - normal[0][1] * normal[1][0];
    let chord = norm(minus(last, first));
    let solved = [
        (right[0] * normal[1][1] - right[1] * normal[0][1]) / determinant,
        (right[1] * normal[0][0] - right[0] * normal[1][0]) / determinant,
    ];
    // Backward tangents, or longer ones than the run, would make loops; a third of the chord is always sane.
    let is_sane = solved.iter().all(|&length| length > 1e-3 * chord) && solved[0] + solved[1] < run_length(run);
    let lengths = if is_sane { solved } else { [chord / 3.0; 2] };
    [first, along(first, ends[0], lengths[0]), along(last, ends[1], lengths[1]), last]
}

fn run_length(run: &[Point]) -> f64 {
    run.windows(2).map(|pair| norm(minus(pair[1], pair[0]))).sum()
}

/// The largest distance of a point from the curve at its parameter, and which point.
fn farthest(cubic: &[Point; 4], run: &[Point], parameters: &[f64]) -> (f64, usize) {
    let distances = run.iter().zip(parameters).map(|(&point, &u)| norm(minus(at(cubic, u), point)));
    distances.enumerate().fold((0.0, 0), |worst, (i, d)| if d > worst.0 { (d, i) } else { worst })
}

/// A Newton step toward the parameter of the curve point nearest to `point`.
fn nearer(cubic: &[Point; 4], point: Point, u: f64) -> f64 {
    let v = 1.0 - u;
    let steps: [Point; 3] = core::array::from_fn(|i| minus(cubic[i + 1], cubic[i]));
    let slope: Point =
        core::array::from_fn(|a| 3.0 * (v * v * steps[0][a] + 2.0 * v * u * steps[1][a] + u * u * steps[2][a]));
    let bend: Point =
        core::array::from_fn(|a| 6.0 * (v * (steps[1][a] - steps[0][a]) + u * (steps[2][a] - steps[1][a])));
    let gap = minus(at(cubic, u), point);
    let curvature = dot(slope, slope) + dot(gap, bend);
    if curvature > 0.0 { (u - dot(gap, slope) / curvature).clamp(0.0, 1.0) } else { u }
}

/// A number with at most `decimals` decimals, without idle zeros: -.5, 12, .031.
pub(super) fn short(value: f64, decimals: f64) -> String {
    let unit = 10f64.powf(decimals);
    let rounded = (value * unit).round() / unit;
    let text = format!("{}", if rounded == 0.0 { 0.0 } else { rounded });
    match (text.strip_prefix("0."), text.strip_prefix("-0.")) {
        (Some(rest), _) => format!(".{rest}"),
        (_, Some(rest)) => format!("-.{rest}"),
        _ => text,
    }
}
