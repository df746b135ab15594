//! Signed distance to a fixed unit outline, made fast by a grid: exact from the edges near a cell, or to first order from the
//! middle of the cell.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::contour::{centroid, signed_area};
use dvp_core::geometry::{LineSegment, Vec2};
use dvp_core::{Real, simd};

/// Cells per side of the grid, as a part of an index in lanes and as a count.
const CELLS_LANES: u32 = 64;
const CELLS: usize = CELLS_LANES as usize;
/// Edges shorter than this (squared, in units of the outline) are points that two vertices share.
const SHORTEST_EDGE: f64 = 1e-12;

/// One edge of the unit outline.
#[derive(Clone, Copy, Debug)]
struct Edge<T> {
    segment: LineSegment<T>,
    /// Unit normals, to the outside: of the vertex it starts at, its own, of the vertex it ends at. Those of a vertex are
    /// between those of its two edges: together they tell on which side of it a point is.
    normals: [[T; 2]; 3],
}

/// One cell of the grid: the distance as its middle sees it.
#[derive(Clone, Copy, Debug, Default)]
struct Cell<T> {
    /// Signed distance in the middle.
    distance: T,
    /// Distance and gradient of the plane that touches the distance there: its value at the origin, its slopes.
    origin: T,
    gradient: [T; 2],
    /// Index of the edge before the nearest one.
    before: u32,
}

/// Signed distances (positive outside) and their gradients at several points, in units of the outline.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Distances<T, const N: usize> {
    pub(crate) distance: [T; N],
    pub(crate) gradient: [[T; N]; 2],
}

/// Signed distance field of a unit outline.
#[derive(Clone, Debug)]
pub(crate) struct OutlineField<T> {
    /// In order, the last one repeated in front and the first one behind.
    edges: Vec<Edge<T>>,
    cells: Vec<Cell<T>>,
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
        round_corners(&mut edges);
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
            cells: vec![Cell::default(); CELLS * CELLS],
            low,
            cells_per_unit,
            area: signed.abs(),
            centroid: centroid(vertices).unwrap_or_default(),
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

    /// The cells that points lie in; outside of the grid those of its rim.
    #[inline(always)]
    fn cells_of<const N: usize>(&self, points: &[[T; N]; 2]) -> [u32; N] {
        let (zero, most, half) = (T::zero(), T::of_usize(CELLS - 1), T::of(0.5));
        let mut cells = [[0; N]; 2];
        for c in 0..2 {
            let along: [T; N] = simd::lanes(|i| (points[c][i] - self.low[c]) * self.cells_per_unit - half);
            let along: [T; N] = simd::lanes(|i| if along[i] > zero { along[i] } else { zero });
            let along: [T; N] = simd::lanes(|i| if along[i] < most { along[i] } else { most });
            cells[c] = simd::lanes(|i| along[i].round_lanes());
        }
        simd::lanes(|i| cells[1][i] * CELLS_LANES + cells[0][i])
    }

