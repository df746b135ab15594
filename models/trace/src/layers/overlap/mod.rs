//! Things of one color that lie on one another: an outline with corners inward, as the things whose outlines meet there, where that is no longer. These
//! are round, or others of the picture again.
//!
//! | file | holds |
//! |---|---|
//! | `heap` | a heap, and round outlines in it |
//! | `stretch` | what of a boundary lies between corners inward |
//! | `share` | which stretches are of one thing |
//! | `cover` | what these leave uncovered |
//! | `model` | straight things that the picture shows |
//! | `again` | such things that are there again, in a heap |
//!
//! No corner need be told: it is where two outlines meet. A thing of which more than one stretch is seen is told once.

mod again;
mod cover;
mod heap;
mod model;
mod share;
mod stretch;

use alloc::collections::BTreeMap;
use alloc::rc::Rc;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::contains;
use dvp_core::geometry::{LineSegment, convex_hull};
use dvp_core::shape::FillRule;
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::complete::{Completed, Completion};
use super::join::Group;
use super::{raster, walk};
use crate::outline::{Outline, OutlineShape};
use crate::partition::OUTSIDE;
use crate::ruler::Ruler;
use crate::tuning;
use heap::Heap;
use model::Model;
use share::{Part, Shared};
use stretch::Stretches;

/// Windows so near to a corner (pixels) see both sides of it.
const SPOILED: f64 = 2.0;
/// And further by so many standard deviations of the blur, which also fills what is between two things as far from where they are nearest.
const SPOILED_BLURS: f64 = 2.0;
/// What a blur moves an edge by beside another one, standard deviations of the blur.
const BLURRED_SIGMA: f64 = 0.05;
/// Share of the bits of an outline that things in it may need where pixels tell of some of them, and no windows: of heaps of cells most need .45 to .85, of
/// things that are one and uneven .9 and more.
const SURE: f64 = 0.9;
/// Least depth of the notch between two things, as a share of half the size of the smaller: two disks of one size leave as much where 45 % of either is
/// hidden.
const LEAST_NOTCH: f64 = 0.2;
/// Radii closer than so many of their standard deviations together may be equal.
const EQUAL: f64 = 3.0;
/// Most corners outward of one boundary: more are those of something uneven.
const MOST_CORNERS: usize = 64;
/// Least share of an outline that is seen where others may hide the rest.
const LEAST_SEEN: f64 = 0.25;

/// Puts several things where the outlines of a group are those of things that overlap.
pub(super) fn part(completion: &Completion<'_>, groups: &mut [Group]) {
    // Outlines along stairs are moved as a whole.
    if completion.partition.is_hard {
        return;
    }
    let color = |group: &Group| group.faces.first().map(|&face| completion.partition.faces[face as usize].color);
    let mut of_color: BTreeMap<Option<usize>, Vec<&mut Group>> = BTreeMap::new();
    for group in groups {
        of_color.entry(color(group)).or_default().push(group);
    }
    for groups in of_color.into_values() {
        let kinds = model::kinds(groups.iter().map(|group| &*group.completed));
        for group in groups {
            if let Some(parts) = parts(completion, group, &kinds) {
                group.completed = Rc::new(parts);
            }
        }
    }
}

