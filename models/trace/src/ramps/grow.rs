//! Which pixels are of which ramp.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::vec::Vec;

use super::STEP;
use super::fit::{Fitted, Sample, TOLERANCE, along, fit, thinned};
use super::profile::difference;
use super::smooth::{self, Smooth, neighbors};
use crate::partition::{Color, OUTSIDE};
use crate::tuning::{LEAST_RAMP_PIXELS, LEAST_RAMP_STEPS};

/// Pixels between two parts that may be one, where a ramp turns at a stop.
const GAP: usize = 4;

/// What of a picture is flat, and what ramps.
pub(super) struct Regions {
    /// Index of each pixel: below `ramps.len()` a ramp, above it a flat color, [`OUTSIDE`] neither.
    pub(super) labels: Vec<u32>,
    pub(super) ramps: Vec<Region>,
    pub(super) flat_colors: Vec<Color>,
}

/// The pixels of a ramp.
pub(super) struct Region {
    pub(super) fitted: Fitted,
    pub(super) mean: Color,
    /// Whether it explains all of its pixels.
    pub(super) is_exact: bool,
    /// A place in the middle.
    pub(super) near: [f64; 2],
}

/// The ramps and flat colors of a picture, the largest first.
pub(super) fn regions(pixels: &[[f32; 3]], width: usize, smooth: Smooth) -> Regions {
    let Smooth { labels, parts } = smooth;
    let ranges: Vec<f32> = parts.iter().map(|part| range(pixels, part)).collect();
    let beside = beside(&labels, width);
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by_key(|&part| core::cmp::Reverse(parts[part].len()));
    let mut ramp_of = alloc::vec![OUTSIDE; parts.len()];
    let mut ramps: Vec<Fitted> = Vec::new();
    let samples = |part: usize| parts[part].iter().map(|&i| sample(pixels, width, i as usize));
    let may_be = |part: usize| parts[part].len() >= LEAST_RAMP_PIXELS && ranges[part] >= LEAST_RAMP_STEPS * STEP;
    if smooth::is_rough(pixels, width, (0..parts.len()).filter(|&part| may_be(part)).map(|part| &parts[part])) {
        return Regions { labels, ramps: Vec::new(), flat_colors: Vec::new() };
    }
    for &seed in &order {
        if !may_be(seed) || ramp_of[seed] != OUTSIDE {
            continue;
        }
        let mut own: Vec<Sample> = samples(seed).collect();
        let mut ends = alloc::vec![own.len()];
        let Some(mut fitted) = fit(&own, true) else { continue };
        ramp_of[seed] = ramps.len() as u32;
        // What lies beside it, and beside that, as long as one ramp explains it all.
        let mut open: Vec<u32> = beside.get(&(seed as u32)).into_iter().flatten().copied().collect();
        let mut tried: BTreeSet<u32> = open.iter().copied().collect();
        while let Some(part) = open.pop() {
            if ramp_of[part as usize] != OUTSIDE {
                continue;
            }
            own.extend(samples(part as usize));
            ends.push(own.len());
            if let Some(both) = along(fitted.course, &own, &thinned(&own), &ends) {
                fitted = both;
                ramp_of[part as usize] = ramps.len() as u32;
                let others = beside.get(&part).into_iter().flatten();
                open.extend(others.filter(|&&other| tried.insert(other)));
            } else {
                ends.pop();
                own.truncate(*ends.last().unwrap_or(&0));
            }
        }
        // And what shows further away: what changes along the same course may be of the same ramp.
        for other in (0..parts.len()).filter(|&other| may_be(other)) {
            if ramp_of[other] != OUTSIDE {
                continue;
            }
            let before = own.len();
            own.extend(samples(other));
            let both = fitted
                .goes_on(&own[before..])
                .then(|| along(fitted.course, &own, &thinned(&own), &[before, own.len()]));
            match both.flatten() {
                Some(both) => {
                    fitted = both;
                    ramp_of[other] = ramps.len() as u32;
                }
                None => own.truncate(before),
            }
        }
        ramps.push(fitted);
    }
    let exact = ramps.len();
    for &part in order.iter().filter(|&&part| may_be(part)) {
        if ramp_of[part] == OUTSIDE
            && let Some(fitted) = fit(&samples(part).collect::<Vec<_>>(), false)
        {
            ramp_of[part] = ramps.len() as u32;
            ramps.push(fitted);
        }
    }
    finished(pixels, width, (labels, &parts, &ranges), (ramps, exact, &ramp_of))
}

