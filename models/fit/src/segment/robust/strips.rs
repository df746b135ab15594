//! Strips of soft pixels along edges that became regions of their own, told from thin objects: the color of a strip lies
//! between those of its two neighbors.

use alloc::vec::Vec;

use dvp_core::{ImageView, Real};

use crate::segment::transition::along;

/// A region of the partition.
#[derive(Clone, Copy, Debug)]
pub(super) struct Zone<T> {
    pub(super) color: [T; 3],
    pub(super) pixels: u32,
    /// Pixels of boundary with other zones.
    pub(super) boundary: u32,
    /// Flat pixels.
    pub(super) flat: u32,
    pub(super) strip: bool,
}

/// Colors and boundaries; `steps` gets the pairs of zones that touch, one entry per pixel of boundary, in both orders.
pub(super) fn measure_zones<T: Real>(
    smooth: &ImageView<'_, T>,
    count: usize,
    labels: &[u32],
    zones: &mut Vec<Zone<T>>,
    steps: &mut Vec<(u32, u32)>,
) {
    let width = smooth.size().width();
    zones.clear();
    zones.resize(count, Zone { color: [T::zero(); 3], pixels: 0, boundary: 0, flat: 0, strip: false });
    steps.clear();
    for (i, &label) in labels.iter().enumerate() {
        let (zone, color) = (&mut zones[label as usize], smooth.pixel(i));
        zone.pixels += 1;
        for (sum, part) in zone.color.iter_mut().zip(color) {
            *sum += part;
        }
        for other in [(i % width != 0).then(|| labels[i - 1]), (i >= width).then(|| labels[i - width])] {
            if let Some(other) = other.filter(|&other| other != label) {
                steps.push((label, other));
                steps.push((other, label));
            }
        }
    }
    steps.sort_unstable();
    for &(zone, _) in steps.iter() {
        zones[zone as usize].boundary += 1;
    }
    for zone in zones {
        let share = T::one() / T::of_usize(zone.pixels as usize);
        zone.color = zone.color.map(|sum| sum * share);
    }
}

/// Marks zones up to `width` wide (px; twice the area over the boundary) whose color lies between those of two neighbors,
/// `tolerance` off the line at most. A strip beside another strip looks beyond it, to the zones along the same edge that are
/// not thin.
pub(super) fn find_strips<T: Real>(zones: &mut [Zone<T>], steps: &[(u32, u32)], width: T, tolerance: T) {
    let mut anchors: Vec<usize> = Vec::new();
    for own in steps.chunk_by(|a, b| a.0 == b.0) {
        let at = own[0].0 as usize;
        if !is_thin(&zones[at], width) {
            continue;
        }
        let long = |n: usize| 6 * n >= zones[at].boundary as usize;
        let same = || own.chunk_by(|a, b| a.1 == b.1);
        anchors.clear();
        anchors.extend(same().filter(|same| long(same.len())).map(|same| same[0].1 as usize));
        let mut between = is_between_any(zones, at, &anchors, tolerance);
        if !between {
            anchors.clear();
            for neighbor in same().map(|same| same[0].1) {
                if is_thin(&zones[neighbor as usize], width) {
                    let first = steps.partition_point(|step| step.0 < neighbor);
                    let beyond =
                        steps[first..].iter().take_while(|step| step.0 == neighbor).map(|step| step.1 as usize);
                    anchors.extend(beyond.filter(|&zone| !is_thin(&zones[zone], width)));
                } else {
                    anchors.push(neighbor as usize);
                }
            }
            anchors.sort_unstable();
            anchors.dedup();
            between = is_between_any(zones, at, &anchors, tolerance);
        }
        zones[at].strip = between;
    }
}

fn is_thin<T: Real>(zone: &Zone<T>, width: T) -> bool {
    T::of_usize(2 * zone.pixels as usize) <= width * T::of_usize(zone.boundary as usize)
}

fn is_between_any<T: Real>(zones: &[Zone<T>], at: usize, anchors: &[usize], tolerance: T) -> bool {
    let mut pairs = anchors.iter().enumerate().flat_map(|(i, &a)| anchors[..i].iter().map(move |&b| (a, b)));
    pairs.any(|(a, b)| is_between(&zones[at], &zones[a], &zones[b], tolerance))
}

/// Rationale: however near the share is to 0 or 1. The tail of a soft edge has 2 % of the contrast, and noise of a step of 8
/// bits lets it be a region.
fn is_between<T: Real>(zone: &Zone<T>, a: &Zone<T>, b: &Zone<T>, tolerance: T) -> bool {
    let (share, off) = along(zone.color, a.color, b.color);
    let contrast = (0..3).map(|c| (b.color[c] - a.color[c]) * (b.color[c] - a.color[c])).sum::<T>().sqrt();
    share > T::zero() && share < T::one() && off <= tolerance + T::of(0.1) * contrast
}
