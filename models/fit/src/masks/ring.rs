//! One border of a mask to a smooth ring.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::contour::{perimeter, signed_area};
use dvp_core::shape::REFERENCE_VERTICES;

use super::between::{Crack, settle};
use super::smooth::smooth_polygon;
use crate::free::basis::Basis;
use crate::free::foot::{EdgeLanes, foot};
use crate::free::grow::{Freedom, GrowScratch, GrowSettings, grow};
use crate::free::outline_fit::{FreeOutline, OutlineScratch};
use crate::price::Prices;
use crate::segment::EdgeSample;

/// Standard deviation (px) of the outline from the middle of a crack: anywhere within half a pixel along the row or column is
/// 0.29; across the outline, over all its directions, that comes to 0.24.
const CRACK_NOISE: f64 = 0.24;
/// An outline that is farther (px) from the middle of a crack does not follow the mask.
const FARTHEST: f64 = 1.0;
/// Most that an outline may exceed the bounds of cracks (px): its 64 straight edges stray so far from a curve.
const EXCESS: f64 = 0.05;
/// Most corners of a border that is taken as it is; more are the stairs of a curve.
const MOST_CORNERS: usize = 16;
/// Most harmonics: those that 64 vertices can tell.
const MOST_HARMONICS: usize = 31;
/// Numbers of harmonics that are tried.
const LADDER: [usize; 14] = [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 15, 19, 24, 31];
/// Cracks per harmonic, at least: a harmonic has four numbers, and neighboring cracks tell about the same.
const CRACKS_PER_HARMONIC: usize = 8;

/// Fits rings, with the tables that it takes.
pub(super) struct RingFitter<T> {
    basis: Basis<T>,
}

/// What a border becomes.
pub(super) enum Ring<T> {
    /// The border as it is: fewer numbers than any smooth outline has, one per edge.
    Upright,
    /// Descriptors, px, and the polygon that they are drawn as.
    Smooth(FreeOutline<T>, Vec<[T; 2]>),
    /// A polygon: 64 vertices do not follow the border.
    Winding(Vec<[T; 2]>),
}

impl<T: Real> RingFitter<T> {
    pub(super) fn new() -> Self {
        Self { basis: Basis::new(REFERENCE_VERTICES, MOST_HARMONICS) }
    }

    /// The simplest ring that follows a border, whose vertices are corners of pixels.
    pub(super) fn fit(&self, border: &[[T; 2]]) -> Ring<T> {
        let cracks = cracks_of(border);
        let fitted = self.fitted(&cracks).filter(|(_, vertices)| follows(vertices, &cracks));
        // Center and descriptors; where the outline starts says nothing.
        let numbers = fitted.as_ref().map_or(usize::MAX, |(outline, _)| 2 + 4 * outline.rows.len() - 1);
        match fitted {
            _ if border.len() <= numbers.min(MOST_CORNERS) => Ring::Upright,
            Some((outline, mut vertices)) => {
                // The last one repeats the first.
                vertices.pop();
                Ring::Smooth(outline, vertices)
            }
            None => {
                let middles: Vec<[T; 2]> = cracks.iter().map(|crack| crack.middle).collect();
                Ring::Winding(smooth_polygon(&middles, signed_area(border)))
            }
        }
    }

    /// The outline and its vertices.
    ///
    /// The fewest harmonics that leave every pixel center on its side, in the middle of the room there is. Where the mask is rougher
    /// than any such outline, as many as pay by least squares.
    fn fitted(&self, cracks: &[Crack<T>]) -> Option<(FreeOutline<T>, Vec<[T; 2]>)> {
        let middles: Vec<[T; 2]> = cracks.iter().map(|crack| crack.middle).collect();
        let sample = |&point: &[T; 2]| EdgeSample { point, distance: T::zero(), weight: T::one() };
        let samples: Vec<EdgeSample<T>> = middles.iter().map(sample).collect();
        let most = (middles.len() / CRACKS_PER_HARMONIC).clamp(1, MOST_HARMONICS);
        let settings = GrowSettings {
            vertex_count: REFERENCE_VERTICES,
            max_harmonics: most,
            freedom: Freedom::Normals,
            noise: T::of(CRACK_NOISE),
            prices: Prices::default(),
        };
        let mut scratch = GrowScratch::default();
        let start = grow(&middles, &samples, &self.basis, settings, &mut scratch)?.outline;
        let mut memory = OutlineScratch::default();
        let between = LADDER.into_iter().filter(|&harmonics| harmonics <= most).find_map(|harmonics| {
            let mut outline = FreeOutline { center: start.center, rows: start.rows[..harmonics].to_vec() };
            (settle(&mut outline, cracks, &self.basis, &mut memory) <= T::of(EXCESS)).then_some(outline)
        });
        let thrifty = || {
            let settings = GrowSettings { freedom: Freedom::Full, ..settings };
            grow(&middles, &samples, &self.basis, settings, &mut scratch).map(|grown| grown.outline)
        };
        let outline = between.or_else(thrifty)?;
        let mut vertices = Vec::new();
        outline.write_vertices(&self.basis, REFERENCE_VERTICES, &mut vertices);
        Some((outline, vertices))
    }
}

/// Whether a closed polygon, whose last vertex repeats the first, passes all cracks nearby.
fn follows<T: Real>(vertices: &[[T; 2]], cracks: &[Crack<T>]) -> bool {
    let mut lanes = EdgeLanes::default();
    lanes.set(vertices);
    cracks.iter().all(|crack| foot(vertices, &lanes, crack.middle).distance.abs() <= T::of(FARTHEST))
}

/// The cracks of a border, whose vertices are corners of pixels.
fn cracks_of<T: Real>(border: &[[T; 2]]) -> Vec<Crack<T>> {
    let mut cracks = Vec::with_capacity(perimeter(border).to_count());
    let ends = border.iter().skip(1).chain(border.first());
    for (&[px, py], &[qx, qy]) in border.iter().zip(ends) {
        let (dx, dy) = (qx - px, qy - py);
        let length = dx.abs().max(dy.abs());
        for i in 0..(length + T::of(0.5)).to_count() {
            let share = (T::of_usize(i) + T::of(0.5)) / length;
            cracks.push(Crack { middle: [px + share * dx, py + share * dy], lies_in_row: dx.abs() > dy.abs() });
        }
    }
    cracks
}
