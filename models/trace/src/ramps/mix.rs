//! Pixels between leveled parts: as much of each color as the picture shows of what was leveled.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::STEP;
use super::grow::{Regions, sample};
use crate::partition::{Color, OUTSIDE};

/// How far the colors may be that a pixel is mixed of, pixels.
const REACH: usize = 2;
/// What a mixture of few colors may miss, before one more color is looked for.
const EXPLAINED: f64 = 3.0 * STEP as f64;

/// A color that a pixel may show, and what it is leveled to.
#[derive(Clone, Copy)]
struct Surface {
    shown: Color,
    leveled: Color,
}

/// The picture with each ramp in its color of `markers`.
pub(super) fn leveled(pixels: &[[f32; 3]], width: usize, regions: &Regions, markers: &[Color]) -> Vec<[f32; 3]> {
    let mut near = Vec::new();
    let mut leveled = pixels.to_vec();
    for (i, (leveled, &label)) in leveled.iter_mut().zip(&regions.labels).enumerate() {
        if let Some(marker) = markers.get(label as usize) {
            *leveled = marker.map(|value| value as f32);
            continue;
        }
        if label != OUTSIDE {
            continue;
        }
        labels_near(&regions.labels, width, i, &mut near);
        if !near.iter().any(|&(label, _)| (label as usize) < markers.len()) {
            continue;
        }
        let (point, color) = sample(pixels, width, i);
        let surface = |label: usize, from: usize| match regions.ramps.get(label) {
            Some(region) => {
                let shown = region.fitted.color(point);
                // What a ramp that does not explain its part leaves beside the pixel, it leaves there too.
                let (place, its) = sample(pixels, width, from);
                let beside = region.fitted.color(place);
                let left = if region.is_exact { [0.0; 3] } else { minus(its, beside) };
                Surface { shown: core::array::from_fn(|c| shown[c] + left[c]), leveled: markers[label] }
            }
            None => {
                let color = regions.flat_colors[label - markers.len()];
                Surface { shown: color, leveled: color }
            }
        };
        let own: Vec<Surface> = near.iter().map(|&(label, from)| surface(label as usize, from)).collect();
        let (mut missed, mut best) = mixture(&own, color);
        if missed > EXPLAINED {
            // A line without a pixel of its own, in one of the colors of the picture.
            for flat in &regions.flat_colors {
                let more: Vec<Surface> =
                    own.iter().copied().chain([Surface { shown: *flat, leveled: *flat }]).collect();
                let (its, other) = mixture(&more, color);
                if its < missed {
                    (missed, best) = (its, other);
                }
            }
        }
        *leveled = best.map(|value| value.clamp(0.0, 1.0) as f32);
    }
    leveled
}

/// The labels around a pixel, the nearest first, each once, with a pixel that has it.
fn labels_near(labels: &[u32], width: usize, i: usize, near: &mut Vec<(u32, usize)>) {
    near.clear();
    let (x, y, height) = (i % width, i / width, labels.len() / width);
    for reach in 1..=REACH {
        for row in y.saturating_sub(reach)..=(y + reach).min(height - 1) {
            for column in x.saturating_sub(reach)..=(x + reach).min(width - 1) {
                let label = labels[row * width + column];
                if label != OUTSIDE && near.iter().all(|&(other, _)| other != label) {
                    near.push((label, row * width + column));
                }
            }
        }
    }
}

/// The mixture of one, two or three surfaces that is nearest to a color: what it misses, and the color when they are leveled, what it misses
/// included.
fn mixture(surfaces: &[Surface], color: Color) -> (f64, Color) {
    let mut best = (f64::INFINITY, color);
    let mut take = |parts: &[(f64, &Surface)], worse: f64| {
        let missed: Color = core::array::from_fn(|c| color[c] - parts.iter().map(|(w, s)| w * s.shown[c]).sum::<f64>());
        let size = missed.iter().map(|v| v * v).sum::<f64>().sqrt() + worse;
        if size < best.0 {
            best =
                (size, core::array::from_fn(|c| missed[c] + parts.iter().map(|(w, s)| w * s.leveled[c]).sum::<f64>()));
        }
    };
    // One more color must explain half a step more.
    let worse = 0.5 * f64::from(STEP);
    for (k, a) in surfaces.iter().enumerate() {
        take(&[(1.0, a)], 0.0);
        for (l, b) in surfaces.iter().enumerate().skip(k + 1) {
            let way = minus(b.shown, a.shown);
            let length = dot(way, way);
            if length <= 0.0 {
                continue;
            }
            let share = (dot(minus(color, a.shown), way) / length).clamp(0.0, 1.0);
            take(&[(1.0 - share, a), (share, b)], worse);
            for c in &surfaces[l + 1..] {
                let other = minus(c.shown, a.shown);
                let (own, both, its) = (length, dot(way, other), dot(other, other));
                let area = own * its - both * both;
                if area <= 1e-6 {
                    continue;
                }
                let off = minus(color, a.shown);
                let (p, q) = (dot(off, way), dot(off, other));
                let (p, q) = ((p * its - q * both) / area, (q * own - p * both) / area);
                if p >= 0.0 && q >= 0.0 && p + q <= 1.0 {
                    take(&[(1.0 - p - q, a), (p, b), (q, c)], 2.0 * worse);
                }
            }
        }
    }
    best
}

fn minus(a: Color, b: Color) -> Color {
    core::array::from_fn(|c| a[c] - b[c])
}

fn dot(a: Color, b: Color) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
