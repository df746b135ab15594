//! Lines taken out of the picture: on both sides of their middle what lies beside them goes on.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::LineSegment;
use dvp_core::image::{coverage, distance};

use super::Color;
use super::chain::{Chain, Mark};
use super::cross::Along;
use super::thin::ThinLine;
use crate::tuning;

/// A picture of which lines are taken out.
pub(super) struct Eraser<'a> {
    pub(super) pixels: &'a mut [[f32; 3]],
    pub(super) size: [usize; 2],
    /// Pixels (ascending) that say nothing but the lines over them.
    pub(super) open: &'a [usize],
    /// Pixels that no line covers, any more or from the start.
    pub(super) known: Vec<bool>,
    pub(super) palette: &'a [Color],
    /// Most difference of a channel from the mixture that explains a pixel.
    pub(super) noise: f64,
    /// Least difference of a channel between a line and what it lies on.
    pub(super) contrast: f64,
}

impl Eraser<'_> {
    fn index(&self, along: Along, line: usize, at: usize) -> usize {
        match along {
            Along::Columns => at * self.size[0] + line,
            Along::Rows => line * self.size[0] + at,
        }
    }

    /// Takes out lines, which end where they are seen to. The pixels that say nothing of what was under the line, and are now as what is nearest.
    pub(super) fn erase(&mut self, lines: &mut [(ThinLine, Chain)]) -> Vec<usize> {
        let mut ends = Vec::new();
        for (line, chain) in lines.iter_mut().filter(|(_, chain)| !chain.is_closed) {
            let [first, second, .., before, last] = &chain.marks[..] else { continue };
            for (end, [tip, inner]) in [[first, second], [last, before]].into_iter().enumerate() {
                let longer = self.beyond(tip, inner, line.color);
                line.chain.ends[end] += longer;
                if longer == 0.0 {
                    ends.push((tip.point, chain.width));
                }
            }
        }
        let chains = lines.iter().map(|(_, chain)| chain);
        for mark in chains.clone().flat_map(|chain| &chain.marks) {
            let sides = mark.cross.sides.map(|side| self.palette[side as usize]);
            self.fill(mark.along, mark.cross.line, mark.cross.run, mark.point.dot(mark.axis()), sides);
        }
        let mut holes = Vec::new();
        for chain in chains {
            let closing = chain.marks.last().zip(chain.marks.first()).filter(|_| chain.is_closed);
            let pairs = chain.marks.windows(2).map(|pair| (pair[0], pair[1])).chain(closing.map(|(a, b)| (*a, *b)));
            for (from, to) in pairs {
                if from.along == to.along && from.cross.line.abs_diff(to.cross.line) > 1 {
                    self.bridge(&from, &to);
                } else if from.along != to.along {
                    self.around(from.point, to.point, chain.width, &mut holes);
                }
            }
        }
        for (end, width) in ends {
            self.around(end, end, width, &mut holes);
        }
        holes.retain(|&i| !self.known[i]);
        holes.sort_unstable();
        holes.dedup();
        self.fill_holes(holes.clone());
        holes
    }

    /// Lets two colors meet at `center` in a window.
    fn fill(&mut self, along: Along, line: usize, [from, to]: [usize; 2], center: f64, sides: [Color; 2]) {
        for at in from..to {
            let share = (center - at as f64).clamp(0.0, 1.0);
            let i = self.index(along, line, at);
            self.pixels[i] = core::array::from_fn(|c| (share * sides[0][c] + (1.0 - share) * sides[1][c]) as f32);
            self.known[i] = true;
        }
    }

    /// Takes out what of a line lies beyond its last window, `tip`, over what is of no flat color: the edge of what the line crosses, or where both
    /// the line and what lies on its sides end. Pixels that it is longer.
    fn beyond(&mut self, tip: &Mark, inner: &Mark, color: Color) -> f64 {
        let step = tip.cross.line as f64 - inner.cross.line as f64;
        let slope = (tip.point - inner.point).dot(tip.axis()) / step;
        if tip.along != inner.along || step.abs() != 1.0 {
            return 0.0;
        }
        let [lines, length] = match tip.along {
            Along::Columns => self.size,
            Along::Rows => [self.size[1], self.size[0]],
        };
        let mut longer = 0.0;
        for k in 1.. {
            let away = step * f64::from(k);
            let line = tip.cross.line as f64 + away;
            let run = tip.cross.run.map(|at| at as f64 + (slope * away).round());
            if line < 0.0 || line >= lines as f64 || run[0] < 1.0 || run[1] >= length as f64 {
                break;
            }
            let (line, run) = (line as usize, run.map(|at| at as usize));
            let pixel = |at: usize| self.pixels[self.index(tip.along, line, at)].map(f64::from);
            let sides = [pixel(run[0] - 1), pixel(run[1])];
            let center = tip.point.dot(tip.axis()) + slope * away;
            let covered = if tip.cross.sides[0] == tip.cross.sides[1] {
                // The edge is the same on both sides of the line, and not of its color.
                if distance(sides[0], sides[1]) > self.noise || distance(sides[0], color) < self.contrast {
                    break;
                }
                let share = |at: usize| coverage(pixel(at), sides[0], color).clamp(0.0, 1.0);
                let covered = (run[0]..run[1]).map(share).sum::<f64>() / tip.width;
                self.fill(tip.along, line, run, center, sides);
                covered
            } else {
                let Some((covered, under)) = self.hidden(tip, color, line, center) else { break };
                for (at, under) in under {
                    let i = self.index(tip.along, line, at);
                    self.pixels[i] = under.map(|value| value as f32);
                    self.known[i] = true;
                }
                covered
            };
            let is_whole = covered > 1.0 - tuning::THIN_TOLERANCE;
            longer += if is_whole { 1.0 } else { covered };
            if !is_whole {
                break;
            }
        }
        longer
    }

    /// Share of a line that is seen in a window beyond its last one, where something of the color of one of its sides hides it and them in part, and
    /// what is under the line there, pixel by pixel; none if that is not what is seen.
    fn hidden(&self, tip: &Mark, color: Color, line: usize, center: f64) -> Option<(f64, Vec<(usize, Color)>)> {
        let sides = tip.cross.sides.map(|side| self.palette[side as usize]);
        let [low, high] = [center - 0.5 * tip.width, center + 0.5 * tip.width];
        let length = if tip.along == Along::Columns { self.size[1] } else { self.size[0] };
        let window = (low.floor() as usize).checked_sub(1)?..high.ceil() as usize + 1;
        if window.end > length {
            return None;
        }
        let of_side = |side: Color| {
            let [mut seen, mut all] = [0.0; 2];
            let mut under = Vec::new();
            for at in window.clone() {
                let within = |from: f64, to: f64| (to.min(at as f64 + 1.0) - from.max(at as f64)).clamp(0.0, 1.0);
                let [of_first, of_line] = [within(at as f64, low), within(low, high)];
                let mixed = |first: f64, line: f64| -> Color {
                    core::array::from_fn(|c| first * sides[0][c] + line * color[c] + (1.0 - first - line) * sides[1][c])
                };
                let pixel = self.pixels[self.index(tip.along, line, at)].map(f64::from);
                let whole = mixed(of_first, of_line);
                let share = coverage(pixel, side, whole).clamp(0.0, 1.0);
                let behind = |of: Color| -> Color { core::array::from_fn(|c| side[c] + share * (of[c] - side[c])) };
                if distance(pixel, behind(whole)) > self.noise {
                    return None;
                }
                seen += share * of_line;
                all += of_line;
                under.push((at, behind(mixed(within(at as f64, center), 0.0))));
            }
            let covered = seen / all;
            // What is seen of it must be more than noise.
            (covered * distance(side, color) > self.noise).then_some((covered, under))
        };
        sides.into_iter().filter_map(of_side).max_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// The windows that are missing between two: what borders on them goes on under the line.
    fn bridge(&mut self, from: &Mark, to: &Mark) {
        let (low, high) = if from.cross.line < to.cross.line { (from, to) } else { (to, from) };
        let lines = high.cross.line - low.cross.line;
        let length = match low.along {
            Along::Columns => self.size[1],
            Along::Rows => self.size[0],
        };
        for k in 1..lines {
            let line = low.cross.line + k;
            let share = k as f64 / lines as f64;
            let center = low.point.lerp(high.point, share).dot(low.axis());
            let [start, end] = [0, 1].map(|side| {
                let [a, b] = [low, high].map(|mark| mark.cross.run[side] as f64);
                a + share * (b - a)
            });
            let run = [start.floor() as usize, end.ceil() as usize];
            if run[0] == 0 || run[1] >= length {
                continue;
            }
            // What is known beside it, or as much as both windows say of what something else covers.
            let sides = [0, 1].map(|side| {
                let beside = self.index(low.along, line, [run[0] - 1, run[1]][side]);
                if low.cross.sides == high.cross.sides && !self.known[beside] {
                    self.palette[low.cross.sides[side] as usize]
                } else {
                    self.pixels[beside].map(f64::from)
                }
            });
            self.fill(low.along, line, run, center, sides);
        }
    }

    /// The pixels around a piece of a line that nothing else explains.
    fn around(&self, from: Vec2<f64>, to: Vec2<f64>, width: f64, holes: &mut Vec<usize>) {
        let reach = 0.5 * width + 1.8;
        let [x0, y0] = [from.x.min(to.x) - reach, from.y.min(to.y) - reach].map(|low| low.max(0.0) as usize);
        let [x1, y1] = [from.x.max(to.x) + reach, from.y.max(to.y) + reach].map(|high| high.max(0.0) as usize + 1);
        let segment = LineSegment::new(from, to);
        for y in y0..y1.min(self.size[1]) {
            for x in x0..x1.min(self.size[0]) {
                let i = y * self.size[0] + x;
                let pixel = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let foot = from.lerp(to, segment.nearest(pixel).share);
                if !self.known[i] && (pixel - foot).length() < reach && self.open.binary_search(&i).is_ok() {
                    holes.push(i);
                }
            }
        }
    }

    /// What is left under corners and ends is as what is nearest.
    fn fill_holes(&mut self, mut holes: Vec<usize>) {
        let [width, height] = self.size;
        loop {
            let near = |i: usize| {
                let (x, y) = (i % width, i / width);
                let beside = [
                    (x > 0).then(|| i - 1),
                    (x + 1 < width).then_some(i + 1),
                    (y > 0).then(|| i - width),
                    (y + 1 < height).then_some(i + width),
                ];
                beside.into_iter().flatten().find(|&j| self.known[j])
            };
            let filled: Vec<(usize, usize)> = holes.iter().filter_map(|&i| Some((i, near(i)?))).collect();
            if filled.is_empty() {
                return;
            }
            for &(i, from) in &filled {
                self.pixels[i] = self.pixels[from];
            }
            for (i, _) in filled {
                self.known[i] = true;
            }
            holes.retain(|&i| !self.known[i]);
        }
    }
}