    /// Bounds of the signed distance at `point`, from its cell alone; outside the grid from the nearest cell.
    #[inline(always)]
    pub(crate) fn distance_bounds(&self, point: [T; 2]) -> (T, T) {
        let cell = &self.cells[self.cells_of(&[[point[0]], [point[1]]])[0] as usize];
        let center = cell.distance;
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
    pub(crate) fn distance(&self, [x, y]: [T; 2]) -> (T, [T; 2]) {
        let Distances { distance, gradient } = self.exact(&[[x], [y]]);
        (distance[0], gradient.map(|slope| slope[0]))
    }

    /// Distances to first order about the middle of each point's cell: right to about the squared size of a cell times the
    /// outline's curvature, and off where the outline has corners.
    #[inline(always)]
    pub(crate) fn rough<const N: usize>(&self, points: &[[T; N]; 2]) -> Distances<T, N> {
        let cells = self.cells_of(points);
        let (mut origin, mut gradient) = ([T::zero(); N], [[T::zero(); N]; 2]);
        for i in 0..N {
            if let Some(cell) = self.cells.get(cells[i] as usize) {
                (origin[i], gradient[0][i], gradient[1][i]) = (cell.origin, cell.gradient[0], cell.gradient[1]);
            }
        }
        let distance = simd::lanes(|i| origin[i] + gradient[0][i] * points[0][i] + gradient[1][i] * points[1][i]);
        Distances { distance, gradient }
    }

    /// Distances to the nearest of three edges: that of the middle of each point's cell and those beside it.
    #[inline(always)]
    pub(crate) fn exact<const N: usize>(&self, points: &[[T; N]; 2]) -> Distances<T, N> {
        let cells = self.cells_of(points);
        let mut before = [0; N];
        for i in 0..N {
            before[i] = self.cells.get(cells[i] as usize).map_or(0, |cell| cell.before);
        }
        let (zero, one) = (T::zero(), T::one());
        let (mut squared, mut share, mut offset, mut at) = ([T::infinity(); N], [zero; N], [[zero; N]; 2], [zero; N]);
        // Of each edge where it starts, its step, and its inverse squared length.
        let mut fans = [[[zero; N]; 5]; 3];
        for i in 0..N {
            if let Some(edges) = self.edges.get(before[i] as usize..).and_then(|edges| edges.first_chunk::<3>()) {
                for k in 0..3 {
                    let LineSegment { from, along, inverse_squared } = edges[k].segment;
                    (fans[k][0][i], fans[k][1][i]) = (from.x, from.y);
                    (fans[k][2][i], fans[k][3][i]) = (along.x, along.y);
                    fans[k][4][i] = inverse_squared;
                }
            }
        }
        for (k, [ax, ay, sx, sy, inverse]) in fans.iter().enumerate() {
            let arm: [[T; N]; 2] = [simd::lanes(|i| points[0][i] - ax[i]), simd::lanes(|i| points[1][i] - ay[i])];
            let u: [T; N] = simd::lanes(|i| (arm[0][i] * sx[i] + arm[1][i] * sy[i]) * inverse[i]);
            let u: [T; N] = simd::lanes(|i| if u[i] > zero { u[i] } else { zero });
            let u: [T; N] = simd::lanes(|i| if u[i] < one { u[i] } else { one });
            let to: [[T; N]; 2] =
                [simd::lanes(|i| arm[0][i] - u[i] * sx[i]), simd::lanes(|i| arm[1][i] - u[i] * sy[i])];
            let length: [T; N] = simd::lanes(|i| to[0][i] * to[0][i] + to[1][i] * to[1][i]);
            share = simd::lanes(|i| if length[i] < squared[i] { u[i] } else { share[i] });
            offset[0] = simd::lanes(|i| if length[i] < squared[i] { to[0][i] } else { offset[0][i] });
            offset[1] = simd::lanes(|i| if length[i] < squared[i] { to[1][i] } else { offset[1][i] });
            let number = T::of_usize(k);
            at = simd::lanes(|i| if length[i] < squared[i] { number } else { at[i] });
            squared = simd::lanes(|i| if length[i] < squared[i] { length[i] } else { squared[i] });
        }
        let nearest: [u32; N] = simd::lanes(|i| before[i] + at[i].round_lanes());
        let end: [u32; N] = simd::lanes(|i| u32::from(share[i] > zero) + u32::from(share[i] >= one));
        let mut normal = [[zero; N]; 2];
        for i in 0..N {
            let edge = self.edges.get(nearest[i] as usize);
            if let Some(there) = edge.and_then(|edge| edge.normals.get(end[i] as usize)) {
                (normal[0][i], normal[1][i]) = (there[0], there[1]);
            }
        }
        let side: [T; N] = simd::lanes(|i| offset[0][i] * normal[0][i] + offset[1][i] * normal[1][i]);
        let length: [T; N] = simd::lanes(|i| squared[i].sqrt());
        let distance: [T; N] = simd::lanes(|i| if side[i] < zero { -length[i] } else { length[i] });
        // On the outline itself the normal is the gradient.
        let least = T::of(1e-9);
        let inverse: [T; N] = simd::lanes(|i| one / distance[i]);
        let gradient = [
            simd::lanes(|i| if length[i] > least { offset[0][i] * inverse[i] } else { normal[0][i] }),
            simd::lanes(|i| if length[i] > least { offset[1][i] * inverse[i] } else { normal[1][i] }),
        ];
        Distances { distance, gradient }
    }
}

/// Gives every vertex of a closed polygon its normal.
fn round_corners<T: Real>(edges: &mut [Edge<T>]) {
    let own: Vec<[T; 2]> = edges.iter().map(|edge| edge.normals[1]).collect();
    let between = |a: [T; 2], b: [T; 2]| {
        let sum = [a[0] + b[0], a[1] + b[1]];
        let length = (sum[0] * sum[0] + sum[1] * sum[1]).sqrt();
        if length > T::zero() { sum.map(|x| x / length) } else { a }
    };
    let n = edges.len();
    for (i, edge) in edges.iter_mut().enumerate() {
        edge.normals[0] = between(own[i], own[(i + n - 1) % n]);
        edge.normals[2] = between(own[i], own[(i + 1) % n]);
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
                    let squared = edge.segment.nearest(Vec2::new(x[column], y)).distance_squared();
                    let nearer = squared < least[column];
                    least[column] = if nearer { squared } else { least[column] };
                    nearest[column] = if nearer { number } else { nearest[column] };
                }
            }
            for column in 0..CELLS {
                // In front of the first edge stands the last one: the edge before number `i` is at `i - 1`.
                let before = u32::try_from(nearest[column].to_count()).unwrap_or(u32::MAX).saturating_sub(1);
                field.cells[row * CELLS + column].before = before;
            }
            let middles = field.exact(&[x, [y; CELLS]]);
            for (column, cell) in field.cells[row * CELLS..][..CELLS].iter_mut().enumerate() {
                cell.distance = middles.distance[column];
                cell.gradient = [middles.gradient[0][column], middles.gradient[1][column]];
                cell.origin = cell.distance - cell.gradient[0] * x[column] - cell.gradient[1] * y;
            }
        }
    }
}

impl<T: Real> Edge<T> {
    fn new(start: [T; 2], end: [T; 2], counterclockwise: bool) -> Option<Self> {
        let segment = LineSegment::new(start.into(), end.into());
        let squared = segment.along.length_squared();
        if squared.is_nan() || squared <= T::of(SHORTEST_EDGE) {
            return None;
        }
        let sign = if counterclockwise { T::one() } else { -T::one() } / squared.sqrt();
        Some(Self { segment, normals: [[segment.along.y * sign, -segment.along.x * sign]; 3] })
    }
}
