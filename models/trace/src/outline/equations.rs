//! What the least squares of a chain are made of: the samples, given to curves, and the equations of all numbers.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::chain::Chain;
use super::gauge::{Gauge, Held, SEARCHES};
use super::skyline::Skyline;
use super::solve::{huber, robust, samples_of, spoiled_chi2};
use super::ties::Tie;
use super::track::Track;
use crate::tuning;

/// How hard ends that nothing else holds are held to the last sample: to half a pixel.
const END_WEIGHT: f64 = 4.0;
/// Squared length of the sum of two directions, of length 1, below which one leads back along the other (168 degrees).
const LEAST_FORWARD: f64 = 0.04;
/// Samples beside a corner that may be moved from one curve to the next at once.
const REACH: usize = 8;
/// Samples beside a corner whose windows may hold it.
const BESIDE: usize = 4;

/// What is minimized.
pub(super) struct Problem<'a> {
    track: &'a Track,
    ties: &'a [(Tie, f64)],
    /// Where the numbers of each point start, as [`Chain::places`] has them.
    places: Vec<usize>,
    /// The directions of each curve, as [`Chain::directions`] has them.
    directions: Vec<Option<[Vec2<f64>; 2]>>,
    /// Of each sample from the first of an open chain on, or of the track: its parameter on the cubic that explains it.
    parameters: Vec<f64>,
    /// The sample of the first parameter.
    base: usize,
}

/// The state of a chain: its equations.
#[derive(Clone)]
pub(super) struct Equations {
    pub(super) normal: Skyline,
    pub(super) right: Vec<f64>,
    pub(super) chi2: f64,
    /// Squared violations of the ties by their weight.
    strain: f64,
}

impl<'a> Problem<'a> {
    /// The fit of a chain of these curves.
    pub(super) fn new(chain: &Chain, track: &'a Track, ties: &'a [(Tie, f64)]) -> Self {
        let (base, count) =
            if chain.closed { (0, track.len()) } else { (chain.firsts[0], chain.end - chain.firsts[0]) };
        let parameters = vec![f64::NAN; count];
        Self { track, ties, places: chain.places(), directions: Vec::new(), parameters, base }
    }

    /// Gives samples beside points to the curve on whose side of the point they lie: before the equations of these numbers are written.
    pub(super) fn assign(&mut self, chain: &mut Chain) {
        let count = chain.curves.len();
        self.directions.clear();
        self.directions.extend((0..count).map(|k| chain.directions(k)));
        for k in usize::from(!chain.closed)..count {
            let before = if k == 0 { count - 1 } else { k - 1 };
            let (Some([_, arrive]), Some([leave, _])) = (self.directions[before], self.directions[k]) else {
                continue;
            };
            let (low, high) = limits(chain, self.track, k);
            let mut first = chain.firsts[k];
            let forward = arrive + leave;
            if first <= low || high <= first || forward.length_squared() < LEAST_FORWARD {
                // Nothing is seen of one of both, or the outline turns back.
                continue;
            }
            let ahead =
                |sample: usize| (self.track.point(sample % self.track.len()) - chain.points[k]).dot(forward) > 0.0;
            let start = first;
            while first > low + 1 && first + REACH > start && ahead(first - 1) {
                first -= 1;
            }
            while first + 1 < high && first < start + REACH && !ahead(first) {
                first += 1;
            }
            for sample in first.min(start)..first.max(start) {
                let slot = self.slot(sample);
                self.parameters[slot] = f64::NAN;
            }
            chain.firsts[k] = first;
        }
    }

    /// Where the parameter of a sample stands.
    fn slot(&self, sample: usize) -> usize {
        (sample - self.base) % self.parameters.len()
    }

    /// Room for the equations.
    pub(super) fn room(&self, chain: &Chain) -> Equations {
        let firsts = self.first_columns(chain);
        let right = vec![0.0; firsts.len()];
        Equations { normal: Skyline::new(firsts), right, chi2: 0.0, strain: 0.0 }
    }

