//! Seams: where two things are painted edge to edge, renderers let through a little of what is behind them.
//!
//! A pixel that the front thing covers by b and the other one by 1 - b is `b front + (1 - b) ((1 - b) other + b behind)`: up to a
//! quarter of it is neither's. The seam says nothing of the drawing; the pixel becomes the mixture of the two that it stands for.

use alloc::vec::Vec;

use super::Color;
use super::cross::shares_of_three;
use super::flat::index;
use super::mix::Near;
use crate::tuning;

/// Colors that may show through, by falling area: what lies behind much is large.
pub(crate) const BEHIND: usize = 3;

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
    palette: &[Color],
    noise: f64,
) -> Vec<Seam> {
    let mut near = Near::default();
    let seams: Vec<_> =
        open.iter().map(|&i| best(pixels[i].map(f64::from), near.around(flat, size, i), palette, noise)).collect();
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
        if let &Some((front, other, behind, share)) = seam {
            pixels[i] = core::array::from_fn(|c| (share * front[c] + (1.0 - share) * other[c]) as f32);
            mended.push(Seam { pixel: index(i), front, behind });
        }
    }
    open.retain(|&i| mended.binary_search_by_key(&index(i), |seam| seam.pixel).is_err());
    mended
}

/// What a pixel is a seam of, if two of some colors nearby and what is behind them explain it: the front thing, the other one, what shows through, and
/// the coverage by the front thing.
fn best(pixel: Color, colors: &[u16], palette: &[Color], noise: f64) -> Option<(Color, Color, u16, f64)> {
    let mut best = (noise, None);
    for (k, &a) in colors.iter().enumerate() {
        for &b in &colors[..k] {
            for behind in (0..palette.len().min(BEHIND) as u16).filter(|&behind| behind != a && behind != b) {
                for [front, other] in [[a, b], [b, a]].map(|pair| pair.map(|color| palette[color as usize])) {
                    let Some((share, misfit)) = seam(pixel, front, other, palette[behind as usize]) else { continue };
                    if misfit < best.0 {
                        best = (misfit, Some((front, other, behind, share)));
                    }
                }
            }
        }
    }
    best.1
}

/// Coverage by the front thing, and what is left, the most that a channel differs.
fn seam(pixel: Color, front: Color, other: Color, behind: Color) -> Option<(f64, f64)> {
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
