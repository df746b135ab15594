//! The cheapest path through samples: cut into pieces, then all its numbers together, then what is tied.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::chain::{Chain, Curve};
use super::mend::mend;
use super::nodes::Nodes;
use super::programme::{Kind, Span, cut};
use super::revise::revise;
use super::solve::Fitted;
use super::ties::{Tie, Tied, tie};
use super::track::Track;
use crate::ruler::Ruler;
use crate::tuning;

/// A path and what it costs.
#[derive(Clone, Debug)]
pub(super) struct FittedPath {
    pub(super) ring: PathRing<f64>,
    /// Numbers and structure.
    pub(super) bits: f64,
    /// Bits of the misfit.
    pub(super) misfit: f64,
}

/// How often stretches that are still far off are drawn anew: polygons beside what is bad may pull on what was good.
const MOST_MENDS: usize = 4;

/// A path before its numbers are tied.
pub(super) struct Draft {
    fitted: Fitted,
    /// How many pieces it was cut into.
    pieces: usize,
}

/// The cheapest closed path; the track starts somewhere else afterward.
pub(super) fn draft_ring(track: &mut Track, ruler: &Ruler) -> Option<Draft> {
    let corner = Nodes::sharpest(track);
    track.rotate(corner.unwrap_or(0));
    let mut spans = cut(track, ruler);
    if corner.is_none() && spans.len() > 1 {
        // Nothing says where to start: again from a place where two pieces meet.
        track.rotate(spans[spans.len() / 2].samples.start);
        spans = cut(track, ruler);
    }
    draft(&spans, track, ruler)
}

/// The cheapest open path.
pub(super) fn fit_line(track: &Track, ruler: &Ruler) -> Option<FittedPath> {
    let draft = draft(&cut(track, ruler), track, ruler)?;
    Some(draft.mended(track, ruler).unwrap_or_else(|| draft.finish(track, ruler)))
}

fn draft(spans: &[Span], track: &Track, ruler: &Ruler) -> Option<Draft> {
    let mut chain = chain_of(spans, track)?;
    if chain.closed && super::solve::samples_of(&chain, track.len(), 0).is_empty() {
        // A bridge comes last rather than first: it goes from one curve to the next.
        chain = chain.rotated(track.len());
    }
    let fitted = bridge(Fitted::of(chain, track, ruler, &[])?, track, ruler);
    Some(Draft { fitted: revised(fitted, spans.len(), track, ruler), pieces: spans.len() })
}

impl Draft {
    /// The path.
    pub(super) fn finish(&self, track: &Track, ruler: &Ruler) -> FittedPath {
        finish(tie(self.fitted.clone(), track, ruler), ruler)
    }

    /// The path before it is mended.
    pub(super) fn ring(&self) -> PathRing<f64> {
        ring_of(&self.fitted.chain, &[])
    }

    /// The path with polygons where it would be far off; none if it is not.
    pub(super) fn mended(&self, track: &Track, ruler: &Ruler) -> Option<FittedPath> {
        let mut mended = mend(&self.fitted, track, ruler)?;
        for _ in 1..MOST_MENDS {
            let Some(next) = mend(&mended, track, ruler) else {
                break;
            };
            mended = next;
        }
        let again = revised(mended.clone(), self.pieces, track, ruler);
        let fitted = if mend(&again, track, ruler).is_none() { again } else { mended };
        Some(finish(tie(fitted, track, ruler), ruler))
    }
}

/// The chain with what the programme could not see, if it is shorter; it was cut into `pieces`.
fn revised(fitted: Fitted, pieces: usize, track: &Track, ruler: &Ruler) -> Fitted {
    // Arcs in corners are paid for by their ties, which come last.
    let slack = 2.0 * ruler.number(track.sigma) * super::figure::as_f64(pieces);
    let bits = |fitted: &Fitted| fitted.misfit(ruler) + fitted.number_bits(ruler);
    let better = revise(&fitted.chain, track, ruler).and_then(|chain| Fitted::of(chain, track, ruler, &[]));
    better.filter(|better| bits(better) < bits(&fitted) + slack).unwrap_or(fitted)
}

/// The curves of the pieces, through the samples where they meet. Where the boundary is hidden between two pieces a straight
/// line leads over.
fn chain_of(spans: &[Span], track: &Track) -> Option<Chain> {
    let count = track.len();
    let mut chain =
        Chain { points: Vec::new(), curves: Vec::new(), firsts: Vec::new(), end: 2 * count, closed: track.closed };
    let (first, last) = (spans.first()?, spans.last()?);
    let mut before = track.closed.then_some(last);
    for (k, span) in spans.iter().enumerate() {
        let start = track.point(span.samples.start);
        // Samples count on past the last of the track; those of the piece before the first one come before.
        let first = count + span.samples.start;
        match before.map(|before: &Span| before.samples.end - 1) {
            Some(last) => {
                let counted = if k == 0 { last } else { count + last };
                match (counted + 1..=first).rev().find(|sample| track.hidden[sample % count]) {
                    // Samples that were left out stay on their side of the gap.
                    Some(gap) => {
                        chain.push(track.point(last), Curve::Line, gap);
                        chain.push(start, Curve::Line, gap);
                    }
                    None => chain.push((track.point(last) + start) * 0.5, Curve::Line, first),
                }
            }
            None => chain.push(start, Curve::Line, count),
        }
        let curve = match span.kind {
            Kind::Line => Curve::Line,
            Kind::Cubic([_, a, b, _]) => Curve::Cubic([a, b]),
            Kind::Arc => {
                let middle = track.point(usize::midpoint(span.samples.start, span.samples.end));
                Curve::Arc(bulge_through(start, middle, track.point(span.samples.end - 1)))
            }
        };
        if let Some(place) = chain.curves.last_mut() {
            *place = curve;
        }
        before = Some(span);
    }
    if !track.closed {
        chain.points.push(track.point(count - 1));
    }
    // A ring of one line is no ring.
    (!track.closed || chain.points.len() > 1 || matches!(first.kind, Kind::Cubic(_))).then_some(chain)
}

