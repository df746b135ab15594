//! Chains: branches that a pen drew in one go, through junctions and around corners.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::LineSegment;
use dvp_core::{Vec2, sort};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::border::Border;
use super::branch::{BLOCK, Branch, End, Node, Skeleton};
use crate::sample::Sample;
use crate::tuning;

/// A line before its center is fitted.
#[derive(Debug)]
pub(super) struct Chain {
    /// Points of the center line from corner to corner.
    pub(super) stretches: Vec<Vec<Sample>>,
    /// Whether it closes on itself: around a corner, or smoothly if there is one stretch and `is_smooth`.
    pub(super) is_closed: bool,
    /// Whether a closed one has no corner at its start.
    pub(super) is_smooth: bool,
    /// What is at its two ends.
    pub(super) tips: [Tip; 2],
}

/// What is at the end of a chain that is not closed.
#[derive(Clone, Debug, Default)]
pub(super) enum Tip {
    /// The end of the line, with the marks around it, or where the border of the picture cuts it, if that may be (`is_cut`).
    Free { marks: Vec<usize>, is_cut: bool },
    /// Other lines.
    Junction,
    /// What is not seen.
    #[default]
    Hidden,
}

/// How a branch goes on.
#[derive(Clone, Debug)]
struct Link {
    to: End,
    is_corner: bool,
    /// Points of the center line on the way.
    bend: Vec<Sample>,
}

/// Two ends at a node, as one line through it.
#[derive(Clone, Copy, Debug)]
struct Passage {
    ends: [End; 2],
    /// How far the line turns, radians.
    turn: f64,
    is_straight: bool,
}

impl Passage {
    fn new(branches: &[Branch], ends: [End; 2], width: f64) -> Self {
        let [(from, out, bend), (to, back, other_bend)] = ends.map(|end| tip(branches, end));
        let gap = to - from;
        let turn = out.cross(-back).atan2(-out.dot(back));
        // What both sides would turn by on the way if they bend on as they do; the second is walked the other way.
        let expected = 0.5 * (bend - other_bend) * gap.length();
        // On a circle the chord points half the turn away.
        let middle = out.turned(Vec2::from_angle(0.5 * turn));
        let aside = gap.cross(middle).abs();
        let is_straight = (turn - expected).abs() <= tuning::STROKE_STRAIGHT_TURN && aside <= 0.3 * width;
        Self { ends, turn: (turn - expected).abs() + aside / width, is_straight }
    }
}

/// Where a branch ends, which way it points there, and by how much it turns per pixel, toward that end.
fn tip(branches: &[Branch], end: End) -> (Vec2<f64>, Vec2<f64>, f64) {
    branches.get(end / 2).map(|branch| branch.tip(end)).unwrap_or_default()
}

/// The chains of all branches.
pub(super) fn chains(border: &Border, skeleton: &Skeleton) -> Vec<Chain> {
    let Skeleton { branches, nodes, width, .. } = skeleton;
    let (branches, width) = (&branches[..], *width);
    let mut links: Vec<Option<Link>> = vec![None; 2 * branches.len()];
    let mut tips = vec![Tip::Hidden; links.len()];
    for node in nodes {
        for passage in passages(branches, node, width) {
            link(border, branches, node, passage, width, &mut links);
        }
        for &end in &node.ends {
            tips[end] = match (node.ends.len(), node.between.first()) {
                (1, Some((_, _, marks))) => Tip::Free { marks: marks.clone(), is_cut: node.is_cut },
                (1, None) => Tip::Hidden,
                _ => Tip::Junction,
            };
        }
    }
    let mut walk = Walk { branches, links: &links, is_used: vec![false; branches.len()] };
    // From ends first, then around corners, then around what has neither.
    let ends = || 0..links.len();
    let open = ends().filter(|&end| links[end].is_none());
    let corners = ends().filter(|&end| links[end].as_ref().is_some_and(|link| link.is_corner));
    let starts: Vec<_> = open.chain(corners).chain(ends()).collect();
    let mut chains: Vec<_> = starts.into_iter().filter_map(|start| walk.from(start, &tips)).collect();
    chains.iter_mut().flat_map(|chain| &mut chain.stretches).for_each(|stretch| thin_out(stretch, skeleton));
    chains
}

/// Keeps what a pen of that width can show of its center line, each with the doubt of the whole block that it stands for.
fn thin_out(stretch: &mut Vec<Sample>, skeleton: &Skeleton) {
    // Short ones keep some all the same.
    let steps = stretch.iter().zip(stretch.iter().skip(1));
    let pace = (skeleton.width / 8.0).min(steps.map(|(a, b)| (b.point - a.point).length()).sum::<f64>() / 10.0);
    let last = stretch.last().map(|sample| sample.point);
    let mut kept: Option<Vec2<f64>> = None;
    stretch.retain_mut(|sample| {
        let is_needed = kept.is_none_or(|kept| (sample.point - kept).length() >= pace) || Some(sample.point) == last;
        if is_needed {
            kept = Some(sample.point);
        }
        is_needed
    });
    // Samples of one block are off together: as many as it has count as one.
    let shared = 0.5 * skeleton.noise.block.powi(2) * (BLOCK as f64 / pace.max(1.0)).max(1.0);
    stretch.iter_mut().for_each(|sample| sample.sigma = (sample.sigma.powi(2) + shared).sqrt());
}

