//! What artists keep exact: lines along the axes, joins without a corner, equal radii. A tie is accepted if the description gets
//! shorter; its number need not be told any more.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::chain::{Chain, Curve, Slopes};
use super::solve::Fitted;
use super::track::Track;
use crate::ruler::Ruler;

/// An equation between numbers of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tie {
    /// The ends of a line have the same y.
    Horizontal { line: usize },
    /// The ends of a line have the same x.
    Vertical { line: usize },
    /// No corner where this curve leaves the one before it.
    Smooth { curve: usize },
    /// Two arcs of one radius.
    EqualRadius { arcs: [usize; 2] },
}

/// A chain and the ties that hold in it.
#[derive(Clone, Debug)]
pub(super) struct Tied {
    pub(super) fitted: Fitted,
    /// Each with the weight that holds it.
    pub(super) ties: Vec<(Tie, f64)>,
    /// What the chain costs: numbers that are not tied.
    pub(super) number_bits: f64,
}

/// Step of central differences, pixels.
const STEP: f64 = 1e-5;
/// Share of a direction that is nothing but rounding.
const FADED: f64 = 1e-12;
/// How much harder a tie is held than the samples hold its number.
const HOLD: f64 = 1e6;

impl Tie {
    /// The curves whose numbers it ties.
    pub(super) fn curves(self, chain: &Chain) -> [usize; 2] {
        match self {
            Self::Horizontal { line } | Self::Vertical { line } => [line; 2],
            Self::Smooth { curve } => [if curve == 0 { chain.curves.len() - 1 } else { curve - 1 }, curve],
            Self::EqualRadius { arcs } => arcs,
        }
    }

    /// What should be 0: pixels, of a join radians.
    fn value(self, chain: &Chain) -> Option<f64> {
        let chord = |k: usize| chain.points[chain.next(k)] - chain.points[k];
        match self {
            Self::Horizontal { line } => Some(chord(line).y),
            Self::Vertical { line } => Some(chord(line).x),
            Self::Smooth { .. } => {
                let [before, after] = self.curves(chain);
                let ([_, arrive], [leave, _]) = (chain.directions(before)?, chain.directions(after)?);
                Some(arrive.cross(leave).atan2(arrive.dot(leave)))
            }
            Self::EqualRadius { arcs: [a, b] } => Some(chain.radius(a)? - chain.radius(b)?),
        }
    }

    /// The value and its slopes; the chain is moved for them and back again.
    pub(super) fn violation(self, moved: &mut Chain, places: &[usize]) -> Option<(f64, Slopes)> {
        let value = self.value(moved)?;
        let mut slopes = Slopes::default();
        let both = self.curves(moved);
        let mut seen: Vec<usize> = Vec::with_capacity(14);
        for &k in if both[0] == both[1] { &both[..1] } else { &both[..] } {
            let end = places[moved.next(k)];
            for (local, place) in (places[k]..places[k + 1]).chain(end..end + 2).enumerate() {
                if seen.contains(&place) {
                    continue;
                }
                seen.push(place);
                let old = *moved.number_mut(k, local)?;
                *moved.number_mut(k, local)? = old + STEP;
                let above = self.value(moved);
                *moved.number_mut(k, local)? = old - STEP;
                let below = self.value(moved);
                *moved.number_mut(k, local)? = old;
                let slope = (above? - below?) / (2.0 * STEP);
                if slope.abs() > 0.0 {
                    slopes.push(place, slope);
                }
            }
        }
        Some((value, slopes))
    }

    /// Bits that knowing its value to `sigma` costs.
    fn price(self, ruler: &Ruler, sigma: f64) -> f64 {
        match self {
            // A direction to sigma: as a length on a circle whose half circumference is the picture.
            Self::Smooth { .. } => ruler.number(sigma * ruler.extent / core::f64::consts::PI),
            _ => ruler.number(sigma),
        }
    }
}

impl Chain {
    /// Radius of curve `k` if it is an arc, positive where it turns from +x to +y.
    pub(super) fn radius(&self, k: usize) -> Option<f64> {
        let Curve::Arc(bulge) = *self.curves.get(k)? else {
            return None;
        };
        let chord = (self.points[self.next(k)] - self.points[k]).length();
        (bulge.abs() > 0.0).then(|| chord * (1.0 + bulge * bulge) / (4.0 * bulge))
    }

    /// A number of curve `k`: its start, what else it has, its end.
    fn number_mut(&mut self, k: usize, local: usize) -> Option<&mut f64> {
        fn coordinate(point: &mut Vec2<f64>, axis: usize) -> &mut f64 {
            if axis == 0 { &mut point.x } else { &mut point.y }
        }
        let next = self.next(k);
        let own = self.curves.get(k)?.number_count();
        if local < 2 {
            return self.points.get_mut(k).map(|point| coordinate(point, local));
        }
        if local >= 2 + own {
            return self.points.get_mut(next).map(|point| coordinate(point, local - 2 - own));
        }
        match self.curves.get_mut(k)? {
            Curve::Line => None,
            Curve::Arc(bulge) => Some(bulge),
            Curve::Cubic(controls) => controls.get_mut((local - 2) / 2).map(|point| coordinate(point, local % 2)),
        }
    }
}

