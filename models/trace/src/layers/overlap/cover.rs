//! What things of a heap leave uncovered: one of them reaches there, or another one is there.

use alloc::collections::BTreeSet;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::contains;
use dvp_core::geometry::{LineSegment, convex_hull};

use super::super::raster;
use super::heap::{HELD_SIGMA, Heap, MOST_HELD};
use super::share::Part;
use crate::outline::Outline;
use crate::sample::Sample;
use crate::tuning;

/// Most regions that are looked at.
const MOST_REGIONS: usize = 32;

/// Covers what is missed, region by region: by the thing that costs least more by it, or another one; small ones only by what is there.
#[inline(never)]
pub(super) fn cover(
    parts: &mut Vec<Part>,
    stretches: &[Vec<Sample>],
    heap: &Heap<'_>,
    missed: &dyn Fn(&[Part]) -> Vec<[usize; 2]>,
) {
    let mut left_out: Vec<[usize; 2]> = Vec::new();
    for _ in 0..MOST_REGIONS {
        let mut missed = missed(parts);
        missed.retain(|at| !left_out.contains(at));
        let pixels = largest(&missed);
        if pixels.is_empty() {
            return;
        }
        let region: Vec<Vec2<f64>> = pixels.iter().map(|&[x, y]| Vec2::new(x as f64 + 0.5, y as f64 + 0.5)).collect();
        let of_parts = parts.iter().enumerate().filter_map(|(k, part)| {
            let found = grown(part, &region, stretches, heap)?;
            Some((found.bits - part.bits, k, found))
        });
        let is_small = region.len() as f64 <= tuning::MOST_WRONG_PIXELS;
        let other = if is_small { None } else { another(&region, stretches, heap) };
        let other = other.map(|part| (part.bits, parts.len(), part));
        match of_parts.chain(other).min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((_, k, part)) if k < parts.len() => parts[k] = part,
            Some((_, _, part)) => parts.push(part),
            None if is_small => left_out.extend(pixels),
            None => return,
        }
    }
}

/// The part with an outline that covers a region too.
fn grown(part: &Part, region: &[Vec2<f64>], of: &[Vec<Sample>], heap: &Heap<'_>) -> Option<Part> {
    if part.stretches.is_empty() {
        return None;
    }
    let Some(_) = &part.outline else {
        let held = corners(region);
        return Some(Part::new(part.stretches.clone(), held, of, heap)).filter(|part| part.outline.is_some());
    };
    let mut part = part.clone();
    for _ in 0..MOST_HELD {
        let Some(held) = farthest(part.outline.as_ref()?, region) else { return Some(part) };
        part.held.push(held);
        part = Part::new(part.stretches, part.held, of, heap);
    }
    None
}

/// A thing of which a region alone is known.
fn another(region: &[Vec2<f64>], of: &[Vec<Sample>], heap: &Heap<'_>) -> Option<Part> {
    Some(Part::new(Vec::new(), corners(region), of, heap)).filter(|part| part.outline.is_some())
}

/// The corners of the hull of a region.
fn corners(region: &[Vec2<f64>]) -> Vec<Sample> {
    let points: Vec<[f64; 2]> = region
        .iter()
        .flat_map(|at| {
            [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|off| (*at + Vec2::from(off)).to_array())
        })
        .collect();
    let middle = points.iter().fold(Vec2::default(), |sum, &point| sum + Vec2::from(point)) / points.len() as f64;
    let of = |&corner: &[f64; 2]| {
        let axis = (Vec2::from(corner) - middle).normalized().unwrap_or_default();
        Sample::new(Vec2::from(corner), axis, HELD_SIGMA)
    };
    convex_hull(&points).iter().map(of).collect()
}

/// The place of a region that is farthest outside of an outline; none if it covers all of it.
fn farthest(outline: &Outline, region: &[Vec2<f64>]) -> Option<Sample> {
    let polygon = raster::polygon(outline)?;
    let off = |at: &Vec2<f64>| {
        let offsets = LineSegment::closed(&polygon).map(|side| side.nearest(*at).offset);
        offsets.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared())).map(|offset| (*at, offset))
    };
    let outside = region.iter().filter(|at| !contains(&polygon, at.to_array())).filter_map(off);
    let (at, offset) = outside.max_by(|a, b| a.1.length_squared().total_cmp(&b.1.length_squared()))?;
    let axis = offset.normalized()?;
    Some(Sample::new(at + axis * 0.5, axis, HELD_SIGMA))
}

/// The largest region of pixels that hang together.
#[inline(never)]
pub(super) fn largest(pixels: &[[usize; 2]]) -> Vec<[usize; 2]> {
    let mut left: BTreeSet<(u32, u32)> = pixels.iter().map(|&[x, y]| (x as u32, y as u32)).collect();
    let mut largest: Vec<[usize; 2]> = Vec::new();
    for &[x, y] in pixels {
        let first = (x as u32, y as u32);
        if !left.remove(&first) {
            continue;
        }
        let (mut region, mut next) = (Vec::new(), Vec::from([first]));
        while let Some((x, y)) = next.pop() {
            let beside = [(x + 1, y), (x.wrapping_sub(1), y), (x, y + 1), (x, y.wrapping_sub(1))];
            next.extend(beside.into_iter().filter(|at| left.remove(at)));
            region.push([x as usize, y as usize]);
        }
        if region.len() > largest.len() {
            largest = region;
        }
    }
    largest
}
