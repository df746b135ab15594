//! What the dynamic programme could not see: it cuts between samples and leaves samples at corners out. Here curves are joined,
//! left out and put in at corners, where that makes the description of the stretch shorter.

use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::MOST_BULGE;
use super::chain::{Chain, Curve};
use super::cubic;
use super::figure::as_f64;
use super::gauge::Gauge;
use super::solve::{Fitted, samples_of, spoiled_chi2};
use super::ties::{saved, tie};
use super::track::Track;
use crate::ruler::Ruler;
use crate::tuning;

/// Curves with up to so many samples may be left out.
const SHORT: usize = 10;
/// Samples to both sides of a corner that tell whether it is round.
const BESIDE: usize = 4;
/// Length that a round corner first takes of both sides at least, pixels.
const LEAST_TANGENT: f64 = 1.0;

/// A chain whose stretches are described more shortly; none if there is nothing shorter.
pub(super) fn revise(chain: &Chain, track: &Track, ruler: &Ruler) -> Option<Chain> {
    let reviser = Reviser { track, ruler };
    let mut chain = chain.clone();
    // Stretches overlap, so that what one gains another may lose: each curve is good for one change.
    let most = chain.curves.len();
    let mut changes = 0;
    // Of a ring the start moves on, so that the point to look at is always the second.
    let (mut k, mut left) = (1, chain.curves.len());
    while left > 0 && changes < most && (chain.closed || k < chain.curves.len()) {
        if let Some(better) = reviser.better(&chain, k) {
            // The same place again: there are fewer curves now, or the corner is round and is no corner any more.
            chain = better;
            changes += 1;
            left = (left + 1).min(chain.curves.len());
            continue;
        }
        left -= 1;
        if chain.closed {
            chain = chain.rotated(track.len());
        } else {
            k += 1;
        }
    }
    (changes > 0).then_some(chain)
}

struct Reviser<'a> {
    track: &'a Track,
    ruler: &'a Ruler,
}

