//! Outlines through what is seen of a layer, completed where others hide it.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{FillRule, Outline as Polygons, Path, PathRing, Shape as _};

use super::visible::{self, Hidden};
use super::{link, raster};
use crate::boundary::{Ring, Step, walk_mask};
use crate::outline::{Outline, OutlineShape, fit_closed};
use crate::partition::{OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::sample::RingSamples;
use crate::stroke::StrokeFit;
use crate::tuning;

/// What outlines follow from.
pub(super) struct Completion<'a> {
    pub(super) partition: &'a Partition,
    pub(super) rings: &'a [Vec<Ring>],
    /// Place of every face in the order of painting; 0 of what is not painted.
    pub(super) rank: Vec<usize>,
    pub(super) pens: &'a [Option<StrokeFit>],
    pub(super) ruler: Ruler,
}

/// Where a hidden outline may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Policy {
    /// Anywhere, as long as it hides nothing.
    Free,
    /// Along the border of the picture; anywhere behind other layers.
    Border,
    /// Along the border and along the layers in front.
    Pinned,
}

impl Policy {
    /// What remains hidden of a step.
    fn of(self, step: &Step, hidden: Hidden) -> Option<Hidden> {
        let is_free = match self {
            Self::Free => true,
            Self::Border => step.other != OUTSIDE,
            Self::Pinned => false,
        };
        (is_free || hidden != Hidden::Free).then_some(hidden)
    }
}

/// Outlines, and bits of their numbers and misfits.
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
        Self::new(outlines, self.agrees && other.agrees)
    }

    /// Nothing to complete.
    pub(super) fn none() -> Self {
        Self { outlines: Vec::new(), bits: 0.0, agrees: true }
    }

    fn new(outlines: Vec<Outline>, agrees: bool) -> Self {
        let bits = outlines.iter().map(|outline| outline.bits + outline.misfit).sum();
        Self { outlines, bits, agrees }
    }
}