/// Labels of ramps and flat colors, ramps grown over pixels beside them that they explain.
fn finished(
    pixels: &[[f32; 3]],
    width: usize,
    (mut labels, parts, ranges): (Vec<u32>, &[Vec<u32>], &[f32]),
    (ramps, exact, ramp_of): (Vec<Fitted>, usize, &[u32]),
) -> Regions {
    let height = pixels.len() / width;
    let mut flat_colors = Vec::new();
    let mut sums = alloc::vec![([0.0; 3], [0.0; 2], 0.0); ramps.len()];
    let mut border = Vec::new();
    for (part, its) in parts.iter().enumerate() {
        let label = if ramp_of[part] != OUTSIDE {
            border.extend(its.iter().copied());
            ramp_of[part]
        } else if ranges[part] <= 2.0 * STEP {
            let (_, color) = sample(pixels, width, its[its.len() / 2] as usize);
            let known = flat_colors.iter().position(|other| difference(*other, color) < f64::from(STEP));
            let index = known.unwrap_or(flat_colors.len());
            if known.is_none() {
                flat_colors.push(color);
            }
            (ramps.len() + index) as u32
        } else {
            OUTSIDE
        };
        its.iter().for_each(|&i| labels[i as usize] = label);
    }
    let mut next = 0;
    while let Some(&i) = border.get(next) {
        next += 1;
        let label = labels[i as usize];
        let (point, color) = sample(pixels, width, i as usize);
        let ramp = &ramps[label as usize];
        let shown = ramp.color_beyond(point);
        let left: Color = core::array::from_fn(|c| color[c] - shown[c]);
        let (mean, near, count) = &mut sums[label as usize];
        (0..3).for_each(|c| mean[c] += color[c]);
        (0..2).for_each(|k| near[k] += point[k]);
        *count += 1.0;
        for neighbor in neighbors(i as usize, width, height).into_iter().flatten() {
            let (point, color) = sample(pixels, width, neighbor);
            if labels[neighbor] != OUTSIDE {
                continue;
            }
            // A ramp that does not explain its part goes on as that does; behind its ends one goes on, or stays as it is.
            let left = if (label as usize) < exact { [0.0; 3] } else { left };
            let seen: Color = core::array::from_fn(|c| color[c] - left[c]);
            if [ramp.color_beyond(point), ramp.color(point)].iter().any(|&shown| difference(shown, seen) <= TOLERANCE) {
                labels[neighbor] = label;
                border.push(neighbor as u32);
            }
        }
    }
    // What was seen of the ramps by now reaches further than what they were found by.
    let mut seen: Vec<Vec<Sample>> = alloc::vec![Vec::new(); ramps.len()];
    for &i in &border {
        seen[labels[i as usize] as usize].push(sample(pixels, width, i as usize));
    }
    let ramps = ramps.iter().zip(&seen).enumerate().map(|(index, (fitted, seen))| fitted.of_more(seen, index < exact));
    let ramps = ramps.zip(sums).enumerate().map(|(index, (fitted, (mean, near, count)))| Region {
        fitted,
        is_exact: index < exact,
        mean: mean.map(|sum| sum / count),
        near: near.map(|sum| sum / count),
    });
    Regions { labels, ramps: ramps.collect(), flat_colors }
}

/// Middle and color of a pixel.
pub(super) fn sample(pixels: &[[f32; 3]], width: usize, i: usize) -> Sample {
    ([(i % width) as f64 + 0.5, (i / width) as f64 + 0.5], pixels[i].map(f64::from))
}

/// Which parts lie beside which, at most [`GAP`] pixels apart.
fn beside(labels: &[u32], width: usize) -> BTreeMap<u32, BTreeSet<u32>> {
    let mut beside: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (i, &label) in labels.iter().enumerate().filter(|(_, label)| **label != OUTSIDE) {
        let right = (1..=GAP).take_while(|step| i % width + step < width).map(|step| i + step);
        let below = (1..=GAP).map(|step| i + step * width).take_while(|&other| other < labels.len());
        for ways in [&mut right.collect::<Vec<_>>(), &mut below.collect::<Vec<_>>()] {
            let Some(&other) = ways.iter().find(|&&other| labels[other] != OUTSIDE) else { continue };
            let other = labels[other];
            if other != label {
                beside.entry(label).or_default().insert(other);
                beside.entry(other).or_default().insert(label);
            }
        }
    }
    beside
}

/// Most that a channel changes within pixels.
fn range(pixels: &[[f32; 3]], part: &[u32]) -> f32 {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for &i in part {
        for c in 0..3 {
            low[c] = low[c].min(pixels[i as usize][c]);
            high[c] = high[c].max(pixels[i as usize][c]);
        }
    }
    (0..3).map(|c| high[c] - low[c]).fold(0.0, f32::max)
}
