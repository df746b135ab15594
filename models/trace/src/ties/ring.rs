//! Rows of lines, arcs and cubics: the places of all their points and radii that are told with the fewest bits, by a dynamic
//! programme along the row.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Piece, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::circle::{self, Circle};
use super::figure::circle_of_arc;
use super::numbers::{AXES, Kind, SIGMA, arc_sigma};
use super::places::{LIMIT, Place, Places};
use crate::stroke::piece::{nearest, pieces};

/// Where a point may go.
#[derive(Clone, Copy, Debug)]
struct State {
    point: Vec2<f64>,
    /// Bits of its coordinates.
    bits: f64,
    /// The arc on whose circle it was put.
    on: Option<usize>,
}

/// A row that may move.
struct Row<'a> {
    pieces: Vec<Piece<f64>>,
    closed: bool,
    circles: Vec<Option<Circle>>,
    states: Vec<Vec<State>>,
    places: &'a Places<'a>,
}

/// Puts the numbers of a row where the drawing has its places, as far as nothing moves that can be seen.
pub(super) fn tie(ring: &mut PathRing<f64>, places: &Places<'_>) {
    let is_known =
        |segment: &Segment<f64>| matches!(segment, Segment::Line | Segment::Arc { .. } | Segment::Cubic { .. });
    let pieces = pieces(ring);
    if places.are_none()
        || pieces.is_empty()
        || pieces.len() != ring.segments.len()
        || !ring.segments.iter().all(is_known)
    {
        return;
    }
    if circle::tie(ring, &pieces, places) {
        return;
    }
    let circles = pieces.iter().map(|piece| circle::of_arc(piece, places)).collect();
    let mut row = Row { pieces, closed: ring.is_closed(), circles, states: Vec::new(), places };
    row.states = ring.points.iter().enumerate().map(|(k, &point)| row.candidates(k, Vec2::from(point))).collect();
    let path = row.cheapest();
    for (k, segment) in ring.segments.iter_mut().enumerate() {
        let next = row.next(k);
        let [from, to] = [row.states[k][path[k]], row.states[next][path[next]]];
        let Some((_, piece)) = row.step(k, &from, &to) else { continue };
        match (segment, piece) {
            (Segment::Arc { bulge }, Piece::Arc { bulge: new, .. }) => *bulge = new,
            (Segment::Cubic { controls }, Piece::Cubic([_, a, b, _])) => *controls = [a.to_array(), b.to_array()],
            _ => (),
        }
    }
    for ((point, states), &state) in ring.points.iter_mut().zip(&row.states).zip(&path) {
        *point = states[state].point.to_array();
    }
    drop_vanished(ring);
}

/// Leaves out the pieces of a row whose ends fell together, which had another length.
fn drop_vanished(ring: &mut PathRing<f64>) {
    for k in (0..ring.segments.len()).rev() {
        let next = (k + 1) % ring.points.len();
        let length = (Vec2::from(ring.points[next]) - Vec2::from(ring.points[k])).length();
        if length < SAME && ring.segments.len() > 2 && matches!(ring.segments[k], Segment::Line | Segment::Arc { .. }) {
            ring.segments.remove(k);
            ring.points.remove(k);
        }
    }
}

