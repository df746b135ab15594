//! Lines and dots too thin to have a flat pixel: their pixels have neighbors of another color on both sides.
//!
//! What is left of the soft pixels once those between two regions are placed, and what has one region on both sides of it,
//! is grouped. A group whose colors lie on one line from that region's color is a region of its own, of the color that is
//! farthest off; its pixels that show that color nearly in full count as flat. Beside regions of that color it is a part of
//! them, and joins them: a stroke of three pixels is flat only here and there.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;
use dvp_core::image::distance;
use dvp_core::{ImageView, Real};

use super::color::is_same;
use super::flat::{FlatMap, Run};
use super::region::Region;
use super::transition::{Soft, SoftScratch, along, off_overshoot};
use crate::tuning::{RIM_REACH_PX, THIN_CONTRAST, THIN_CORE, THIN_COVERAGE, THIN_STRAY, TIP_REACH_PX};

/// A soft pixel that lies between no two regions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leftover {
    pub(crate) pixel: [u32; 2],
    /// The region on both sides, counted from 1.
    pub(crate) host: u32,
}

/// A group as it was read.
struct Thin<T> {
    color: [T; 3],
    /// Pixels that show the color.
    covered: Vec<[u32; 2]>,
    /// Regions of that color beside it, counted from 1.
    parts: Vec<u32>,
}

/// Pixels beside regions that show their color in full without being flat, and the regions that such pixels connect.
struct Fringe {
    /// Per pixel, the region counted from 1; 0 for others.
    regions: Vec<u32>,
    /// Pairs of regions of one color.
    joined: Vec<[u32; 2]>,
}

impl Fringe {
    fn new<T: Real>(image: &ImageView<'_, T>, map: &FlatMap, regions: &[Region<T>], soft: &[Soft]) -> Self {
        let (width, height) = (image.size().width(), image.size().height());
        let color = |label: u32| regions[label as usize - 1].color;
        let mut fringe = Self { regions: vec![0; width * height], joined: Vec::new() };
        for one in soft {
            let [x, y] = one.pixel.map(|v| v as usize);
            let seen = image.pixel(y * width + x);
            let Some(&own) = one.ends.iter().find(|&&label| label != 0 && is_same(seen, color(label))) else {
                continue;
            };
            fringe.regions[y * width + x] = own;
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    let index = row * width + column;
                    let other = map.labels[index].max(fringe.regions[index]);
                    if other != 0
                        && other != own
                        && is_same(color(own), color(other))
                        && !fringe.joined.contains(&[own, other])
                    {
                        fringe.joined.push([own, other]);
                    }
                }
            }
        }
        fringe
    }
}

/// Labels thin regions in `map`, after the others; returns their colors, or nothing if the map stays as it is.
pub(crate) fn label_thin<T: Real>(
    image: &ImageView<'_, T>,
    map: &mut FlatMap,
    regions: &[Region<T>],
    scratch: &SoftScratch<T>,
    tolerance: T,
) -> Option<Vec<[T; 3]>> {
    let (width, height) = (image.size().width(), image.size().height());
    let at = |[x, y]: [u32; 2]| y as usize * width + x as usize;
    let contrast = |one: &Leftover| distance(image.pixel(at(one.pixel)), regions[one.host as usize - 1].color);
    let open: Vec<Leftover> =
        scratch.leftover.iter().filter(|one| contrast(one) > T::of(THIN_CONTRAST)).copied().collect();
    if open.is_empty() {
        return None;
    }
    let fringe = Fringe::new(image, map, regions, &scratch.soft);
    let mut found = Vec::new();
    // 1 + index into `open`; 0 where nothing is left to visit.
    let mut waiting = vec![0_u32; width * height];
    for (index, one) in (1..).zip(&open) {
        waiting[at(one.pixel)] = index;
    }
    let mut group: Vec<Leftover> = Vec::new();
    for first in &open {
        if core::mem::take(&mut waiting[at(first.pixel)]) == 0 {
            continue;
        }
        group.clear();
        group.push(*first);
        let mut next = 0;
        while let Some(one) = group.get(next) {
            let [x, y] = one.pixel.map(|v| v as usize);
            next += 1;
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    let index = core::mem::take(&mut waiting[row * width + column]);
                    if index > 0 {
                        group.push(open[index as usize - 1]);
                    }
                }
            }
        }
        found.extend(read_group(image, map, &fringe, regions, &group, tolerance));
    }
    (!found.is_empty() || !fringe.joined.is_empty()).then(|| add_regions(map, width, &found, &fringe.joined))
}

