//! Exact signed distance to a fixed unit outline, made fast by a grid that knows the nearest edge of each cell.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::{Real, simd};

/// Cells per side of the grid.
const CELLS: usize = 64;
/// Edges shorter than this (squared, in units of the outline) are points that two vertices share.
const SHORTEST_EDGE: f64 = 1e-12;

/// One edge of the unit outline.
#[derive(Clone, Copy, Debug)]
struct Edge<T> {
    start: [T; 2],
    step: [T; 2],
    inverse_length_squared: T,
    /// Unit normal, to the outside.
    normal: [T; 2],
}

/// Signed distance field of a unit outline.
#[derive(Clone, Debug)]
pub(crate) struct OutlineField<T> {
    /// In order, the last one repeated in front and the first one behind.
    edges: Vec<Edge<T>>,
    nearest: Vec<u16>,
    /// Signed distance at the center of each cell.
    centers: Vec<T>,
    low: [T; 2],
    cells_per_unit: T,
    /// Area, centroid and largest distance of a vertex from the origin.
    pub(crate) area: T,
    pub(crate) centroid: [T; 2],
    pub(crate) radius: T,
}

impl<T: Real> OutlineField<T> {
    /// The field of a closed polygon; none if it has fewer than three edges or no area.
    pub(crate) fn new(vertices: &[[T; 2]]) -> Option<Self> {
        let signed = signed_area(vertices);
        let mut edges: Vec<Edge<T>> = (0..vertices.len())
            .filter_map(|i| Edge::new(vertices[i], vertices[(i + 1) % vertices.len()], signed > T::zero()))
            .collect();
        if edges.len() < 3 || signed.abs() <= T::of(1e-9) {
            return None;
        }
        let (first, last) = (edges[0], edges[edges.len() - 1]);
        edges.insert(0, last);
        edges.push(first);
        let mut low = vertices[0];
        let mut high = vertices[0];
        let mut radius = T::zero();
        for v in vertices {
            for c in 0..2 {
                low[c] = low[c].min(v[c]);
                high[c] = high[c].max(v[c]);
            }
            radius = radius.max((v[0] * v[0] + v[1] * v[1]).sqrt());
        }
        // A margin of half the size around: distances are wanted near the outline.
        let size = (high[0] - low[0]).max(high[1] - low[1]);
        let side = size * T::of(2.0);
        let cells_per_unit = T::of_usize(CELLS) / side;
        let low = [0, 1].map(|c| T::of(0.5) * (low[c] + high[c]) - size);
        let mut field = Self {
            edges,
            nearest: vec![0; CELLS * CELLS],
            centers: vec![T::zero(); CELLS * CELLS],
            low,
            cells_per_unit,
            area: signed.abs(),
            centroid: centroid(vertices, signed),
            radius,
        };
        simd::dispatch(FillGrid { field: &mut field });
        Some(field)
    }

    /// The middle of a column or row of cells.
    #[inline(always)]
    fn middle(&self, axis: usize, cell: usize) -> T {
        self.low[axis] + (T::of_usize(cell) + T::of(0.5)) / self.cells_per_unit
    }

    fn cell(&self, point: [T; 2]) -> usize {
        let along = |c: usize| -> usize {
            let position = (point[c] - self.low[c]) * self.cells_per_unit;
            position.min(T::of_usize(CELLS - 1)).to_count()
        };
        along(1) * CELLS + along(0)
    }

    /// Bounds of the signed distance at `point`, from its cell alone; outside the grid from the nearest cell.
    #[inline(always)]
    pub(crate) fn distance_bounds(&self, point: [T; 2]) -> (T, T) {
        let center = self.centers[self.cell(point)];
        let side = T::of_usize(CELLS) / self.cells_per_unit;
        let outside = (0..2).fold(T::zero(), |sum, c| {
            let beyond = (self.low[c] - point[c]).max(point[c] - self.low[c] - side).max(T::zero());
            sum + beyond
        });
        // Half the diagonal of a cell, and at most the way to it (a distance changes by no more than a point moves).
        let slack = T::of(core::f64::consts::FRAC_1_SQRT_2) / self.cells_per_unit + outside;
        (center - slack, center + slack)
    }

