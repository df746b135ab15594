//! Branches: stretches of the boundary that run side by side, a width apart, and the nodes at which they end.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;
use dvp_core::{Real, Vec2, sort};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::border::{Border, Hit};
use crate::sample::Sample;
use crate::tuning;

/// A stretch of a line: two stretches of the boundary and what is in the middle between them.
#[derive(Debug)]
pub(super) struct Branch {
    /// Points of the center line, along the walk on its first side.
    pub(super) centers: Vec<Sample>,
}

/// One of the two ends of a branch: twice its number, plus one for the end at which the centers end.
pub(super) type End = usize;

/// Where branches end: one for a free end of a line, two for a corner, three and more for a junction.
#[derive(Debug, Default)]
pub(super) struct Node {
    pub(super) ends: Vec<End>,
    /// The marks between two stretches that follow each other on the boundary: the end of a branch after which they come, the
    /// end that they lead to, and they themselves.
    pub(super) between: Vec<(End, End, Vec<usize>)>,
    /// Whether the boundary is not seen whole there: the border of the picture may cut the line.
    pub(super) is_cut: bool,
}

/// The width of the pen: the most frequent distance across the face, if there is one and the face is that long.
///
/// Only some of the marks are asked: most faces are no strokes.
pub(super) fn pen_width(border: &Border) -> Option<f64> {
    let (length, area) = border.measures();
    // Twice the area per length is the width of a long stroke, and less than twice that of any other one.
    let limit = 4.0 * area / length;
    let every = (border.marks.len() / tuning::STROKE_PROBES).max(1);
    let asked = (0..border.marks.len()).step_by(every);
    let mut widths: Vec<_> = asked.clone().filter_map(|mark| Some(border.across(mark, limit)?.distance)).collect();
    let width = sort::median(&mut widths)?;
    let agreeing = widths.iter().filter(|&&other| is_as_wide(other, width)).count();
    let is_most = agreeing as f64 >= tuning::STROKE_PAIRED_SHARE * asked.count() as f64;
    (is_most && length >= tuning::STROKE_LEAST_LENGTH * width).then_some(width)
}

/// Whether the distance across the face at one place may be the width of the pen.
fn is_as_wide(distance: f64, width: f64) -> bool {
    (distance - width).abs() <= tuning::STROKE_WIDTH_TOLERANCE * width.max(2.0)
}

/// What a face is made of if a pen drew it.
#[derive(Debug)]
pub(super) struct Skeleton {
    pub(super) branches: Vec<Branch>,
    pub(super) nodes: Vec<Node>,
    /// Width of the pen.
    pub(super) width: f64,
    /// What the width of the pen, which does not change, tells of the marks.
    pub(super) noise: Noise,
}

/// By how much marks are off, standard deviations in pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noise {
    /// Each by itself.
    pub(super) single: f64,
    /// All of [`BLOCK`] side by side.
    pub(super) block: f64,
}

/// Marks side by side that a renderer's lattice of sub-pixels moves by about the same.
pub(super) const BLOCK: usize = 16;

/// The branches of a face that is about `width` wide.
pub(super) fn skeleton(border: &Border, width: f64) -> Skeleton {
    let limit = width + tuning::STROKE_WIDTH_TOLERANCE * width.max(2.0);
    let hits: Vec<_> = (0..border.marks.len())
        .map(|mark| border.across(mark, limit).filter(|hit| is_as_wide(hit.distance, width)))
        .collect();
    let (width, noise) = measure(&hits, width);
    let least_marks = Real::to_count(width / 6.0).max(3);
    let mut sides = Sides {
        border,
        hits: &hits,
        labels: vec![None; hits.len()],
        branches: Vec::new(),
        lasts: Vec::new(),
        least_marks,
    };
    let mut start = 0;
    while start < hits.len() {
        start = sides.take(start);
    }
    let nodes = sides.nodes();
    Skeleton { branches: sides.branches, nodes, width, noise }
}

