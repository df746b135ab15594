//! Stretches that a chain is far off: fitted again as polygons through their samples.
//!
//! The dynamic programme prices pieces as lines and circles without ends. Where such pieces do not meet (the sides of a thin bar, of a
//! ray narrower than its windows) the chain goes astray; there corners at the samples themselves are the description left.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::Vec2;

use super::chain::{Chain, Curve};
use super::gauge::Gauge;
use super::solve::{Fitted, huber, samples_of, spoiled_chi2};
use super::track::Track;
use crate::ruler::Ruler;
use crate::tuning;

/// Samples in a row that tell whether a stretch is off.
const STRETCH: usize = 6;
/// How far samples may lie beyond the ends of their curve, pixels: in windows beside corners.
const BEYOND: f64 = 1.5;
/// Corners of the polygon may be this far from the ends of the curves beside it, pixels.
const NEAR: f64 = 2.0;

/// The chain with polygons where it was far off; none if it was not, or they are no shorter.
pub(super) fn mend(fitted: &Fitted, track: &Track, ruler: &Ruler) -> Option<Fitted> {
    let off = misfits(&fitted.chain, track, ruler);
    // Two lines between two points enclose nothing.
    let is_flat = |chain: &Chain| {
        chain.closed
            && chain.curves.len() <= 2
            && (0..chain.curves.len())
                .all(|k| chain.curves[k] == Curve::Line && !samples_of(chain, track.len(), k).is_empty())
    };
    let mut bad = bad_curves(&fitted.chain, &off, track.len());
    if is_flat(&fitted.chain) {
        bad.fill(true);
    }
    if !bad.contains(&true) {
        return None;
    }
    let bits = |fitted: &Fitted, off: &[f64]| off.iter().sum::<f64>() + fitted.number_bits(ruler);
    // Polygons beside curves that pull on them may do no better: then all around.
    [bad, vec![true; fitted.chain.curves.len()]].iter().find_map(|bad| {
        let mended = Fitted::of(with_polygons(fitted.chain.clone(), bad, track)?, track, ruler, &[])?;
        let is_shorter = || bits(&mended, &misfits(&mended.chain, track, ruler)) < bits(fitted, &off);
        (is_flat(&fitted.chain) && !is_flat(&mended.chain) || is_shorter()).then_some(mended)
    })
}

/// Bits of what the chain misses each sample by; unlike lines and circles its curves have ends.
fn misfits(chain: &Chain, track: &Track, ruler: &Ruler) -> Vec<f64> {
    let mut off = vec![0.0; track.len()];
    for k in 0..chain.curves.len() {
        let range = samples_of(chain, track.len(), k);
        let ends = [k, chain.next(k)].map(|point| chain.points[point]);
        let directions = chain.directions(k);
        let gauge = Gauge::of(chain, k);
        for number in range.clone() {
            let index = number % track.len();
            let sample = &track.samples[index];
            #[expect(clippy::cast_precision_loss, reason = "counts of samples are small")]
            let t = (number - range.start) as f64 / range.len() as f64;
            let misfit = gauge.misfit(sample, t);
            let beyond = directions.map_or(0.0, |[leave, arrive]| {
                let [before, behind] = ends.map(|end| sample.point - end);
                let is_first = before.length_squared() < behind.length_squared();
                if is_first { -before.dot(leave) } else { behind.dot(arrive) }
            });
            let beyond = (beyond - BEYOND).max(0.0) / sample.sigma;
            let mut chi2 = misfit.map_or(f64::INFINITY, huber) + huber(beyond);
            if ends.iter().any(|&end| sample.holds(end)) {
                chi2 = chi2.min(spoiled_chi2());
            }
            off[index] = ruler.misfit(chi2);
        }
    }
    off
}

/// The curves that are far off a stretch of their samples.
fn bad_curves(chain: &Chain, off: &[f64], count: usize) -> Vec<bool> {
    let is_bad = |k: usize| {
        let range = samples_of(chain, count, k);
        let length = range.len().min(STRETCH);
        let sum = |first: usize| (first..first + length).map(|number| off[number % count]).sum::<f64>();
        #[expect(clippy::cast_precision_loss, reason = "a few samples")]
        let most = tuning::OUTLINE_MOST_MISFIT * length as f64;
        length > 0 && (range.start..=range.end - length).any(|first| sum(first) > most)
    };
    (0..chain.curves.len()).map(is_bad).collect()
}

/// The chain with the polygon through the samples in place of bad curves; none if nothing is left that can be drawn.
fn with_polygons(mut chain: Chain, bad: &[bool], track: &Track) -> Option<Chain> {
    let mut bad = bad.to_vec();
    if chain.closed {
        // A row of bad curves that goes on past the start begins there; of curves that are all bad the ring has one corner at least.
        let start = bad.iter().position(|&bad| !bad).unwrap_or(0);
        for _ in 0..start {
            chain = chain.rotated(track.len());
        }
        bad.rotate_left(start);
    }
    let mut next = Chain { points: Vec::new(), curves: Vec::new(), firsts: Vec::new(), ..chain.clone() };
    let mut k = 0;
    while k < chain.curves.len() {
        let row = bad[k..].iter().take_while(|&&bad| bad).count();
        let first = chain.firsts[k];
        if row == 0 {
            next.push(chain.points[k], chain.curves[k], first);
            k += 1;
            continue;
        }
        let range = first..samples_of(&chain, track.len(), k + row - 1).end;
        let corners = polygon(track, range.clone());
        let near = |point: Vec2<f64>, sample: usize| {
            let seen = track.point(sample % track.len());
            if (seen - point).length() < NEAR { point } else { seen }
        };
        next.push(near(chain.points[k], range.start), Curve::Line, first);
        for &corner in corners.iter().filter(|&&corner| corner > range.start && corner + 1 < range.end) {
            next.push(track.point(corner % track.len()), Curve::Line, corner);
        }
        k += row;
        let end = if k < chain.points.len() { k } else { 0 };
        let point = near(chain.points[end], range.end - 1);
        if end > 0 {
            chain.points[end] = point;
        } else if chain.closed && row < chain.curves.len() {
            next.points[0] = point;
        } else if chain.closed {
            // All around: the last sample is a corner too.
            next.push(track.point((range.end - 1) % track.len()), Curve::Line, range.end - 1);
        }
    }
    if !chain.closed {
        next.points.push(*chain.points.last()?);
    }
    (!chain.closed || next.points.len() > 2).then_some(next)
}

/// Samples of `range` such that the straight lines between them pass all others within what their doubt explains, rising.
fn polygon(track: &Track, range: Range<usize>) -> Vec<usize> {
    let mut kept = vec![range.start, range.end - 1];
    let mut open = vec![(range.start, range.end - 1)];
    while let Some((first, last)) = open.pop() {
        let [from, to] = [first, last].map(|k| track.point(k % track.len()));
        let chord = to - from;
        let length = chord.length();
        let distance = |k: usize| {
            let offset = track.point(k % track.len()) - from;
            let distance = if length > 0.0 { chord.cross(offset).abs() / length } else { offset.length() };
            distance / track.samples[k % track.len()].sigma
        };
        let farthest = (first + 1..last).map(|k| (distance(k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, middle)) = farthest.filter(|&(gap, _)| gap > tuning::OUTLINE_HUBER) {
            kept.push(middle);
            open.extend([(first, middle), (middle, last)]);
        }
    }
    kept.sort_unstable();
    kept
}
