//! Who lies in front where three faces meet: the one whose boundary goes on as if nothing were there (T-junctions).

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::Vec2;

use crate::boundary::Ring;
use crate::partition::OUTSIDE;
use crate::sample::Sample;
use crate::tuning;

/// How much speaks for the first face of a pair lying in front of the second, bits.
pub(super) type Votes = BTreeMap<(u32, u32), f64>;

/// A place where the neighbor of a face changes.
#[derive(Clone, Copy, Debug)]
struct Turn {
    /// The face that walks past.
    face: u32,
    at: Vec2<f64>,
    /// Bits by which one smooth curve misses the samples on both sides.
    misfit: f64,
}

/// The votes of all junctions.
pub(super) fn votes(rings: &[Vec<Ring>]) -> Votes {
    let mut junctions: BTreeMap<[u32; 3], Vec<Turn>> = BTreeMap::new();
    for (face, ring) in
        rings.iter().enumerate().flat_map(|(face, rings)| rings.iter().map(move |ring| (face as u32, ring)))
    {
        let n = ring.steps.len();
        for k in 0..n {
            let [here, next] = [ring.steps[k], ring.steps[(k + 1) % n]];
            if here.other == next.other || here.other == OUTSIDE || next.other == OUTSIDE {
                continue;
            }
            let mut faces = [face, here.other, next.other];
            faces.sort_unstable();
            let [x, y] = here.crack.end();
            if let Some(misfit) = misfit_across(ring, k) {
                let turn = Turn { face, at: Vec2::new(x as f64, y as f64), misfit };
                junctions.entry(faces).or_default().push(turn);
            }
        }
    }
    let mut votes = Votes::new();
    for (faces, turns) in &junctions {
        for turn in turns {
            // The other faces' walks past the same junction; one that could not be measured is no rival.
            let rivals = turns
                .iter()
                .filter(|other| other.face != turn.face && (other.at - turn.at).length() <= tuning::JUNCTION_SIZE);
            let Some(best_rival) = rivals.map(|rival| rival.misfit).min_by(f64::total_cmp) else { continue };
            let gain = (best_rival - turn.misfit).min(tuning::MOST_VOTE);
            if gain > 0.0 && turn.misfit < tuning::MOST_VOTE {
                for &behind in faces.iter().filter(|&&face| face != turn.face) {
                    *votes.entry((turn.face, behind)).or_default() += gain;
                }
            }
        }
    }
    votes
}

/// Bits by which one parabola misses the samples of a ring on both sides of the corner after step `k`; none where there are
/// too few samples.
fn misfit_across(ring: &Ring, k: usize) -> Option<f64> {
    let n = ring.steps.len();
    let side = |offsets: &mut dyn Iterator<Item = usize>, other: u32| {
        let mut samples: Vec<Sample> = Vec::new();
        for j in offsets.take_while(|&j| ring.steps[j].other == other).take(2 * tuning::JUNCTION_SAMPLES) {
            samples.extend(ring.steps[j].sample);
            if samples.len() == tuning::JUNCTION_SAMPLES {
                break;
            }
        }
        samples
    };
    let before = side(&mut (0..n).map(|j| (k + n - j) % n), ring.steps[k].other);
    let behind = side(&mut (0..n).map(|j| (k + 1 + j) % n), ring.steps[(k + 1) % n].other);
    if before.len() < 3 || behind.len() < 3 {
        return None;
    }
    let all: Vec<Sample> = before.iter().rev().chain(&behind).copied().collect();
    let (first, last) = (all.first()?.point, all.last()?.point);
    let along = (last - first).normalized()?;
    parabola_misfit(&all, first, along)
}

/// Bits by which the best parabola over the line through `origin` along `along` misses.
fn parabola_misfit(samples: &[Sample], origin: Vec2<f64>, along: Vec2<f64>) -> Option<f64> {
    let normal = along.perp();
    let mut moments = [0.0_f64; 5];
    let mut right = [0.0_f64; 3];
    let rows: Vec<(f64, f64, f64)> = samples
        .iter()
        .map(|sample| {
            let offset = sample.point - origin;
            let slant = normal.dot(sample.axis).abs().max(0.3);
            let sigma = (sample.sigma * slant).hypot(tuning::JUNCTION_SIGMA);
            (offset.dot(along), offset.dot(normal), 1.0 / (sigma * sigma))
        })
        .collect();
    let scale = rows.last()?.0.max(1.0);
    for &(t, y, w) in &rows {
        let mut power = w;
        for (j, moment) in moments.iter_mut().enumerate() {
            *moment += power;
            if j < 3 {
                right[j] += power * y;
            }
            power *= t / scale;
        }
    }
    let solution = solve(
        [
            [moments[0], moments[1], moments[2]],
            [moments[1], moments[2], moments[3]],
            [moments[2], moments[3], moments[4]],
        ],
        right,
    )?;
    let chi2: f64 = rows
        .iter()
        .map(|&(t, y, w)| {
            let t = t / scale;
            let miss = y - solution[0] - t * (solution[1] + t * solution[2]);
            w * miss * miss
        })
        .sum();
    Some(chi2 * 0.5 * core::f64::consts::LOG2_E)
}

/// Solves three equations by elimination with pivots; none if they are singular.
fn solve(mut matrix: [[f64; 3]; 3], mut right: [f64; 3]) -> Option<[f64; 3]> {
    for i in 0..3 {
        let pivot = (i..3).max_by(|&a, &b| matrix[a][i].abs().total_cmp(&matrix[b][i].abs()))?;
        if matrix[pivot][i].abs() < 1e-12 {
            return None;
        }
        matrix.swap(i, pivot);
        right.swap(i, pivot);
        for j in i + 1..3 {
            let factor = matrix[j][i] / matrix[i][i];
            let above = matrix[i];
            for (value, above) in matrix[j].iter_mut().zip(above).skip(i) {
                *value -= factor * above;
            }
            right[j] -= factor * right[i];
        }
    }
    for i in (0..3).rev() {
        for k in i + 1..3 {
            right[i] -= matrix[i][k] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    Some(right)
}