    /// The equations around a chain, which stays as it is; none if they cannot be computed.
    pub(super) fn write(&mut self, chain: &mut Chain, equations: &mut Equations) -> Option<()> {
        equations.clear();
        for k in 0..chain.curves.len() {
            match &Gauge::of(chain, k) {
                Gauge::Line(line) => self.write_curve(chain, k, line, 0, equations)?,
                Gauge::Arc(arc) => self.write_curve(chain, k, arc, 0, equations)?,
                Gauge::Cubic(cubic) => self.write_curve(chain, k, cubic, SEARCHES, equations)?,
            }
        }
        for (point, sample) in self.loose_ends(chain) {
            let off = chain.points[point] - self.track.point(sample % self.track.len());
            for (axis, off) in [off.x, off.y].into_iter().enumerate() {
                equations.strain += END_WEIGHT * off * off;
                equations.add(&[(self.places[point] + axis, 1.0)], off, END_WEIGHT);
            }
        }
        for &(tie, weight) in self.ties {
            if let Some((value, slopes)) = tie.violation(chain, &self.places) {
                equations.strain += weight * value * value;
                equations.add(slopes.entries(), value, weight);
            }
        }
        equations.cost().is_finite().then_some(())
    }

    /// The samples of one curve. They are many, and its numbers few: sums are kept at hand.
    fn write_curve<const N: usize>(
        &mut self,
        chain: &Chain,
        k: usize,
        curve: &impl Held<N>,
        searches: usize,
        equations: &mut Equations,
    ) -> Option<()> {
        let range = samples_of(chain, self.track.len(), k);
        if range.is_empty() {
            return Some(());
        }
        let sharp = [k, chain.next(k)].map(|point| self.is_sharp(chain, point).then(|| chain.points[point]));
        let (first, last) = (self.places[k], self.places[chain.next(k)]);
        let mut places: [usize; N] = core::array::from_fn(|i| if i + 2 < N { first + i } else { last + i + 2 - N });
        // The curve that closes a ring ends at its first point; alone it ends where it starts, and its numbers meet themselves.
        let (closes, is_alone) = (last < first, last == first);
        if closes {
            places.rotate_right(2);
        }
        let (mut normal, mut right) = if is_alone { ([[0.0; N]; N], [0.0; N]) } else { equations.block(&places) };
        let (mut index, mut slot) = (range.start % self.track.len(), self.slot(range.start));
        for number in range.clone() {
            let sample = &self.track.samples[index];
            let mut t = self.parameters[slot];
            if t.is_nan() {
                #[expect(clippy::cast_precision_loss, reason = "counts of samples are small")]
                let share = (number - range.start) as f64 / range.len() as f64;
                t = share;
                for _ in 0..searches {
                    curve.miss(sample, &mut t)?;
                }
            }
            let (misfit, mut slopes) = curve.miss(sample, &mut t)?;
            self.parameters[slot] = t;
            index = if index + 1 < self.track.len() { index + 1 } else { 0 };
            slot = if slot + 1 < self.parameters.len() { slot + 1 } else { 0 };
            let holds = |corner: Option<_>| corner.is_some_and(|corner| sample.holds(corner));
            if number - range.start < BESIDE && holds(sharp[0]) || range.end - number <= BESIDE && holds(sharp[1]) {
                // It tells of both sides, or by chance of this one.
                equations.chi2 += (misfit * misfit).min(spoiled_chi2());
                continue;
            }
            let weight = robust(misfit);
            equations.chi2 += huber(misfit);
            if closes {
                slopes.rotate_right(2);
            } else if is_alone {
                let slopes: [(usize, f64); N] = core::array::from_fn(|i| (places[i], slopes[i]));
                equations.add(&slopes, misfit, weight);
                continue;
            }
            for i in 0..N {
                let weighted = weight * slopes[i];
                for j in 0..=i {
                    normal[i][j] += weighted * slopes[j];
                }
                right[i] -= weighted * misfit;
            }
        }
        if !is_alone {
            equations.set_block(&places, &normal, &right);
        }
        Some(())
    }

