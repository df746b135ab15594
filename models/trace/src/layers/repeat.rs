//! Things that are others again, elsewhere, in another size, or reflected: what is seen of one tells what is hidden of the other.
//!
//! A thing that others hide in part is held against the outlines of every other thing of the picture (`template`), and takes those that
//! cover what it should, where three numbers in place of an outline are the shorter description. Things may be upside down or mirrored, but are
//! not turned.

use alloc::rc::Rc;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::{LineSegment, Similarity};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::complete::{Completed, Completion};
use super::frame;
use super::join::Group;
use super::swap;
use super::visible::Hidden;
use super::walk::Walk;
use crate::outline::Outline;
use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// Most edges of a template: more are no straight shape.
const MOST_EDGES: usize = 96;
/// Pixels that shift and scale of a thing are known to.
const SIGMA: f64 = 0.01;

/// Takes another thing's outlines for what is hidden in part, where that is the shorter description; then leaves out what was painted in the
/// color of the background only because others were thought to lie there.
pub(super) fn repeat(completion: &mut Completion<'_>, groups: &mut Vec<Group>) {
    if groups.len() < 2 || completion.is_spent() {
        return;
    }
    unite(completion, groups);
    // What lies in front is hidden less, and tells of what lies behind.
    (0..groups.len()).rev().for_each(|at| again(completion, groups, at));
    swap::swap(completion, groups);
    let painted_ground = |at: &usize| completion.shows_background(groups[*at].faces[0]);
    for at in (0..groups.len()).rev().filter(painted_ground).collect::<Vec<_>>() {
        let ranks: Vec<usize> = groups[at].faces.iter().map(|&face| completion.rank(face)).collect();
        groups[at].faces.iter().for_each(|&face| completion.rank[face as usize] = 0);
        let leaves_it = |(other, group): (usize, &Group)| {
            let is_pen = completion.pen(&group.faces).is_some();
            other == at || !is_pen && completion.shows_only(&group.faces, &group.completed)
        };
        if groups.iter().enumerate().all(leaves_it) {
            groups.remove(at);
        } else {
            groups[at].faces.iter().zip(ranks).for_each(|(&face, rank)| completion.rank[face as usize] = rank);
        }
    }
}

/// Takes the outlines of another thing for those of a group that is hidden in part, where these are the shorter description.
pub(super) fn again(completion: &Completion<'_>, groups: &mut [Group], at: usize) {
    if is_hidden(completion, &groups[at].faces)
        && let Some(found) = best(completion, groups, &[at], groups[at].completed.bits)
    {
        groups[at].completed = Rc::new(found);
    }
}

/// Bits of a group, as another thing again if that is shorter, be it hidden or not.
pub(super) fn least_bits(completion: &Completion<'_>, groups: &[Group], at: usize) -> f64 {
    let bits = groups[at].completed.bits;
    best(completion, groups, &[at], bits).map_or(bits, |found| found.bits)
}

/// Makes one thing of all things of a color, where they are another thing again together.
fn unite(completion: &mut Completion<'_>, groups: &mut Vec<Group>) {
    let color = |group: &Group, completion: &Completion<'_>| completion.partition.faces[group.faces[0] as usize].color;
    let mut colors: Vec<usize> = groups.iter().map(|group| color(group, completion)).collect();
    colors.sort_unstable();
    colors.dedup();
    for wanted in colors {
        let apart = completion.apart();
        let is_wanted = |at: &usize| color(&groups[*at], completion) == wanted;
        let is_apart = |at: &usize| groups[*at].faces.iter().any(|face| apart.contains(face));
        let of_color: Vec<usize> = (0..groups.len()).filter(is_wanted).filter(|at| !is_apart(at)).collect();
        let [first, .., _] = of_color[..] else { continue };
        if of_color.len() > tuning::MOST_PAIRED {
            continue;
        }
        let faces: Vec<u32> = of_color.iter().flat_map(|&at| &groups[at].faces).copied().collect();
        let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
        let apart: f64 = of_color.iter().map(|&at| groups[at].completed.bits + tuning::THING_BITS).sum();
        completion.sink(&faces);
        // What lies in front of all of it now must leave it seen.
        let is_seen = |completion: &Completion<'_>| {
            let others = groups.iter().enumerate().filter(|(at, _)| !of_color.contains(at)).map(|(_, group)| group);
            others.into_iter().all(|group| completion.holds(&group.faces, &group.completed))
        };
        let is_hidden = is_hidden(completion, &faces);
        let united = is_hidden.then(|| best(completion, groups, &of_color, apart - tuning::THING_BITS)).flatten();
        if let Some(completed) = united.filter(|_| is_seen(completion)) {
            groups[first] = Group { faces, completed: Rc::new(completed) };
            of_color[1..].iter().rev().for_each(|&at| drop(groups.remove(at)));
        } else {
            faces.iter().zip(ranks).for_each(|(&face, rank)| completion.rank[face as usize] = rank);
        }
    }
}

