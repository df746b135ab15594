//! Lines thinner than two pixels: found across, chained along, and taken out of the picture, so that what they lie on meets in
//! their middle as if they were not there.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::image::{coverage, distance};
use dvp_core::sort;

use super::chain::{Chain, Mark, are_near, crossings, hidden_crossings, join, median, read_once};
use super::cross::{Along, Canvas, Cross};
use super::{Color, ink, pair, shade};
use crate::stroke::{ThinChain, ThinSample};
use crate::tuning;

/// A thin line.
#[derive(Clone, Debug)]
pub struct ThinLine {
    /// Its color.
    pub color: Color,
    /// Where it passes.
    pub chain: ThinChain,
    /// Pixels just beyond its reach that show something of it all the same, less those that show less than nothing of it, and how many
    /// were looked at: near 0 of many if it is as clear as area coverage.
    pub stained: [i32; 2],
}

/// Finds thin lines. `palette`: the colors of flat pixels, those of thick regions first.
pub(super) fn find(canvas: &Canvas<'_>, palette: &[Color]) -> Vec<(ThinLine, Chain)> {
    let mut crosses = [Along::Columns, Along::Rows].map(|along| canvas.crosses(along));
    let mut colors = ink::colors(canvas, &mut crosses, palette);
    let axes = [Along::Columns, Along::Rows];
    let mut linked = [0, 1].map(|k| link(canvas, axes[k], &crosses[k], &colors, palette));
    shade::settle(canvas, &mut linked, &mut colors, palette);
    let mut chains = Vec::new();
    for ((along, crosses), mut linked) in axes.into_iter().zip(&crosses).zip(linked) {
        pair::grow(canvas, along, &mut linked, crosses, [palette, &colors]);
        chains.extend(linked.into_iter().flat_map(level_parts));
    }
    let chains = read_once(join(canvas, chains));
    let mut lines = Vec::new();
    for mut chain in chains {
        let color = colors[chain.colors.trailing_zeros() as usize];
        if let Some(thin) = constant(&mut chain, canvas.widest) {
            let stained = stained(canvas, &chain, color);
            lines.push((ThinLine { color, chain: thin, stained }, chain));
        }
    }
    in_order(canvas, lines)
}

/// Lines from back to front: where two cross the one in front shows its color.
fn in_order(canvas: &Canvas<'_>, mut lines: Vec<(ThinLine, Chain)>) -> Vec<(ThinLine, Chain)> {
    // Of every line those in front of it, and how many are behind it.
    let bounds: Vec<_> = lines.iter().map(|(_, chain)| chain.bounds()).collect();
    let mut in_front = alloc::vec![Vec::new(); lines.len()];
    let mut behind = alloc::vec![0_usize; lines.len()];
    for a in 0..lines.len() {
        for b in (0..a).filter(|&b| are_near(bounds[a], bounds[b], 0.0)) {
            for at in crossings(&lines[a].1, &lines[b].1) {
                let [x, y] = [at.x, at.y].map(|value| value.max(0.0) as usize);
                let i = y.min(canvas.size[1] - 1) * canvas.size[0] + x.min(canvas.size[0] - 1);
                let away = [a, b].map(|k| distance(lines[k].0.color, canvas.pixels[i].map(f64::from)));
                let (front, back) = if away[0] <= away[1] { (a, b) } else { (b, a) };
                in_front[back].push(front);
                behind[front] += 1;
            }
        }
    }
    let mut rest: BTreeSet<usize> = (0..lines.len()).collect();
    let mut free: BTreeSet<usize> = rest.iter().copied().filter(|&k| behind[k] == 0).collect();
    let mut order = Vec::new();
    // Of lines that lie around one another the first is taken for the hindmost.
    while let Some(hindmost) = free.first().or(rest.first()).copied() {
        order.push(hindmost);
        rest.remove(&hindmost);
        free.remove(&hindmost);
        for &front in in_front[hindmost].iter().filter(|front| rest.contains(front)) {
            behind[front] -= 1;
            if behind[front] == 0 {
                free.insert(front);
            }
        }
    }
    let mut place = alloc::vec![0; order.len()];
    order.into_iter().enumerate().for_each(|(k, line)| place[line] = k);
    let mut numbered: Vec<_> = place.into_iter().zip(lines.drain(..)).collect();
    sort::ascending(&mut numbered, |&(place, _)| place as f64);
    numbered.into_iter().map(|(_, line)| line).collect()
}

