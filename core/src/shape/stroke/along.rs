//! The sides of a piece.

use alloc::vec::Vec;

use super::Join;
use super::leg::At;
use super::place::{Source, bulge, factor};
use super::walk::{Side, Walker};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{CubicVertex, End, Piece, cut, derivatives, edges, is_turn_too_wide, push};

const SIDES: [Side; 2] = [-1, 1];

/// Cuts of a cubic, and the vertices to one side of them.
struct Beside<'a> {
    side: Side,
    /// The vertices at the cuts.
    vertices: &'a [usize],
    /// Of the stretch that is turned around: where the lines across the pen at its cuts cross each other, and the vertices beside.
    fold: (Vec<usize>, Vec<usize>),
}

impl<T: Real> Walker<'_, T> {
    /// Appends the vertices to both sides of a leg.
    pub(super) fn along(&mut self, leg: usize) {
        let piece = self.legs[leg].piece;
        if let Piece::Cubic(points) = piece {
            self.has_tip = [false; 2];
            return self.along_cubic(leg, &points);
        }
        let has_tip = core::mem::take(&mut self.has_tip);
        for (side, has_tip) in SIDES.into_iter().zip(has_tip) {
            let [start, finish] =
                [End::Start, End::Finish].map(|end| Source::Offset { at: At::End(leg, end), across: side, along: 0 });
            if !(has_tip && self.is_straight(leg)) {
                self.add_to(side, start);
            }
            if let Piece::Arc { .. } = piece {
                self.along_arc(leg, side, [start, finish]);
            }
            self.add_to(side, finish);
        }
    }

    fn along_arc(&mut self, leg: usize, side: Side, ends: [Source<T>; 2]) {
        let (bulge, offset) = (bulge(&self.legs[leg]), self.half * factor(side));
        let piece = self.legs[leg].piece;
        let [start, finish] = [End::Start, End::Finish].map(|end| {
            let frame = self.frame(At::End(leg, end));
            frame.point + frame.normal() * offset
        });
        let count = edges((finish - start).length(), bulge, self.tolerance);
        let inner = (1..count).map(|step| Source::BesideArc { leg, side, step, count });
        // The radius is chord (1 + bulge^2) / (4 bulge), negative where the center is on the side -1.
        let chord = (piece.to() - piece.from()).length();
        if T::of(4.0) * offset * bulge <= chord * (T::one() + bulge * bulge) {
            inner.for_each(|source| self.add_to(side, source));
            return;
        }
        // Beyond the center: the strip ends there, and what lies behind turns the other way.
        self.add_to(side, Source::Center { leg });
        let center = self.add(Source::Center { leg });
        let mut island = alloc::vec![center, self.add(ends[0])];
        island.extend(inner.collect::<Vec<_>>().into_iter().map(|source| self.add(source)));
        island.push(self.add(ends[1]));
        self.add_island(island);
    }

    fn along_cubic(&mut self, leg: usize, points: &[Vec2<T>; 4]) {
        let cuts = self.cuts(leg, points);
        let vertices = SIDES.map(|side| {
            let sources = cuts.iter().map(|&(at, push)| match at {
                At::Inside(leg, t) => {
                    Source::BesideCubic { leg, vertex: CubicVertex { t, distance: factor(side), push } }
                }
                at @ At::End(..) => Source::Offset { at, across: side, along: 0 },
            });
            sources.map(|source| self.add(source)).collect::<Vec<_>>()
        });
        let mut beside =
            [0, 1].map(|k| Beside { side: SIDES[k], vertices: &vertices[k], fold: (Vec::new(), Vec::new()) });
        for beside in &beside {
            self.chains[usize::from(beside.side > 0)].push(beside.vertices[0]);
        }
        for (i, pair) in cuts.windows(2).enumerate() {
            let (before, after) = (pair[0].0, pair[1].0);
            if self.is_sharp(before, after) {
                beside.iter_mut().for_each(|beside| self.end_fold(beside, i));
                self.corner_joined(before, after, Join::Round);
                for beside in &beside {
                    self.chains[usize::from(beside.side > 0)].push(beside.vertices[i + 1]);
                }
                continue;
            }
            for beside in &mut beside {
                self.step(beside, i, [before, after]);
            }
        }
        beside.iter_mut().for_each(|beside| self.end_fold(beside, cuts.len() - 1));
    }

    /// Whether the direction turns by more between two cuts of a cubic than the tolerance allows, though they are as near as they
    /// get: the pen turns there as at a corner with a round join.
    fn is_sharp(&self, before: At<T>, after: At<T>) -> bool {
        let [before, after] = [before, after].map(|at| self.frame(at).direction);
        let angle = before.cross(after).atan2(before.dot(after));
        is_turn_too_wide(angle.abs(), T::zero(), self.half, self.tolerance)
    }

    /// The places at which a cubic is cut, both ends included, and how far vertices stand outside there.
    fn cuts(&mut self, leg: usize, points: &[Vec2<T>; 4]) -> Vec<(At<T>, T)> {
        let mut parameters = core::mem::take(&mut self.parameters);
        parameters.clear();
        cut(*points, self.tolerance, self.half, &mut parameters);
        // At the tip of a cusp the pen has no direction.
        parameters.retain(|&t| derivatives(points, t)[1].normalized().is_some());
        let last = parameters.len().saturating_sub(1);
        let mut cuts = Vec::with_capacity(parameters.len() + 2);
        cuts.push((At::End(leg, End::Start), T::zero()));
        for (i, &t) in parameters.iter().enumerate() {
            let before = if i == 0 { t } else { t - parameters[i - 1] };
            let after = if i == last { T::one() - t } else { parameters[i + 1] - t };
            let push = push(points, t, [before, after], [i == 0, i == last], [self.tolerance, self.half]);
            cuts.push((At::Inside(leg, t), push));
        }
        cuts.push((At::End(leg, End::Finish), T::zero()));
        self.parameters = parameters;
        cuts
    }

    /// From cut `i` to the next, on one side.
    fn step(&mut self, beside: &mut Beside<'_>, i: usize, places: [At<T>; 2]) {
        let ends = [beside.vertices[i], beside.vertices[i + 1]];
        let pens = [0, 1].map(|k| [self.frame(places[k]).point, self.places[ends[k]]]);
        if !cross_inside(pens) {
            self.end_fold(beside, i);
            self.chains[usize::from(beside.side > 0)].push(ends[1]);
            return;
        }
        let middles = places.map(|at| self.add(Source::Offset { at, across: 0, along: 0 }));
        let crossing = self.add(Source::Crossing([[middles[0], ends[0]], [middles[1], ends[1]]]));
        self.chains[usize::from(beside.side > 0)].push(crossing);
        beside.fold.0.push(crossing);
        beside.fold.1.push(ends[0]);
    }

    /// Ends the stretch that is turned around, if there is one, at cut `i`.
    fn end_fold(&mut self, beside: &mut Beside<'_>, i: usize) {
        let (mut island, mut vertices) = core::mem::take(&mut beside.fold);
        if island.is_empty() {
            return;
        }
        self.chains[usize::from(beside.side > 0)].push(beside.vertices[i]);
        vertices.push(beside.vertices[i]);
        vertices.reverse();
        island.append(&mut vertices);
        self.add_island(island);
    }

    /// A ring of its own, made to turn from +x to +y.
    fn add_island(&mut self, mut island: Vec<usize>) {
        let places = |i: usize| self.places[island[i % island.len()]] - self.places[island[0]];
        let twice_area: T = (0..island.len()).map(|i| places(i).cross(places(i + 1))).sum();
        if twice_area < T::zero() {
            island.reverse();
        }
        self.islands.push(island);
    }
}

/// Whether two lines cross, both between their ends.
fn cross_inside<T: Real>([[a, b], [c, d]]: [[Vec2<T>; 2]; 2]) -> bool {
    let apart = |first: T, second: T| first.min(second) < T::zero() && first.max(second) > T::zero();
    apart((b - a).cross(c - a), (b - a).cross(d - a)) && apart((d - c).cross(a - c), (d - c).cross(b - c))
}
