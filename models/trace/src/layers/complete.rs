//! The outlines of what is painted together, in an order of painting.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;
use core::cell::RefCell;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
use dvp_core::sort;

use super::memo::Memo;
use super::order::Order;
use super::raster;
use super::visible::Hidden;
use super::walk::Walk;
use crate::boundary::{Ring, Step};
use crate::outline::{Outline, OutlineShape};
use crate::partition::{OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::stroke::StrokeFit;
use crate::tuning;

/// By how much opposite sides of a parallelogram may differ, per length.
const ALMOST: f64 = 0.02;

/// The faces painted together, and those in front of them.
type Place = (Vec<u32>, Vec<u32>);

/// What outlines follow from.
pub(super) struct Completion<'a> {
    pub(super) partition: &'a Partition,
    pub(super) rings: &'a [Vec<Ring>],
    /// Place of every face in the order of painting; 0 of what is not painted.
    pub(super) rank: Vec<usize>,
    pub(super) pens: Vec<Option<StrokeFit>>,
    /// The faces that each face touches.
    pub(super) neighbors: Vec<Vec<u32>>,
    /// Pairs of faces of which neither goes on behind the other.
    pub(super) seamed: BTreeSet<(u32, u32)>,
    /// What speaks for the order.
    pub(super) order: &'a Order,
    /// The face that everything lies on.
    pub(super) background: u32,
    /// Whether what has its color shows nothing at all.
    pub(super) is_clear: bool,
    pub(super) ruler: Ruler,
    /// Pairs of faces that were found to be one thing behind another, when the order was.
    pub(super) united: Vec<(u32, u32)>,
    /// Whether orders are searched for: then nothing is fitted any more once that has taken too long.
    pub(super) is_searching: bool,
    /// Outlines that were found, by the faces painted together and those in front of them.
    pub(super) known: RefCell<BTreeMap<Place, Completed>>,
    /// Outlines that were fitted.
    pub(super) memo: Memo,
}

/// Outlines, and bits of their numbers and misfits.
#[derive(Clone)]
pub(super) struct Completed {
    pub(super) outlines: Vec<Outline>,
    pub(super) bits: f64,
    /// Whether they cover what they should, and nothing else; false for the last resort.
    pub(super) agrees: bool,
}

impl Completed {
    /// Two layers as one that covers what both do.
    pub(super) fn with(&self, other: &Self) -> Self {
        let outlines = self.outlines.iter().chain(&other.outlines).cloned().collect();
        Self { outlines, bits: self.bits + other.bits, agrees: self.agrees && other.agrees }
    }

    /// Whether it is a thing as people draw them: figures, and paths that are parallelograms, as rectangles with a hidden side may be.
    pub(super) fn is_whole(&self) -> bool {
        let is_figure = |outline: &Outline| match &outline.shape {
            OutlineShape::Path(ring) => is_parallelogram(ring),
            _ => true,
        };
        self.outlines.iter().all(is_figure)
    }

    /// Not asked for any more.
    fn unknown() -> Self {
        Self { bits: f64::INFINITY, agrees: false, ..Self::none() }
    }

    /// Nothing to complete.
    pub(super) fn none() -> Self {
        Self { outlines: Vec::new(), bits: 0.0, agrees: true }
    }

    pub(super) fn new(outlines: Vec<Outline>, agrees: bool) -> Self {
        let bits = outlines.iter().map(|outline| outline.bits + outline.misfit).sum();
        Self { outlines, bits, agrees }
    }
}

