//! Which of two things lies in front of the other, once what is hidden of them is known from other things.
//!
//! The order of faces was settled before: with outlines that go on behind others as smoothly as they can. A thing that is another one again
//! (`repeat`) is told by three numbers from whatever is seen of it, but only if no boundary of what hides it is taken for its own.

use alloc::vec::Vec;
use core::ops::RangeInclusive;

use super::complete::Completion;
use super::join::Group;
use super::repeat;
use crate::tuning;

/// Puts one of two things that meet just beyond the other, as long as that saves bits.
pub(super) fn swap(completion: &mut Completion<'_>, groups: &mut Vec<Group>) {
    for _ in 0..tuning::MOST_ROUNDS {
        let mut is_changed = false;
        for (back, front) in (1..groups.len()).flat_map(|front| (0..front).map(move |back| (back, front))) {
            is_changed |= exchange(completion, groups, back, front);
        }
        if !is_changed || completion.is_spent() {
            break;
        }
    }
}

/// Puts one of the groups at two places just beyond the other, if that saves more bits than what junctions say against it.
fn exchange(completion: &mut Completion<'_>, groups: &mut Vec<Group>, back: usize, front: usize) -> bool {
    if completion.is_spent() {
        return false;
    }
    let Some(against) = against(completion, &groups[front].faces, &groups[back].faces) else { return false };
    let before = bits(completion, groups, back..=front);
    // Of two that follow each other both moves are one.
    for (from, to) in [(back, front), (front, back)].into_iter().take(front - back) {
        if completion.is_spent() {
            return false;
        }
        let rank = completion.rank.clone();
        let mut moved = groups.clone();
        let group = moved.remove(from);
        moved.insert(to, group);
        completion.paint_groups(&moved);
        // Most that meet are no other thing again in any order; no outline is fitted then.
        if bits(completion, &moved, back..=front) < before {
            complete(completion, &mut moved, back..=front);
            if bits(completion, &moved, back..=front) + against < before - tuning::LEAST_SAVED {
                *groups = moved;
                return true;
            }
        }
        completion.rank = rank;
    }
    false
}

/// Bits that speak against putting what lies in front behind; none where they do not meet, where that is clear, and of what a pen has drawn: it has
/// no outline that goes on.
fn against(completion: &Completion<'_>, front: &[u32], back: &[u32]) -> Option<f64> {
    let meet = |&(face, other): &(u32, u32)| completion.neighbors[face as usize].contains(&other);
    let pairs = front.iter().flat_map(|&face| back.iter().map(move |&other| (face, other))).filter(meet);
    let votes: Vec<f64> = pairs.map(|(face, other)| completion.order.net(face, other)).collect();
    let is_pen = [back, front].iter().any(|faces| completion.pen(faces).is_some());
    let is_open = !is_pen && !votes.is_empty() && votes.iter().all(|vote| vote.abs() < tuning::CLEAR_VOTE);
    is_open.then(|| votes.iter().map(|vote| vote.max(0.0)).sum())
}

/// What is hidden of groups as they are painted now.
fn complete(completion: &Completion<'_>, groups: &mut [Group], places: RangeInclusive<usize>) {
    for at in places.clone() {
        groups[at] = Group::again(completion, groups[at].faces.clone());
    }
    for at in places.rev() {
        repeat::again(completion, groups, at);
    }
}

/// Bits of some of the groups. What is seen whole is another thing again as well as what is hidden, and as short: else what lies in front would be
/// shorter behind.
fn bits(completion: &Completion<'_>, groups: &[Group], places: RangeInclusive<usize>) -> f64 {
    places.map(|at| repeat::least_bits(completion, groups, at)).sum()
}
