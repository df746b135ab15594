//! Soft pixels: between which two regions each one lies, and how far along from one color to the other.

use alloc::vec::Vec;

use dvp_core::image::distance;
use dvp_core::sort::median;
use dvp_core::{ImageView, Real};

use super::color::is_same;
use super::flat::FlatMap;
use super::region::Region;
use super::thin::Leftover;
use crate::tuning::OVERSHOOT;

/// A pixel whose color lies on the line between the colors of two regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transition<T> {
    /// Column and row.
    pub(crate) pixel: [u32; 2],
    /// The two regions, indices into the list of regions, the lower first.
    pub(crate) pair: [u32; 2],
    /// 0 at the color of the first region, 1 at that of the second; a little beyond either for noise.
    pub(crate) weight: T,
    /// Whether the colors change from one pixel to the next, this being one of the two.
    pub(crate) step: bool,
}

/// Soft pixel with the nearest regions to the left, right, above and below (0: none, else region + 1), and the lengths
/// of the soft runs through it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Soft {
    pub(crate) pixel: [u32; 2],
    pub(crate) ends: [u32; 4],
    runs: [u32; 2],
}

impl Soft {
    /// The region on both sides of the pixel, or on one side with the border of the image on the other.
    fn host(&self) -> Option<u32> {
        let [left, right, up, down] = self.ends;
        let sides = [(left, right), (up, down)];
        let both = sides.into_iter().find(|&(a, b)| a == b && a != 0);
        let (a, b) = both.or_else(|| sides.into_iter().find(|&(a, b)| (a == 0) != (b == 0)))?;
        Some(a.max(b))
    }
}

/// Memory of [`find`].
#[derive(Clone, Debug, Default)]
pub(crate) struct SoftScratch<T> {
    pub(crate) soft: Vec<Soft>,
    column: Vec<(u32, u32)>,
    offs: Vec<T>,
    /// Soft pixels that lie between no two regions.
    pub(crate) leftover: Vec<Leftover>,
    /// Soft pixels that lie between no two regions, but show the color of one beside them: those around a corner.
    pub(crate) settled: usize,
}

impl<T: Real> SoftScratch<T> {
    /// Number of soft pixels.
    pub(crate) fn len(&self) -> usize {
        self.soft.len()
    }

    /// Standard deviation of a channel beside edges, from how far soft pixels lie off the lines between their regions.
    pub(crate) fn noise_across(
        &mut self,
        image: &ImageView<'_, T>,
        regions: &[Region<T>],
        transitions: &[Transition<T>],
    ) -> T {
        let width = image.size().width();
        self.offs.clear();
        for transition in transitions {
            let color = image.pixel(transition.pixel[1] as usize * width + transition.pixel[0] as usize);
            let [from, to] = transition.pair.map(|i| regions[i as usize].color);
            self.offs.push(along(color, from, to).1);
        }
        // The median of the largest channel of noise across a line is about its standard deviation.
        median(&mut self.offs).unwrap_or_default()
    }
}

/// Fills `transitions` in reading order. `tolerance`: how far from the line between two colors a pixel may lie.
pub(crate) fn find<T: Real>(
    image: &ImageView<'_, T>,
    map: &FlatMap,
    regions: &[Region<T>],
    tolerance: T,
    scratch: &mut SoftScratch<T>,
    transitions: &mut Vec<Transition<T>>,
) {
    collect_soft(image.size().width(), image.size().height(), map, scratch);
    transitions.clear();
    scratch.leftover.clear();
    scratch.settled = 0;
    let width = image.size().width();
    for soft in &scratch.soft {
        let color = image.pixel(soft.pixel[1] as usize * width + soft.pixel[0] as usize);
        let across = [(soft.ends[0], soft.ends[1], soft.runs[0]), (soft.ends[2], soft.ends[3], soft.runs[1])];
        let mut best: Option<(T, Transition<T>)> = None;
        for (axis, (a, b, run)) in (0..).zip(across) {
            if a == b || a == 0 || b == 0 {
                continue;
            }
            let pair = [a.min(b) - 1, a.max(b) - 1];
            let (weight, off) =
                along_sharpened(color, regions[pair[0] as usize].color, regions[pair[1] as usize].color);
            // Of two crossings that explain the pixel about as well, the shorter is the more perpendicular one.
            let cost = off + tolerance * T::of(0.05) * T::of_usize(run as usize);
            if off <= tolerance && best.as_ref().is_none_or(|(c, _)| cost < *c) {
                // A run from row to row counts from flat row to flat row.
                let step = run == 2 + axis;
                best = Some((cost, Transition { pixel: soft.pixel, pair, weight, step }));
            }
        }
        if let Some((_, transition)) = best {
            transitions.push(transition);
            continue;
        }
        let shown = |&label: &u32| label != 0 && is_same(color, regions[label as usize - 1].color);
        scratch.settled += usize::from(soft.ends.iter().any(shown));
        if let Some(host) = soft.host() {
            scratch.leftover.push(Leftover { pixel: soft.pixel, host });
        }
    }
}