/// The boundaries of what is painted together, but for those that are filled.
fn walks<'a>(completion: &'a Completion<'_>, faces: &[u32]) -> Vec<Walk<'a>> {
    let mut walks = completion.walks(faces, completion.hindmost(faces));
    walks.retain(|walk| !walk.is_filled);
    walks
}

/// Whether something of what is painted together may go on behind something else.
fn is_hidden(completion: &Completion<'_>, faces: &[u32]) -> bool {
    walks(completion, faces).iter().any(|walk| walk.hidden.contains(&Some(Hidden::Free)))
}

/// The outlines of another thing, moved, that some groups together are described by in less than `most` bits.
fn best(completion: &Completion<'_>, groups: &[Group], own: &[usize], most: f64) -> Option<Completed> {
    let faces: Vec<u32> = own.iter().flat_map(|&at| &groups[at].faces).copied().collect();
    let place = completion.place(&faces);
    let choices = groups.len() * flips().len();
    let numbers = 3.0 * completion.ruler.number(SIGMA) + (choices as f64).log2() + tuning::OUTLINE_PIECE_BITS;
    if place.rank == 0 || completion.pen(&faces).is_some() || numbers >= most - tuning::LEAST_SAVED {
        return None;
    }
    completion.memo.look(choices);
    let rings: Vec<RingSamples> = walks(completion, &faces).iter().map(|walk| walk.samples()).collect();
    let runs: Vec<&Vec<Sample>> = rings.iter().flat_map(|ring| &ring.runs).collect();
    let frames = frame::frames(&runs);
    let own_sides: Vec<LineSegment<f64>> = own.iter().flat_map(|&at| groups[at].completed.sides()).copied().collect();
    let seen = completion.memo.seen(runs.into_iter().flatten().copied().collect(), &own_sides);
    let mut best: Option<Completed> = None;
    let others = (0..groups.len()).filter(|at| !own.contains(at)).map(|at| &*groups[at].completed);
    let agreeing = others.filter(|template| !template.outlines.is_empty() && template.agrees);
    let straight: Vec<&Completed> = agreeing.filter(|template| template.sides().len() <= MOST_EDGES).collect();
    let others = straight.into_iter().flat_map(|template| flips().map(move |flip| (template, flip, numbers)));
    // A frame is told by one number more, and is the same upside down.
    let frames = frames.iter().map(|frame| (frame, Similarity::identity(), numbers + completion.ruler.number(SIGMA)));
    for (template, flip, numbers) in others.chain(frames) {
        if completion.is_spent() {
            break;
        }
        let flipped = |edge: &LineSegment<f64>| LineSegment {
            from: flip.point(edge.from),
            along: flip.direction(edge.along),
            ..*edge
        };
        let edges: Vec<LineSegment<f64>> = template.sides().iter().map(flipped).collect();
        let Some((map, misfit)) = completion.memo.placed(&seen, &edges) else { continue };
        let bits = numbers + completion.ruler.misfit(misfit);
        if bits >= best.as_ref().map_or(most - tuning::LEAST_SAVED, |best| best.bits) {
            continue;
        }
        let count = template.outlines.len() as f64;
        let map = flip.then(&map);
        let moved = |outline: &Outline| Outline {
            shape: outline.shape.moved(&map),
            bits: numbers / count,
            misfit: completion.ruler.misfit(misfit) / count,
            covariance: Vec::new(),
        };
        let outlines: Vec<Outline> = template.outlines.iter().map(moved).collect();
        if completion.check(&outlines, &place).is_ok() {
            best = Some(Completed::new(outlines, true));
        }
    }
    best
}

/// A template as it is, upside down, and mirrored.
fn flips() -> [Similarity<f64>; 3] {
    let flip = |x: f64, reflected: bool| Similarity { turn: Vec2::new(x, 0.0), reflected, ..Similarity::identity() };
    [flip(1.0, false), flip(1.0, true), flip(-1.0, true)]
}
