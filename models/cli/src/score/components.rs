//! Connected components of equal color: what the simplest program finds, as the first row of every table.

use alloc::collections::{BTreeMap, VecDeque};

use dvp_core::ImageSize;

use super::objects::Parts;

/// What belongs to no part yet.
const OPEN: u32 = u32::MAX;

/// The parts of exactly one color, `pixels` r, g, b, r, g, b, ...; neighbors are the four beside a pixel. Parts of the commonest color are
/// the background.
///
/// Parts without a square of 2 x 2 pixels are edges: their pixels go to the nearest part, counted in steps from pixel to pixel. Parts have
/// no order, and no class.
///
/// *Dimensions*: `pixels` 3 x pixels of `size`; what is missing counts as black.
#[must_use]
pub fn connected_components(pixels: &[u8], size: ImageSize) -> Parts {
    let (width, count) = (size.width(), size.pixels());
    let color = |pixel: usize| pixels.get(3 * pixel..3 * pixel + 3).map_or([0; 3], |c| [c[0], c[1], c[2]]);
    let colors: Vec<[u8; 3]> = (0..count).map(color).collect();
    let mut frequencies = BTreeMap::new();
    for color in &colors {
        *frequencies.entry(color).or_insert(0_usize) += 1;
    }
    let ground = frequencies.iter().max_by_key(|&(_, &frequency)| frequency).map_or([0; 3], |(color, _)| **color);
    let mut labels = vec![OPEN; count];
    let mut visited = vec![false; count];
    let mut parts = 0;
    for start in 0..count {
        if visited[start] {
            continue;
        }
        visited[start] = true;
        let mut part = vec![start];
        let mut next = 0;
        while next < part.len() {
            for neighbor in neighbors(part[next], size) {
                if !visited[neighbor] && colors[neighbor] == colors[start] {
                    visited[neighbor] = true;
                    part.push(neighbor);
                }
            }
            next += 1;
        }
        // The pixel is the upper left one of a square; all four are of one color, so of one part.
        let has_square = part.iter().any(|&pixel| {
            let right = pixel % width + 1 < width;
            right
                && pixel + width + 1 < count
                && [pixel + 1, pixel + width, pixel + width + 1].iter().all(|&other| colors[other] == colors[start])
        });
        if has_square {
            let is_ground = colors[start] == ground;
            parts += u32::from(!is_ground);
            let label = if is_ground { 0 } else { parts };
            part.iter().for_each(|&pixel| labels[pixel] = label);
        }
    }
    fill(&mut labels, size);
    let whole = (1..=parts).flat_map(|part| labels.iter().map(move |&label| label == part)).collect();
    Parts { labels, whole: Some(whole), ordered: false, classes: Vec::new() }
}

/// Gives open pixels the label of the nearest other one; 0 if all are open.
fn fill(labels: &mut [u32], size: ImageSize) {
    let mut waiting: VecDeque<usize> = (0..labels.len()).filter(|&pixel| labels[pixel] != OPEN).collect();
    while let Some(pixel) = waiting.pop_front() {
        for neighbor in neighbors(pixel, size) {
            if labels[neighbor] == OPEN {
                labels[neighbor] = labels[pixel];
                waiting.push_back(neighbor);
            }
        }
    }
    labels.iter_mut().filter(|label| **label == OPEN).for_each(|label| *label = 0);
}

/// The pixels beside one.
fn neighbors(pixel: usize, size: ImageSize) -> impl Iterator<Item = usize> {
    let (width, height) = (size.width(), size.height());
    let (column, row) = (pixel % width, pixel / width);
    [
        (column > 0).then(|| pixel - 1),
        (column + 1 < width).then(|| pixel + 1),
        (row > 0).then(|| pixel - width),
        (row + 1 < height).then(|| pixel + width),
    ]
    .into_iter()
    .flatten()
}
