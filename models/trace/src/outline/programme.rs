//! The cheapest way to cut a track into lines, arcs and cubics: a dynamic programme over the places where they may meet.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::Vec2;

use super::cubic;
use super::moments::Moments;
use super::nodes::Nodes;
use super::track::Track;
use crate::ruler::Ruler;
use crate::sample::Sample;
use crate::tuning;

/// What leaving out a sample costs, bits, that nothing can have spoiled: more than any piece.
const EXACT_BITS: f64 = 1e3;

/// What explains a stretch of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Line,
    Arc,
    Cubic([Vec2<f64>; 4]),
}

/// A stretch of samples and what explains them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) samples: Range<usize>,
    pub(super) kind: Kind,
}

/// The cheapest way to have everything before a place explained, a piece ending there.
#[derive(Clone, Copy, Debug)]
struct Best {
    bits: f64,
    /// Node at which the last piece starts.
    from: usize,
    kind: Kind,
}

/// What pieces cost, bits.
#[derive(Clone, Copy, Debug)]
struct Prices {
    line: f64,
    arc: f64,
    cubic: f64,
}

/// The cheapest row of pieces; empty if there is none.
pub(super) fn cut(track: &Track, ruler: &Ruler) -> Vec<Span> {
    let nodes = Nodes::of(track);
    let number = ruler.number(track.sigma);
    let prices = [2.0, 3.0, 6.0].map(|numbers| numbers * number + tuning::OUTLINE_PIECE_BITS);
    let [line, arc, cubic] = prices;
    Programme::new(track, ruler, &nodes, Prices { line, arc, cubic }).run()
}

struct Programme<'a> {
    track: &'a Track,
    ruler: &'a Ruler,
    nodes: &'a Nodes,
    prices: Prices,
    /// Of each node: pieces up to it.
    ends: Vec<Best>,
    /// Of each node: the bits up to it, and the node at which the last piece before it ends; samples between are left out.
    starts: Vec<(f64, usize)>,
    /// Of each node: the last sample before it up to which no piece from further back leads.
    folds: Vec<usize>,
    /// Of each node: what the last cubic tried from it missed by, bits: longer ones miss by more.
    floors: Vec<f64>,
}

impl<'a> Programme<'a> {
    fn new(track: &'a Track, ruler: &'a Ruler, nodes: &'a Nodes, prices: Prices) -> Self {
        let count = nodes.places.len();
        let mut fold = 0;
        let folds = (0..count).map(|node| {
            let from = nodes.places[node.max(1) - 1];
            fold = (from..nodes.places[node]).rev().find(|&k| track.folds(k)).unwrap_or(fold);
            fold
        });
        let none = Best { bits: f64::INFINITY, from: 0, kind: Kind::Line };
        Self {
            track,
            ruler,
            nodes,
            prices,
            ends: vec![none; count],
            starts: vec![(f64::INFINITY, 0); count],
            folds: folds.collect(),
            floors: vec![0.0; count],
        }
    }

    fn run(mut self) -> Vec<Span> {
        let count = self.nodes.places.len();
        for node in 0..count {
            self.try_cubics(node);
            self.starts[node] = self.start(node);
            self.extend(node);
        }
        let (_, last) = self.start(count - 1);
        self.trace_back(last)
    }

    /// Bits up to `node`, and the node at which the piece before it ends: corners spoil up to two samples beside them.
    fn start(&self, node: usize) -> (f64, usize) {
        let place = self.nodes.places[node];
        if place <= tuning::OUTLINE_SPOILED {
            return (self.bits_left_out(0..place), 0);
        }
        let near = (0..=node).rev().take_while(|&other| place - self.nodes.places[other] <= tuning::OUTLINE_SPOILED);
        let options =
            near.map(|other| (self.ends[other].bits + self.bits_left_out(self.nodes.places[other]..place), other));
        options.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, node))
    }

    /// Lines and arcs from `node` on.
    fn extend(&mut self, node: usize) {
        let (before, _) = self.starts[node];
        let first = self.nodes.places[node];
        if !before.is_finite() || first >= self.track.len() {
            return;
        }
        let origin = self.track.point(first);
        let (mut moments, mut done) = (Moments::default(), first);
        // A circle is not a piece: two of its arcs are.
        let most = if self.track.closed { self.track.len() * 3 / 4 } else { self.track.len() };
        for end in node + 1..self.nodes.places.len() {
            let place = self.nodes.places[end];
            if first < self.folds[end] {
                break;
            }
            while done < place {
                moments.add(self.track.point(done) - origin, self.track.weights[done]);
                done += 1;
            }
            if place - first < 2 {
                continue;
            }
            let line = self.prices.line + self.ruler.misfit(moments.line_chi2());
            self.offer(end, Best { bits: before + line, from: node, kind: Kind::Line });
            if line < self.prices.arc || place - first < 4 {
                continue;
            }
            let misfit = self.ruler.misfit(moments.circle_chi2());
            if place - first <= most {
                self.offer(end, Best { bits: before + self.prices.arc + misfit, from: node, kind: Kind::Arc });
            }
            if misfit > 4.0 * self.prices.arc {
                break;
            }
        }
    }

    /// Cubics that end at `node`, where they may be cheaper than what is known.
    fn try_cubics(&mut self, node: usize) {
        let place = self.nodes.places[node];
        if !self.nodes.cubic[node] {
            return;
        }
        let (mut floor, mut corner) = (0.0_f64, 0);
        for from in (0..node).rev() {
            let (before, first) = (self.starts[from].0, self.nodes.places[from]);
            if corner > first + 2 || first < self.folds[node] {
                break;
            }
            if self.nodes.turns[from] > tuning::OUTLINE_SHARP && first + 2 < place {
                corner = first;
            }
            // What contains a stretch that a cubic missed misses more.
            floor = floor.max(self.floors[from]);
            if !self.nodes.cubic[from]
                || place - first < tuning::OUTLINE_CUBIC_SAMPLES
                || before + self.prices.cubic + floor >= self.ends[node].bits
            {
                continue;
            }
            let Some((cubic, chi2)) = cubic::fit(self.track, first..place) else {
                continue;
            };
            let misfit = self.ruler.misfit(chi2);
            self.floors[from] = self.floors[from].max(0.7 * misfit);
            self.offer(node, Best { bits: before + self.prices.cubic + misfit, from, kind: Kind::Cubic(cubic) });
        }
    }

    /// Bits of samples that nothing explains: beside a corner, which no window holds along which the boundary is exact.
    fn bits_left_out(&self, samples: Range<usize>) -> f64 {
        let bits = |sample: &Sample| if sample.is_exact { EXACT_BITS } else { tuning::OUTLINE_SPOILED_BITS };
        self.track.samples[samples].iter().map(bits).sum()
    }

    fn offer(&mut self, node: usize, best: Best) {
        if best.bits < self.ends[node].bits {
            self.ends[node] = best;
        }
    }

    fn trace_back(&self, last: usize) -> Vec<Span> {
        let mut spans = Vec::new();
        let mut end = last;
        while self.nodes.places[end] > tuning::OUTLINE_SPOILED && self.ends[end].bits.is_finite() {
            let Best { from, kind, .. } = self.ends[end];
            spans.push(Span { samples: self.nodes.places[from]..self.nodes.places[end], kind });
            if self.nodes.places[from] <= tuning::OUTLINE_SPOILED {
                break;
            }
            end = self.starts[from].1;
        }
        spans.reverse();
        spans
    }
}
