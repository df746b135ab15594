//! Windows across two lines side by side, which meet or cross at a small angle: what is seen of each.
//!
//! No single line explains such a window, but both together do: every pixel is a mixture of the two and of what lies behind them. The one
//! behind shows its free side alone; how wide it is its own chain says, and so where its middle is.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::image::{coverage, distance};
use dvp_core::sort;

use super::Color;
use super::chain::{Chain, Mark};
use super::cross::{Along, Canvas, Cross, LONGEST, shares_of_three};
use crate::tuning;

/// What is seen of a line that shares its window.
struct Seen {
    /// Where it begins and ends along the window, pixels.
    range: [f64; 2],
    /// Whether the other line lies behind its end rather than before its beginning.
    is_first: bool,
    /// How much of what lies behind both is seen between them, pixels.
    gap: f64,
}

/// Lets chains go on where another line runs beside them. `crosses`: the windows that single lines explain; `palette`: colors of the flat
/// pixels beside windows; `colors`: those that lines have.
pub(super) fn grow(
    canvas: &Canvas<'_>,
    along: Along,
    chains: &mut [Chain],
    crosses: &[Vec<Cross>],
    [palette, colors]: [&[Color]; 2],
) {
    let color_of = |chain: &Chain| chain.colors.trailing_zeros() as usize;
    let mut pens: Vec<usize> =
        chains.iter().filter(|chain| chain.marks.len() >= tuning::THIN_LEAST_LENGTH).map(color_of).collect();
    pens.sort_unstable();
    pens.dedup();
    if pens.len() < 2 {
        return;
    }
    let mut taken = BTreeSet::new();
    let mut order: Vec<usize> = (0..chains.len()).filter(|&k| chains[k].marks.len() >= tuning::PAIR_MARKS).collect();
    sort::descending(&mut order, |&k| chains[k].marks.len() as f64);
    for k in order {
        let own = color_of(&chains[k]);
        for at_finish in [true, false] {
            let Some(tip) = Tip::of(&chains[k], at_finish) else { continue };
            let ground = palette[tip.ground as usize];
            let center = |cross: &Cross, width: f64| {
                let is_short = cross.run[1] - cross.run[0] <= LONGEST;
                let alone = if is_short { canvas.measure(along, cross, colors[own], palette) } else { None };
                if let Some([center, seen, misfit]) = alone
                    && misfit <= canvas.noise
                {
                    return ((seen - width).abs() <= tolerance(width)).then_some(center);
                }
                let others = pens.iter().filter(|&&other| other != own);
                let pairs = others.filter_map(|&other| canvas.pair(along, cross, [ground, colors[own], colors[other]]));
                pairs.min_by(|a, b| a.1.total_cmp(&b.1)).and_then(|(seen, _)| seen.center(width))
            };
            while let Some(mark) = tip.next(canvas, along, &chains[k], crosses, ground, center) {
                if !taken.insert((mark.cross.line, mark.cross.run[0], own)) {
                    break;
                }
                let at = if at_finish { chains[k].marks.len() } else { 0 };
                chains[k].marks.insert(at, mark);
            }
        }
    }
}

/// Where a chain goes at one of its ends.
struct Course {
    /// The last window: its line, and the middle in it.
    line: f64,
    center: f64,
    /// +1 if windows beyond the end have greater lines, else -1.
    step: f64,
    /// By how much the middle moves from window to window.
    slope: f64,
}

impl Course {
    fn of(chain: &Chain, at_finish: bool) -> Option<Self> {
        let n = chain.marks.len();
        let reach = tuning::PAIR_REACH.min(n);
        let ends = if at_finish { [n - 1, n - reach] } else { [0, reach - 1] };
        let [[line, center], [inner_line, inner]] = ends.map(|k| {
            let mark = &chain.marks[k];
            [mark.cross.line as f64, mark.point.dot(mark.axis())]
        });
        let lines = line - inner_line;
        let slope = (center - inner) / lines.abs();
        (lines != 0.0).then_some(Self { line, center, step: lines.signum(), slope })
    }

    /// How much longer windows across a line are than it is wide.
    fn stretch(&self) -> f64 {
        (1.0 + self.slope * self.slope).sqrt()
    }
}

/// What the line is that goes on from an end of a chain.
struct Tip {
    at_finish: bool,
    /// Width of the line, pixels: across it, not along windows.
    width: f64,
    /// The palette's color of what it lies on.
    ground: u16,
}

impl Tip {
    fn of(chain: &Chain, at_finish: bool) -> Option<Self> {
        let stretch = Course::of(chain, at_finish)?.stretch();
        let n = chain.marks.len();
        let reach = tuning::PAIR_REACH.min(n);
        let (of_end, last) = if at_finish { (&chain.marks[n - reach..], n - 1) } else { (&chain.marks[..reach], 0) };
        let [ground, other] = chain.marks[last].cross.sides;
        let mut widths: Vec<f64> = of_end.iter().map(|mark| mark.width / stretch).collect();
        let width = sort::median(&mut widths)?;
        (ground == other).then_some(Self { at_finish, width, ground })
    }