impl Completion<'_> {
    /// Place of a face in the order of painting.
    pub(super) fn rank(&self, face: u32) -> usize {
        self.rank[face as usize]
    }

    /// Whether a face that is painted has the color of the background.
    pub(super) fn shows_background(&self, face: u32) -> bool {
        let color = |face: u32| self.partition.faces[face as usize].color;
        self.rank(face) > 0 && color(face) == color(self.background)
    }

    /// Whether a face has no flat pixel: it may be a part of anything.
    pub(super) fn is_small(&self, face: u32) -> bool {
        self.partition.faces[face as usize].flat == 0
    }

    /// The pen that has drawn a group, if it is one face that one has drawn.
    pub(super) fn pen(&self, group: &[u32]) -> Option<&StrokeFit> {
        let [face] = group else { return None };
        self.pens[*face as usize].as_ref()
    }

    /// Faces that are no part of anything larger.
    pub(super) fn apart(&self) -> BTreeSet<u32> {
        let beside: BTreeSet<u32> = self.seamed.iter().map(|&(face, _)| face).collect();
        beside.into_iter().filter(|&face| self.is_apart(face)).collect()
    }

    /// Whether a face, which has seams, lies edge to edge with all around it, but for lines and what lies behind everything: then nothing of it
    /// is hidden.
    fn is_apart(&self, face: u32) -> bool {
        let around = &self.neighbors[face as usize];
        let is_beside = |other: &u32| self.seamed.contains(&(face, *other));
        // What has its color touches it across a corner.
        let color = |face: u32| self.partition.faces[face as usize].color;
        let may_hide = |other: &&u32| {
            self.rank(**other) > 0 && self.pens[**other as usize].is_none() && color(**other) != color(face)
        };
        around.iter().filter(may_hide).all(is_beside)
    }

    /// The faces beside some faces that come to lie in front of them if they go where the hindmost of them is.
    pub(super) fn crossed(&self, faces: &[u32]) -> BTreeSet<u32> {
        let rank = self.hindmost(faces);
        let beside =
            faces.iter().flat_map(|&face| self.neighbors[face as usize].iter().map(move |&other| (face, other)));
        let is_crossed = |&(face, other): &(u32, u32)| (rank + 1..self.rank(face)).contains(&self.rank(other));
        beside.filter(is_crossed).map(|(_, other)| other).filter(|other| !faces.contains(other)).collect()
    }

    /// Puts faces where the hindmost of them is.
    pub(super) fn sink(&mut self, faces: &[u32]) {
        let hindmost = self.hindmost(faces);
        for &face in faces {
            self.rank[face as usize] = hindmost;
        }
    }

    /// The faces that are painted, from back to front.
    pub(super) fn painted(&self) -> Vec<u32> {
        let mut faces: Vec<u32> = (0..self.rank.len() as u32).filter(|&face| self.rank(face) > 0).collect();
        sort::ascending(&mut faces, |&face| self.rank(face) as f64);
        faces
    }

    /// Whether so many outlines were fitted that no other order or group is tried any more.
    pub(super) fn is_spent(&self) -> bool {
        self.is_spent_times(1)
    }

    fn is_spent_times(&self, times: usize) -> bool {
        self.memo.spent.get() > times * self.wanted_samples().min(tuning::MOST_TRIED_SAMPLES)
    }

    /// Whether the search for an order has all the time that it can use.
    pub(super) fn has_time(&self) -> bool {
        self.wanted_samples() <= tuning::MOST_TRIED_SAMPLES
    }

    /// Samples that outlines may be fitted to in such a search, were there no bound.
    fn wanted_samples(&self) -> usize {
        tuning::MOST_TRIED * self.rings.iter().flatten().map(|ring| ring.steps.len()).sum::<usize>()
    }

    /// Faces are painted in this order, and no others.
    pub(super) fn paint(&mut self, order: &[u32]) {
        self.rank.fill(0);
        for (place, &face) in order.iter().enumerate() {
            self.rank[face as usize] = place + 1;
        }
    }

    /// The outlines of faces that are painted together, at the place of the hindmost of them.
    ///
    /// What others hide may go anywhere, as long as it hides nothing itself: where it would, it goes along what hides it.
    pub(super) fn outlines(&self, group: &[u32]) -> Completed {
        let rank = self.hindmost(group);
        let mut faces = group.to_vec();
        faces.sort_unstable();
        let is_in_front = |face: &u32| self.rank(*face) > rank && faces.binary_search(face).is_err();
        let front = (0..self.rank.len() as u32).filter(is_in_front).collect();
        let key = (faces, front);
        if let Some(known) = self.known.borrow().get(&key) {
            return known.clone();
        }
        // What is being tried when that is spent may take as much again.
        if self.is_searching && self.is_spent_times(2) {
            return Completed::unknown();
        }
        let completed = self.completed(group, rank);
        self.known.borrow_mut().insert(key, completed.clone());
        completed
    }

    /// The boundaries of a group at place `rank`.
    pub(super) fn walks(&self, group: &[u32], rank: usize) -> Vec<Walk<'_>> {
        // Too small to tell how it goes on.
        let are_specks = group.iter().all(|&face| self.is_small(face) && !self.partition.has_sliver(face));
        let hidden = |step| self.hidden(step, rank, are_specks, group.len() > 1);
        let rings = group.iter().flat_map(|&face| &self.rings[face as usize]);
        rings.map(|ring| Walk::new(ring, ring.steps.iter().map(hidden).collect())).collect()
    }

    /// Whether a layer of the faces `group` at place `rank` must show a face, must not hide it, or may (none).
    pub(super) fn wanted(&self, face: u32, group: &[u32], rank: usize) -> Option<bool> {
        let is_own = group.contains(&face);
        (is_own || self.rank(face) <= rank).then_some(is_own)
    }

    /// Whether what was completed still covers what it should and hides nothing; what the order did not change since is as it was.
    pub(super) fn holds(&self, group: &[u32], completed: &Completed) -> bool {
        let rank = self.hindmost(group);
        !completed.agrees
            || completed.outlines.is_empty()
            || self.check(&completed.outlines, |face| self.wanted(face, group, rank)).is_ok()
    }

    /// Whether outlines cover what they should, and nothing else.
    pub(super) fn shows_only(&self, group: &[u32], completed: &Completed) -> bool {
        let rank = self.hindmost(group);
        self.check(&completed.outlines, |face| self.wanted(face, group, rank)).is_ok()
    }

    pub(super) fn hindmost(&self, faces: &[u32]) -> usize {
        faces.iter().map(|&face| self.rank(face)).min().unwrap_or(0)
    }

    /// How a step of a layer's boundary is hidden, if it is.
    fn hidden(&self, step: &Step, rank: usize, is_speck: bool, is_part: bool) -> Option<Hidden> {
        // What is seen in parts goes on behind something in any case.
        let is_beside = !is_part && self.seamed.contains(&(step.inner, step.other));
        if step.other != OUTSIDE && (self.rank(step.other) <= rank || is_beside) {
            return None;
        }
        let pen = self.pens.get(step.other as usize).and_then(Option::as_ref).and_then(|pen| pen.strokes.first());
        match pen {
            // What ends at a line ends under it, and what is seen on both sides of it goes on.
            Some(stroke) if !is_part => Some(Hidden::Under { shift: 0.5 * stroke.width }),
            _ => (!is_speck).then_some(Hidden::Free),
        }
    }

    pub(super) fn check(
        &self,
        outlines: &[Outline],
        wanted: impl Fn(u32) -> Option<bool>,
    ) -> Result<(), Vec<[usize; 2]>> {
        let polygons: Vec<Vec<[f64; 2]>> = outlines.iter().filter_map(raster::polygon).collect();
        if polygons.is_empty() { Err(Vec::new()) } else { raster::check(self.partition, &polygons, wanted) }
    }
}

/// Whether a ring is four straight lines, opposite ones about equal.
fn is_parallelogram(ring: &PathRing<f64>) -> bool {
    let [a, b, c, d] = ring.points[..] else { return false };
    let [a, b, c, d] = [a, b, c, d].map(Vec2::from);
    let off = (a - b) + (c - d);
    ring.segments.iter().all(|segment| matches!(segment, Segment::Line))
        && off.length() < ALMOST * ((a - b).length() + (b - c).length())
}

/// The faces that each face touches.
pub(super) fn neighbors(rings: &[Vec<Ring>]) -> Vec<Vec<u32>> {
    let of_face = |rings: &Vec<Ring>| {
        let others: BTreeSet<u32> = rings.iter().flat_map(|ring| &ring.steps).map(|step| step.other).collect();
        others.into_iter().filter(|&other| other != OUTSIDE).collect()
    };
    rings.iter().map(of_face).collect()
}
