//! Chains of windows across thin lines, and which of them are one line.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::Vec2;
use dvp_core::geometry::LineSegment;
use dvp_core::sort;

use super::cross::{Along, Canvas, Cross};
use crate::tuning;

/// A window of a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    pub(super) along: Along,
    pub(super) cross: Cross,
    /// Middle of the line, pixels.
    pub(super) point: Vec2<f64>,
    /// Width along the window, pixels.
    pub(super) width: f64,
    /// Whether another line is in the window, too.
    pub(super) is_shared: bool,
}

impl Mark {
    /// The axis that the window lies along.
    pub(super) fn axis(&self) -> Vec2<f64> {
        match self.along {
            Along::Columns => Vec2::new(0.0, 1.0),
            Along::Rows => Vec2::new(1.0, 0.0),
        }
    }

    pub(super) fn place(&mut self, center: f64, width: f64) {
        let line = self.cross.line as f64 + 0.5;
        self.point = match self.along {
            Along::Columns => Vec2::new(line, center),
            Along::Rows => Vec2::new(center, line),
        };
        self.width = width;
    }
}

/// Windows in order along a line.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) marks: Vec<Mark>,
    /// Colors that explain all windows, bits.
    pub(super) colors: u128,
    /// Whether the last is followed by the first.
    pub(super) is_closed: bool,
    /// Median width across the line, pixels.
    pub(super) width: f64,
}

impl Chain {
    pub(super) fn new(along: Along, cross: Cross, center: f64, width: f64) -> Self {
        let mut chain = Self { marks: Vec::new(), colors: cross.colors, is_closed: false, width };
        chain.push(along, cross, center, width);
        chain
    }

    pub(super) fn push(&mut self, along: Along, cross: Cross, center: f64, width: f64) {
        let mut mark = Mark { along, cross, point: Vec2::default(), width, is_shared: false };
        mark.place(center, width);
        self.colors &= cross.colors;
        self.marks.push(mark);
    }

    pub(super) fn last_line(&self) -> usize {
        self.marks.last().map_or(usize::MAX - 1, |mark| mark.cross.line)
    }

    pub(super) fn last_center(&self, along: Along) -> f64 {
        self.marks.last().map_or(f64::INFINITY, |mark| match along {
            Along::Columns => mark.point.y,
            Along::Rows => mark.point.x,
        })
    }

    /// How wide the line is across at each of its windows, pixels.
    pub(super) fn widths(&self) -> Vec<f64> {
        let n = self.marks.len();
        let width = |k: usize| {
            let step = self.marks[(k + 3).min(n - 1)].point - self.marks[k.saturating_sub(3)].point;
            let along = step.normalized().unwrap_or_default();
            self.marks[k].width * along.perp().dot(self.marks[k].axis()).abs().max(0.6)
        };
        (0..n).map(width).collect()
    }

    /// The way from each of its windows to the next.
    fn steps(&self) -> impl Iterator<Item = [Vec2<f64>; 2]> + Clone {
        self.marks.windows(2).map(|pair| [pair[0].point, pair[1].point])
    }

    /// Least and greatest coordinates of its windows' middles.
    pub(super) fn bounds(&self) -> [Vec2<f64>; 2] {
        let points = || self.marks.iter().map(|mark| mark.point);
        let least =
            points().fold(Vec2::new(f64::INFINITY, f64::INFINITY), |a, b| Vec2::new(a.x.min(b.x), a.y.min(b.y)));
        let most = points().fold(-least, |a, b| Vec2::new(a.x.max(b.x), a.y.max(b.y)));
        [least, most]
    }

    /// The first and the last point, each with the direction out of the line there.
    pub(super) fn ends(&self) -> [[Vec2<f64>; 2]; 2] {
        [self.tip(false), self.tip(true)]
    }

    /// The first or last point, and the direction out of the line there.
    fn tip(&self, at_finish: bool) -> [Vec2<f64>; 2] {
        let n = self.marks.len();
        let (end, inner) = if at_finish { (n - 1, n.saturating_sub(6)) } else { (0, 5.min(n - 1)) };
        let [end, inner] = [end, inner].map(|k| self.marks[k].point);
        [end, (end - inner).normalized().unwrap_or_default()]
    }
}

/// The middle one of some values, in order of their size; 0 if there are none.
pub(super) fn median(values: &[f64]) -> f64 {
    sort::median(&mut values.to_vec()).unwrap_or(0.0)
}

/// Ends of chains, by their number: twice the chain's, and one more for its finish.
struct Joint {
    cost: f64,
    ends: [usize; 2],
}

