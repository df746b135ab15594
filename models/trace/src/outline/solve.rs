//! All numbers of a chain together, by damped least squares.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::chain::{Chain, Curve};
use super::skyline::Skyline;
use super::ties::Tie;
use super::track::Track;
use crate::ruler::Ruler;
use crate::tuning;

/// Most steps of a fit.
const MOST_STEPS: usize = 15;
/// A step that lowers the sum of squares by less ends the fit.
const LEAST_GAIN: f64 = 0.1;
/// A step that would lower it by less if the outline were straight in its numbers is not tried: a tenth of a sigma of one of them.
const LEAST_PROMISE: f64 = 0.01;
/// What damping adds for its size, 1/px^2: the tip of a narrow ray is hardly held by its sides, and must not be thrown far along them.
const STIFFNESS: f64 = 1e4;
/// How hard ends that nothing else holds are held to the last sample: to half a pixel.
const END_WEIGHT: f64 = 4.0;
/// Squared length of the sum of two directions, of length 1, below which one leads back along the other (168 degrees).
const LEAST_FORWARD: f64 = 0.04;
/// Samples beside a corner that may be moved from one curve to the next at once.
const REACH: usize = 8;

/// A chain as the samples want it.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) chain: Chain,
    /// Sum of squared misfits of the samples, each by its variance; beyond [`tuning::OUTLINE_HUBER`] sigmas it grows linearly.
    pub(super) chi2: f64,
    /// Cholesky factor of the inverse covariance of the numbers, ties included.
    pub(super) factor: Skyline,
}

/// What is minimized.
struct Problem<'a> {
    track: &'a Track,
    ties: &'a [(Tie, f64)],
    /// Of each sample: its parameter on the cubic that explains it.
    parameters: Vec<f64>,
}

/// The state of a chain: its equations.
struct Equations {
    normal: Skyline,
    right: Vec<f64>,
    chi2: f64,
    /// Squared violations of the ties by their weight.
    strain: f64,
}

impl Fitted {
    /// The chain of these curves, with `ties` held, that misses the samples least; none if nothing can be computed.
    pub(super) fn of(mut chain: Chain, track: &Track, ruler: &Ruler, ties: &[(Tie, f64)]) -> Option<Self> {
        let mut problem = Problem { track, ties, parameters: vec![f64::NAN; track.len()] };
        let ridge = ruler.extent.max(1.0).powi(-2);
        problem.assign(&mut chain);
        let mut now = problem.equations(&chain)?;
        let mut damping = 1e-3;
        for _ in 0..MOST_STEPS {
            let mut change = now.right.clone();
            now.normal.factor(damping, ridge + damping * STIFFNESS)?.solve(&mut change);
            let promised: f64 = change.iter().zip(&now.right).map(|(change, right)| change * right).sum();
            if promised < LEAST_PROMISE {
                break;
            }
            let mut next = chain.clone();
            next.shift(&change);
            problem.assign(&mut next);
            let Some(then) = problem.equations(&next).filter(|then| then.cost() < now.cost() && is_plain(&next, track))
            else {
                damping *= 10.0;
                if damping > 1e3 {
                    break;
                }
                continue;
            };
            let gain = now.cost() - then.cost();
            (chain, now, damping) = (next, then, (damping * 0.1).max(1e-7));
            if gain < LEAST_GAIN {
                break;
            }
        }
        // Damping only where rounding makes the equations indefinite.
        let factor = [0.0, 1e-9, 1e-6].into_iter().find_map(|damping| now.normal.factor(damping, ridge))?;
        Some(Self { chain, chi2: now.chi2, factor })
    }

    /// Sum of squared misfits of a chain as it is, without fitting.
    pub(super) fn chi2_of(mut chain: Chain, track: &Track) -> Option<f64> {
        let mut problem = Problem { track, ties: &[], parameters: vec![f64::NAN; track.len()] };
        problem.assign(&mut chain);
        Some(problem.equations(&chain)?.chi2)
    }

    /// Bits of the misfit.
    pub(super) fn misfit(&self, ruler: &Ruler) -> f64 {
        ruler.misfit(self.chi2)
    }

    /// Bits of the numbers, each given those after it: half the logarithm of the determinant of the inverse covariance.
    pub(super) fn number_bits(&self, ruler: &Ruler) -> f64 {
        let chain = &self.chain;
        let mut bits = 0.0;
        let mut diagonal = self.factor.diagonal();
        for k in 0..chain.points.len() {
            let mut price = |lever: f64| diagonal.next().map_or(0.0, |root| ruler.number(lever / root));
            bits += price(1.0) + price(1.0);
            match chain.curves.get(k) {
                Some(Curve::Arc(_)) => {
                    let chord = chain.points[chain.next(k)] - chain.points[k];
                    bits += price(0.5 * chord.length());
                }
                Some(Curve::Cubic(_)) => bits += (0..4).map(|_| price(1.0)).sum::<f64>(),
                Some(Curve::Line) | None => {}
            }
        }
        bits
    }
}

impl Equations {
    fn cost(&self) -> f64 {
        self.chi2 + self.strain
    }
}

