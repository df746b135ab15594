//! Whether the edges of a picture are wide: in a picture that was blurred, they change as steadily as ramps do.

use dvp_core::ImageView;

use super::STEP;

/// Least change between two pixels that is an edge: what rounding leaves is a quarter of it.
const LEAST: f32 = 4.0 * STEP;

/// Share of the change over five steps that the largest of them has where an edge is clear. An area has half of it or more in one step at any angle;
/// a blur of a pixel has .37, of one and a half .29.
const CLEAR: f32 = 0.4;

/// Steps within which an edge ends, on each side of its largest: a blur of four pixels has fallen to an eighth there.
const REACH: usize = 8;

/// Share of the edges of a picture, along rows and columns, that are clear rather than wide: up to .07 in drawings that were blurred by 1.5 pixels and more,
/// .16 and more in photographs, .74 and more in drawings; 1 where there are no edges.
#[must_use]
pub fn clear_share(image: &ImageView<'_, f32>) -> f64 {
    let (width, height) = (image.size().width(), image.size().height());
    let channels = [0, 1, 2].map(|c| image.channel(c));
    let mut counts = Counts::default();
    let mut steps = alloc::vec::Vec::new();
    let mut add = |start: usize, step: usize, count: usize| {
        let places = || (0..count).map(|k| start + k * step);
        steps.clear();
        steps.extend(
            places()
                .zip(places().skip(1))
                .map(|(a, b)| channels.iter().map(|channel| (channel[b] - channel[a]).abs()).fold(0.0, f32::max)),
        );
        counts.add(&steps);
    };
    (0..height).for_each(|y| add(y * width, 1, width));
    (0..width).for_each(|x| add(x, width, height));
    let all = counts.wide + counts.clear;
    if all == 0 { 1.0 } else { counts.clear as f64 / all as f64 }
}

/// Whether more edges are wide than clear.
#[must_use]
pub fn are_wide(image: &ImageView<'_, f32>) -> bool {
    clear_share(image) < 0.5
}

/// Numbers of edges.
#[derive(Default)]
struct Counts {
    clear: usize,
    wide: usize,
}

impl Counts {
    /// Adds the edges of a line of pixels, given by what changes from each to the next.
    fn add(&mut self, steps: &[f32]) {
        let at = |i: usize| steps.get(i).copied().unwrap_or(0.0);
        for (i, &step) in steps.iter().enumerate() {
            let (before, after) = (if i > 0 { at(i - 1) } else { 0.0 }, at(i + 1));
            if step <= LEAST || step < before || step <= after {
                continue;
            }
            let around: f32 = steps[i.saturating_sub(2)..steps.len().min(i + 3)].iter().sum();
            if step >= CLEAR * around {
                self.clear += 1;
                continue;
            }
            let ends = |its: &[f32]| its.len() < REACH || its.iter().any(|&other| other < 0.5 * step);
            let (left, right) = (&steps[i.saturating_sub(REACH)..i], &steps[i + 1..steps.len().min(i + 1 + REACH)]);
            if ends(left) && ends(right) {
                self.wide += 1;
            }
        }
    }
}