/// Joins chains that go on from one to the other: around corners at once, straight on across what crosses them.
pub(super) fn join(canvas: &Canvas<'_>, chains: Vec<Chain>) -> Vec<Chain> {
    let tips: Vec<[Vec2<f64>; 2]> = (0..2 * chains.len()).map(|end| chains[end / 2].tip(end % 2 == 1)).collect();
    let mut joints = Vec::new();
    // Wider lines hide more of one another.
    let longest = tuning::THIN_GAP * (canvas.widest / tuning::THIN_WIDTH);
    for [a, b] in near_pairs(&tips, longest) {
        let [[from, out], [to, other_out]] = [tips[a], tips[b]];
        let gap = to - from;
        let distance = gap.length();
        if chains[a / 2].colors & chains[b / 2].colors == 0
            || a / 2 == b / 2 && (chains[a / 2].marks.len() as f64) < 8.0 + 4.0 * distance
        {
            continue;
        }
        let turn = (-out.dot(other_out)).clamp(-1.0, 1.0).acos();
        let aside = out.cross(gap).abs().max(other_out.cross(gap).abs());
        // Where columns give way to rows both have read the same stretch.
        let overlap = if chains[a / 2].marks[0].along == chains[b / 2].marks[0].along { 0.5 } else { longest };
        let is_straight =
            turn < tuning::STROKE_STRAIGHT_TURN && out.dot(gap) > -overlap && aside < 1.0 + 0.25 * distance;
        let is_corner = distance < 3.5 && turn < 2.4 && out.dot(gap) > -1.5 && other_out.dot(gap) < 1.5;
        let [leave, arrive] = [out.cross(gap).atan2(out.dot(gap)), gap.cross(-other_out).atan2(-gap.dot(other_out))];
        let is_bend = distance > 3.5 && (leave - arrive).abs() < 0.35 && (leave + arrive).abs() < 1.3;
        if (is_straight || is_corner || is_bend) && is_covered(canvas, from, to) {
            joints.push(Joint { cost: distance + 4.0 * turn + aside, ends: [a, b] });
        }
    }
    sort::ascending(&mut joints, |joint| joint.cost);
    let mut partner = alloc::vec![usize::MAX; tips.len()];
    let mut colors: Vec<u128> = chains.iter().map(|chain| chain.colors).collect();
    let mut root: Vec<usize> = (0..chains.len()).collect();
    for Joint { ends: [a, b], .. } in joints {
        if partner[a] != usize::MAX || partner[b] != usize::MAX {
            continue;
        }
        let [first, second] = [root[a / 2], root[b / 2]];
        if colors[first] & colors[second] == 0 {
            continue;
        }
        (partner[a], partner[b]) = (b, a);
        colors[first] &= colors[second];
        if first != second {
            root.iter_mut().filter(|root| **root == second).for_each(|root| *root = first);
        }
    }
    let mut done = alloc::vec![false; chains.len()];
    let mut joined = Vec::new();
    // Open ones from an end, then those that are closed.
    let starts = (0..tips.len()).filter(|&end| partner[end] == usize::MAX).chain((0..chains.len()).map(|k| 2 * k));
    for start in starts.collect::<Vec<_>>() {
        if done[start / 2] {
            continue;
        }
        let mut whole = Chain { marks: Vec::new(), colors: colors[root[start / 2]], is_closed: false, width: 0.0 };
        let mut end = start;
        loop {
            let chain = &chains[end / 2];
            done[end / 2] = true;
            if end % 2 == 0 {
                append(&mut whole.marks, chain.marks.iter());
            } else {
                append(&mut whole.marks, chain.marks.iter().rev());
            }
            let next = partner[end ^ 1];
            if next == usize::MAX {
                break;
            }
            if done[next / 2] {
                whole.is_closed = next == start && goes_around(&whole.marks);
                break;
            }
            end = next;
        }
        joined.push(whole);
    }
    joined
}

/// Pairs of tips (by their number, the higher one first, in the order of these) that are no further apart than `longest`, pixels.
fn near_pairs(tips: &[[Vec2<f64>; 2]], longest: f64) -> Vec<[usize; 2]> {
    let at = |k: usize| tips[k][0];
    let mut from_left: Vec<usize> = (0..tips.len()).collect();
    sort::ascending(&mut from_left, |&k| at(k).x);
    let mut pairs = Vec::new();
    for (place, &k) in from_left.iter().enumerate() {
        let near = from_left[place + 1..].iter().take_while(|&&other| at(other).x - at(k).x <= longest);
        let near = near.filter(|&&other| (at(other) - at(k)).length() <= longest);
        pairs.extend(near.map(|&other| [k.max(other), k.min(other)]));
    }
    sort::ascending(&mut pairs, |&[a, b]| (a * tips.len() + b) as f64);
    pairs
}

/// Whether marks in order go around anything: what they enclose is a pixel wide, at least. A line at 45 degrees, which windows along both axes read,
/// leads to its end and back on itself.
fn goes_around(marks: &[Mark]) -> bool {
    let next = marks.iter().cycle().skip(1);
    let [mut way, mut area] = [0.0; 2];
    for (here, next) in marks.iter().zip(next) {
        way += (next.point - here.point).length();
        area += 0.5 * here.point.cross(next.point);
    }
    2.0 * area.abs() > way
}