/// The things that a group is; none if it is no heap of such.
fn parts(completion: &Completion<'_>, group: &Group, kinds: &[Vec<Model>]) -> Option<Completed> {
    let completed = &group.completed;
    let is_path = |outline: &Outline| matches!(outline.shape, OutlineShape::Path(_));
    let is_pen = completion.pen(&group.faces).is_some();
    if is_pen || !completed.agrees || !completed.outlines.iter().any(is_path) {
        return None;
    }
    let place = completion.place(&group.faces);
    let mut rings = walk::samples(&completion.walks(&group.faces, place.rank));
    let is_closed = rings.iter().all(|ring| ring.closed);
    // What is seen in parts without anything in front is a line of letters.
    if group.faces.len() > 1 && rings.iter().any(|ring| ring.closed) {
        return None;
    }
    let blur = completion.partition.blur;
    for sample in rings.iter_mut().flat_map(|ring| &mut ring.runs).flatten() {
        sample.sigma = sample.sigma.hypot(BLURRED_SIGMA * blur);
    }
    let mut stretches = Stretches::new(rings, &completed.outlines, SPOILED + SPOILED_BLURS * blur);
    if stretches.corners.len() > MOST_CORNERS {
        return None;
    }
    let may_be_heap = |Vec2 { x, y }: Vec2<f64>| {
        let face = if x < 0.0 || y < 0.0 { OUTSIDE } else { completion.partition.face_at([x as usize, y as usize]) };
        face == OUTSIDE || group.faces.contains(&face) || place.is_behind(face)
    };
    let heap = Heap { may_be: &may_be_heap, ruler: &completion.ruler };
    let again = again::take(kinds, &mut stretches, &heap)?;
    // A blur fills corners.
    if again.is_empty() && blur == 0.0 && !stretches.may_be_round(&completed.outlines) {
        return None;
    }
    let Shared { mut parts, cuts, stretches } = share::share(stretches, completed.bits, &heap)?;
    // Pixels that are covered and should not be, or not and should; where a blur fills the gap between outlines that meet they may be either.
    let reach = SPOILED + 2.0 * SPOILED_BLURS * blur;
    let wrong = |outlines: &[Outline]| {
        let is_filled = |&[x, y]: &[usize; 2]| {
            let middle = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
            blur > 0.0 && cuts.iter().any(|&cut| (cut - middle).length() < reach)
        };
        let mut wrong = completion.check_filled(outlines, FillRule::NonZero, &place).err().unwrap_or_default();
        wrong.retain(|at| !is_filled(at));
        wrong
    };
    let outlines =
        |parts: &[Part]| parts.iter().chain(&again).filter_map(|part| part.outline.clone()).collect::<Vec<_>>();
    let missed = |parts: &[Part]| {
        let mut wrong = wrong(&outlines(parts));
        wrong.retain(|at| group.faces.contains(&completion.partition.face_at(*at)));
        wrong
    };
    // What straight things leave is no thing that is round.
    if again.is_empty() {
        cover::cover(&mut parts, &stretches, &heap, &missed);
    }
    let outlines = outlines(&parts);
    let are_round = again.is_empty();
    parts.extend(again);
    // Of what goes on behind others no pixel tells that it is not there.
    if !is_closed && parts.iter().any(|part| part.seen() < LEAST_SEEN) {
        return None;
    }
    let bits = parts.iter().map(|part| part.bits).sum();
    // What is uneven is not two disks by chance, where edges are clear.
    let is_disk = |outline: &Outline| matches!(outline.shape, OutlineShape::Circle { .. });
    let may_be_one = are_round && (blur > 0.0 || !outlines.iter().all(is_disk));
    if outlines.len() < 2 || may_be_one && !has_notch(&outlines, &cuts, SPOILED + SPOILED_BLURS * blur) {
        return None;
    }
    // As many numbers say either: things that people draw hardly turn inward.
    let are_told = parts.iter().all(|part| part.is_told);
    // A coder makes edges uneven that are not.
    if !are_told && completion.partition.reading.coded && blur == 0.0 {
        return None;
    }
    let saved = tuning::LEAST_SAVED * outlines.len() as f64 + spared(&outlines, &completion.ruler);
    let most = if are_told { completed.bits + saved } else { SURE * completed.bits };
    let wrong = wrong(&outlines);
    // A blur leaves a few wherever outlines are near each other.
    let count = if blur > 0.0 { cover::largest(&wrong).len() } else { wrong.len() };
    let are_right = bits < most && count as f64 <= tuning::MOST_WRONG_PIXELS;
    are_right.then(|| Completed { are_things: true, bits, ..Completed::new(outlines, true) })
}

/// Whether the boundary turns in by more than a little where it was cut between any two outlines: else they are what one thing may be that is uneven.
fn has_notch(outlines: &[Outline], cuts: &[Vec2<f64>], reach: f64) -> bool {
    let outlines: Vec<(Vec<[f64; 2]>, f64)> =
        outlines.iter().filter_map(|outline| Some((raster::polygon(outline)?, heap::extent(outline).1))).collect();
    let distance = |at: Vec2<f64>, polygon: &[[f64; 2]]| {
        LineSegment::closed(polygon).map(|side| side.nearest(at).distance()).fold(f64::INFINITY, f64::min)
    };
    let is_notch = |(one, size): &(Vec<[f64; 2]>, f64), (other, other_size): &(Vec<[f64; 2]>, f64)| {
        let hull = convex_hull(&[one.as_slice(), other].concat());
        let is_deep = |cut: Vec2<f64>| {
            let is_between = distance(cut, one).max(distance(cut, other)) < reach;
            is_between && contains(&hull, cut.to_array()) && distance(cut, &hull) > LEAST_NOTCH * size.min(*other_size)
        };
        cuts.iter().any(|&cut| is_deep(cut))
    };
    (0..outlines.len()).any(|k| outlines[..k].iter().any(|other| is_notch(&outlines[k], other)))
}

/// Bits of radii that are told once: those of a path are equal by now if they are to be.
fn spared(outlines: &[Outline], ruler: &Ruler) -> f64 {
    let radius = |outline: &Outline| match outline.shape {
        OutlineShape::Circle { radius, .. } => Some((radius, outline.covariance.get(8)?.sqrt())),
        _ => None,
    };
    let mut radii: Vec<(f64, f64)> = outlines.iter().filter_map(radius).collect();
    sort::ascending(&mut radii, |&(radius, _)| radius);
    let next = radii.iter().skip(1);
    let are_equal = |(one, other): &(&(f64, f64), &(f64, f64))| other.0 - one.0 < EQUAL * (one.1 + other.1);
    radii.iter().zip(next).filter(are_equal).map(|(one, other)| ruler.number(one.1.max(other.1))).sum()
}