/// As [`along`], but what a filter that sharpens adds to the contrast of an edge is no distance.
fn along_sharpened<T: Real>(color: [T; 3], from: [T; 3], to: [T; 3]) -> (T, T) {
    let (weight, off) = along(color, from, to);
    if weight < T::zero() {
        (weight, off.min(off_overshoot(color, to, from)))
    } else if weight > T::one() {
        (weight, off.min(off_overshoot(color, from, to)))
    } else {
        (weight, off)
    }
}

/// The largest channel distance of a color beyond `to` from where an edge that is sharpened shows it, cut off at black and
/// white.
pub(super) fn off_overshoot<T: Real>(color: [T; 3], from: [T; 3], to: [T; 3]) -> T {
    let most = distance(from, to);
    let mut beyond = T::zero();
    for c in 0..3 {
        let step = to[c] - from[c];
        if step.abs() > T::of(0.5) * most {
            beyond = beyond.max((color[c] - to[c]) / step);
        }
    }
    let beyond = beyond.min(T::of(OVERSHOOT));
    let shown = core::array::from_fn(|c| (to[c] + beyond * (to[c] - from[c])).max(T::zero()).min(T::one()));
    distance(color, shown)
}

/// Position along the line from `from` to `to`, and the largest channel distance from it.
pub(crate) fn along<T: Real>(color: [T; 3], from: [T; 3], to: [T; 3]) -> (T, T) {
    let (mut dot, mut length) = (T::zero(), T::zero());
    for c in 0..3 {
        let d = to[c] - from[c];
        dot += (color[c] - from[c]) * d;
        length += d * d;
    }
    if length <= T::zero() {
        return (T::zero(), T::infinity());
    }
    let weight = dot / length;
    let clamped = weight.max(T::zero()).min(T::one());
    let mut off = T::zero();
    for c in 0..3 {
        off = off.max((color[c] - from[c] - clamped * (to[c] - from[c])).abs());
    }
    (weight, off)
}

#[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
fn collect_soft<T>(width: usize, height: usize, map: &FlatMap, scratch: &mut SoftScratch<T>) {
    let SoftScratch { soft, column, .. } = scratch;
    soft.clear();
    column.clear();
    column.resize(width, (0, 0));
    let mut next = 0;
    for row in 0..height {
        let mut x = 0;
        let mut left = 0;
        loop {
            let run = map.runs.get(next).filter(|run| run.row as usize == row);
            let (end, right) = run.map_or((width, 0), |run| (run.start as usize, run.label));
            for (at, &(up, below)) in (x..end).zip(&column[x..end]) {
                soft.push(Soft {
                    pixel: [at as u32, row as u32],
                    ends: [left, right, up, 0],
                    runs: [(end - x) as u32, row as u32 - if up == 0 { 0 } else { below }],
                });
            }
            let Some(run) = run else { break };
            column[run.start as usize..run.end as usize].fill((run.label, row as u32));
            left = run.label;
            x = run.end as usize;
            next += 1;
        }
    }
    // The same from below.
    column.clear();
    column.resize(width, (0, 0));
    let mut runs = map.runs.iter().rev().peekable();
    let mut at = soft.len();
    for row in (0..height).rev() {
        while at > 0 && soft[at - 1].pixel[1] as usize == row {
            at -= 1;
            let entry = &mut soft[at];
            let (down, below) = column[entry.pixel[0] as usize];
            entry.ends[3] = down;
            entry.runs[1] += if down == 0 { 0 } else { below - row as u32 };
        }
        while let Some(run) = runs.peek().filter(|run| run.row as usize == row) {
            column[run.start as usize..run.end as usize].fill((run.label, row as u32));
            runs.next();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{along_sharpened, off_overshoot};

    #[test]
    fn a_rim_is_on_the_line_of_its_edge() {
        let (from, to) = ([0.2, 0.5, 0.9], [0.6, 0.5, 0.5]);
        // A tenth of the contrast beyond: 0.6 + 0.04, 0.5 - 0.04.
        assert!(along_sharpened([0.64, 0.5, 0.46], from, to).1 < 1e-9);
        assert!(along_sharpened([0.16, 0.5, 0.94], from, to).1 < 1e-9);
        // Half of it is too much, by a quarter of 0.4; and a color off the line stays off.
        assert!((off_overshoot([0.8, 0.5, 0.3], from, to) - 0.1_f64).abs() < 1e-9);
        assert!((along_sharpened([0.64, 0.6, 0.46], from, to).1 - 0.1_f64).abs() < 1e-9);
        // Black and white cut it off.
        assert!(off_overshoot([1.0_f64, 0.0, 0.46], [0.2, 0.8, 0.9], [0.96, 0.02, 0.5]) < 1e-9);
    }
}