    /// Whether the chain has a corner at point `k`.
    fn is_sharp(&self, chain: &Chain, k: usize) -> bool {
        let before = match k {
            0 if chain.closed => chain.curves.len() - 1,
            0 => return false,
            _ => k - 1,
        };
        match (self.directions[before], self.directions.get(k)) {
            (Some([_, arrive]), Some(&Some([leave, _]))) => arrive.dot(leave) < tuning::OUTLINE_SHARP.cos(),
            _ => false,
        }
    }

    /// Points up to which no sample says how far the outline goes, and the last sample before each: the ends of open lines and of lines over
    /// hidden stretches. The outline ends about where the samples do.
    fn loose_ends(&self, chain: &Chain) -> Vec<(usize, usize)> {
        if !chain.closed {
            return [(0, chain.firsts[0]), (chain.points.len() - 1, chain.end - 1)].into();
        }
        let bridges = (0..chain.curves.len()).filter(|&k| samples_of(chain, self.track.len(), k).is_empty());
        bridges.flat_map(|k| [(k, chain.firsts[k] + self.track.len() - 1), (chain.next(k), chain.firsts[k])]).collect()
    }

    /// The first number that each meets, by what curves and ties hold together.
    fn first_columns(&self, chain: &Chain) -> Vec<usize> {
        let places = &self.places;
        let mut firsts: Vec<usize> = (0..places.last().copied().unwrap_or(0)).collect();
        let mut meet = |groups: &[Range<usize>]| {
            let least = groups.iter().map(|group| group.start).min().unwrap_or(0);
            for row in groups.iter().cloned().flatten() {
                firsts[row] = firsts[row].min(least);
            }
        };
        let numbers = |k: usize| {
            let end = places[chain.next(k)];
            [places[k]..places[k + 1], end..end + 2]
        };
        (0..chain.curves.len()).for_each(|k| meet(&numbers(k)));
        for (tie, _) in self.ties {
            let [a, b] = tie.curves(chain);
            meet([numbers(a), numbers(b)].as_flattened());
        }
        firsts
    }
}

impl Equations {
    /// What is minimized.
    pub(super) fn cost(&self) -> f64 {
        self.chi2 + self.strain
    }

    /// The equations of the numbers at some places, rising: the lower triangle, and the right side.
    fn block<const N: usize>(&self, places: &[usize; N]) -> ([[f64; N]; N], [f64; N]) {
        (self.normal.block(places), places.map(|place| self.right[place]))
    }

    /// Puts them back.
    fn set_block<const N: usize>(&mut self, places: &[usize; N], normal: &[[f64; N]; N], right: &[f64; N]) {
        self.normal.set_block(places, normal);
        places.iter().zip(right).for_each(|(&place, &sum)| self.right[place] = sum);
    }

    fn clear(&mut self) {
        self.normal.clear();
        self.right.fill(0.0);
        (self.chi2, self.strain) = (0.0, 0.0);
    }

    fn add(&mut self, slopes: &[(usize, f64)], misfit: f64, weight: f64) {
        self.normal.add_outer(slopes, weight);
        for &(place, slope) in slopes {
            self.right[place] -= weight * slope * misfit;
        }
    }
}

/// Between which samples point `k` may part its curves: at least one stays on either side.
fn limits(chain: &Chain, track: &Track, k: usize) -> (usize, usize) {
    let high = samples_of(chain, track.len(), k).end;
    let low = match k {
        0 => chain.firsts.last().copied().unwrap_or(0).saturating_sub(track.len()),
        _ => chain.firsts[k - 1],
    };
    (low, high)
}