/// The width by blocks of marks, and what is left unexplained by it, per side of the line. To start with, the renderer's lattice
/// moves blocks as of one block.
fn measure(hits: &[Option<Hit>], width: f64) -> (f64, Noise) {
    let spread = |block: &[Option<Hit>]| {
        let count = block.len() as f64;
        let mean = block.iter().flatten().map(|hit| hit.distance).sum::<f64>() / count;
        let squares: f64 = block.iter().flatten().map(|hit| (hit.distance - mean).powi(2)).sum();
        block.iter().all(Option::is_some).then_some((mean, squares / (count - 1.0)))
    };
    let blocks: Vec<_> =
        hits.chunks_exact(BLOCK).filter_map(spread).filter(|block| (block.0 - width).abs() < 0.5).collect();
    let count = blocks.len() as f64;
    let width = if blocks.is_empty() { width } else { blocks.iter().map(|block| block.0).sum::<f64>() / count };
    let squares: f64 = blocks.iter().map(|block| 0.5 * (block.0 - width).powi(2)).sum();
    let block = ((squares + tuning::STROKE_OFFSET.powi(2)) / (count + 1.0)).sqrt();
    // Blocks at ends of bends have jumps: the median.
    let mut singles: Vec<_> = blocks.iter().map(|block| (0.5 * block.1).sqrt()).collect();
    let single = sort::median(&mut singles).unwrap_or(0.0);
    (
        width,
        Noise {
            single: single.min(tuning::STROKE_OFFSET),
            block: block.clamp(0.5 * tuning::STROKE_OFFSET, tuning::STROKE_OFFSET),
        },
    )
}

/// Branches on the way.
struct Sides<'a> {
    border: &'a Border,
    hits: &'a [Option<Hit>],
    /// The end of a branch that a walk along the boundary comes to after a mark on its side: twice the number of the branch, plus one on
    /// the first side.
    labels: Vec<Option<End>>,
    branches: Vec<Branch>,
    /// The last mark of each side, in the order of ends.
    lasts: Vec<usize>,
    /// Fewer marks side by side are chance, as at the base of a round end.
    least_marks: usize,
}

