//! Lines thinner than two pixels: found across, chained along, and taken out of the picture, so that what they lie on meets in
//! their middle as if they were not there.


use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::Vec2;

use super::chain::{Chain, join};
use super::cross::{Along, Canvas, Cross};
use super::palette::distance;
use super::Color;
use crate::stroke::{ThinChain, ThinSample};
use crate::tuning;

/// A thin line.
#[derive(Clone, Debug)]
pub struct ThinLine {
    /// Its color.
    pub color: Color,
    /// Where it passes.
    pub chain: ThinChain,
}

/// Most colors that only thin lines have.
const MOST_NEW_COLORS: usize = 24;

/// Finds thin lines. `palette`: the colors of flat pixels, those of thick regions first.
pub(super) fn find(canvas: &Canvas<'_>, palette: &[Color]) -> (Vec<ThinLine>, Vec<Chain>) {
    let mut crosses = [Along::Columns, Along::Rows].map(|along| canvas.crosses(along));
    let colors = color(canvas, &mut crosses, palette);
    let mut chains = Vec::new();
    for (along, crosses) in [Along::Columns, Along::Rows].into_iter().zip(&crosses) {
        for chain in link(canvas, along, crosses, &colors, palette) {
            chains.extend(level_parts(chain));
        }
    }
    let chains = join(canvas, chains);
    let mut lines = Vec::new();
    let mut taken = Vec::new();
    for mut chain in chains {
        let color = colors[chain.colors.trailing_zeros() as usize];
        if let Some(thin) = constant(&mut chain) {
            lines.push(ThinLine { color, chain: thin });
            taken.push(chain);
        }
    }
    (lines, taken)
}

/// Says of every window which colors a line across it may have; the colors, new ones last.
fn color(canvas: &Canvas<'_>, crosses: &mut [Vec<Vec<Cross>>; 2], palette: &[Color]) -> Vec<Color> {
    let mut colors = palette.to_vec();
    let mut rest: Vec<(f64, Along, &mut Cross, Color)> = Vec::new();
    let [columns, rows] = crosses;
    let columns = columns.iter_mut().flatten().map(|cross| (Along::Columns, cross));
    for (along, cross) in columns.chain(rows.iter_mut().flatten().map(|cross| (Along::Rows, cross))) {
        for (k, &color) in palette.iter().enumerate() {
            cross.colors |= u128::from(fits(canvas, along, cross, color, palette)) << k;
        }
        if cross.colors == 0 {
            let sides = cross.sides.map(|side| palette[side as usize]);
            let away = |color: &Color| distance(*color, sides[0]).min(distance(*color, sides[1]));
            let run = (cross.run[0]..cross.run[1]).map(|at| canvas.color(along, cross.line, at));
            if let Some(extreme) = run.max_by(|a, b| away(a).total_cmp(&away(b))) {
                rest.push((away(&extreme), along, cross, extreme));
            }
        }
    }
    rest.sort_by(|a, b| b.0.total_cmp(&a.0));
    for _ in 0..MOST_NEW_COLORS {
        let Some(&(away, .., color)) = rest.first() else { break };
        if away < tuning::LEAST_CONTRAST || colors.len() == 128 {
            break;
        }
        let (explained, left): (Vec<_>, Vec<_>) =
            rest.into_iter().partition(|(_, along, cross, _)| fits(canvas, *along, cross, color, palette));
        rest = left;
        if explained.len() >= tuning::THIN_LEAST_LENGTH {
            for (_, _, cross, _) in explained {
                cross.colors |= 1 << colors.len();
            }
            colors.push(color);
        } else {
            rest.extend(explained.into_iter().skip(1));
            rest.sort_by(|a, b| b.0.total_cmp(&a.0));
        }
    }
    colors
}

fn fits(canvas: &Canvas<'_>, along: Along, cross: &Cross, color: Color, palette: &[Color]) -> bool {
    canvas.measure(along, cross, color, palette).is_some_and(|[_, width, misfit]| {
        misfit <= canvas.noise && width <= tuning::THIN_WIDTH * core::f64::consts::SQRT_2
    })
}

