//! What of a picture changes steadily: connected pixels that lie on the line between their neighbors.

use alloc::vec::Vec;

use dvp_core::ImageView;

use super::STEP;
use crate::partition::OUTSIDE;

/// How far a pixel may lie off the middle of its neighbors, twice: each of the three is rounded, by half a step for every layer that was painted
/// there, and what curves a little is steady too.
const BEND: f32 = 4.0 * STEP;

/// Share of what lies off the middle of its neighbors by more than rounding leaves, of what changes: more is noise, or what a camera saw. Drawings
/// have up to .034, pictures of cameras .067 and more.
const ROUGH: f64 = 0.05;

/// Rows and columns of a picture that are looked at before all are.
const LOOKED_AT: usize = 64;

/// Whether colors change steadily anywhere: along a row or a column, where every pixel lies on the lines between its neighbors, by more than may
/// lie between neighbors there. In large pictures a part of the rows and columns is looked at, since most have no ramps: what lies between them is
/// small there.
pub(super) fn may_change(image: &ImageView<'_, f32>) -> bool {
    let (width, height) = (image.size().width(), image.size().height());
    let channels = [0, 1, 2].map(|c| image.channel(c));
    let is_steady = |i: usize, step: usize| {
        channels.iter().all(|channel| (channel[i - step] + channel[i + step] - 2.0 * channel[i]).abs() <= BEND)
    };
    // Along a line of pixels: the least and the most of each channel since it was not steady.
    let changes = |start: usize, step: usize, count: usize| {
        let mut range = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
        (0..count).map(|k| start + k * step).any(|i| {
            if !(is_steady(i, 1) && is_steady(i, width)) {
                range = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
                return false;
            }
            range.iter_mut().zip(channels).any(|(range, channel)| {
                *range = [range[0].min(channel[i]), range[1].max(channel[i])];
                range[1] - range[0] > BEND
            })
        })
    };
    let part = (width.min(height) / LOOKED_AT).max(1);
    let [across, down] = [width, height].map(|side| side.saturating_sub(2));
    (0..down).step_by(part).any(|k| changes((k + 1) * width + 1, 1, across))
        || (0..across).step_by(part).any(|k| changes(width + 1 + k, width, down))
}

/// Connected parts of a picture in which colors change steadily, or not at all.
pub(super) struct Smooth {
    /// Part of every pixel, or [`OUTSIDE`].
    pub(super) labels: Vec<u32>,
    /// Pixels of each part, in rows.
    pub(super) parts: Vec<Vec<u32>>,
}

impl Smooth {
    /// The parts of a picture of `width` columns. Every pixel of a part belongs to a block of three by three that is steady all through: the middle
    /// of a straight edge lies between its neighbors as well.
    pub(super) fn of(pixels: &[[f32; 3]], width: usize) -> Self {
        let height = pixels.len() / width;
        let is_in = spread(&all_around(&steady(pixels, width), width), width);
        let (mut labels, mut parts) = (alloc::vec![OUTSIDE; pixels.len()], Vec::new());
        for first in 0..pixels.len() {
            if !is_in[first] || labels[first] != OUTSIDE {
                continue;
            }
            let label = parts.len() as u32;
            let (mut part, mut next) = (alloc::vec![first as u32], 0);
            labels[first] = label;
            while let Some(&i) = part.get(next) {
                next += 1;
                for neighbor in neighbors(i as usize, width, height).into_iter().flatten() {
                    if is_in[neighbor] && labels[neighbor] == OUTSIDE {
                        labels[neighbor] = label;
                        part.push(neighbor as u32);
                    }
                }
            }
            part.sort_unstable();
            parts.push(part);
        }
        Self { labels, parts }
    }
}

/// Whether what changes in parts of a picture of `width` columns changes by leaps: noise hides how it changes.
pub(super) fn is_rough<'a>(pixels: &[[f32; 3]], width: usize, parts: impl Iterator<Item = &'a Vec<u32>>) -> bool {
    let (mut off, mut all) = (0, 0);
    let inside = width + 1..pixels.len().saturating_sub(width + 1);
    for i in parts.flatten().map(|&i| i as usize).filter(|i| inside.contains(i)) {
        let beside = [1, width].map(|step| (pixels[i - step], pixels[i + step]));
        let changes = |(a, b): &([f32; 3], [f32; 3])| (0..3).any(|c| (a[c] - b[c]).abs() > 0.5 * STEP);
        if !beside.iter().any(changes) {
            continue;
        }
        let bends = beside.iter().flat_map(|(a, b)| (0..3).map(|c| (a[c] + b[c] - 2.0 * pixels[i][c]).abs()));
        for bend in bends.filter(|&bend| bend <= BEND) {
            all += 1;
            off += usize::from(bend > 2.5 * STEP);
        }
    }
    f64::from(off as u32) > ROUGH * f64::from(all as u32)
}

/// Which pixels lie on the line between their neighbors, along the row and along the column. Beyond the border there is none.
fn steady(pixels: &[[f32; 3]], width: usize) -> Vec<bool> {
    let bends = |a: &[f32; 3], b: &[f32; 3], c: &[f32; 3]| (0..3).any(|k| (a[k] + c[k] - 2.0 * b[k]).abs() > BEND);
    let mut steady = alloc::vec![true; pixels.len()];
    for (row, its) in pixels.chunks(width).zip(steady.chunks_mut(width)) {
        for (three, its) in row.windows(3).zip(its.iter_mut().skip(1)) {
            *its = !bends(&three[0], &three[1], &three[2]);
        }
    }
    let below = pixels.iter().skip(2 * width);
    for (((a, b), c), its) in
        pixels.iter().zip(&pixels[width.min(pixels.len())..]).zip(below).zip(steady.iter_mut().skip(width))
    {
        *its &= !bends(a, b, c);
    }
    steady
}

/// Which pixels are the middle of three by three that are all marked.
fn all_around(marked: &[bool], width: usize) -> Vec<bool> {
    let mut across = alloc::vec![false; marked.len()];
    for (row, its) in marked.chunks(width).zip(across.chunks_mut(width)) {
        for (three, its) in row.windows(3).zip(its.iter_mut().skip(1)) {
            *its = three.iter().all(|&is_marked| is_marked);
        }
    }
    let mut all = alloc::vec![false; marked.len()];
    for (i, its) in all.iter_mut().enumerate().take(marked.len().saturating_sub(width)).skip(width) {
        *its = across[i - width] && across[i] && across[i + width];
    }
    all
}

/// Which pixels belong to three by three around a marked one.
fn spread(marked: &[bool], width: usize) -> Vec<bool> {
    let mut spread = alloc::vec![false; marked.len()];
    for (i, _) in marked.iter().enumerate().filter(|(_, is_marked)| **is_marked) {
        for row in [i - width, i, i + width] {
            spread[row - 1..row + 2].fill(true);
        }
    }
    spread
}

/// The pixels above, left, right and below.
pub(super) fn neighbors(i: usize, width: usize, height: usize) -> [Option<usize>; 4] {
    let (x, y) = (i % width, i / width);
    [
        (y > 0).then(|| i - width),
        (x > 0).then(|| i - 1),
        (x + 1 < width).then_some(i + 1),
        (y + 1 < height).then_some(i + width),
    ]
}