impl Problem<'_> {
    /// Gives samples beside points to the curve on whose side of the point they lie.
    fn assign(&mut self, chain: &mut Chain) {
        let count = chain.curves.len();
        for k in usize::from(!chain.closed)..count {
            let before = if k == 0 { count - 1 } else { k - 1 };
            let (Some([_, arrive]), Some([leave, _])) = (chain.directions(before), chain.directions(k)) else {
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
                self.parameters[sample % self.track.len()] = f64::NAN;
            }
            chain.firsts[k] = first;
        }
    }

    fn equations(&mut self, chain: &Chain) -> Option<Equations> {
        let places = chain.places();
        let count = places.last().copied().unwrap_or(0);
        let mut equations = Equations {
            normal: Skyline::new(self.first_columns(chain, &places)),
            right: vec![0.0; count],
            chi2: 0.0,
            strain: 0.0,
        };
        for k in 0..chain.curves.len() {
            let range = samples_of(chain, self.track.len(), k);
            let sharp = [k, chain.next(k)].map(|point| is_sharp(chain, point).then_some(point));
            for sample_number in range.clone() {
                let index = sample_number % self.track.len();
                let sample = &self.track.samples[index];
                let at_ends = [sample_number - range.start < 4, range.end - sample_number <= 4];
                let mut near = sharp.iter().zip(at_ends).filter_map(|(&point, near)| point.filter(|_| near));
                let t = &mut self.parameters[index];
                if t.is_nan() {
                    #[expect(clippy::cast_precision_loss, reason = "counts of samples are small")]
                    let share = (sample_number - range.start) as f64 / range.len() as f64;
                    *t = share;
                    // Lines and arcs know the nearest place at once.
                    let searches = if matches!(chain.curves[k], Curve::Cubic(_)) { 4 } else { 0 };
                    for _ in 0..searches {
                        chain.misfit(k, sample, &places, t)?;
                    }
                }
                let (misfit, slopes) = chain.misfit(k, sample, &places, t)?;
                if near.any(|point| sample.holds(chain.points[point])) {
                    // It tells of both sides, or by chance of this one.
                    equations.chi2 += (misfit * misfit).min(spoiled_chi2());
                    continue;
                }
                let weight = robust(misfit);
                equations.chi2 += huber(misfit);
                equations.add(slopes.entries(), misfit, weight);
            }
        }
        for (point, sample) in self.loose_ends(chain) {
            let off = chain.points[point] - self.track.point(sample % self.track.len());
            for (axis, off) in [off.x, off.y].into_iter().enumerate() {
                equations.strain += END_WEIGHT * off * off;
                equations.add(&[(places[point] + axis, 1.0)], off, END_WEIGHT);
            }
        }
        for &(tie, weight) in self.ties {
            if let Some((value, slopes)) = tie.violation(chain, &places) {
                equations.strain += weight * value * value;
                equations.add(slopes.entries(), value, weight);
            }
        }
        equations.cost().is_finite().then_some(equations)
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
    fn first_columns(&self, chain: &Chain, places: &[usize]) -> Vec<usize> {
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
    fn add(&mut self, slopes: &[(usize, f64)], misfit: f64, weight: f64) {
        self.normal.add_outer(slopes, weight);
        for &(place, slope) in slopes {
            self.right[place] -= weight * slope * misfit;
        }
    }
}

/// Whether each curve is about as long as the walk along its samples: no loop, no spike.
fn is_plain(chain: &Chain, track: &Track) -> bool {
    (0..chain.curves.len()).all(|k| {
        let range = samples_of(chain, track.len(), k);
        if range.is_empty() || track.is_hidden(range.start + track.len() - 1, range.end + track.len()) {
            return true;
        }
        let [from, to] = [k, chain.next(k)].map(|point| chain.points[point]);
        let chord = (to - from).length();
        let length = match chain.curves[k] {
            Curve::Line => chord,
            Curve::Arc(bulge) if bulge.abs() < 1e-6 => chord,
            Curve::Arc(bulge) => chord * bulge.abs().atan() * (1.0 + bulge * bulge) / bulge.abs(),
            // The control polygon is longer than the curve.
            Curve::Cubic([a, b]) => 0.7 * ((a - from).length() + (b - a).length() + (to - b).length()),
        };
        length < 1.1 * track.length(&range) + tuning::OUTLINE_SLACK
    })
}

/// The weight of a misfit, in sigmas: beyond [`tuning::OUTLINE_HUBER`] it counts linearly.
fn robust(misfit: f64) -> f64 {
    1.0 / (misfit.abs() / tuning::OUTLINE_HUBER).max(1.0)
}

/// What a misfit, in sigmas, counts in a sum of squares.
pub(super) fn huber(misfit: f64) -> f64 {
    let weight = robust(misfit);
    misfit * misfit * weight * (2.0 - weight)
}

/// What a sample counts whose window holds a corner, at most: half of what leaving out a sample costs where no corner is known
/// yet, so that sharp corners stay sharp.
pub(super) fn spoiled_chi2() -> f64 {
    tuning::OUTLINE_SPOILED_BITS * core::f64::consts::LN_2
}

/// Samples of curve `k`, counted on past the last of the track.
pub(super) fn samples_of(chain: &Chain, track_len: usize, k: usize) -> Range<usize> {
    let end = match chain.firsts.get(k + 1) {
        Some(&end) => end,
        None if chain.closed => chain.firsts[0] + track_len,
        None => chain.end,
    };
    chain.firsts[k]..end
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

/// Whether the chain has a corner at point `k`.
fn is_sharp(chain: &Chain, k: usize) -> bool {
    let before = match k {
        0 if chain.closed => chain.curves.len() - 1,
        0 => return false,
        _ => k - 1,
    };
    if k >= chain.curves.len() {
        return false;
    }
    match (chain.directions(before), chain.directions(k)) {
        (Some([_, arrive]), Some([leave, _])) => arrive.dot(leave) < tuning::OUTLINE_SHARP.cos(),
        _ => false,
    }
}
