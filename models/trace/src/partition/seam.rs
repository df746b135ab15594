//! Seams: where two things are painted edge to edge, renderers let through a little of what is behind them.
//!
//! A pixel that the front thing covers by b and the other one by 1 - b is `b front + (1 - b) ((1 - b) other + b behind)`: up to a
//! quarter of it is neither's. The seam says nothing of the drawing; the pixel becomes the mixture of the two that it stands for.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use dvp_core::image::distance;

use super::Color;
use super::cross::shares_of_three;
use super::flat::index;
use super::mix::Near;
use crate::tuning;

/// Colors of the palette that may show through, by falling area: what lies behind much is large.
const LARGEST: usize = 3;
/// All that may show through: the largest, and white, the page on which renderers paint what covers all of it.
pub(crate) const BEHIND: usize = LARGEST + 1;

/// A pixel that was a seam.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seam {
    /// Its index in the picture.
    pub(crate) pixel: u32,
    /// Color of what was painted last there.
    pub(crate) front: Color,
    /// What shows through, one of [`BEHIND`].
    pub(crate) behind: u16,
}

/// Mends the pixels of `open` (ascending) that are seams; they are open no more. Which those were.
pub(super) fn mend(
    pixels: &mut [[f32; 3]],
    size: [usize; 2],
    flat: &[u16],
    open: &mut Vec<usize>,
    [palette, white]: [&[Color]; 2],
    noise: f64,
) -> Vec<Seam> {
    let mut near = Near::default();
    let behind: Vec<Color> = palette.iter().take(LARGEST).chain(white).copied().collect();
    // Of each two colors the open pixels beside both, and those that show the page between them.
    let mut beside: BTreeMap<[u16; 2], [usize; 2]> = BTreeMap::new();
    let mut seams = Vec::with_capacity(open.len());
    for &i in &*open {
        let colors = near.around(flat, size, i);
        let seam = best(pixels[i].map(f64::from), colors, [palette, &behind], noise);
        for pair in pairs(colors) {
            let [all, shown] = beside.entry(pair).or_default();
            *all += 1;
            *shown += usize::from(seam.as_ref().is_some_and(|seam| seam.is_page && seam.between == pair));
        }
        seams.push(seam);
    }
    // Of the page nothing else is seen: it shows all along a seam, or not at all.
    let is_told = |seam: &Mixed| {
        let [all, shown] = beside.get(&seam.between).copied().unwrap_or_default();
        !seam.is_page || shown as f64 > tuning::SEAM_SHARE * all as f64
    };
    seams.iter_mut().for_each(|seam| *seam = seam.take().filter(is_told));
    // Along pixels that are no seams lies what is none, though some three colors explain it: a line that shows in two pixels, mostly in one. Single ones
    // are where seams meet.
    let at = |[x, y]: [usize; 2]| {
        if x < size[0] && y < size[1] { open.binary_search(&(y * size[0] + x)).ok() } else { None }
    };
    let is_beside_line = |i: usize| {
        let place = [i % size[0], i / size[0]];
        let moved =
            |[x, y]: [usize; 2], [right, down]: [isize; 2]| [x.wrapping_add_signed(right), y.wrapping_add_signed(down)];
        [[1, 0], [-1, 0], [0, 1], [0, -1]].into_iter().any(|across: [isize; 2]| {
            let along = [across[1], across[0]];
            let is_along = |k: isize| {
                let here = moved(place, along.map(|step| k * step));
                at(here).is_some() && at(moved(here, across)).is_some_and(|k| seams[k].is_none())
            };
            is_along(0) && (is_along(1) || is_along(-1))
        })
    };
    let mut mended = Vec::new();
    for (&i, seam) in open.iter().zip(&seams).filter(|&(&i, _)| !is_beside_line(i)) {
        if let &Some(Mixed { colors: [front, other], behind, share, .. }) = seam {
            pixels[i] = core::array::from_fn(|c| (share * front[c] + (1.0 - share) * other[c]) as f32);
            mended.push(Seam { pixel: index(i), front, behind });
        }
    }
    open.retain(|&i| mended.binary_search_by_key(&index(i), |seam| seam.pixel).is_err());
    mended
}

/// What a pixel shows.
struct Mixed {
    /// Two colors of the palette, the larger number first.
    between: [u16; 2],
    /// What was painted last, and the other one.
    colors: [Color; 2],
    /// What shows through, one of [`BEHIND`], and whether it is the page.
    behind: u16,
    is_page: bool,
    /// Coverage by what was painted last.
    share: f64,
}

/// Every two of some colors.
fn pairs(colors: &[u16]) -> impl Iterator<Item = [u16; 2]> {
    colors.iter().enumerate().flat_map(|(k, &a)| colors[..k].iter().map(move |&b| [a.max(b), a.min(b)]))
}

/// What a pixel is a seam of, if two of some colors nearby and what is behind them, the last of `all` the page, explain it.
fn best(pixel: Color, colors: &[u16], [palette, all]: [&[Color]; 2], noise: f64) -> Option<Mixed> {
    let mut best = (noise, None);
    for between in pairs(colors) {
        let [a, b] = between.map(|color| palette[color as usize]);
        let is_third = |color: Color| distance(color, a).min(distance(color, b)) > noise;
        for (k, &behind) in all.iter().enumerate().filter(|&(_, &color)| is_third(color)) {
            for colors in [[a, b], [b, a]] {
                let Some((share, misfit)) = seam(pixel, colors, behind) else { continue };
                if misfit < best.0 {
                    let is_page = k + 1 == all.len();
                    best = (misfit, Some(Mixed { between, colors, behind: k as u16, is_page, share }));
                }
            }
        }
    }
    best.1
}

/// Coverage by the front thing, and what is left, the most that a channel differs.
fn seam(pixel: Color, [front, other]: [Color; 2], behind: Color) -> Option<(f64, f64)> {
    let [of_other, of_behind] = shares_of_three(pixel, [front, other, behind])?;
    let share = 1.0 - of_other - of_behind;
    if !(0.0..=1.0).contains(&share) || of_behind > tuning::SEAM_MOST {
        return None;
    }
    let misfit = |share: f64| {
        let rest = 1.0 - share;
        let expected = |c: usize| share * front[c] + rest * (rest * other[c] + share * behind[c]);
        (0..3).map(|c| (pixel[c] - expected(c)).abs()).fold(0.0, f64::max)
    };
    Some((share, misfit(share)))
}