    /// The next window of the line that it shares with another one, or fills alone.
    fn next(
        &self,
        canvas: &Canvas<'_>,
        along: Along,
        chain: &Chain,
        crosses: &[Vec<Cross>],
        ground: Color,
        center_of: impl Fn(&Cross, f64) -> Option<f64>,
    ) -> Option<Mark> {
        let course = Course::of(chain, self.at_finish)?;
        // Where it is steeper windows along the other axis read it.
        if course.slope.abs() > tuning::PAIR_SLOPE {
            return None;
        }
        let width = self.width * course.stretch();
        for missing in 0..(2.0 * canvas.widest) as usize {
            let ahead = (1 + missing) as f64;
            let line = course.line + course.step * ahead;
            if line < 0.0 {
                return None;
            }
            let (line, predicted) = (line as usize, course.center + course.slope * ahead);
            let run = canvas.run_around(along, line, predicted, (self.ground, ground))?;
            let cross = Cross { line, run, sides: [self.ground; 2], colors: 0 };
            if crosses[line].iter().any(|single| single.run == cross.run && single.colors & chain.colors != 0) {
                return None;
            }
            let Some(center) = center_of(&cross, width) else { continue };
            if (center - predicted).abs() <= tuning::PAIR_ASIDE[0] + tuning::PAIR_ASIDE[1] * missing as f64 {
                let mut mark = Mark { along, cross, point: dvp_core::Vec2::default(), width, is_shared: true };
                mark.place(center, width);
                return Some(mark);
            }
        }
        None
    }
}

/// By how much the width of a line may differ from window to window, pixels.
fn tolerance(width: f64) -> f64 {
    tuning::THIN_TOLERANCE * width + 0.08
}

impl Seen {
    /// The middle of a line of this width, if that is what is seen.
    fn center(&self, width: f64) -> Option<f64> {
        let [low, high] = self.range;
        let seen = high - low;
        if self.gap > tuning::PAIR_SEEN {
            return ((seen - width).abs() <= tolerance(width)).then_some(0.5 * (low + high));
        }
        // What is hidden of it lies under the other one.
        (tuning::PAIR_SEEN..width + tolerance(width)).contains(&seen).then_some(if self.is_first {
            low + 0.5 * width
        } else {
            high - 0.5 * width
        })
    }
}

impl Canvas<'_> {
    /// The pixels around a place up to those that show the ground on which lines lie, if two lines can fill them.
    fn run_around(&self, along: Along, line: usize, at: f64, (ground, color): (u16, Color)) -> Option<[usize; 2]> {
        let [lines, length] = self.extent(along);
        let at = at.max(0.0) as usize;
        if line >= lines || at >= length {
            return None;
        }
        let is_ground = |at: usize| distance(self.color(along, line, at), color) <= self.noise;
        let is_end = |at: usize| self.flat[self.index(along, line, at)] != u16::MAX || is_ground(at);
        if is_end(at) {
            return None;
        }
        let longest = (2.0 * self.widest * core::f64::consts::SQRT_2).ceil() as usize + 3;
        let before = (at.saturating_sub(longest)..at).rev().find(|&k| is_end(k))?;
        let behind = (at + 1..length.min(at + longest)).find(|&k| is_end(k))?;
        let is_on = [before, behind].map(|k| self.flat[self.index(along, line, k)] == ground || is_ground(k));
        (is_on == [true; 2] && behind - before <= longest).then_some([before + 1, behind])
    }

    /// What is seen of a line beside another one, and the most that a channel differs from their mixture. Colors: what lies behind both, the
    /// line's, the other one's. None if they do not explain the window.
    fn pair(&self, along: Along, cross: &Cross, [side, own, other]: [Color; 3]) -> Option<(Seen, f64)> {
        if distance(own, other) < self.contrast || distance(own, side) < self.contrast {
            return None;
        }
        let [from, to] = cross.run;
        let mut shares: Vec<[f64; 3]> = Vec::with_capacity(to - from);
        let mut worst = 0.0_f64;
        for at in from..to {
            let pixel = self.color(along, cross.line, at);
            let [mut a, mut b] = shares_of_three(pixel, [side, own, other])?;
            if a < 0.0 {
                (a, b) = (0.0, coverage(pixel, side, other).clamp(0.0, 1.0));
            } else if b < 0.0 {
                (a, b) = (coverage(pixel, side, own).clamp(0.0, 1.0), 0.0);
            } else if a + b > 1.0 {
                b = coverage(pixel, own, other).clamp(0.0, 1.0);
                a = 1.0 - b;
            }
            let misfit = |c: usize| (pixel[c] - side[c] - a * (own[c] - side[c]) - b * (other[c] - side[c])).abs();
            worst = (0..3).map(misfit).fold(worst, f64::max);
            shares.push([1.0 - a - b, a, b]);
        }
        let total = |of: usize| shares.iter().map(|share| share[of]).sum::<f64>();
        if worst > self.noise || total(1) < tuning::PAIR_SEEN || total(2) < tuning::PAIR_SEEN {
            return None;
        }
        let fullest = |of: usize| (0..shares.len()).max_by(|&a, &b| shares[a][of].total_cmp(&shares[b][of]));
        let (own, other) = (fullest(1)?, fullest(2)?);
        let behind = |range: core::ops::Range<usize>| shares[range].iter().map(|share| share[0]).sum::<f64>();
        let (range, gap) = if own < other {
            let low = from as f64 + behind(0..own + 1);
            ([low, low + total(1)], behind(own + 1..other))
        } else {
            let high = to as f64 - behind(own..shares.len());
            ([high - total(1), high], behind(other + 1..own.max(other + 1)))
        };
        (own != other).then_some((Seen { range, is_first: own < other, gap }, worst))
    }
}
