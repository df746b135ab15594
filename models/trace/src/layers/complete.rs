//! Outlines through what is seen of a layer, completed where others hide it.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::shape::{FillRule, Outline as Polygons, Path, PathRing, Shape as _};

use super::visible::{self, Hidden};
use super::raster;
use crate::boundary::{Ring, Step, walk_mask};
use crate::outline::{Outline, OutlineShape, fit_closed};
use crate::partition::{OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::sample::RingSamples;
use crate::stroke::StrokeFit;

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

    /// The outlines of faces that are painted together, at the place of the hindmost of them.
    pub(super) fn outlines(&self, group: &[u32]) -> Completed {
        let rank = group.iter().map(|&face| self.rank(face)).min().unwrap_or(0);
        let walked;
        let rings: &[Ring] = match group {
            [face] => &self.rings[*face as usize],
            _ => {
                walked = self.walk(group, rank);
                &walked
            }
        };
        let wanted = |label: u32| {
            if group.contains(&label) {
                Some(true)
            } else if self.rank(label) > rank {
                None
            } else {
                Some(false)
            }
        };
        for policy in [Policy::Free, Policy::Border, Policy::Pinned] {
            let hidden = |step: &Step| self.hidden(step, group, rank);
            // A hole that is filled by what lies in front of it is none.
            let is_ring = |ring: &&Ring| ring.area > 0.0 || ring.steps.iter().any(|step| hidden(step).is_none());
            let needed = |step: &Step| hidden(step).and_then(|hidden| policy.of(step, hidden));
            let fits = rings.iter().filter(is_ring).filter_map(|ring| fit_closed(&visible::samples(ring, needed), &self.ruler));
            let outlines: Vec<Outline> = fits.collect();
            if self.agrees(&outlines, wanted) {
                return Completed::new(outlines, true);
            }
        }
        if group.len() > 1 {
            return Completed::new(Vec::new(), false);
        }
        // Nothing is completed: all around what is seen.
        let seen: Vec<Outline> =
            rings.iter().filter_map(|ring| fit_closed(&visible::samples(ring, |_| None), &self.ruler)).collect();
        if self.agrees(&seen, wanted) {
            return Completed::new(seen, true);
        }
        Completed::new(rings.iter().map(|ring| self.traced(ring)).collect(), false)
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