/// Accepts the ties that make the description of a chain shorter.
pub(super) fn tie(fitted: Fitted, track: &Track, ruler: &Ruler) -> Tied {
    let number_bits = fitted.number_bits(ruler);
    let accepted = accepted(&fitted, ruler);
    // All of them or, if together they pull harder than expected, those along the axes alone.
    let plain = |verdict: &&Verdict| matches!(verdict.tie, Tie::Horizontal { .. } | Tie::Vertical { .. });
    let sets = [accepted.iter().collect::<Vec<_>>(), accepted.iter().filter(plain).collect()];
    for set in sets.into_iter().filter(|set| !set.is_empty()) {
        let ties: Vec<_> = set.iter().map(|verdict| (verdict.tie, verdict.weight)).collect();
        let saved: f64 = set.iter().map(|verdict| verdict.price).sum();
        if let Some(next) = Fitted::of(fitted.chain.clone(), track, ruler, &ties)
            && next.misfit(ruler) - fitted.misfit(ruler) < saved
        {
            return Tied { fitted: next, ties, number_bits: number_bits - saved };
        }
    }
    Tied { fitted, ties: Vec::new(), number_bits }
}

/// Bits of the numbers that ties spare, were all of them to hold together.
pub(super) fn saved(fitted: &Fitted, ruler: &Ruler) -> f64 {
    accepted(fitted, ruler).iter().map(|verdict| verdict.price).sum()
}

/// The ties that each shorten the description, given those before.
fn accepted(fitted: &Fitted, ruler: &Ruler) -> Vec<Verdict> {
    let chain = &fitted.chain;
    let mut judge = Judge { fitted, ruler, places: chain.places(), moved: chain.clone(), held: Vec::new() };
    let proposed = [axis_ties, smooth_ties, radius_ties].into_iter().flat_map(|propose| propose(chain));
    proposed.filter_map(|tie| judge.verdict(tie)).collect()
}

/// A tie that is accepted.
struct Verdict {
    tie: Tie,
    weight: f64,
    /// Bits that it saves.
    price: f64,
}

/// What ties do to a Gaussian of all numbers, tie after tie.
struct Judge<'a> {
    fitted: &'a Fitted,
    ruler: &'a Ruler,
    places: Vec<usize>,
    /// Room to move the chain in.
    moved: Chain,
    held: Vec<Direction>,
}

/// Of a tie that is accepted: its direction among all numbers in units of their doubt, at right angles to those before and of length 1.
struct Direction {
    /// The first number in it, and the parts along this and those after it, up to the last that counts.
    first: usize,
    parts: Vec<f64>,
    /// By how much the tie is violated along it.
    violation: f64,
}

impl Judge<'_> {
    /// *Source*: the ratio of Savage and Dickey: the density at 0 of what should be 0, after over before the samples were seen.
    fn verdict(&mut self, tie: Tie) -> Option<Verdict> {
        let (mut value, slopes) = tie.violation(&mut self.moved, &self.places)?;
        let mut direction = vec![0.0; self.places.last().copied().unwrap_or(0)];
        slopes.entries().iter().for_each(|&(place, slope)| direction[place] = slope);
        self.fitted.factor.solve_lower(&mut direction);
        let free: f64 = direction.iter().map(|x| x * x).sum();
        for Direction { first, parts, violation } in &self.held {
            let own = &mut direction[*first..];
            let share: f64 = own.iter().zip(parts).map(|(a, b)| a * b).sum();
            own.iter_mut().zip(parts).for_each(|(a, b)| *a -= share * b);
            value -= share * violation;
        }
        let variance: f64 = direction.iter().map(|x| x * x).sum();
        if variance.is_nan() || variance <= free * 1e-2 {
            // The ties before hold this number already.
            return None;
        }
        let sigma = variance.sqrt();
        let price = tie.price(self.ruler, sigma);
        let misfit = self.ruler.misfit(value * value / variance);
        if misfit.is_nan() || misfit >= price {
            return None;
        }
        // What a tie says of numbers further on fades away.
        let counts = |x: &f64| x.abs() > FADED * sigma;
        let first = direction.iter().position(counts).unwrap_or(0);
        let end = direction.iter().rposition(counts).map_or(first, |last| last + 1);
        let parts = direction[first..end].iter().map(|x| x / sigma).collect();
        self.held.push(Direction { first, parts, violation: value / sigma });
        Some(Verdict { tie, weight: HOLD / variance, price })
    }
}

fn axis_ties(chain: &Chain) -> Vec<Tie> {
    let lines = (0..chain.curves.len()).filter(|&k| chain.curves[k] == Curve::Line);
    lines
        .map(|line| {
            let chord = chain.points[chain.next(line)] - chain.points[line];
            if chord.x.abs() > chord.y.abs() { Tie::Horizontal { line } } else { Tie::Vertical { line } }
        })
        .collect()
}

fn smooth_ties(chain: &Chain) -> Vec<Tie> {
    let joins = usize::from(!chain.closed)..chain.curves.len();
    joins
        .map(|curve| Tie::Smooth { curve })
        .filter(|tie| tie.curves(chain).iter().any(|&k| chain.curves[k] != Curve::Line))
        .filter(|tie| tie.value(chain).is_some_and(|angle| angle.abs() < 0.5))
        .collect()
}

/// Each arc with the last one before it of about its radius: nearer numbers meet in fewer equations.
fn radius_ties(chain: &Chain) -> Vec<Tie> {
    let radius = |k: usize| chain.radius(k).map(|radius| (k, radius));
    let arcs: Vec<(usize, f64)> = (0..chain.curves.len()).filter_map(radius).collect();
    let near = |a: f64, b: f64| (a - b).abs() < 0.2 * a.abs();
    let twin = |&(k, radius): &(usize, f64)| {
        // Arcs that join smoothly have one radius if they are one arc.
        let apart = |other: usize| chain.next(other) != k && chain.next(k) != other;
        let last = arcs.iter().rev().find(|&&(other, value)| other < k && apart(other) && near(value, radius))?;
        Some(Tie::EqualRadius { arcs: [last.0, k] })
    };
    arcs.iter().filter_map(twin).collect()
}
