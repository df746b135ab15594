//! Windows across thin things: short runs of pixels of a column or row between flat ones that no mixture of these explains.

use alloc::vec;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::image::{coverage, distance};

use super::Color;
use super::flat::NONE;
use super::mix::narrow;
use super::runs::runs;

/// The longest run, pixels: the widest line that is asked for at 45 degrees, and a mixed pixel on both sides.
pub(super) const LONGEST: usize = 16;

/// A line wider than this, pixels across a window, covers a pixel whichever way it runs: sqrt(2) of 45 degrees and the pixel.
const COVERS: f64 = 2.5;

/// The least share of a pixel that is covered, give or take the noise of a coder.
const FULL: f64 = 0.9;

/// A window across something thin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cross {
    /// Column of a window along a column, row of one along a row.
    pub(super) line: usize,
    /// First pixel of the run along the window, and the one after its last.
    pub(super) run: [usize; 2],
    /// Palette colors of the flat pixels before and behind the run.
    pub(super) sides: [u16; 2],
    /// The colors of the thin thing that would explain the window, bits of the list of colors.
    pub(super) colors: u128,
}

/// A picture with what is known of it: flat pixels, and colors.
pub(super) struct Canvas<'a> {
    pub(super) pixels: &'a [[f32; 3]],
    pub(super) size: [usize; 2],
    /// Color of every flat pixel; `u16::MAX` elsewhere.
    pub(super) flat: &'a [u16],
    /// Pixels (ascending) that no mixture of flat colors nearby explains.
    pub(super) open: &'a [usize],
    /// Most difference of a channel from the mixture that explains a pixel.
    pub(super) noise: f64,
    /// Least difference of a channel between a line and what it lies on.
    pub(super) contrast: f64,
    pub(super) white: Color,
    /// The widest lines, pixels.
    pub(super) widest: f64,
}

/// Which way windows lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Along {
    Columns,
    Rows,
}

impl Canvas<'_> {
    /// Index of a pixel: number `at` of the window along `line`.
    pub(super) fn index(&self, along: Along, line: usize, at: usize) -> usize {
        match along {
            Along::Columns => at * self.size[0] + line,
            Along::Rows => line * self.size[0] + at,
        }
    }

    /// Lines of windows, and pixels of each.
    pub(super) fn extent(&self, along: Along) -> [usize; 2] {
        match along {
            Along::Columns => self.size,
            Along::Rows => [self.size[1], self.size[0]],
        }
    }

    pub(super) fn color(&self, along: Along, line: usize, at: usize) -> Color {
        self.pixels[self.index(along, line, at)].map(f64::from)
    }

    /// All windows, line by line; which of `palette` explains them is not said yet.
    pub(super) fn crosses(&self, along: Along) -> Vec<Vec<Cross>> {
        let [lines, length] = self.extent(along);
        let longest = ((self.widest * core::f64::consts::SQRT_2).ceil() as usize + 2).min(LONGEST);
        let mut found: Vec<Vec<Cross>> = vec![Vec::new(); lines];
        for &i in self.open {
            let [x, y] = [i % self.size[0], i / self.size[0]];
            let (line, at) = match along {
                Along::Columns => (x, y),
                Along::Rows => (y, x),
            };
            let flat = |at: usize| self.flat[self.index(along, line, at)];
            // A window begins behind a flat pixel, and ends before one.
            let before = (at.saturating_sub(longest)..at).rev().find(|&at| flat(at) != u16::MAX);
            let behind = (at + 1..length).take(longest).find(|&at| flat(at) != u16::MAX);
            let Some((before, end)) = before.zip(behind) else { continue };
            let start = before + 1;
            // Open pixels come in the order of a picture, so that those of one window follow one another in its line.
            if end - start <= longest && found[line].last().is_none_or(|last| last.run[0] != start) {
                found[line].push(Cross { line, run: [start, end], sides: [before, end].map(flat), colors: 0 });
            }
        }
        found
    }

    /// Center and width of a line of color `line_color` in a window, pixels, and what is left, the most that a channel differs.
    pub(super) fn measure(
        &self,
        along: Along,
        cross: &Cross,
        line_color: Color,
        palette: &[Color],
    ) -> Option<[f64; 3]> {
        let sides = cross.sides.map(|side| palette[side as usize]);
        if sides.iter().any(|&side| distance(side, line_color) < self.contrast) {
            return None;
        }
        let [from, to] = cross.run;
        let count = to - from;
        let mut shares = [[0.0_f64; 2]; LONGEST];
        let mut misfits = [[0.0_f64; 2]; LONGEST];
        for k in 0..count {
            let pixel = self.color(along, cross.line, from + k);
            for side in 0..2 {
                let share = coverage(pixel, sides[side], line_color).clamp(0.0, 1.0);
                let misfit = (0..3)
                    .map(|c| (pixel[c] - sides[side][c] - share * (line_color[c] - sides[side][c])).abs())
                    .fold(0.0, f64::max);
                shares[k][side] = share;
                misfits[k][side] = misfit;
            }
        }
        // The line is fullest in one pixel, which may hold something of both sides if these are not alike; which it is shares do not
        // tell if the line is nowhere full, but what is left to explain does.
        let is_even = sides[0] == sides[1];
        let worst_at = |peak: usize| {
            let middle = self.peak(self.color(along, cross.line, from + peak), sides, line_color);
            let before = misfits[..peak].iter().map(|misfit| misfit[0]);
            let after = misfits[peak + 1..count].iter().map(|misfit| misfit[1]);
            (peak, middle, before.chain(after).fold(middle[2], f64::max))
        };
        let most = |k: usize| shares[k][0].min(shares[k][1]);
        let fullest = (0..count).max_by(|&a, &b| most(a).total_cmp(&most(b)).then(b.cmp(&a))).map(worst_at)?;
        let (peak, middle, worst) = if is_even || fullest.2 <= self.noise {
            fullest
        } else {
            (0..count).map(worst_at).min_by(|a, b| a.2.total_cmp(&b.2))?
        };
        let before: f64 = shares[..peak].iter().map(|share| share[0]).sum();
        let after: f64 = shares[peak + 1..count].iter().map(|share| share[1]).sum();
        let width = before + after + middle[0];
        // What is that wide covers some pixel: else all of it is of a color between.
        if width > COVERS && middle[0] < FULL {
            return None;
        }
        // The edges: beside the crack between two pixels that share the line, or full pixels between them; else the middle of what is covered.
        let place = from as f64 + peak as f64;
        let center = if is_even {
            let centroid =
                (0..count).map(|k| shares[k][0] * (k as f64 + 0.5)).sum::<f64>() / width.max(1e-9) + from as f64;
            let covered = shares[..count].iter().filter(|share| share[0] > 0.03).count();
            if covered == 2 && (before > 0.03 || after > 0.03) {
                // Both pixels beside a crack: what is covered begins and ends in them.
                let (crack, low, high) =
                    if before > after { (place, before, middle[0]) } else { (place + 1.0, middle[0], after) };
                crack + 0.5 * (high - low)
            } else if middle[0] > 0.95 {
                place + 0.5 + 0.5 * (after - before)
            } else {
                centroid
            }
        } else {
            // What of the peak is the first side's comes first.
            let first = if before > 0.03 {
                0.0
            } else if after > 0.03 {
                1.0 - middle[0]
            } else {
                middle[1]
            };
            place + first - before + 0.5 * width
        };
        Some([center, width, worst])
    }

    /// How much of the fullest pixel is the line, how much the first side, and what is left.
    fn peak(&self, pixel: Color, sides: [Color; 2], line: Color) -> [f64; 3] {
        let mut best = [0.0, 0.0, f64::INFINITY];
        let mut keep = |share: f64, first: f64| {
            let second = 1.0 - share - first;
            let misfit = (0..3)
                .map(|c| (pixel[c] - share * line[c] - first * sides[0][c] - second * sides[1][c]).abs())
                .fold(0.0, f64::max);
            if misfit < best[2] - 0.5 * self.noise {
                best = [share, first, misfit];
            }
        };
        let [a, b] = sides.map(|side| coverage(pixel, side, line).clamp(0.0, 1.0));
        keep(a, 1.0 - a);
        keep(b, 0.0);
        if sides[0] != sides[1]
            && let Some([first, second]) = shares_of_three(pixel, [line, sides[0], sides[1]])
            && first >= 0.0
            && second >= 0.0
            && first + second <= 1.0
        {
            keep(1.0 - first - second, first);
        }
        best
    }
}