    /// Signed distance from `point` to the outline (positive outside) and its gradient, both in units of the outline.
    #[inline]
    pub(crate) fn distance(&self, point: [T; 2]) -> (T, [T; 2]) {
        let center = usize::from(self.nearest[self.cell(point)]);
        let Some(edges) = self.edges.get(center - 1..center + 2) else { return (T::zero(), [T::zero(); 2]) };
        let mut best = (T::infinity(), T::zero(), [T::zero(); 2], 0);
        for (i, edge) in edges.iter().enumerate() {
            let (squared, u, offset) = edge.closest(point);
            if squared < best.0 {
                best = (squared, u, offset, i);
            }
        }
        let (squared, u, offset, at) = best;
        let mut normal = edges[at].normal;
        // At a vertex the two normals together tell the side; the second is the center's own or, for it, the nearer one.
        if u <= T::zero() || u >= T::one() {
            let other = match (at, u <= T::zero()) {
                (1, true) => 0,
                (1, false) => 2,
                _ => 1,
            };
            let beside = edges[other].normal;
            normal = [normal[0] + beside[0], normal[1] + beside[1]];
        }
        let side = offset[0] * normal[0] + offset[1] * normal[1];
        let length = squared.sqrt();
        if length <= T::of(1e-9) {
            return (T::zero(), edges[at].normal);
        }
        let sign = if side < T::zero() { -T::one() } else { T::one() };
        let scale = sign / length;
        (sign * length, [offset[0] * scale, offset[1] * scale])
    }
}

/// Finds the nearest edge of every cell, a row of cells at a time.
struct FillGrid<'a, T> {
    field: &'a mut OutlineField<T>,
}

impl<T: Real> simd::Kernel for FillGrid<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let field = self.field;
        let x: [T; CELLS] = simd::lanes(|column| field.middle(0, column));
        for row in 0..CELLS {
            let y = field.middle(1, row);
            let (mut least, mut nearest) = ([T::infinity(); CELLS], [T::zero(); CELLS]);
            for (i, edge) in field.edges.iter().enumerate().skip(1).take(field.edges.len() - 2) {
                // Edges are numbered in `T`, to be chosen in lanes as wide as the distances.
                let number = T::of_usize(i);
                for column in 0..CELLS {
                    let squared = edge.closest([x[column], y]).0;
                    let nearer = squared < least[column];
                    least[column] = if nearer { squared } else { least[column] };
                    nearest[column] = if nearer { number } else { nearest[column] };
                }
            }
            for column in 0..CELLS {
                let at = row * CELLS + column;
                field.nearest[at] = u16::try_from(nearest[column].to_count()).unwrap_or(u16::MAX);
                field.centers[at] = field.distance([x[column], y]).0;
            }
        }
    }
}

impl<T: Real> Edge<T> {
    fn new(start: [T; 2], end: [T; 2], counterclockwise: bool) -> Option<Self> {
        let step = [end[0] - start[0], end[1] - start[1]];
        let squared = step[0] * step[0] + step[1] * step[1];
        if squared.is_nan() || squared <= T::of(SHORTEST_EDGE) {
            return None;
        }
        let length = squared.sqrt();
        let sign = if counterclockwise { T::one() } else { -T::one() } / length;
        Some(Self {
            start,
            step,
            inverse_length_squared: T::one() / squared,
            normal: [step[1] * sign, -step[0] * sign],
        })
    }

    /// Squared distance, position along the edge clamped to [0, 1], and the vector from the closest point.
    #[inline(always)]
    fn closest(&self, point: [T; 2]) -> (T, T, [T; 2]) {
        let d = [point[0] - self.start[0], point[1] - self.start[1]];
        let u =
            ((d[0] * self.step[0] + d[1] * self.step[1]) * self.inverse_length_squared).max(T::zero()).min(T::one());
        let offset = [d[0] - u * self.step[0], d[1] - u * self.step[1]];
        (offset[0] * offset[0] + offset[1] * offset[1], u, offset)
    }
}

fn signed_area<T: Real>(vertices: &[[T; 2]]) -> T {
    let n = vertices.len();
    let twice: T = (0..n)
        .map(|i| {
            let (a, b) = (vertices[i], vertices[(i + 1) % n]);
            a[0] * b[1] - a[1] * b[0]
        })
        .sum();
    twice * T::of(0.5)
}

fn centroid<T: Real>(vertices: &[[T; 2]], signed_area: T) -> [T; 2] {
    let n = vertices.len();
    let mut sum = [T::zero(); 2];
    for i in 0..n {
        let (a, b) = (vertices[i], vertices[(i + 1) % n]);
        let cross = a[0] * b[1] - a[1] * b[0];
        for c in 0..2 {
            sum[c] += (a[c] + b[c]) * cross;
        }
    }
    sum.map(|s| s / (T::of(6.0) * signed_area))
}
