//! The outlines of what is painted together, in an order of painting.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::rc::Rc;
use alloc::vec::Vec;
use core::cell::{Cell, OnceCell, RefCell};

use dvp_core::Vec2;
use dvp_core::geometry::LineSegment;
use dvp_core::shape::{FillRule, PathRing, Segment};
use dvp_core::sort;

use super::join::Group;
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
    /// Samples that outlines may be fitted to in such a search, were there no bound.
    pub(super) wanted_samples: usize,
    /// Outlines that were found, by the faces painted together (ascending).
    pub(super) known: RefCell<BTreeMap<Vec<u32>, Vec<Known>>>,
    /// Outlines that were fitted.
    pub(super) memo: &'a Memo,
}

/// Outlines, and what they depend on.
pub(super) struct Known {
    completed: Rc<Completed>,
    /// The faces whose place was asked for, and whether they lay in front.
    asked: BTreeMap<u32, bool>,
    /// Whether they are a thing as people draw them, once that was asked.
    is_whole: Cell<Option<bool>>,
}

/// Where faces are painted together, and of which others it was asked whether they lie in front.
pub(super) struct Place<'a> {
    pub(super) faces: &'a [u32],
    /// Place of the hindmost of them in the order of painting.
    pub(super) rank: usize,
    rank_of: &'a [usize],
    asked: RefCell<BTreeMap<u32, bool>>,
}

impl Place<'_> {
    /// Whether what is painted here lies behind a face: it may go on there as it likes.
    pub(super) fn is_behind(&self, face: u32) -> bool {
        let is_behind = self.rank_of[face as usize] > self.rank;
        self.asked.borrow_mut().insert(face, is_behind);
        is_behind
    }
}

/// Outlines, and bits of their numbers and misfits.
#[derive(Clone)]
pub(super) struct Completed {
    pub(super) outlines: Vec<Outline>,
    pub(super) bits: f64,
    /// Whether they cover what they should, and nothing else; false for the last resort.
    pub(super) agrees: bool,
    /// Whether each of them is a thing by itself; else they are one, and fill by the even-odd rule.
    pub(super) are_things: bool,
    /// The sides of the polygons that they are painted as, once asked for.
    pub(super) sides: OnceCell<Vec<LineSegment<f64>>>,
}

impl Completed {
    /// The sides of the polygons that the outlines are painted as.
    pub(super) fn sides(&self) -> &[LineSegment<f64>] {
        self.sides.get_or_init(|| {
            let polygons = self.outlines.iter().filter_map(raster::polygon);
            polygons.flat_map(|points| LineSegment::closed(&points).collect::<Vec<_>>()).collect()
        })
    }

    /// Two layers as one that covers what both do.
    pub(super) fn with(&self, other: &Self) -> Self {
        let outlines = self.outlines.iter().chain(&other.outlines).cloned().collect();
        Self { bits: self.bits + other.bits, ..Self::new(outlines, self.agrees && other.agrees) }
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
        Self::new(Vec::new(), true)
    }

    pub(super) fn new(outlines: Vec<Outline>, agrees: bool) -> Self {
        let bits = outlines.iter().map(|outline| outline.bits + outline.misfit).sum();
        Self { outlines, bits, agrees, are_things: false, sides: OnceCell::new() }
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
        // The searches of all readings of a picture so far are one.
        let searches = if self.is_searching { self.memo.searches.get() } else { 1 };
        self.memo.spent.get() > times * (searches * self.wanted_samples).min(tuning::MOST_TRIED_SAMPLES)
    }

    /// Whether the search for an order has all the time that it can use.
    pub(super) fn has_time(&self) -> bool {
        self.wanted_samples <= tuning::MOST_TRIED_SAMPLES
    }

    /// Faces are painted in this order, and no others.
    pub(super) fn paint(&mut self, order: &[u32]) {
        self.rank.fill(0);
        self.paint_from(0, order);
    }

    /// Faces are painted in this order, the first of them at place `first`; all others stay where they are.
    pub(super) fn paint_from(&mut self, first: usize, order: &[u32]) {
        for (place, &face) in order.iter().enumerate() {
            self.rank[face as usize] = first + place + 1;
        }
    }

    /// Groups are painted in this order, and nothing else.
    pub(super) fn paint_groups(&mut self, groups: &[Group]) {
        self.rank.fill(0);
        for (place, group) in groups.iter().enumerate() {
            group.faces.iter().for_each(|&face| self.rank[face as usize] = place + 1);
        }
    }