impl Reviser<'_> {
    /// The chain with something better around point `k`.
    fn better(&self, chain: &Chain, k: usize) -> Option<Chain> {
        let first = k - 1;
        // A line over a hidden stretch explains nothing, and nothing that is seen explains it.
        let seen =
            (first..chain.curves.len()).take_while(|&k| !samples_of(chain, self.track.len(), k).is_empty()).count();
        if seen == 0 {
            return None;
        }
        let one = chain.part(first, 1, self.track.len());
        if let Some(better) = self.shorter(&one, self.simpler(&one)) {
            return Some(chain.with_part(first, 1, &better));
        }
        if seen >= 2 {
            let pair = chain.part(first, 2, self.track.len());
            if let Some(better) = self.shorter(&pair, self.merged(&pair).into_iter().chain(self.rounded(&pair))) {
                return Some(chain.with_part(first, 2, &better));
            }
        }
        if seen >= 3 && samples_of(chain, self.track.len(), k).len() <= SHORT {
            let three = chain.part(first, 3, self.track.len());
            if let Some(better) =
                self.shorter(&three, self.without_middle(&three).into_iter().chain(bent_middle(&three)))
            {
                return Some(chain.with_part(first, 3, &better));
            }
        }
        None
    }

    /// The one of `others` with the shortest description, if that is shorter than that of `part`.
    fn shorter(&self, part: &Chain, others: impl IntoIterator<Item = Chain>) -> Option<Chain> {
        let mut others = others.into_iter().peekable();
        others.peek()?;
        // As a part of the whole chain it is nearly as its samples want it: others that are no shorter than that are not asked for more.
        let as_it_is = Fitted::as_it_is(part.clone(), self.track, self.ruler)?;
        let untied = as_it_is.misfit(self.ruler) + as_it_is.number_bits(self.ruler) + self.piece_bits(&as_it_is.chain);
        let mut most = untied - tuning::OUTLINE_PIECE_BITS;
        let mut best = None;
        for other in others {
            let fitted = Fitted::of(other, self.track, self.ruler, &[]);
            let Some(fitted) = fitted.filter(|fitted| self.bits(fitted) < most) else { continue };
            let (chain, bits) = self.tied(fitted);
            if bits < most {
                (best, most) = (Some(chain), bits);
            }
        }
        let best = best?;
        let own = Fitted::of(part.clone(), self.track, self.ruler, &[])?;
        (most < self.tied(own).1 - tuning::OUTLINE_PIECE_BITS).then_some(best)
    }

    /// Bits of a chain, were ties to come at no misfit.
    fn bits(&self, fitted: &Fitted) -> f64 {
        let numbers = fitted.number_bits(self.ruler) - saved(fitted, self.ruler);
        fitted.misfit(self.ruler) + numbers + self.piece_bits(&fitted.chain)
    }

    /// A chain with its ties, and its bits.
    fn tied(&self, fitted: Fitted) -> (Chain, f64) {
        let tied = tie(fitted, self.track, self.ruler);
        let bits = tied.fitted.misfit(self.ruler) + tied.number_bits + self.piece_bits(&tied.fitted.chain);
        (tied.fitted.chain, bits)
    }

    /// What a chain costs for its pieces alone.
    fn piece_bits(&self, chain: &Chain) -> f64 {
        tuning::OUTLINE_PIECE_BITS * as_f64(chain.curves.len())
    }

    /// A line or an arc in place of a curve of more numbers.
    fn simpler(&self, one: &Chain) -> Vec<Chain> {
        let range = self.between_corners(one);
        let number = self.ruler.number(self.track.sigma);
        let moments = self.track.moments(range.clone());
        let middle = self.track.point(usize::midpoint(range.start, range.end) % self.track.len());
        let arc = Curve::Arc(super::path::bulge_through(one.points[0], middle, one.points[1]));
        let options = [(Curve::Line, moments.line_chi2()), (arc, moments.circle_chi2())];
        let had = one.curves[0].number_count();
        let worth = options.into_iter().filter(|(curve, chi2)| {
            let saved = number * as_f64(had.saturating_sub(curve.number_count()));
            self.ruler.misfit((chi2 - as_f64(range.len())).max(0.0)) < saved
        });
        worth.map(|(curve, _)| Chain { curves: [curve].into(), ..one.clone() }).collect()
    }

    /// The samples of a part, without those that corners at its outer ends may spoil, if there are many.
    fn between_corners(&self, part: &Chain) -> core::ops::Range<usize> {
        let (first, end, spoiled) = (part.firsts[0], part.end, tuning::OUTLINE_SPOILED);
        let enough = end - first > 4 * spoiled + tuning::OUTLINE_CUBIC_SAMPLES;
        if enough { first + spoiled..end - spoiled } else { first..end }
    }

    /// One curve in place of two.
    fn merged(&self, pair: &Chain) -> Vec<Chain> {
        let range = self.between_corners(pair);
        let [from, joint, to] = [pair.points[0], pair.points[1], pair.points[2]];
        let number = self.ruler.number(self.track.sigma);
        let saved = |curve: Curve| {
            let numbers = 4 + pair.curves.iter().map(|curve| curve.number_count()).sum::<usize>();
            number * as_f64(numbers.saturating_sub(2 + curve.number_count()))
        };
        let one = |curve| Chain {
            points: [from, to].into(),
            curves: [curve].into(),
            firsts: [pair.firsts[0]].into(),
            ..pair.clone()
        };
        let mut options = Vec::new();
        let moments = self.track.moments(range.clone());
        if self.ruler.misfit(moments.line_chi2()) < saved(Curve::Line) {
            options.push(one(Curve::Line));
        }
        let bulge = super::path::bulge_through(from, joint, to);
        if self.ruler.misfit(moments.circle_chi2()) < saved(Curve::Arc(bulge)) && bulge.abs() < MOST_BULGE {
            options.push(one(Curve::Arc(bulge)));
        }
        if range.len() >= tuning::OUTLINE_CUBIC_SAMPLES
            && saved(Curve::Cubic([from, to])) > 0.0
            && let Some(([_, a, b, _], chi2)) = cubic::fit(self.track, range.clone())
            && self.ruler.misfit(chi2) < saved(Curve::Cubic([a, b])) + 2.0 * number
        {
            options.push(one(Curve::Cubic([a, b])));
        }
        options
    }

    /// An arc in place of a corner, if the samples beside it are missed by more than an arc costs.
    fn rounded(&self, pair: &Chain) -> Option<Chain> {
        let ([_, arrive], [leave, _]) = (pair.directions(0)?, pair.directions(1)?);
        let turn = arrive.cross(leave).atan2(arrive.dot(leave));
        let first = pair.firsts[1];
        if turn.abs() < tuning::OUTLINE_SHARP
            || first < pair.firsts[0] + BESIDE
            || pair.end < first + BESIDE
            || self.track.is_hidden(first - 1, first)
        {
            return None;
        }
        let chi2 = |k: usize, range: core::ops::Range<usize>| {
            let samples = range.map(|sample| &self.track.samples[sample % self.track.len()]);
            let gauge = Gauge::of(pair, k);
            let misfits = samples.filter_map(|sample| {
                let misfit = gauge.misfit(sample, if k == 0 { 1.0 } else { 0.0 })?;
                let most = if sample.holds(pair.points[1]) { spoiled_chi2() } else { f64::INFINITY };
                Some((misfit * misfit).min(most))
            });
            misfits.sum::<f64>()
        };
        // An arc that goes on smoothly at both ends has one number.
        let excess = chi2(0, first - BESIDE..first) + chi2(1, first..first + BESIDE);
        if self.ruler.misfit(excess) < self.ruler.number(self.track.sigma) {
            return None;
        }
        let length = |k: usize| (pair.points[k + 1] - pair.points[k]).length();
        let corner = pair.points[1];
        // The samples pass the corner at radius (1 / cos(turn / 2) - 1); the arc takes radius tan(turn / 2) of both sides.
        let around = (first - BESIDE..first + BESIDE).map(|k| self.track.point(k % self.track.len()));
        let pass = around.map(|point| (point - corner).length()).fold(f64::INFINITY, f64::min);
        let (sine, cosine) = (0.5 * turn.abs()).sin_cos();
        let tangent = (pass * sine / (1.0 - cosine)).max(LEAST_TANGENT).min(0.45 * length(0)).min(0.45 * length(1));
        let mut rounded = pair.clone();
        rounded.points[1] = corner - arrive * tangent;
        rounded.points.insert(2, corner + leave * tangent);
        rounded.curves.insert(1, Curve::Arc((0.25 * turn).tan()));
        rounded.firsts[1] = first - 1;
        rounded.firsts.insert(2, first + 1);
        Some(rounded)
    }

    /// Two curves in place of three: the outer ones, to where they meet.
    fn without_middle(&self, three: &Chain) -> Option<Chain> {
        let ([_, arrive], [leave, _]) = (three.directions(0)?, three.directions(2)?);
        let gap = three.points[2] - three.points[1];
        let sine = arrive.cross(leave);
        let on = gap.cross(leave) / sine;
        let middle = three.points[1].lerp(three.points[2], 0.5);
        let meet = three.points[1] + arrive * on;
        let near = sine.abs() > 0.1 && (meet - middle).length() < 2.0 * gap.length();
        let joint = if near { meet } else { middle };
        let mut two = three.clone();
        two.stretch(0, joint, true);
        two.stretch(2, joint, false);
        two.points.remove(1);
        two.points[1] = joint;
        two.curves.remove(1);
        two.firsts[2] = usize::midpoint(two.firsts[1], two.firsts[2]);
        two.firsts.remove(1);
        // It is made better by a fit, but not by that much.
        let misfit = Fitted::as_it_is(two.clone(), self.track, self.ruler)?.misfit(self.ruler);
        (misfit < 20.0 * self.ruler.number(self.track.sigma)).then_some(two)
    }
}

