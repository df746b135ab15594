//! Forward: the signed squared distance of each pixel center to the nearest triangle, and coverage from it.

use alloc::vec::Vec;
use core::array;

use super::profile::SquaredProfile;
use super::triangulate::Face;
use crate::geometry::{LineSegment, Vec2};
use crate::real::Real;
use crate::render::tile::{ChunkState, LANES, Lanes, Tile, Window, grow, pixel_range};
use crate::simd::Kernel;

/// What the forward pass of an object leaves for the backward pass, and memory.
#[derive(Clone, Debug, Default)]
pub struct TriangleRecord<T> {
    /// Triangles of the interior.
    pub(super) faces: Vec<Face>,
    /// The vertices from the upper left pixel of the tile.
    pub(super) vertices: Vec<[T; 2]>,
    /// Signed squared distance to the nearest triangle, px^2; infinite where none is within reach.
    pub(super) distance: Vec<Lanes<T>>,
    /// 3 x face + edge of the nearest edge of that triangle; means something where the distance is finite.
    pub(super) winner: Vec<[u32; LANES]>,
}

/// Covers one object whose faces stand in the record.
pub(super) struct Cover<'a, T> {
    pub(super) profile: SquaredProfile<T>,
    pub(super) vertices_px: &'a [[T; 2]],
    pub(super) tile: &'a mut Tile<T>,
    pub(super) record: &'a mut TriangleRecord<T>,
}

impl<T: Real> Kernel for Cover<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { profile, vertices_px, tile, record } = self;
        let window = tile.window();
        let count = window.chunks * window.rows;
        let corner = [window.left(), window.top].map(T::of_usize);
        let TriangleRecord { faces, vertices, distance, winner } = record;
        vertices.clear();
        vertices.extend(vertices_px.iter().map(|&[x, y]| [x - corner[0], y - corner[1]]));
        grow(distance, count, tile.reserved());
        grow(winner, count, tile.reserved());
        distance[..count].fill([T::infinity(); LANES]);
        let mut code = 0;
        for face in faces.iter() {
            let corners = face.map(|vertex| vertices[vertex]);
            if let Some(triangle) = Triangle::new(corners, profile.least_area) {
                triangle.draw(code, profile.reach, window, distance, winner);
            }
            code += 3;
        }
        for (chunk, distance) in distance[..count].iter().enumerate() {
            let coverage = distance.map(|d2| profile.coverage(d2));
            tile.states[chunk] = if coverage.iter().all(|&p| p == T::zero()) {
                ChunkState::Empty
            } else if coverage.iter().all(|&p| p == T::one()) {
                ChunkState::Full
            } else {
                ChunkState::Mixed
            };
            tile.coverage[chunk] = coverage;
        }
    }
}

/// A triangle, ready to be measured from.
#[derive(Clone, Copy)]
struct Triangle<T> {
    corners: [[T; 2]; 3],
    edges: [LineSegment<T>; 3],
    /// +1 or -1, so that inside is where all three sides times it are positive.
    turn: T,
}

impl<T: Real> Triangle<T> {
    /// `None` if the doubled area is not above `least_area`.
    #[inline(always)]
    fn new([a, b, c]: [[T; 2]; 3], least_area: T) -> Option<Self> {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        let turn = if area > T::zero() { T::one() } else { -T::one() };
        let edge = |from: [T; 2], to: [T; 2]| LineSegment::new(from.into(), to.into());
        let edges = [edge(a, b), edge(b, c), edge(c, a)];
        (area.abs() > least_area).then_some(Self { corners: [a, b, c], edges, turn })
    }

    /// Signed squared distance, and which edge is nearest.
    #[inline(always)]
    fn measure(&self, x: T, y: T) -> (T, u32) {
        let point = Vec2::new(x, y);
        let measure = |edge: LineSegment<T>| {
            // Squared distance, and on which side the point lies.
            (edge.nearest(point).distance_squared(), edge.along.cross(point - edge.from))
        };
        let [(d0, side0), (d1, side1), (d2, side2)] = self.edges.map(measure);
        let (near, edge) = if d1 < d0 { (d1, 1) } else { (d0, 0) };
        let (near, edge) = if d2 < near { (d2, 2) } else { (near, edge) };
        let (side0, side1, side2) = (side0 * self.turn, side1 * self.turn, side2 * self.turn);
        let least = if side0 < side1 { side0 } else { side1 };
        let least = if least < side2 { least } else { side2 };
        (if least > T::zero() { -near } else { near }, edge)
    }

    /// Lowers the distances of the pixels within `reach` (and some more) to those of this triangle, whose first edge has
    /// number `code`.
    #[inline(always)]
    fn draw(&self, code: u32, reach: T, window: Window, distance: &mut [Lanes<T>], winner: &mut [[u32; LANES]]) {
        let [a, b, c] = self.corners;
        let Some((top, bottom)) =
            pixel_range(a[1].min(b[1]).min(c[1]) - reach, a[1].max(b[1]).max(c[1]) + reach, window.rows)
        else {
            return;
        };
        for row in top..=bottom {
            let y = T::of_usize(row);
            let (left, right) = span(self.corners, y - reach, y + reach);
            let Some((first, last)) = pixel_range(left - reach, right + reach, window.width()) else { continue };
            for column in first / LANES..=last / LANES {
                let chunk = row * window.chunks + column;
                let (distance, winner) = (&mut distance[chunk], &mut winner[chunk]);
                let left = T::of_usize(column * LANES);
                let x: Lanes<T> = array::from_fn(|lane| left + T::of_usize(lane));
                for lane in 0..LANES {
                    let (signed, edge) = self.measure(x[lane], y);
                    let closer = signed < distance[lane];
                    distance[lane] = if closer { signed } else { distance[lane] };
                    winner[lane] = if closer { code + edge } else { winner[lane] };
                }
            }
        }
    }
}

/// Least and greatest x of the part of a triangle with `top` <= y <= `bottom`; an empty range if there is none.
#[inline(always)]
fn span<T: Real>(corners: [[T; 2]; 3], top: T, bottom: T) -> (T, T) {
    let (mut left, mut right) = (T::infinity(), T::neg_infinity());
    for k in 0..3 {
        let (p, q) = (corners[k], corners[(k + 1) % 3]);
        let (upper, lower) = if p[1] <= q[1] { (p, q) } else { (q, p) };
        if upper[1] > bottom || lower[1] < top {
            continue;
        }
        let rise = lower[1] - upper[1];
        for y in [top, bottom] {
            let t = if rise > T::zero() { ((y - upper[1]) / rise).max(T::zero()).min(T::one()) } else { T::zero() };
            let x = upper[0] + t * (lower[0] - upper[0]);
            left = left.min(x);
            right = right.max(x);
        }
        if rise == T::zero() {
            left = left.min(lower[0]);
            right = right.max(lower[0]);
        }
    }
    (left, right)
}