/// Whether two boxes are within `margin` of one another.
pub(super) fn are_near([low, high]: [Vec2<f64>; 2], [other_low, other_high]: [Vec2<f64>; 2], margin: f64) -> bool {
    let is_near =
        |low: f64, high: f64, other_low: f64, other_high: f64| low <= other_high + margin && other_low <= high + margin;
    is_near(low.x, high.x, other_low.x, other_high.x) && is_near(low.y, high.y, other_low.y, other_high.y)
}

/// Where two chains cross.
pub(super) fn crossings(one: &Chain, other: &Chain) -> Vec<Vec2<f64>> {
    crossings_of(one, other, |_| true)
}

/// Where two chains cross and something of the first is not seen: windows are missing there, or the other line is in them, too.
pub(super) fn hidden_crossings(one: &Chain, other: &Chain) -> Vec<Vec2<f64>> {
    let is_hidden = |[from, to]: [&Mark; 2]| {
        from.is_shared || to.is_shared || (to.point - from.point).length() > tuning::CHAIN_NEXT
    };
    crossings_of(one, other, is_hidden)
}

fn crossings_of(one: &Chain, other: &Chain, is_asked: impl Fn([&Mark; 2]) -> bool) -> Vec<Vec2<f64>> {
    let bounds = other.bounds();
    if !are_near(one.bounds(), bounds, 0.0) {
        return Vec::new();
    }
    let sorted =
        |[a, b]: [Vec2<f64>; 2]| [Vec2::new(a.x.min(b.x), a.y.min(b.y)), Vec2::new(a.x.max(b.x), a.y.max(b.y))];
    let asked = one.marks.windows(2).filter(|pair| is_asked([&pair[0], &pair[1]]));
    let near = asked.map(|pair| [pair[0].point, pair[1].point]).filter(|&step| are_near(sorted(step), bounds, 0.0));
    near.flat_map(|step| other.steps().filter_map(move |next| crossing(step, next))).collect()
}

/// Where two segments cross.
fn crossing([a, b]: [Vec2<f64>; 2], [c, d]: [Vec2<f64>; 2]) -> Option<Vec2<f64>> {
    let (u, v, w) = (b - a, d - c, c - a);
    let cross = u.cross(v);
    let [s, t] = [w.cross(v) / cross, w.cross(u) / cross];
    ((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t)).then(|| a.lerp(b, s))
}

/// Without chains that lie on longer ones: where a line lies at 45 degrees windows along both axes read it.
pub(super) fn read_once(chains: Vec<Chain>) -> Vec<Chain> {
    let bounds: Vec<_> = chains.iter().map(Chain::bounds).collect();
    let is_on = |mark: &Mark, other: &Chain| {
        // Where windows are missing something else may lie.
        other.steps().filter(|[from, to]| (*to - *from).length() <= tuning::CHAIN_NEXT).any(|[from, to]| {
            let foot = from.lerp(to, LineSegment::new(from, to).nearest(mark.point).share);
            (mark.point - foot).length() < 0.25 * mark.width
        })
    };
    let is_read = |k: usize| {
        let (chain, count) = (&chains[k], chains[k].marks.len());
        (0..chains.len()).filter(|&j| chains[j].marks.len() > count || chains[j].marks.len() == count && j < k).any(
            |j| {
                chains[j].colors & chain.colors != 0
                    && are_near(bounds[k], bounds[j], 1.0)
                    && 5 * chain.marks.iter().filter(|mark| is_on(mark, &chains[j])).count() > 4 * count
            },
        )
    };
    let keep: Vec<bool> = (0..chains.len()).map(|k| !is_read(k)).collect();
    chains.into_iter().zip(keep).filter_map(|(chain, keep)| keep.then_some(chain)).collect()
}

/// Appends marks; those that go back behind where the line has come are left out.
fn append<'a>(marks: &mut Vec<Mark>, more: impl Iterator<Item = &'a Mark>) {
    let n = marks.len();
    let ahead = (n >= 2)
        .then(|| (marks[n - 1].point, (marks[n - 1].point - marks[n - 2].point).normalized().unwrap_or_default()));
    let mut is_ahead = false;
    for mark in more {
        is_ahead |= ahead.is_none_or(|(at, out)| {
            let step = mark.point - at;
            step.dot(out) > 0.3 || step.cross(out).abs() > 1.0
        });
        if is_ahead {
            marks.push(*mark);
        }
    }
}

/// Whether no flat pixel lies on the straight way between two points.
fn is_covered(canvas: &Canvas<'_>, from: Vec2<f64>, to: Vec2<f64>) -> bool {
    let steps = (2.0 * (to - from).length()).ceil().max(1.0) as usize;
    (0..=steps).all(|k| {
        let at = from.lerp(to, k as f64 / steps as f64);
        let [x, y] = [at.x, at.y].map(|value| value.max(0.0) as usize);
        x < canvas.size[0] && y < canvas.size[1] && canvas.flat[y * canvas.size[0] + x] == u16::MAX
    })
}
