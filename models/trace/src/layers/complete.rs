//! Outlines through what is seen of a layer, completed where others hide it.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec;
use alloc::vec::Vec;
use core::cell::RefCell;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::memo::Memo;
use super::order::Order;
use super::visible::{self, Hidden};
use super::walk::{self, Walk};
use super::{link, raster, sheet};
use crate::boundary::{Ring, Step};
use crate::outline::{Outline, OutlineShape};
use crate::partition::{OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::sample::RingSamples;
use crate::stroke::StrokeFit;
use crate::tuning;

/// Bits that tell of a sheet as large as the picture: that it is one, and of which kind.
const FRAME_BITS: f64 = 8.0;

/// By how much opposite sides of a parallelogram may differ, per length.
const ALMOST: f64 = 0.02;

/// Most ways to link the parts of one thing that are tried.
const MOST_LINKED: usize = 4;

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
        let steps: usize = self.rings.iter().flatten().map(|ring| ring.steps.len()).sum();
        self.memo.spent.get() > times * (tuning::MOST_TRIED * steps).min(tuning::MOST_TRIED_SAMPLES)
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

    /// [`Completion::outlines`] of a group at place `rank` that was not asked for before.
    fn completed(&self, group: &[u32], rank: usize) -> Completed {
        let wanted = |label: u32| self.wanted(label, group, rank);
        let mut walks = self.walks(group, rank);
        // What is not hidden has no boundary but its own.
        let is_seen = |at: Vec2<f64>| self.pure_face(at).is_some_and(|face| wanted(face).is_some());
        let mut samples = walk::samples(&walks);
        let most = if group.len() > 1 { MOST_LINKED } else { 1 };
        let linked = link::relinked(&samples, is_seen, most).into_iter().map(|samples| self.framed(&samples));
        let linked = linked.filter(|linked| self.check(&linked.outlines, wanted).is_ok());
        let mut linked = linked.min_by(|a, b| a.bits.total_cmp(&b.bits));
        let mut wrong_ways = Vec::new();
        // Long boundaries are not led around what they must not hide without end. With a quarter of that the description of two flags of 160
        // doubled; without a bound layers took up to 39 rounds.
        let count: usize = samples.iter().flat_map(|ring| &ring.runs).map(Vec::len).sum();
        for round in 0..=tuning::MOST_TRIED * tuning::MOST_TRIED_SAMPLES / count.max(1) {
            let walked = self.fit(&samples);
            match self.check(&walked.outlines, wanted) {
                Ok(()) => return linked.filter(|linked| linked.bits <= walked.bits).unwrap_or(walked),
                Err(wrong) => {
                    if round == 0 {
                        let led = sheet::bordered(&samples, self.partition.size, is_seen).map(|led| self.fit(&led));
                        let led = led.filter(|led| self.check(&led.outlines, wanted).is_ok());
                        linked = [linked, led].into_iter().flatten().min_by(|a, b| a.bits.total_cmp(&b.bits));
                    }
                    let is_pinned = walk::pin(&mut walks, &wrong);
                    wrong_ways.push((walked, wrong));
                    if !is_pinned {
                        break;
                    }
                    samples = walk::samples(&walks);
                }
            }
        }
        linked.unwrap_or_else(|| {
            walks.retain(|walk| !walk.is_filled);
            let traced = Completed::new(walks.iter().map(|walk| self.traced(walk.ring)).collect(), false);
            // Of many boundaries most are right as they are.
            let blamed = wrong_ways.last().map(|(_, wrong)| walk::blamed(&walks, wrong)).unwrap_or_default();
            let parts = walks.iter().zip(blamed).filter_map(|(walk, is_blamed)| match is_blamed {
                true => Some(self.traced(walk.ring)),
                false => self.memo.fit_closed(&walk.samples(), &self.ruler),
            });
            let parts = Completed::new(parts.collect(), false);
            let parts = self.check(&parts.outlines, wanted).is_ok().then_some(parts);
            let priced = wrong_ways.into_iter().map(|(walked, wrong)| self.priced(walked, &wrong, wanted)).chain(parts);
            priced.fold(traced, |best, other| if other.bits < best.bits { other } else { best })
        })
    }

    /// The boundaries of a group at place `rank`.
    pub(super) fn walks(&self, group: &[u32], rank: usize) -> Vec<Walk<'_>> {
        // Too small to tell how it goes on.
        let are_specks = group.iter().all(|&face| self.is_small(face) && !self.partition.has_sliver(face));
        let hidden = |step| self.hidden(step, rank, are_specks, group.len() > 1);
        let rings = group.iter().flat_map(|&face| &self.rings[face as usize]);
        rings.map(|ring| Walk::new(ring, ring.steps.iter().map(hidden).collect())).collect()
    }

    /// Outlines that get pixels wrong, with what these cost: where colors are alike, or a coder has changed them, less than the corners of a
    /// polygon that gets them right.
    fn priced(&self, completed: Completed, wrong: &[[usize; 2]], wanted: impl Fn(u32) -> Option<bool>) -> Completed {
        let mut pixels: BTreeMap<u32, usize> = BTreeMap::new();
        wrong.iter().for_each(|&at| *pixels.entry(self.partition.face_at(at)).or_default() += 1);
        let own: Vec<u32> = (0..self.rank.len() as u32).filter(|&face| wanted(face) == Some(true)).collect();
        let chi2 = |(&face, &count): (&u32, &usize)| {
            // What else may be shown where its own face is missed is not known: the worst of what is beside.
            let shown = if own.contains(&face) { &self.neighbors[face as usize] } else { &own };
            let color = self.partition.color(face);
            let contrast2 = |other: &u32| (0..3).map(|c| (self.partition.color(*other)[c] - color[c]).powi(2)).sum();
            count as f64 * shown.iter().map(contrast2).fold(0.0, f64::max) / self.partition.sigma.powi(2)
        };
        let bits = completed.bits + self.ruler.misfit(pixels.iter().map(chi2).sum());
        // Without outlines nothing is explained.
        let bits = if completed.outlines.is_empty() { f64::INFINITY } else { bits };
        Completed { bits, agrees: false, ..completed }
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

    /// The outlines through samples.
    fn fit(&self, samples: &[RingSamples]) -> Completed {
        let outlines = samples.iter().filter_map(|samples| self.memo.fit_closed(samples, &self.ruler));
        Completed::new(outlines.filter(|outline| !raster::is_nothing(outline)).collect(), true)
    }

    /// The outlines through samples, within that of the picture where they go around what they leave free: corners around a disk are a
    /// sheet with an opening.
    fn framed(&self, samples: &[RingSamples]) -> Completed {
        let mut completed = self.fit(samples);
        if samples.iter().map(link::area).sum::<f64>() < 0.0 {
            let [width, height] = self.partition.size.map(|side| side as f64);
            let points = vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
            let shape = OutlineShape::Path(PathRing::polygon(points));
            completed.bits += FRAME_BITS;
            completed.outlines.push(Outline { shape, bits: FRAME_BITS, misfit: 0.0, covariance: Vec::new() });
        }
        completed
    }

    /// The face at a place if nothing else has a share there.
    fn pure_face(&self, at: Vec2<f64>) -> Option<u32> {
        let [x, y] = [at.x as usize, at.y as usize];
        let face = self.partition.face_at([x, y]);
        (face != OUTSIDE && self.partition.shares[y * self.partition.size[0] + x] >= tuning::PURE_SHARE).then_some(face)
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

    /// The last resort: the polygon through the samples themselves.
    fn traced(&self, ring: &Ring) -> Outline {
        let RingSamples { runs, .. } = visible::samples(ring, &vec![None; ring.steps.len()], &[]);
        let mut points: Vec<[f64; 2]> = runs.iter().flatten().map(|sample| sample.point.to_array()).collect();
        if points.len() < 3 {
            points = ring.steps.iter().map(|step| step.crack.start.map(|value| value as f64)).collect();
        }
        let bits = 2.0 * points.len() as f64 * self.ruler.number(0.1);
        Outline { shape: OutlineShape::Path(PathRing::polygon(points)), bits, misfit: 0.0, covariance: Vec::new() }
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