/// Chains of windows side by side with a color in common.
fn link(canvas: &Canvas<'_>, along: Along, crosses: &[Vec<Cross>], colors: &[Color], palette: &[Color]) -> Vec<Chain> {
    let mut done: Vec<Chain> = Vec::new();
    let mut open: Vec<Chain> = Vec::new();
    for (line, of_line) in crosses.iter().enumerate() {
        let (live, ended): (Vec<Chain>, Vec<Chain>) = open.into_iter().partition(|chain| chain.last_line() + 1 == line);
        done.extend(ended);
        open = live;
        for cross in of_line.iter().filter(|cross| cross.colors != 0) {
            let color = colors[cross.colors.trailing_zeros() as usize];
            let Some([center, width, _]) = canvas.measure(along, cross, color, palette) else { continue };
            let fit = |chain: &Chain| {
                let off = (chain.last_center(along) - center).abs();
                (chain.last_line() + 1 == line && chain.colors & cross.colors != 0 && off <= 1.5).then_some(off)
            };
            let best = (0..open.len()).filter_map(|k| Some((fit(&open[k])?, k))).min_by(|a, b| a.0.total_cmp(&b.0));
            match best {
                Some((_, k)) => open[k].push(along, *cross, center, width),
                None => open.push(Chain::new(along, *cross, center, width)),
            }
        }
    }
    done.extend(open);
    // One color for all windows of a chain.
    for chain in &mut done {
        let color = colors[chain.colors.trailing_zeros() as usize];
        for mark in &mut chain.marks {
            if let Some([center, width, _]) = canvas.measure(along, &mark.cross, color, palette) {
                mark.place(center, width);
            }
        }
    }
    done
}

/// The parts of a chain where windows across it are the shorter ones.
fn level_parts(chain: Chain) -> Vec<Chain> {
    let n = chain.marks.len();
    let is_level = |k: usize| {
        let [a, b] = [chain.marks[k.saturating_sub(3)], chain.marks[(k + 3).min(n - 1)]];
        let step = b.point - a.point;
        let axis = a.axis();
        step.dot(axis).abs() <= 1.03 * step.dot(axis.perp()).abs() + 0.01
    };
    let mut parts = Vec::new();
    let mut k = 0;
    while k < n {
        let length = (k..n).take_while(|&j| is_level(j)).count();
        if length >= 3 {
            parts.push(Chain { marks: chain.marks[k..k + length].to_vec(), ..chain.clone() });
        }
        k += length.max(1);
    }
    parts
}

/// The line that a chain is, if it is long enough and its width the same all along.
fn constant(chain: &mut Chain) -> Option<ThinChain> {
    let n = chain.marks.len();
    if n < tuning::THIN_LEAST_LENGTH {
        return None;
    }
    let at = |k: usize| &chain.marks[k];
    let widths: Vec<f64> = (0..n)
        .map(|k| {
            let step = at((k + 3).min(n - 1)).point - at(k.saturating_sub(3)).point;
            let along = step.normalized().unwrap_or_default();
            at(k).width * along.perp().dot(at(k).axis()).abs().max(0.6)
        })
        .collect();
    let median = |values: &[f64]| {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    };
    let width = median(&widths);
    let tolerance = tuning::THIN_TOLERANCE * width + 0.08;
    let off = widths.iter().filter(|&&one| (one - width).abs() > tolerance).count();
    let thirds = [median(&widths[..n.div_ceil(3)]), median(&widths[n - n.div_ceil(3)..])];
    if !(0.08..=tuning::THIN_WIDTH).contains(&width) || off * 5 > n || thirds.iter().any(|third| (third - width).abs() > tolerance) {
        return None;
    }
    // Ends that are covered in part say how much further the line goes.
    let mut keep = [0, n];
    let mut ends = [0.0; 2];
    if !chain.is_closed {
        while keep[0] + 3 < n && widths[keep[0]] < width - tolerance && keep[0] < 2 {
            ends[0] += widths[keep[0]] / width;
            keep[0] += 1;
        }
        while keep[1] > keep[0] + 3 && widths[keep[1] - 1] < width - tolerance && n - keep[1] < 2 {
            ends[1] += widths[keep[1] - 1] / width;
            keep[1] -= 1;
        }
    }
    let is_good = |k: usize| (widths[k] - width).abs() <= 2.0 * tolerance;
    let samples: Vec<ThinSample> = (keep[0]..keep[1])
        .filter(|&k| is_good(k))
        .map(|k| ThinSample { point: at(k).point, axis: at(k).axis(), sigma: sigma(at(k).width), width: at(k).width })
        .collect();
    chain.width = width;
    (samples.len() >= 3).then_some(ThinChain { samples, ends, is_closed: chain.is_closed })
}