    /// The outlines of faces that are painted together, at the place of the hindmost of them.
    ///
    /// What others hide may go anywhere, as long as it hides nothing itself: where it would, it goes along what hides it.
    pub(super) fn outlines(&self, group: &[u32]) -> Rc<Completed> {
        if let Some(known) = self.known(group, |known| Rc::clone(&known.completed)) {
            return known;
        }
        // What is being tried when that is spent may take as much again.
        if self.is_searching && self.is_spent_times(2) {
            return Rc::new(Completed::unknown());
        }
        let place = self.place(group);
        for &other in group.iter().flat_map(|&face| &self.neighbors[face as usize]) {
            place.is_behind(other);
        }
        let completed = Rc::new(self.completed(&place));
        let known =
            Known { completed: Rc::clone(&completed), asked: place.asked.into_inner(), is_whole: Cell::default() };
        self.known.borrow_mut().entry(sorted(group)).or_default().push(known);
        completed
    }

    /// What was found of a group, if all that was asked for it is as it was.
    fn known<T>(&self, group: &[u32], of: impl Fn(&Known) -> T) -> Option<T> {
        let rank = self.hindmost(group);
        let is_same =
            |known: &&Known| known.asked.iter().all(|(&face, &is_behind)| is_behind == (self.rank(face) > rank));
        self.known.borrow().get(&sorted(group))?.iter().rev().find(is_same).map(of)
    }

    /// Whether a group with these outlines is a thing as people draw them (`is_whole`), which depends on no more than its outlines do: where those are
    /// known it is asked once.
    pub(super) fn is_whole(&self, group: &[u32], completed: &Rc<Completed>, is_whole: impl Fn() -> bool) -> bool {
        let of_these = |known: &Known| Rc::ptr_eq(&known.completed, completed).then(|| known.is_whole.get());
        match self.known(group, of_these).flatten() {
            Some(Some(known)) => known,
            Some(None) => {
                let is_whole = is_whole();
                self.known(group, |known| known.is_whole.set(Some(is_whole)));
                is_whole
            }
            None => is_whole(),
        }
    }

    /// Where a group is painted.
    pub(super) fn place<'b>(&'b self, faces: &'b [u32]) -> Place<'b> {
        Place { faces, rank: self.hindmost(faces), rank_of: &self.rank, asked: RefCell::default() }
    }

    /// The boundaries of a group at place `rank`.
    pub(super) fn walks(&self, group: &[u32], rank: usize) -> Vec<Walk<'_>> {
        // Too small to tell how it goes on.
        let are_specks = group.iter().all(|&face| self.is_small(face) && !self.partition.has_sliver(face));
        let hidden = |step| self.hidden(step, rank, are_specks, group.len() > 1);
        let rings = group.iter().flat_map(|&face| &self.rings[face as usize]);
        rings.map(|ring| Walk::new(ring, ring.steps.iter().map(hidden).collect())).collect()
    }

    /// Whether what was completed still covers what it should and hides nothing; what the order did not change since is as it was.
    pub(super) fn holds(&self, group: &[u32], completed: &Rc<Completed>) -> bool {
        !completed.agrees
            || completed.outlines.is_empty()
            || self.known(group, |known| Rc::ptr_eq(&known.completed, completed)) == Some(true)
            || self.shows_only(group, completed)
    }

    /// Whether outlines cover what they should, and nothing else.
    pub(super) fn shows_only(&self, group: &[u32], completed: &Completed) -> bool {
        self.check(&completed.outlines, &self.place(group)).is_ok()
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

    /// Whether outlines cover all of the faces of a place and hide nothing; else the pixels that are wrong.
    pub(super) fn check(&self, outlines: &[Outline], place: &Place<'_>) -> Result<(), Vec<[usize; 2]>> {
        self.check_filled(outlines, FillRule::EvenOdd, place)
    }

    /// The same for outlines that fill by some rule.
    pub(super) fn check_filled(
        &self,
        outlines: &[Outline],
        fill: FillRule,
        place: &Place<'_>,
    ) -> Result<(), Vec<[usize; 2]>> {
        let polygons: Vec<Vec<[f64; 2]>> = outlines.iter().filter_map(raster::polygon).collect();
        if polygons.is_empty() {
            return Err(Vec::new());
        }
        raster::check(self.partition, (&polygons, fill), place.faces, |face| !place.is_behind(face))
    }
}

/// Faces, ascending.
fn sorted(faces: &[u32]) -> Vec<u32> {
    let mut faces = faces.to_vec();
    faces.sort_unstable();
    faces
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