/// Shares of the second and third color in a mixture of three; none if they lie on a line.
pub(super) fn shares_of_three(pixel: Color, [a, b, c]: [Color; 3]) -> Option<[f64; 2]> {
    let minus = |p: Color, q: Color| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let dot = |p: Color, q: Color| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (u, v, w) = (minus(b, a), minus(c, a), minus(pixel, a));
    let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
    let determinant = uu * vv - uv * uv;
    (determinant > 1e-3 * uu * vv)
        .then(|| [(dot(u, w) * vv - dot(v, w) * uv) / determinant, (dot(v, w) * uu - dot(u, w) * uv) / determinant])
}

/// Flat pixels for windows: those of regions that hold no block of `block` pixels' side are what a line covers, too.
pub(super) fn thick(regions: &[u32], width: usize, of_region: &[usize], block: u16) -> Vec<u16> {
    let mut is_thick = vec![false; of_region.len()];
    // Side of the largest block of one region whose lower right pixel is this one, of the row above and of this row; what holds a block is
    // not asked again.
    let [mut above, mut sides] = [vec![0_u16; width], vec![0_u16; width]];
    let rows = || regions.chunks_exact(width);
    for (row, upper) in rows().zip(core::iter::once(None).chain(rows().map(Some))) {
        core::mem::swap(&mut above, &mut sides);
        for (region, columns) in runs(row) {
            if region == NONE || is_thick[region as usize] {
                continue;
            }
            let mut left = 0;
            for x in columns.clone() {
                let inside = x > columns.start && upper.is_some_and(|upper| upper[x - 1..=x] == [region; 2]);
                left = if inside { 1 + above[x].min(above[x - 1]).min(left) } else { 1 };
                sides[x] = left;
                is_thick[region as usize] |= left >= block;
            }
        }
    }
    let mut colors = vec![u16::MAX; regions.len()];
    for (row, colors) in rows().zip(colors.chunks_exact_mut(width)) {
        for (region, columns) in runs(row).filter(|&(region, _)| region != NONE && is_thick[region as usize]) {
            colors[columns].fill(narrow(of_region[region as usize]));
        }
    }
    colors
}
