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

    /// The value and its slopes.
    pub(super) fn violation(self, chain: &Chain, places: &[usize]) -> Option<(f64, Slopes)> {
        let value = self.value(chain)?;
        let mut slopes = Slopes::default();
        let mut moved = chain.clone();
        let [a, b] = self.curves(chain);
        let mut seen: Vec<usize> = Vec::with_capacity(14);
        for k in if a == b { vec![a] } else { vec![a, b] } {
            let end = places[chain.next(k)];
            for (local, place) in (places[k]..places[k + 1]).chain(end..end + 2).enumerate() {
                if seen.contains(&place) {
                    continue;
                }
                seen.push(place);
                let old = *moved.number_mut(k, local)?;
                *moved.number_mut(k, local)? = old + STEP;
                let above = self.value(&moved)?;
                *moved.number_mut(k, local)? = old - STEP;
                let below = self.value(&moved)?;
                *moved.number_mut(k, local)? = old;
                let slope = (above - below) / (2.0 * STEP);
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
        let own = match self.curves.get(k)? {
            Curve::Line => 0,
            Curve::Arc(_) => 1,
            Curve::Cubic(_) => 4,
        };
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

/// Accepts the ties that make the description of a chain shorter, kind by kind.
pub(super) fn tie(fitted: Fitted, track: &Track, ruler: &Ruler) -> Tied {
    let number_bits = fitted.number_bits(ruler);
    let mut tied = Tied { fitted, ties: Vec::new(), number_bits };
    for propose in [axis_ties, smooth_ties, radius_ties] {
        let accepted: Vec<_> = propose(&tied.fitted.chain)
            .into_iter()
            .filter_map(|tie| judge(tie, &tied.fitted, ruler).filter(|verdict| verdict.gain > 0.0))
            .collect();
        if accepted.is_empty() {
            continue;
        }
        let ties: Vec<_> = tied.ties.iter().copied().chain(accepted.iter().map(|verdict| (verdict.tie, verdict.weight))).collect();
        let saved: f64 = accepted.iter().map(|verdict| verdict.price).sum();
        let Some(next) = Fitted::of(tied.fitted.chain.clone(), track, ruler, &ties) else {
            continue;
        };
        // Together they may pull harder than each alone.
        if next.misfit(ruler) - tied.fitted.misfit(ruler) < saved {
            tied = Tied { fitted: next, ties, number_bits: tied.number_bits - saved };
        }
    }
    tied
}

/// What a tie would save and cost.
struct Verdict {
    tie: Tie,
    weight: f64,
    price: f64,
    gain: f64,
}

/// *Source*: the ratio of Savage and Dickey: the density at 0 of what should be 0, after over before the samples were seen.
fn judge(tie: Tie, fitted: &Fitted, ruler: &Ruler) -> Option<Verdict> {
    let places = fitted.chain.places();
    let (value, slopes) = tie.violation(&fitted.chain, &places)?;
    let mut spread = vec![0.0; places.last().copied().unwrap_or(0)];
    slopes.entries().iter().for_each(|&(place, slope)| spread[place] = slope);
    fitted.factor.solve_lower(&mut spread);
    let variance: f64 = spread.iter().map(|x| x * x).sum();
    let price = tie.price(ruler, variance.sqrt());
    let gain = price - ruler.misfit(value * value / variance);
    (variance > 0.0 && gain.is_finite()).then_some(Verdict { tie, weight: HOLD / variance, price, gain })
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

/// Each arc with the first one of about its radius.
fn radius_ties(chain: &Chain) -> Vec<Tie> {
    let radius = |k: usize| chain.radius(k).map(|radius| (k, radius));
    let arcs: Vec<(usize, f64)> = (0..chain.curves.len()).filter_map(radius).collect();
    let near = |a: f64, b: f64| (a - b).abs() < 0.2 * a.abs();
    let twin = |&(k, radius): &(usize, f64)| {
        let first = arcs.iter().find(|&&(other, value)| other < k && near(value, radius))?;
        Some(Tie::EqualRadius { arcs: [first.0, k] })
    };
    arcs.iter().filter_map(twin).collect()
}
