//! All numbers of a chain together, by damped least squares.

use core::ops::Range;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::chain::{Chain, Curve};
use super::equations::{Equations, Problem};
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
/// A chain as the samples want it.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) chain: Chain,
    /// Sum of squared misfits of the samples, each by its variance; beyond [`tuning::OUTLINE_HUBER`] sigmas it grows linearly.
    pub(super) chi2: f64,
    /// Cholesky factor of the inverse covariance of the numbers, ties included.
    pub(super) factor: Skyline,
}

impl Fitted {
    /// The chain of these curves, with `ties` held, that misses the samples least; none if nothing can be computed.
    pub(super) fn of(mut chain: Chain, track: &Track, ruler: &Ruler, ties: &[(Tie, f64)]) -> Option<Self> {
        let mut problem = Problem::new(&chain, track, ties);
        let ridge = ridge(ruler);
        let mut now = problem.room(&chain);
        let (mut then, mut factor) = (now.clone(), now.normal.clone());
        problem.assign(&mut chain);
        problem.write(&mut chain, &mut now)?;
        let (mut change, mut next) = (now.right.clone(), chain.clone());
        let mut damping = 1e-3;
        for _ in 0..MOST_STEPS {
            change.clone_from(&now.right);
            factor.clone_from(&now.normal);
            factor.factorize(damping, ridge + damping * STIFFNESS)?;
            factor.solve(&mut change);
            let promised: f64 = change.iter().zip(&now.right).map(|(change, right)| change * right).sum();
            if promised < LEAST_PROMISE {
                break;
            }
            next.copy(&chain);
            next.shift(&change);
            problem.assign(&mut next);
            let is_better =
                problem.write(&mut next, &mut then).is_some() && then.cost() < now.cost() && is_plain(&next, track);
            if !is_better {
                damping *= 10.0;
                if damping > 1e3 {
                    break;
                }
                continue;
            }
            let gain = now.cost() - then.cost();
            core::mem::swap(&mut now, &mut then);
            core::mem::swap(&mut chain, &mut next);
            damping = (damping * 0.1).max(1e-7);
            if gain < LEAST_GAIN {
                break;
            }
        }
        Self::at(chain, &now, factor, ridge)
    }

    /// A chain as it is, without fitting.
    pub(super) fn as_it_is(mut chain: Chain, track: &Track, ruler: &Ruler) -> Option<Self> {
        let mut problem = Problem::new(&chain, track, &[]);
        let mut equations = problem.room(&chain);
        problem.assign(&mut chain);
        problem.write(&mut chain, &mut equations)?;
        let room = equations.normal.clone();
        Self::at(chain, &equations, room, ridge(ruler))
    }

    /// A chain with its equations, for which there is `room` to factorize them.
    fn at(chain: Chain, equations: &Equations, mut factor: Skyline, ridge: f64) -> Option<Self> {
        // Damping only where rounding makes the equations indefinite.
        [0.0, 1e-9, 1e-6].into_iter().find_map(|damping| {
            factor.clone_from(&equations.normal);
            factor.factorize(damping, ridge)
        })?;
        Some(Self { chain, chi2: equations.chi2, factor })
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

/// What keeps numbers that no sample tells within the picture, 1/px^2.
fn ridge(ruler: &Ruler) -> f64 {
    ruler.extent.max(1.0).powi(-2)
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
pub(super) fn robust(misfit: f64) -> f64 {
    if misfit.abs() <= tuning::OUTLINE_HUBER { 1.0 } else { 1.0 / (misfit.abs() / tuning::OUTLINE_HUBER).max(1.0) }
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