impl Completion<'_> {
    /// Place of a face in the order of painting.
    pub(super) fn rank(&self, face: u32) -> usize {
        self.rank[face as usize]
    }

    /// Puts faces where the hindmost of them is.
    pub(super) fn sink(&mut self, faces: &[u32]) {
        let hindmost = self.hindmost(faces);
        for &face in faces {
            self.rank[face as usize] = hindmost;
        }
    }

    /// The outlines of faces that are painted together, at the place of the hindmost of them.
    pub(super) fn outlines(&self, group: &[u32]) -> Completed {
        let rank = self.hindmost(group);
        let walked;
        let rings: &[Ring] = match group {
            [face] => &self.rings[*face as usize],
            _ => {
                walked = self.walk(group, rank);
                &walked
            }
        };
        let wanted = |label: u32| self.wanted(label, group, rank);
        // A face without a flat pixel is too small to tell how it goes on.
        let is_small = group.iter().all(|&face| self.partition.faces[face as usize].flat == 0);
        let policies = [Policy::Free, Policy::Border, Policy::Pinned];
        let mut tried: Vec<RingSamples> = Vec::new();
        for &policy in if is_small { &policies[2..] } else { &policies[..] } {
            let hidden = |step: &Step| self.hidden(step, group, rank);
            // A hole that is filled by what lies in front of it is none.
            let is_ring = |ring: &&Ring| ring.area > 0.0 || ring.steps.iter().any(|step| hidden(step).is_none());
            let needed = |step: &Step| hidden(step).and_then(|hidden| policy.of(step, hidden));
            let samples: Vec<RingSamples> =
                rings.iter().filter(is_ring).map(|ring| visible::samples(ring, needed)).collect();
            if samples == tried {
                continue;
            }
            tried.clone_from(&samples);
            // What is not hidden has no boundary but its own.
            let is_seen = |at: Vec2<f64>| self.pure_face(at).is_some_and(|face| wanted(face).is_some());
            let ways = [link::relinked(&samples, is_seen), Some(samples)];
            let completed = ways.iter().flatten().filter_map(|samples| self.fit(samples, wanted));
            if let Some(best) = completed.min_by(|a, b| a.bits.total_cmp(&b.bits)) {
                return best;
            }
        }
        if group.len() > 1 {
            return Completed::new(Vec::new(), false);
        }
        // Nothing is completed: all around what is seen.
        let around: Vec<RingSamples> = rings.iter().map(|ring| visible::samples(ring, |_| None)).collect();
        let seen: Vec<Outline> = if around == tried {
            Vec::new()
        } else {
            around.iter().filter_map(|ring| fit_closed(ring, &self.ruler)).collect()
        };
        if self.agrees(&seen, wanted) {
            return Completed::new(seen, true);
        }
        Completed::new(rings.iter().map(|ring| self.traced(ring)).collect(), false)
    }

    /// Whether a layer of the faces `group` at place `rank` must show a face, must not hide it, or may (none).
    fn wanted(&self, face: u32, group: &[u32], rank: usize) -> Option<bool> {
        let is_own = group.contains(&face);
        (is_own || self.rank(face) <= rank).then_some(is_own)
    }

    /// Whether what was completed still covers what it should and hides nothing; what the order did not change since is as it was.
    pub(super) fn holds(&self, group: &[u32], completed: &Completed) -> bool {
        let rank = self.hindmost(group);
        !completed.agrees
            || completed.outlines.is_empty()
            || self.agrees(&completed.outlines, |face| self.wanted(face, group, rank))
    }

    /// Whether the boundary of some faces goes on smoothly as that of others, behind what lies in front of both.
    pub(super) fn is_related(&self, parts: [&[u32]; 2]) -> bool {
        let all: Vec<u32> = parts.concat();
        let rank = self.hindmost(&all);
        let samples = parts.map(|part| {
            let rings = part.iter().flat_map(|&face| &self.rings[face as usize]);
            rings.map(|ring| visible::samples(ring, |step| self.hidden(step, &all, rank))).collect::<Vec<_>>()
        });
        let is_seen = |at: Vec2<f64>| self.pure_face(at).is_some_and(|face| self.wanted(face, &all, rank).is_some());
        link::relation([&samples[0], &samples[1]], is_seen).is_some_and(|price| price < tuning::MOST_TURN)
    }

    fn hindmost(&self, faces: &[u32]) -> usize {
        faces.iter().map(|&face| self.rank(face)).min().unwrap_or(0)
    }

    /// The outlines through samples if they agree with what is seen.
    fn fit(&self, samples: &[RingSamples], wanted: impl Fn(u32) -> Option<bool>) -> Option<Completed> {
        let outlines: Vec<Outline> = samples.iter().filter_map(|samples| fit_closed(samples, &self.ruler)).collect();
        self.agrees(&outlines, wanted).then(|| Completed::new(outlines, true))
    }

    /// The face at a place if nothing else has a share there.
    fn pure_face(&self, at: Vec2<f64>) -> Option<u32> {
        let [x, y] = [at.x as usize, at.y as usize];
        let face = self.partition.face_at([x, y]);
        (face != OUTSIDE && self.partition.shares[y * self.partition.size[0] + x] >= tuning::PURE_SHARE).then_some(face)
    }

    /// How a step of a layer's boundary is hidden, if it is.
    fn hidden(&self, step: &Step, group: &[u32], rank: usize) -> Option<Hidden> {
        if step.other == OUTSIDE {
            return Some(Hidden::Free);
        }
        let front = if !group.contains(&step.inner) {
            step.inner
        } else if self.rank(step.other) > rank {
            step.other
        } else {
            return None;
        };
        let width = self.pens[front as usize].as_ref().and_then(|pen| pen.strokes.first()).map(|stroke| stroke.width);
        // Seen from inside of the group the stroke lies outward, seen from outside inward.
        let sign = if front == step.other { 1.0 } else { -1.0 };
        Some(width.map_or(Hidden::Free, |width| Hidden::Under { shift: 0.5 * sign * width }))
    }

    /// The rings around a group and what hides the gaps in it.
    fn walk(&self, group: &[u32], rank: usize) -> Vec<Ring> {
        let mut member = vec![false; self.partition.faces.len()];
        for &face in group {
            member[face as usize] = true;
            for step in self.rings[face as usize].iter().flat_map(|ring| &ring.steps) {
                if step.other != OUTSIDE && self.rank(step.other) > rank {
                    member[step.other as usize] = true;
                }
            }
        }
        let mut bounds = [usize::MAX, usize::MAX, 0, 0];
        for (face, _) in self.partition.faces.iter().zip(&member).filter(|&(_, &is_member)| is_member) {
            let [left, top, right, bottom] = face.bounds;
            bounds = [bounds[0].min(left), bounds[1].min(top), bounds[2].max(right), bounds[3].max(bottom)];
        }
        walk_mask(self.partition, |at| member[self.partition.face_at(at) as usize], bounds)
    }

    fn agrees(&self, outlines: &[Outline], wanted: impl Fn(u32) -> Option<bool>) -> bool {
        let polygons: Vec<Vec<[f64; 2]>> = outlines.iter().filter_map(polygon).collect();
        !polygons.is_empty() && raster::agrees(self.partition, &polygons, wanted)
    }

    /// The last resort: the polygon through the samples themselves.
    fn traced(&self, ring: &Ring) -> Outline {
        let RingSamples { runs, .. } = visible::samples(ring, |_| None);
        let mut points: Vec<[f64; 2]> = runs.iter().flatten().map(|sample| sample.point.to_array()).collect();
        if points.len() < 3 {
            points = ring.steps.iter().map(|step| step.crack.start.map(|value| value as f64)).collect();
        }
        let bits = 2.0 * points.len() as f64 * self.ruler.number(0.1);
        Outline { shape: OutlineShape::Path(PathRing::polygon(points)), bits, misfit: 0.0, deviations: Vec::new() }
    }
}

/// The polygon of an outline.
fn polygon(outline: &Outline) -> Option<Vec<[f64; 2]>> {
    let path = Path { rings: vec![outline.shape.ring()], fill: FillRule::EvenOdd };
    let mut polygons = Polygons::default();
    path.boundary().ok()?.flatten(0.1, &mut polygons).ok()?;
    (polygons.vertices.len() > 2).then_some(polygons.vertices)
}
