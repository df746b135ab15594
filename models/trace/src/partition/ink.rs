//! The colors of thin lines: of the palette, or new ones, which no flat pixel shows.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use dvp_core::image::{coverage, distance, misfit};

use super::Color;
use super::cross::{Along, Canvas, Cross};
use crate::tuning;

/// A window that something crosses.
struct Window<'a> {
    along: Along,
    cross: &'a mut Cross,
    /// The color in it that is furthest from both sides, and how far it is.
    extreme: Color,
    away: f64,
}

/// Says of every window which colors a line across it may have; the colors, new ones last.
pub(super) fn colors(canvas: &Canvas<'_>, crosses: &mut [Vec<Vec<Cross>>; 2], palette: &[Color]) -> Vec<Color> {
    let mut colors = palette.to_vec();
    let [columns, rows] = crosses;
    let columns = columns.iter_mut().flatten().map(|cross| (Along::Columns, cross));
    let crosses = columns.chain(rows.iter_mut().flatten().map(|cross| (Along::Rows, cross)));
    let mut windows: Vec<Window<'_>> =
        crosses.filter_map(|(along, cross)| Window::of(canvas, along, cross, palette)).collect();
    for (k, &color) in palette.iter().enumerate() {
        windows.iter_mut().for_each(|window| window.try_color(canvas, (k, color), palette));
    }
    let opens: Vec<Color> = canvas.open.iter().map(|&i| canvas.pixels[i].map(f64::from)).collect();
    let mut rest: Vec<usize> = (0..windows.len()).filter(|&k| windows[k].cross.colors == 0).collect();
    for _ in 0..tuning::THIN_TRIES {
        if rest.len() < tuning::THIN_LEAST_LENGTH || colors.len() == MOST {
            break;
        }
        let bin = modal(rest.iter().map(|&k| windows[k].extreme));
        let Some(&first) = rest.iter().find(|&&k| bin_of(windows[k].extreme) == bin) else { break };
        let Window { ref cross, extreme, away, .. } = windows[first];
        let sides = cross.sides.map(|side| palette[side as usize]);
        let side = if distance(sides[0], extreme) <= distance(sides[1], extreme) { sides[0] } else { sides[1] };
        let seen = rest.iter().map(|&k| windows[k].extreme);
        let own = farthest(side, extreme, seen, canvas.noise);
        let darkest = farthest(side, own, opens.iter().copied(), canvas.noise);
        // Where lines of one color cross they are darker: what is no darker elsewhere is nowhere full.
        let is_more = coverage(darkest, side, own) > 1.15;
        let candidates = [if is_more { beyond(side, darkest, canvas) } else { own }, [0.0; 3], canvas.white];
        let counts = candidates.map(|color| rest.iter().filter(|&&k| windows[k].fits(canvas, color, palette)).count());
        let margin = counts[0] + tuning::THIN_LEAST_LENGTH.max(counts[0] / 4);
        let best = if counts[1].max(counts[2]) < margin {
            0
        } else if counts[1] >= counts[2] {
            1
        } else {
            2
        };
        if away < canvas.contrast || counts[best] < tuning::THIN_LEAST_LENGTH {
            rest.retain(|&k| bin_of(windows[k].extreme) != bin);
            continue;
        }
        let color = (colors.len(), candidates[best]);
        // Between two colors a third one of the palette may explain by chance what a line of this color is: which it is its neighbors tell.
        let is_asked =
            |window: &&mut Window<'_>| window.cross.colors == 0 || window.cross.sides[0] != window.cross.sides[1];
        windows.iter_mut().filter(is_asked).for_each(|window| window.try_color(canvas, color, palette));
        rest.retain(|&k| windows[k].cross.colors == 0);
        colors.push(candidates[best]);
    }
    windows.iter_mut().for_each(|window| window.keep_shown(canvas, &colors));
    colors
}

/// Most colors: bits of [`Cross::colors`].
pub(super) const MOST: usize = 128;

impl<'a> Window<'a> {
    fn of(canvas: &Canvas<'_>, along: Along, cross: &'a mut Cross, palette: &[Color]) -> Option<Self> {
        let sides = cross.sides.map(|side| palette[side as usize]);
        let away = |color: Color| distance(color, sides[0]).min(distance(color, sides[1]));
        let run = (cross.run[0]..cross.run[1]).map(|at| canvas.color(along, cross.line, at));
        let extreme = run.max_by(|&a, &b| away(a).total_cmp(&away(b)))?;
        Some(Self { along, cross, extreme, away: away(extreme) })
    }

    fn try_color(&mut self, canvas: &Canvas<'_>, (k, color): (usize, Color), palette: &[Color]) {
        self.cross.colors |= u128::from(self.fits(canvas, color, palette)) << k;
    }

    /// Between two colors a third one may explain by chance what a line of another color is: of those that do, what three pixels along the line
    /// show in full is no chance, and is kept alone.
    fn keep_shown(&mut self, canvas: &Canvas<'_>, colors: &[Color]) {
        let Self { along, ref mut cross, .. } = *self;
        let [lines, _] = canvas.extent(along);
        if cross.sides[0] == cross.sides[1] || cross.line == 0 || cross.line + 1 == lines {
            return;
        }
        let shows = |color: Color| {
            let is_full = |line, at| distance(canvas.color(along, line, at), color) <= canvas.noise;
            (cross.run[0]..cross.run[1]).any(|at| (cross.line - 1..=cross.line + 1).all(|line| is_full(line, at)))
        };
        let shown = (0..colors.len()).filter(|&k| cross.colors >> k & 1 == 1 && shows(colors[k]));
        let shown = shown.fold(0, |shown, k| shown | 1 << k);
        if shown != 0 {
            cross.colors = shown;
        }
    }

    fn fits(&self, canvas: &Canvas<'_>, color: Color, palette: &[Color]) -> bool {
        let widest = canvas.widest * core::f64::consts::SQRT_2;
        canvas
            .measure(self.along, self.cross, color, palette)
            .is_some_and(|[_, width, misfit]| misfit <= canvas.noise && width <= widest)
    }
}

/// Colors that are alike, 16 levels to a channel.
fn bin_of(color: Color) -> [u8; 3] {
    color.map(|value| (value * 15.0 + 0.5) as u8)
}

/// The bin with the most colors.
fn modal(colors: impl Iterator<Item = Color>) -> [u8; 3] {
    let mut counts: BTreeMap<[u8; 3], usize> = BTreeMap::new();
    for color in colors {
        *counts.entry(bin_of(color)).or_default() += 1;
    }
    counts.into_iter().max_by_key(|&(_, count)| count).map_or([0; 3], |(bin, _)| bin)
}

/// The color furthest from `side` on the ray through `through`.
fn farthest(side: Color, through: Color, colors: impl Iterator<Item = Color>, noise: f64) -> Color {
    let on_ray = |color: &Color| {
        let t = coverage(*color, side, through);
        (t >= 1.0 && misfit(*color, side, through, t) <= noise).then_some((t, *color))
    };
    colors.filter_map(|color| on_ray(&color)).max_by(|a, b| a.0.total_cmp(&b.0)).map_or(through, |(_, color)| color)
}

/// What a line that is nowhere full is likely to be: black on gray, white on gray; else as much as is seen.
fn beyond(side: Color, seen: Color, canvas: &Canvas<'_>) -> Color {
    let is_gray = |color: Color| distance(color, canvas.white.map(|value| value * color[0])) <= tuning::LEAST_CONTRAST;
    match is_gray(side) && is_gray(seen) {
        true if seen[0] < side[0] => [0.0; 3],
        true => canvas.white,
        false => seen,
    }
}