impl Chain {
    /// A curve from `point` on.
    pub(super) fn push(&mut self, point: Vec2<f64>, curve: Curve, first: usize) {
        self.points.push(point);
        self.curves.push(curve);
        self.firsts.push(first);
    }
}

/// tan(sweep / 4) of the arc between `from` and `to` through `middle`.
pub(super) fn bulge_through(from: Vec2<f64>, middle: Vec2<f64>, to: Vec2<f64>) -> f64 {
    let chord = to - from;
    let q = middle - (from + to) * 0.5;
    let (quarter, cross) = (q.length_squared() - 0.25 * chord.length_squared(), chord.cross(q));
    let bulge = -cross / (quarter.hypot(cross) - quarter);
    if bulge.is_finite() { bulge.clamp(-20.0, 20.0) } else { 0.0 }
}

/// Takes the straight lines over hidden stretches away where the curves beside them meet ahead and not far away.
fn bridge(fitted: Fitted, track: &Track, ruler: &Ruler) -> Fitted {
    let mut fitted = fitted;
    let mut k = 0;
    while k < fitted.chain.curves.len() {
        if let Some(chain) = without_bridge(&fitted.chain, track, k)
            && let Some(next) = Fitted::of(chain, track, ruler, &[])
            && next.misfit(ruler) + next.number_bits(ruler) < fitted.misfit(ruler) + fitted.number_bits(ruler)
        {
            fitted = next;
            continue;
        }
        k += 1;
    }
    fitted
}

/// The chain in which the curves beside curve `k`, along which nothing is seen, meet in a corner; none if they do not.
fn without_bridge(chain: &Chain, track: &Track, k: usize) -> Option<Chain> {
    let count = chain.curves.len();
    let samples = super::solve::samples_of(chain, track.len(), k);
    if !samples.is_empty() || count < 3 || chain.points.len() != count || k == 0 {
        return None;
    }
    let next = chain.next(k);
    let [_, arrive] = chain.directions(k - 1)?;
    let [leave, _] = chain.directions(next)?;
    let gap = chain.points[next] - chain.points[k];
    let sine = arrive.cross(leave);
    let (on, back) = (gap.cross(leave) / sine, gap.cross(arrive) / sine);
    let far = tuning::OUTLINE_BRIDGE * gap.length();
    if !(0.0..far).contains(&on) || !(0.0..far).contains(&-back) {
        return None;
    }
    let mut shorter = chain.clone();
    let corner = chain.points[k] + arrive * on;
    shorter.stretch(k - 1, corner, true);
    shorter.stretch(next, corner, false);
    shorter.points[next] = corner;
    shorter.points.remove(k);
    shorter.curves.remove(k);
    shorter.firsts.remove(k);
    Some(shorter)
}

fn finish(tied: Tied, ruler: &Ruler) -> FittedPath {
    let misfit = tied.fitted.misfit(ruler);
    let ring = ring_of(&tied.fitted.chain, &tied.ties);
    #[expect(clippy::cast_precision_loss, reason = "counts of pieces are small")]
    let pieces = ring.segments.len() as f64;
    FittedPath { ring, bits: tied.number_bits.max(0.0) + tuning::OUTLINE_PIECE_BITS * (pieces + 1.0), misfit }
}

/// The path of a chain; what is tied is exact.
fn ring_of(chain: &Chain, ties: &[(Tie, f64)]) -> PathRing<f64> {
    let mut points: Vec<[f64; 2]> = chain.points.iter().map(|point| point.to_array()).collect();
    for &(tie, _) in ties {
        let (line, axis) = match tie {
            Tie::Horizontal { line } => (line, 1),
            Tie::Vertical { line } => (line, 0),
            Tie::Smooth { .. } | Tie::EqualRadius { .. } => continue,
        };
        let next = chain.next(line);
        let mean = 0.5 * (points[line][axis] + points[next][axis]);
        points[line][axis] = mean;
        points[next][axis] = mean;
    }
    let segment = |curve: &Curve| match *curve {
        Curve::Line => Segment::Line,
        Curve::Arc(bulge) => Segment::Arc { bulge },
        Curve::Cubic(controls) => Segment::Cubic { controls: controls.map(Vec2::to_array) },
    };
    PathRing { points, segments: chain.curves.iter().map(segment).collect() }
}