/// Standard deviation of a line's center, pixels: where a line narrower than a pixel lies inside of one cannot be seen.
fn sigma(width: f64) -> f64 {
    tuning::THIN_SIGMA + 0.25 * (1.0 - width).max(0.0)
}

/// Takes the lines out of the picture: on both sides of their middle what lies beside them goes on.
pub(super) fn erase(pixels: &mut [[f32; 3]], size: [usize; 2], flat: &[u16], open: &[bool], palette: &[Color], chains: &[Chain]) {
    let mut known: Vec<bool> = flat.iter().map(|&color| color != u16::MAX).collect();
    let mut holes = Vec::new();
    let index = |along: Along, line: usize, at: usize| match along {
        Along::Columns => at * size[0] + line,
        Along::Rows => line * size[0] + at,
    };
    for chain in chains {
        let reach = 0.5 * chain.width + 1.2;
        let mut around = |from: Vec2<f64>, to: Vec2<f64>, only_open: bool| {
            let [x0, y0] = [from.x.min(to.x) - reach, from.y.min(to.y) - reach].map(|low| low.max(0.0) as usize);
            let [x1, y1] = [from.x.max(to.x) + reach, from.y.max(to.y) + reach].map(|high| high.max(0.0) as usize + 1);
            for y in y0..y1.min(size[1]) {
                for x in x0..x1.min(size[0]) {
                    let i = y * size[0] + x;
                    let pixel = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
                    let segment = dvp_core::geometry::LineSegment::new(from, to);
                    let foot = from.lerp(to, segment.nearest(pixel).share);
                    if flat[i] == u16::MAX && (open[i] || !only_open) && (pixel - foot).length() < reach {
                        holes.push(i);
                    }
                }
            }
        };
        for pair in chain.marks.windows(2) {
            if (pair[1].point - pair[0].point).length() > 1.9 || pair[0].along != pair[1].along {
                around(pair[0].point, pair[1].point, false);
            }
        }
        if let [first, .., last] = &chain.marks[..] {
            around(first.point, first.point, true);
            around(last.point, last.point, true);
        }
        for mark in &chain.marks {
            let sides = mark.cross.sides.map(|side| palette[side as usize]);
            let center = mark.point.dot(mark.axis());
            for at in mark.cross.run[0]..mark.cross.run[1] {
                let share = (center - at as f64).clamp(0.0, 1.0);
                let i = index(mark.along, mark.cross.line, at);
                pixels[i] = core::array::from_fn(|c| (share * sides[0][c] + (1.0 - share) * sides[1][c]) as f32);
                known[i] = true;
            }
        }
    }
    // What is left under crossings and corners is as what is nearest.
    holes.retain(|&i| !known[i]);
    holes.sort_unstable();
    holes.dedup();
    while !holes.is_empty() {
        let near = |i: usize| {
            let (x, y) = (i % size[0], i / size[0]);
            let beside = [(x > 0).then(|| i - 1), (x + 1 < size[0]).then_some(i + 1), (y > 0).then(|| i - size[0]), (y + 1 < size[1]).then_some(i + size[0])];
            beside.into_iter().flatten().find(|&j| known[j])
        };
        let filled: Vec<(usize, usize)> = holes.iter().filter_map(|&i| Some((i, near(i)?))).collect();
        if filled.is_empty() {
            break;
        }
        for &(i, from) in &filled {
            pixels[i] = pixels[from];
        }
        for (i, _) in filled {
            known[i] = true;
        }
        holes.retain(|&i| !known[i]);
    }
}