/// Which ends at a node belong together: what goes straight on does, and of the rest what turns least.
fn passages(branches: &[Branch], node: &Node, width: f64) -> Vec<Passage> {
    let ends = &node.ends;
    let mut all: Vec<_> = (0..ends.len())
        .flat_map(|i| (i + 1..ends.len()).map(move |k| [i, k]))
        .map(|pair| Passage::new(branches, pair.map(|i| ends[i]), width))
        .collect();
    // What turns least first, of what is straight and then of the rest.
    sort::ascending(&mut all, |passage| passage.turn);
    sort::descending(&mut all, |passage| f64::from(u8::from(passage.is_straight)));
    let mut taken: Vec<End> = Vec::new();
    all.retain(|passage| {
        let is_free = passage.ends.iter().all(|end| !taken.contains(end));
        if is_free {
            taken.extend(passage.ends);
        }
        is_free
    });
    all
}

/// Joins two ends: smoothly, by a bend through what is seen of the outer side, or around a corner.
fn link(border: &Border, branches: &[Branch], node: &Node, passage: Passage, width: f64, links: &mut [Option<Link>]) {
    let ends = passage.ends;
    let [(from, out, _), (to, back, _)] = ends.map(|end| tip(branches, end));
    let between = |ends: [End; 2]| node.between.iter().find(|link| link.0 == ends[0] && link.1 == ends[1]);
    // The outer side of a bend is the longer one.
    let sides = [between(ends), between([ends[1], ends[0]])];
    let is_second = sides.map(|side| side.map_or(0, |side| side.2.len()));
    let is_second = is_second[1] > is_second[0];
    let outer: &[usize] = sides[usize::from(is_second)].map_or(&[], |side| &side.2);
    let mut bend: Vec<Sample> = Vec::new();
    let mut is_corner = !passage.is_straight;
    if node.ends.len() == 2 {
        bend.extend(
            outer
                .iter()
                .filter_map(|&mark| border.marks.get(mark))
                .map(|mark| Sample::new(mark.point + mark.inward * (0.5 * width), mark.inward, mark.sigma)),
        );
        if let (true, Some(corner)) = (is_corner, meeting([from, out], [to, back])) {
            // The pen has been in a corner, but cuts past it in a bend, by the more the rounder that is.
            let steps = bend.iter().zip(bend.iter().skip(1));
            let passes = steps.map(|(a, b)| LineSegment::new(a.point, b.point).nearest(corner).distance());
            let rounded = 0.5 * (to - from).length() * (0.25 * passage.turn).tan();
            is_corner =
                passes.fold(f64::INFINITY, f64::min) < 0.1 * rounded + 2.0 * tuning::STROKE_OFFSET || bend.is_empty();
        }
        if is_corner {
            bend.clear();
        }
    }
    let mut reversed = bend.clone();
    reversed.reverse();
    if is_second {
        core::mem::swap(&mut bend, &mut reversed);
    }
    links[ends[0]] = Some(Link { to: ends[1], is_corner, bend });
    links[ends[1]] = Some(Link { to: ends[0], is_corner, bend: reversed });
}

/// Where two lines, each a point and a direction, meet; none for parallel ones.
pub(super) fn meeting([from, out]: [Vec2<f64>; 2], [to, back]: [Vec2<f64>; 2]) -> Option<Vec2<f64>> {
    let cross = out.cross(back);
    (cross.abs() > 1e-3).then(|| from + out * ((to - from).cross(back) / cross))
}

struct Walk<'a> {
    branches: &'a [Branch],
    links: &'a [Option<Link>],
    is_used: Vec<bool>,
}

impl Walk<'_> {
    /// The chain that enters a branch at `start`, if it is not used yet.
    fn from(&mut self, start: End, tips: &[Tip]) -> Option<Chain> {
        let mut stretches = vec![Vec::new()];
        let (mut at, mut is_closed) = (start, false);
        while !core::mem::replace(self.is_used.get_mut(at / 2)?, true) {
            let centers = &self.branches.get(at / 2)?.centers;
            let stretch = stretches.last_mut()?;
            if at % 2 == 0 {
                stretch.extend(centers)
            } else {
                stretch.extend(centers.iter().rev())
            }
            at ^= 1;
            let Some(link) = self.links.get(at)?.as_ref() else { break };
            stretch.extend(&link.bend);
            is_closed = link.to == start;
            if link.is_corner && !is_closed {
                stretches.push(Vec::new());
            }
            at = link.to;
        }
        let is_smooth = is_closed && !self.links.get(start)?.as_ref()?.is_corner;
        let end = |end: End| tips.get(end).cloned().unwrap_or_default();
        let tips = if is_closed { [Tip::Hidden, Tip::Hidden] } else { [end(start), end(at)] };
        (!stretches[0].is_empty()).then_some(Chain { stretches, is_closed, is_smooth, tips })
    }
}
