//! What windows of pixels tell of a known boundary.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{Path, PathRing, Piece, Shape};

use crate::sample::{RingSamples, Sample};

/// Numbers that look random, the same in every run.
pub(super) struct Random(pub(super) u64);

impl Random {
    /// From 0 to 1.
    pub(super) fn share(&mut self) -> f64 {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// With mean 0 and standard deviation 1.
    pub(super) fn normal(&mut self) -> f64 {
        (-2.0 * self.share().max(1e-300).ln()).sqrt() * (core::f64::consts::TAU * self.share()).cos()
    }
}

/// Exact pieces of a ring.
pub(super) fn pieces(ring: &PathRing<f64>) -> Vec<Piece<f64>> {
    Path::new(vec![ring.clone()]).unwrap().boundary().unwrap().pieces
}

/// Points along the pieces, about `step` apart, each with the number of its piece.
fn dense(pieces: &[Piece<f64>], step: f64) -> Vec<(Vec2<f64>, usize)> {
    let mut points = Vec::new();
    for (k, piece) in pieces.iter().enumerate() {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a positive count")]
        let count = (piece.length() / step).ceil().max(1.0) as usize;
        points.extend((0..count).map(|i| (piece.point(i as f64 / count as f64), k)));
    }
    points
}

/// Samples along a ring, one per column where it is flat and one per row where it is steep, each off by `noise` pixels (standard
/// deviation) and said to be off by `sigma`. A window with a corner in it tells the mean of what it sees of both sides.
pub(super) fn samples(ring: &PathRing<f64>, noise: f64, sigma: f64, seed: u64) -> Vec<Sample> {
    samples_of(&pieces(ring), ring.is_closed(), noise, sigma, seed)
}

/// The same of pieces, which are closed or not.
pub(super) fn samples_of(pieces: &[Piece<f64>], closed: bool, noise: f64, sigma: f64, seed: u64) -> Vec<Sample> {
    let step = 0.01;
    let points = dense(pieces, step);
    let count = points.len();
    let at = |i: usize| points[i % count];
    let sharp: Vec<bool> = (0..pieces.len())
        .map(|k| {
            let before = pieces[(k + pieces.len() - 1) % pieces.len()].velocity(1.0).normalized().unwrap();
            before.dot(pieces[k].velocity(0.0).normalized().unwrap()) < 0.9
        })
        .collect();
    let mut random = Random(seed);
    let mut samples = Vec::new();
    let last = if closed { count } else { count - 1 };
    for i in 0..last {
        let ((a, _), (b, _)) = (at(i), at(i + 1));
        let delta = b - a;
        let flat = delta.x.abs() >= delta.y.abs();
        let (along, next) = if flat { (a.x, b.x) } else { (a.y, b.y) };
        let middle = along.min(next).floor() + 0.5;
        if (along < middle) == (next < middle) {
            continue;
        }
        let mut point = a.lerp(b, (middle - along) / (next - along));
        // What lies in the window before and after.
        let inside = |j: &usize| {
            let (p, _) = at(*j);
            ((if flat { p.x } else { p.y }) - middle).abs() < 0.5
        };
        let window: Vec<usize> = (1..300)
            .map(|j| (i + count - j) % count)
            .take_while(inside)
            .chain((0..300).map(|j| (i + j) % count).take_while(inside))
            .collect();
        let cornered = window.iter().any(|&j| at(j).1 != at(j + 1).1 && sharp[at(j + 1).1]);
        if cornered {
            let mut sum = (0.0, 0.0);
            for &j in &window {
                let (p, q) = (at(j).0, at(j + 1).0);
                let width = if flat { q.x - p.x } else { q.y - p.y }.abs();
                sum = (sum.0 + width, sum.1 + width * if flat { p.y } else { p.x });
            }
            if flat { point.y = sum.1 / sum.0 } else { point.x = sum.1 / sum.0 }
        }
        let axis = if flat { Vec2::new(0.0, 1.0) } else { Vec2::new(1.0, 0.0) };
        samples.push(Sample::new(point + axis * (noise * random.normal()), axis, sigma));
    }
    samples
}

/// The samples of a ring that is seen whole.
pub(super) fn ring_samples(ring: &PathRing<f64>, noise: f64, sigma: f64, seed: u64) -> RingSamples {
    RingSamples { runs: vec![samples(ring, noise, sigma, seed)], closed: true }
}

/// The largest distance of points of one boundary from another, over both ways, pixels.
pub(super) fn deviation(a: &[Piece<f64>], b: &[Piece<f64>]) -> f64 {
    one_way(a, b).max(one_way(b, a))
}

fn one_way(a: &[Piece<f64>], b: &[Piece<f64>]) -> f64 {
    let targets = dense(b, 0.05);
    let segment = |i: usize| {
        let end = targets[(i + 1) % targets.len()].0;
        (targets[i].0, end)
    };
    dense(a, 0.5)
        .iter()
        .map(|&(point, _)| {
            (0..targets.len())
                .map(|i| {
                    let (from, to) = segment(i);
                    let chord = to - from;
                    let t = ((point - from).dot(chord) / chord.length_squared().max(1e-12)).clamp(0.0, 1.0);
                    (point - from.lerp(to, t)).length_squared()
                })
                .fold(f64::INFINITY, f64::min)
                .sqrt()
        })
        .fold(0.0, f64::max)
}