impl Sides<'_> {
    /// Whether a mark and what lies across from it are in no branch yet.
    fn free(&self, mark: usize) -> Option<&Hit> {
        let hit = self.hits.get(mark)?.as_ref()?;
        let is_taken = |mark: usize| self.labels.get(mark).is_none_or(Option::is_some);
        (!is_taken(mark) && !is_taken(hit.mark)).then_some(hit)
    }

    /// Makes a branch of the marks from `start` on, as far as they run along what lies across from them. Returns where to go on.
    fn take(&mut self, start: usize) -> usize {
        let Some(first) = self.free(start).copied() else { return start + 1 };
        let (mut last, mut hit) = (start, first);
        let mut back = 0.0;
        while let Some(next) = self.free(last + 1).copied() {
            let Some(steps) =
                self.border.steps_back(&hit, &next).filter(|&steps| self.goes_on(last, &hit, &next, steps))
            else {
                break;
            };
            (last, hit, back) = (last + 1, next, back + steps);
        }
        let far = self.border.before(&first, back);
        if last + 1 < start + self.least_marks || far.is_empty() {
            return last + 1;
        }
        let end = 2 * self.branches.len();
        for mark in start..=last {
            self.labels[mark] = Some(end + 1);
        }
        for &mark in &far {
            self.labels[mark].get_or_insert(end);
        }
        self.lasts.extend([far.last().copied().unwrap_or(first.mark), last]);
        let centers = (start..=last).filter_map(|mark| self.center(mark)).collect();
        self.branches.push(Branch { centers });
        last + 1
    }

    /// Whether the hit of the mark after `last` continues that of `last`: on the same run, backward, and not by a jump.
    fn goes_on(&self, last: usize, hit: &Hit, next: &Hit, steps: f64) -> bool {
        let places = [hit, next].map(|hit| self.landing(hit));
        let marks = [last, last + 1].map(|mark| self.border.marks[mark].point);
        let jump = (places[1] - places[0]).length();
        self.border.next(last) == Some(last + 1) && steps >= -0.5 && jump <= 3.0 * (marks[1] - marks[0]).length() + 1.0
    }

    /// The point of the boundary that a ray hit.
    fn landing(&self, hit: &Hit) -> Vec2<f64> {
        let from = self.border.marks[hit.mark].point;
        let to = self.border.next(hit.mark).map_or(from, |next| self.border.marks[next].point);
        from.lerp(to, hit.share)
    }

    /// The point in the middle between a mark and what lies across from it.
    fn center(&self, mark: usize) -> Option<Sample> {
        let hit = self.hits.get(mark)?.as_ref()?;
        let from = self.border.marks.get(mark)?;
        let sigma = 0.5 * from.sigma.hypot(self.border.marks.get(hit.mark)?.sigma);
        let point = from.point + from.inward * (0.5 * hit.distance);
        Some(Sample::new(point, from.inward, sigma))
    }

    /// What each end of a branch leads to: the stretches that follow each other on the boundary end at the same node.
    fn nodes(&self) -> Vec<Node> {
        let ends = u32::try_from(self.lasts.len()).unwrap_or(u32::MAX);
        let mut sets = DisjointSets::default();
        sets.reset(ends);
        let mut links = Vec::new();
        let mut cut = vec![false; self.lasts.len()];
        for (end, &last) in self.lasts.iter().enumerate() {
            let mut marks = Vec::new();
            let mut at = self.border.next(last);
            cut[end] |= self.border.is_last(last);
            while let Some(mark) = at.filter(|_| marks.len() < self.labels.len()) {
                if let Some(label) = self.labels[mark] {
                    // A side that comes to one end of its branch has started at the other.
                    let start = label ^ 1;
                    sets.unite(index(end), index(start));
                    links.push((end, start, marks));
                    break;
                }
                marks.push(mark);
                cut[end] |= self.border.is_last(mark);
                at = self.border.next(mark);
            }
        }
        let mut nodes: Vec<_> = (0..self.lasts.len()).map(|_| Node::default()).collect();
        for end in 0..self.lasts.len() {
            let node = &mut nodes[sets.root(index(end)) as usize];
            node.ends.push(end);
            node.is_cut |= cut[end];
        }
        for link in links {
            nodes[sets.root(index(link.0)) as usize].between.push(link);
        }
        nodes.retain(|node| !node.ends.is_empty());
        nodes
    }
}

fn index(end: End) -> u32 {
    u32::try_from(end).unwrap_or(u32::MAX)
}

impl Branch {
    /// Where the branch ends, which way it points there, out of the branch, and by how much it turns per pixel, toward that end.
    pub(super) fn tip(&self, end: End) -> (Vec2<f64>, Vec2<f64>, f64) {
        let count = self.centers.len();
        let nth = |k: usize| {
            let k = k.min(count.saturating_sub(1));
            self.centers.get(if end % 2 == 1 { count - 1 - k } else { k })
        };
        let (Some(tip), Some(inner), Some(far)) = (nth(0), nth(2), nth(10)) else { return Default::default() };
        // Across the axes: bends turn them less than chords; out of the branch.
        let out = |at: &Sample, chord: Vec2<f64>| at.axis.perp() * 1f64.copysign(at.axis.perp().dot(chord));
        let [near, away] = [inner, far].map(|at| out(at, tip.point - nth(4).unwrap_or(at).point));
        let length = (inner.point - far.point).length();
        let bend = if length > 3.0 { away.cross(near).atan2(away.dot(near)) / length } else { 0.0 };
        (tip.point, near, bend)
    }
}
