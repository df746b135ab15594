//! What of a picture changes steadily: connected pixels that lie on the line between their neighbors.

use alloc::vec::Vec;

use super::STEP;
use crate::partition::OUTSIDE;

/// How far a pixel may lie off the middle of its neighbors: each of the three is rounded, by half a step, and what curves a little
/// is steady too.
const BEND: f32 = 2.5 * STEP;

/// Connected parts of a picture in which colors change steadily, or not at all.
pub(super) struct Smooth {
    /// Part of every pixel, or [`OUTSIDE`].
    pub(super) labels: Vec<u32>,
    /// Pixels of each part, in rows.
    pub(super) parts: Vec<Vec<u32>>,
}

impl Smooth {
    /// The parts of a picture of `width` columns. Every pixel of a part belongs to a block of three by three that is steady all
    /// through: the middle of a straight edge lies between its neighbors as well.
    pub(super) fn of(pixels: &[[f32; 3]], width: usize) -> Self {
        let height = pixels.len() / width;
        let bend = |i: usize, step: usize| {
            (0..3).any(|c| (pixels[i - step][c] + pixels[i + step][c] - 2.0 * pixels[i][c]).abs() > BEND)
        };
        let is_steady = |i: usize| {
            let (x, y) = (i % width, i / width);
            let inner = [x > 0 && x + 1 < width, y > 0 && y + 1 < height];
            !(inner[0] && bend(i, 1) || inner[1] && bend(i, width))
        };
        let steady: Vec<bool> = (0..pixels.len()).map(is_steady).collect();
        let mut is_in = alloc::vec![false; pixels.len()];
        for y in 1..height.saturating_sub(1) {
            for x in 1..width.saturating_sub(1) {
                let block = || (y - 1..=y + 1).map(|row| row * width + x - 1..row * width + x + 2);
                if block().flatten().all(|i| steady[i]) {
                    block().for_each(|row| is_in[row].fill(true));
                }
            }
        }
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