/// Of lines that may be wider than what is thin: those that cross one another, or cut in two what they lie on with the color of
/// what lies behind all, `back`: they would be holes. A pen draws what else is alone.
pub(super) fn crossing_lines(lines: Vec<(ThinLine, Chain)>, back: Color) -> Vec<(ThinLine, Chain)> {
    let mut keep = alloc::vec![false; lines.len()];
    for a in 0..lines.len() {
        for b in (0..lines.len()).filter(|&b| lines[a].0.color != lines[b].0.color) {
            if !hidden_crossings(&lines[a].1, &lines[b].1).is_empty() {
                (keep[a], keep[b]) = (true, true);
            }
        }
    }
    // What the same pen has drawn belongs to them.
    let pens: Vec<f64> = lines.iter().zip(&keep).filter(|&(_, &keep)| keep).map(|(line, _)| line.1.width).collect();
    let is_of_pen = |chain: &Chain| pens.iter().any(|width| (width - chain.width).abs() <= 0.05 * width);
    let is_slit = |(line, chain): &(ThinLine, Chain)| {
        let is_within = |mark: &&Mark| mark.cross.sides[0] == mark.cross.sides[1];
        line.color == back && 5 * chain.marks.iter().filter(is_within).count() > 4 * chain.marks.len()
    };
    lines
        .into_iter()
        .zip(keep)
        .filter_map(|(line, keep)| (keep || is_of_pen(&line.1) || is_slit(&line)).then_some(line))
        .collect()
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
fn constant(chain: &mut Chain, widest: f64) -> Option<ThinChain> {
    let n = chain.marks.len();
    if n < tuning::THIN_LEAST_LENGTH {
        return None;
    }
    let at = |k: usize| &chain.marks[k];
    let widths = chain.widths();
    let width = median(&widths);
    let tolerance = tuning::THIN_TOLERANCE * width + 0.08;
    let off = widths.iter().filter(|&&one| (one - width).abs() > tolerance).count();
    let thirds = [median(&widths[..n.div_ceil(3)]), median(&widths[n - n.div_ceil(3)..])];
    if !(0.08..=widest).contains(&width) || off * 5 > n || thirds.iter().any(|third| (third - width).abs() > tolerance)
    {
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

/// Of the pixels beside a chain that it does not reach, how many show something of it, and how many there are.
fn stained(canvas: &Canvas<'_>, chain: &Chain, color: Color) -> [i32; 2] {
    let [mut stained, mut count] = [0; 2];
    for three in chain.marks.windows(3) {
        let [before, here, behind] = [three[0], three[1], three[2]];
        let axis = here.axis();
        let slopes = [here.point - before.point, behind.point - here.point].map(|step| step.dot(axis));
        let is_next = |other: &Mark| other.along == here.along && other.cross.line.abs_diff(here.cross.line) == 1;
        // Where a line lies between two things their edge is under it, and renderers let through something of both.
        let is_clean = here.cross.sides[0] == here.cross.sides[1] && (slopes[0] - slopes[1]).abs() < 0.1;
        if !is_next(&before) || !is_next(&behind) || !is_clean {
            continue;
        }
        let (center, [from, to]) = (here.point.dot(axis), here.cross.run);
        let reach = 0.5 * (here.width + slopes[0].abs().max(slopes[1].abs())) + sigma(here.width);
        let first = ((center - reach).max(0.0) as usize).max(from) - 1;
        let last = ((center + reach).ceil() as usize).min(to);
        // The flat pixels beside a window are what its sides are.
        for (at, side) in [(first, from - 1), (last, to)] {
            let [pixel, side] = [at, side].map(|at| canvas.color(here.along, here.cross.line, at));
            let share = coverage(pixel, side, color);
            stained += i32::from(share > tuning::LEAST_STAIN) - i32::from(share < -tuning::LEAST_STAIN);
            count += 1;
        }
    }
    [stained, count]
}

/// Standard deviation of a line's center, pixels: where a line narrower than a pixel lies inside of one cannot be seen.
fn sigma(width: f64) -> f64 {
    tuning::THIN_SIGMA + 0.25 * (1.0 - width).max(0.0)
}
