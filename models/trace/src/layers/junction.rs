//! Who lies in front where three faces meet: the one whose boundary goes on as if nothing were there (T-junctions).

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::Vec2;

use crate::boundary::Ring;
use crate::elimination::solve;
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
    /// Bits by which one smooth curve misses the samples on both sides: near by, and further.
    misfits: [Option<f64>; 2],
}

/// Pairs of faces of which the boundary of the first goes on smoothly where the second one ends at it: what would be seen if the
/// first one hid a part of the second.
pub(super) type Passes = BTreeSet<(u32, u32)>;

/// The votes of all junctions, and who passes whom.
pub(super) fn votes(rings: &[Vec<Ring>]) -> (Votes, Passes) {
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
            let at = Vec2::new(x as f64, y as f64);
            let misfits = tuning::JUNCTION_SAMPLES.map(|count| misfit_across(ring, k, at, count));
            junctions.entry(faces).or_default().push(Turn { face, at, misfits });
        }
    }
    let (mut votes, mut passes) = (Votes::new(), Passes::new());
    for (faces, turns) in &junctions {
        for turn in turns {
            // All walks past the same junction, read as far as one of them is smooth.
            let here: Vec<&Turn> =
                turns.iter().filter(|other| (other.at - turn.at).length() <= tuning::JUNCTION_SIZE).collect();
            let is_smooth = |misfit: Option<f64>| misfit.is_some_and(|misfit| misfit < tuning::MOST_VOTE);
            let scales = 0..turn.misfits.len();
            let Some(scale) = scales.rev().find(|&scale| here.iter().any(|turn| is_smooth(turn.misfits[scale]))) else {
                continue;
            };
            let Some(misfit) = turn.misfits[scale].filter(|&misfit| is_smooth(Some(misfit))) else { continue };
            let ending = || faces.iter().copied().filter(|&face| face != turn.face);
            // Near by a right angle is hardly worse than a bend.
            if turn.misfits.iter().flatten().all(|&misfit| is_smooth(Some(misfit))) {
                passes.extend(ending().map(|face| (turn.face, face)));
            }
            // One that could not be measured is no rival. What is no curve at all misses as much as may speak.
            let rivals = here.iter().filter(|other| other.face != turn.face).filter_map(|rival| rival.misfits[scale]);
            let gain = rivals.min_by(f64::total_cmp).map_or(0.0, |rival| rival.min(tuning::MOST_VOTE) - misfit);
            if gain > 0.0 {
                for behind in ending() {
                    *votes.entry((turn.face, behind)).or_default() += gain;
                }
            }
        }
    }
    (votes, passes)
}

/// Bits by which one parabola misses the samples of a ring, up to `count` on both sides of the corner after step `k`; none where there are
/// too few samples.
fn misfit_across(ring: &Ring, k: usize, at: Vec2<f64>, count: usize) -> Option<f64> {
    let n = ring.steps.len();
    let side = |offsets: &mut dyn Iterator<Item = usize>, other: u32| {
        let steps = offsets.take_while(|&j| ring.steps[j].other == other).take(2 * count);
        let samples: Vec<Sample> = steps
            .map(|j| &ring.steps[j])
            .filter(|step| !step.is_across)
            .filter_map(|step| step.sample)
            .take(count)
            .collect();
        // Windows across the junction itself see three faces.
        samples.into_iter().filter(|sample| (sample.point - at).length() > tuning::JUNCTION_BLUR).collect::<Vec<_>>()
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