/// An arc in place of a short line that cuts a corner.
fn bent_middle(three: &Chain) -> Option<Chain> {
    let ([_, arrive], [leave, _]) = (three.directions(0)?, three.directions(2)?);
    let turn = arrive.cross(leave).atan2(arrive.dot(leave));
    if three.curves[1] != Curve::Line || turn.abs() < tuning::OUTLINE_SHARP {
        return None;
    }
    let mut bent = three.clone();
    bent.curves[1] = Curve::Arc((0.25 * turn).tan());
    Some(bent)
}

impl Chain {
    /// Draws a cubic out to about `end`, at its finish or its start, on its own course; other curves have no more than their ends.
    pub(super) fn stretch(&mut self, k: usize, end: Vec2<f64>, at_finish: bool) {
        let Some(mut cubic) = self.cubic(k) else {
            return;
        };
        if !at_finish {
            cubic.reverse();
        }
        let [a, b, c, d] = cubic;
        let velocity = (d - c) * 3.0;
        let share = 1.0 + (end - d).dot(velocity) / velocity.length_squared();
        if !(0.5..1.5).contains(&share) {
            return;
        }
        // De Casteljau's construction, on past the end.
        let (ab, bc) = (a.lerp(b, share), b.lerp(c, share));
        let mut controls = [ab, ab.lerp(bc, share)];
        if !at_finish {
            controls.reverse();
        }
        self.curves[k] = Curve::Cubic(controls);
    }

    /// `count` curves from curve `first` on, as a chain of its own.
    fn part(&self, first: usize, count: usize, track_len: usize) -> Self {
        Self {
            points: (first..=first + count).map(|k| self.points[k % self.points.len()]).collect(),
            curves: self.curves[first..first + count].to_vec(),
            firsts: self.firsts[first..first + count].to_vec(),
            end: samples_of(self, track_len, first + count - 1).end,
            closed: false,
        }
    }

    /// This chain with `part` in place of `count` curves from curve `first` on.
    fn with_part(&self, first: usize, count: usize, part: &Self) -> Self {
        let mut next = self.clone();
        next.curves.splice(first..first + count, part.curves.iter().copied());
        next.firsts.splice(first..first + count, part.firsts.iter().copied());
        let own = first..(first + count + 1).min(self.points.len());
        let points = if first + count < self.points.len() { part.points.len() } else { part.curves.len() };
        // Its outer points are better known with what lies beyond.
        let outer = [self.points[first], self.points[(first + count) % self.points.len()]];
        next.points.splice(own, part.points[..points].iter().copied());
        next.points[first] = outer[0];
        if let Some(last) = next.points.get_mut(first + part.curves.len()) {
            *last = outer[1];
        }
        next
    }

    /// The same ring from its second point on.
    pub(super) fn rotated(mut self, track_len: usize) -> Self {
        self.points.rotate_left(1);
        self.curves.rotate_left(1);
        self.firsts.rotate_left(1);
        if let Some(last) = self.firsts.last_mut() {
            *last += track_len;
        }
        if self.firsts[0] >= 2 * track_len {
            self.firsts.iter_mut().for_each(|first| *first -= track_len);
        }
        self
    }
}