/// A group as a thin region, or a part of others.
fn read_group<T: Real>(
    image: &ImageView<'_, T>,
    map: &FlatMap,
    fringe: &Fringe,
    regions: &[Region<T>],
    group: &[Leftover],
    tolerance: T,
) -> Option<Thin<T>> {
    let width = image.size().width();
    let at = |[x, y]: [u32; 2]| y as usize * width + x as usize;
    let host_color = |one: &Leftover| regions[one.host as usize - 1].color;
    let off = |one: &Leftover| {
        let (seen, host) = (image.pixel(at(one.pixel)), host_color(one));
        (0..3).map(|c| (seen[c] - host[c]) * (seen[c] - host[c])).sum::<T>()
    };
    let peak = group.iter().max_by(|a, b| off(a).partial_cmp(&off(b)).unwrap_or(core::cmp::Ordering::Equal))?;
    let color = image.pixel(at(peak.pixel));
    let (mut stray, mut total, mut covered) = (0_usize, T::zero(), Vec::new());
    for one in group {
        let (share, distance) = along(image.pixel(at(one.pixel)), host_color(one), color);
        if distance > tolerance + tolerance {
            stray += 1;
        } else {
            total += share;
            if share >= T::of(THIN_CORE) {
                covered.push(one.pixel);
            }
        }
    }
    if T::of_usize(stray) > T::of(THIN_STRAY) * T::of_usize(group.len()) {
        return None;
    }
    let mut thin = Thin { color, covered, parts: Vec::new() };
    let mut tip = false;
    for one in group {
        let [x, y] = one.pixel.map(|v| v as usize);
        for row in y.saturating_sub(RIM_REACH_PX)..(y + RIM_REACH_PX + 1).min(image.size().height()) {
            for column in x.saturating_sub(RIM_REACH_PX)..(x + RIM_REACH_PX + 1).min(width) {
                let label = map.labels[row * width + column].max(fringe.regions[row * width + column]);
                if label == 0 || label == one.host || thin.parts.contains(&label) {
                    continue;
                }
                let beside = regions[label as usize - 1].color;
                let near = row.abs_diff(y).max(column.abs_diff(x)) <= TIP_REACH_PX;
                if is_same(beside, color) {
                    if near {
                        thin.parts.push(label);
                    }
                } else {
                    let host = host_color(one);
                    let rim = off_overshoot(color, beside, host) <= tolerance + tolerance;
                    tip |= rim || near && along(color, host, beside).1 <= tolerance;
                }
            }
        }
    }
    let alone = !tip && total >= T::of(THIN_COVERAGE);
    (alone || !thin.parts.is_empty()).then_some(thin)
}

/// Labels the pixels of the groups, and joins the regions they connect; returns the colors of the new regions.
#[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
fn add_regions<T: Real>(map: &mut FlatMap, width: usize, found: &[Thin<T>], joined: &[[u32; 2]]) -> Vec<[T; 3]> {
    let old = map.region_count as u32;
    let mut sets = DisjointSets::default();
    sets.reset(old + 1);
    let mut new = Vec::new();
    for &[a, b] in joined {
        sets.unite(a, b);
    }
    for thin in found {
        let label = match thin.parts[..] {
            [] => {
                new.push(thin.color);
                sets.push()
            }
            [first, ref others @ ..] => {
                for &other in others {
                    sets.unite(first, other);
                }
                first
            }
        };
        add_pixels(map, width, &thin.covered, label);
    }
    // Regions that were joined leave gaps in the numbering.
    let mut names = vec![0; sets.len()];
    let mut count = 0;
    for label in 1..sets.len() as u32 {
        let first = sets.root(label);
        if first == label {
            count += 1;
            names[label as usize] = count;
        } else {
            names[label as usize] = names[first as usize];
        }
    }
    map.labels.iter_mut().for_each(|label| *label = names[*label as usize]);
    map.runs.iter_mut().for_each(|run| run.label = names[run.label as usize]);
    map.runs.sort_unstable_by_key(|run| (run.row, run.start));
    map.region_count = count as usize;
    new
}

/// Labels pixels.
fn add_pixels(map: &mut FlatMap, width: usize, pixels: &[[u32; 2]], label: u32) {
    for &[x, row] in pixels {
        map.labels[row as usize * width + x as usize] = label;
        map.runs.push(Run { row, start: x, end: x + 1, label });
    }
}