impl Row<'_> {
    fn next(&self, k: usize) -> usize {
        if self.closed { (k + 1) % self.pieces.len() } else { k + 1 }
    }

    fn before(&self, k: usize) -> Option<usize> {
        if self.closed { Some((k + self.pieces.len() - 1) % self.pieces.len()) } else { k.checked_sub(1) }
    }

    /// Distance of a point from piece `k` as it was and from those beside it.
    fn miss(&self, k: usize, point: Vec2<f64>) -> f64 {
        let beside = [self.before(k), Some(k), Some(self.next(k))].into_iter().flatten();
        let pieces = beside.filter_map(|k| self.pieces.get(k));
        pieces.map(|piece| (piece.point(nearest(piece, point)) - point).length()).fold(f64::INFINITY, f64::min)
    }

    /// Where point `k` may go: as it is, first; all places on what was drawn.
    fn candidates(&self, k: usize, point: Vec2<f64>) -> Vec<State> {
        let free = self.places.free_bits();
        let mut states = vec![State { point, bits: 2.0 * free, on: None }];
        // Along what is drawn a point is less certain than across.
        let reach = SLIDE * LIMIT;
        let [xs, ys] = [0, 1].map(|axis| self.places.near(AXES[axis], point.to_array()[axis], reach));
        for (i, j) in (0..xs.len()).flat_map(|i| (0..ys.len()).map(move |j| (i, j))).skip(1) {
            states.push(State { point: Vec2::new(xs[i].value, ys[j].value), bits: xs[i].bits + ys[j].bits, on: None });
        }
        for arc in [self.before(k), Some(k)].into_iter().flatten() {
            let Some(circle) = self.circles.get(arc).copied().flatten() else { continue };
            let mut push = |offset: Vec2<f64>, bits: f64| {
                states.push(State { point: circle.center + offset, bits, on: Some(arc) });
            };
            let arm = point - circle.center;
            push(arm * (circle.radius / arm.length()), free);
            let across =
                |along: f64, side: f64| (circle.radius.powi(2) - along * along).max(0.0).sqrt() * side.signum();
            for place in xs.iter().skip(1) {
                let along = place.value - circle.center.x;
                push(Vec2::new(along, across(along, arm.y)), place.bits);
            }
            for place in ys.iter().skip(1) {
                let along = place.value - circle.center.y;
                push(Vec2::new(across(along, arm.x), along), place.bits);
            }
        }
        let is_end = !self.closed && (k == 0 || k == self.pieces.len());
        // Nothing beside an end of a line says where it is along the line.
        let own = k.min(self.pieces.len() - 1);
        let limit = if is_end { END_LIMIT } else { LIMIT };
        let miss = |state: &State| if is_end { (state.point - point).length() } else { self.miss(own, state.point) };
        // What reaches the border of the picture still does.
        let border = |value: f64| value.abs() < LIMIT || (value - self.places.ruler.extent).abs() < LIMIT;
        let leaves = |state: &State| {
            let [old, new] = [point.to_array(), state.point.to_array()];
            state.on.is_some() && (0..2).any(|axis| border(old[axis]) && (new[axis] - old[axis]).abs() > SAME)
        };
        let mut rank = 0;
        states.retain(|state| {
            rank += 1;
            rank == 1 || (miss(state) <= limit && !leaves(state))
        });
        states
    }

    /// Piece `k` between two points, its bits and misfit among them; none if it moves too far.
    fn step(&self, k: usize, from: &State, to: &State) -> Option<(f64, Piece<f64>)> {
        let (start, end) = (from.point, to.point);
        match self.pieces[k] {
            Piece::Line { .. } => self.judged(k, Piece::Line { from: start, to: end }, 0.0),
            Piece::Cubic([a, b, c, d]) => {
                self.judged(k, Piece::Cubic([start, b + (start - a), c + (end - d), end]), 0.0)
            }
            Piece::Arc { bulge, .. } => self.arc(k, bulge, from, to),
            Piece::Ellipse { .. } => None,
        }
    }

    /// The cheapest arc between two points.
    fn arc(&self, k: usize, bulge: f64, from: &State, to: &State) -> Option<(f64, Piece<f64>)> {
        let half = 0.5 * (to.point - from.point).length();
        let mut radii = Vec::new();
        if let (Some(circle), true) = (self.circles[k], from.on == Some(k) && to.on == Some(k)) {
            radii.push(Place { value: circle.radius, bits: circle.bits });
        } else if let Some((_, radius)) = circle_of_arc(&self.pieces[k]) {
            radii = self.places.near(Kind::Length, radius, 2.0 * arc_sigma(bulge).min(radius));
            radii.remove(0);
        }
        let mut bulges = vec![(bulge, self.places.free_bits())];
        for Place { value, bits } in radii {
            // The center's distance from the chord; half circles may have a chord that is a little too long for them.
            let height = (value * value - half * half).max(0.0).sqrt();
            if value < half - LIMIT {
                continue;
            }
            let minor = half / (value + height);
            bulges.extend([minor, minor.recip()].map(|size| (size * bulge.signum(), bits)));
        }
        let arcs = bulges
            .into_iter()
            .filter_map(|(bulge, bits)| self.judged(k, Piece::Arc { from: from.point, to: to.point, bulge }, bits));
        arcs.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Bits and misfit of a piece in the place of piece `k`.
    fn judged(&self, k: usize, piece: Piece<f64>, bits: f64) -> Option<(f64, Piece<f64>)> {
        if piece == self.pieces[k] {
            return Some((bits, piece));
        }
        let length = |piece: &Piece<f64>| match piece {
            Piece::Cubic([a, .., d]) => (*d - *a).length(),
            piece => piece.length(),
        };
        let old = length(&self.pieces[k]);
        // What is too short to be seen may vanish.
        let vanishes = old < 2.0 * LIMIT && (piece.to() - piece.from()).length() < SAME;
        let is_kept = length(&piece) >= LEAST_LEFT * old;
        if !is_kept && !vanishes {
            return None;
        }
        let piece = if vanishes { Piece::Line { from: piece.from(), to: piece.to() } } else { piece };
        let mut worst = 0.0_f64;
        for t in PROBES {
            let point = piece.point(t);
            // The middle stays on its own piece: the other arc of a circle may run along those beside it.
            let own = (self.pieces[k].point(nearest(&self.pieces[k], point)) - point).length();
            let miss = if t == MIDDLE { own } else { own.min(self.miss(k, point)) };
            if miss.is_nan() || miss > LIMIT {
                return None;
            }
            worst = worst.max(miss);
        }
        Some((bits + self.places.ruler.misfit((worst / SIGMA).powi(2)), piece))
    }

    /// The states of all points that cost the fewest bits together.
    fn cheapest(&self) -> Vec<usize> {
        if !self.closed {
            return self.walk(self.pieces.len(), None);
        }
        // Where a ring is closed the state of its first point is that in the middle of two laps.
        let laps = self.walk(2 * self.pieces.len(), None);
        let first = laps[self.pieces.len()];
        let mut path = self.walk(self.pieces.len(), Some(first));
        path.pop();
        path
    }

    /// The cheapest states along so many pieces from the first one on, from a state to the same one if one is given.
    fn walk(&self, length: usize, fixed: Option<usize>) -> Vec<usize> {
        let count = self.states.len();
        let start = |state: usize| {
            if fixed.is_none_or(|fixed| fixed == state) { self.states[0][state].bits } else { f64::INFINITY }
        };
        let mut bits: Vec<f64> = (0..self.states[0].len()).map(start).collect();
        let mut back: Vec<Vec<usize>> = Vec::with_capacity(length);
        for position in 0..length {
            let (k, next) = (position % self.pieces.len(), (position + 1) % count);
            let mut best = vec![(f64::INFINITY, 0); self.states[next].len()];
            for (i, from) in self.states[k].iter().enumerate().filter(|&(i, _)| bits[i].is_finite()) {
                for (j, to) in self.states[next].iter().enumerate() {
                    let least = bits[i] + to.bits;
                    if least >= best[j].0 {
                        continue;
                    }
                    if let Some((price, _)) = self.step(k, from, to)
                        && least + price < best[j].0
                    {
                        best[j] = (least + price, i);
                    }
                }
            }
            bits = best.iter().map(|best| best.0).collect();
            back.push(best.iter().map(|best| best.1).collect());
        }
        let last = (0..bits.len()).min_by(|&a, &b| bits[a].total_cmp(&bits[b])).unwrap_or(0);
        let last = fixed.unwrap_or(last);
        if !bits[last].is_finite() {
            // Nothing moves.
            return vec![0; length + 1];
        }
        let mut path = vec![last];
        for before in back.iter().rev() {
            path.push(before[path[path.len() - 1]]);
        }
        path.reverse();
        path
    }
}

/// Where along a piece it is asked how far it moved.
const PROBES: [f64; 3] = [0.25, MIDDLE, 0.75];
const MIDDLE: f64 = 0.5;

/// Ends of lines move by no more than this, pixels: thrice their doubt, as no piece that they belong to holds them.
const END_LIMIT: f64 = 3.0 * SIGMA;

/// Points closer than this are one, pixels.
const SAME: f64 = 1e-6;

/// A piece keeps this share of its length: its ends do not fall together.
const LEAST_LEFT: f64 = 0.5;

/// How much further than across a point may go along what is drawn: where a line joins a curve smoothly.
const SLIDE: f64 = 16.0;
