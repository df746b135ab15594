//! The nearest point of a closed polygon: all edges at once, in lanes.

use alloc::vec::Vec;

use dvp_core::contour::signed_area;
use dvp_core::{Real, simd};

/// Edges looked at together.
const LANES: usize = 16;

/// Edges of a closed polygon as lanes: start, step and inverse squared length; filled up with edges that are near to nothing.
#[derive(Clone, Debug, Default)]
pub(crate) struct EdgeLanes<T> {
    start: [Vec<T>; 2],
    step: [Vec<T>; 2],
    inverse: Vec<T>,
    /// 1 if the outline runs counterclockwise in (x, y), else -1.
    pub(crate) orientation: T,
}

impl<T: Real> EdgeLanes<T> {
    /// Takes the edges of `vertices`, the last of which repeats the first.
    #[inline(always)]
    pub(crate) fn set(&mut self, vertices: &[[T; 2]]) {
        for lane in self.start.iter_mut().chain(&mut self.step).chain([&mut self.inverse]) {
            lane.clear();
        }
        self.orientation = if signed_area(vertices) > T::zero() { T::one() } else { -T::one() };
        for pair in vertices.windows(2) {
            let step = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
            for c in 0..2 {
                self.start[c].push(pair[0][c]);
                self.step[c].push(step[c]);
            }
            self.inverse.push(T::one() / (step[0] * step[0] + step[1] * step[1]).max(T::of(1e-9)));
        }
        let filled = self.inverse.len().next_multiple_of(LANES);
        self.start.iter_mut().for_each(|lane| lane.resize(filled, T::infinity()));
        self.step.iter_mut().chain([&mut self.inverse]).for_each(|lane| lane.resize(filled, T::zero()));
    }

    /// The edge closest to `point`, the first of several.
    #[inline(always)]
    pub(crate) fn closest(&self, point: [T; 2]) -> usize {
        let [ax, ay, sx, sy, inverse] = [&self.start[0], &self.start[1], &self.step[0], &self.step[1], &self.inverse]
            .map(|lane| lane.as_chunks::<LANES>().0);
        let (mut least, mut nearest) = ([T::infinity(); LANES], [T::zero(); LANES]);
        for (block, ((ax, ay), ((sx, sy), inverse))) in
            ax.iter().zip(ay).zip(sx.iter().zip(sy).zip(inverse)).enumerate()
        {
            let dx: [T; LANES] = simd::lanes(|i| point[0] - ax[i]);
            let dy: [T; LANES] = simd::lanes(|i| point[1] - ay[i]);
            let u: [T; LANES] = simd::lanes(|i| (dx[i] * sx[i] + dy[i] * sy[i]) * inverse[i]);
            let u: [T; LANES] = simd::lanes(|i| if u[i] > T::zero() { u[i] } else { T::zero() });
            let u: [T; LANES] = simd::lanes(|i| if u[i] < T::one() { u[i] } else { T::one() });
            let ex: [T; LANES] = simd::lanes(|i| dx[i] - u[i] * sx[i]);
            let ey: [T; LANES] = simd::lanes(|i| dy[i] - u[i] * sy[i]);
            let squared: [T; LANES] = simd::lanes(|i| ex[i] * ex[i] + ey[i] * ey[i]);
            let number = T::of_usize(block);
            nearest = simd::lanes(|i| if squared[i] < least[i] { number } else { nearest[i] });
            least = simd::lanes(|i| if squared[i] < least[i] { squared[i] } else { least[i] });
        }
        // Blocks become edges; then the nearer of two halves, the first of those as near, until one lane is left.
        let width = T::of_usize(LANES);
        let mut nearest: [T; LANES] = simd::lanes(|i| nearest[i] * width + T::of_usize(i));
        let mut half = LANES / 2;
        while half > 0 {
            for i in 0..half {
                let (a, b) = ((least[i], nearest[i]), (least[i + half], nearest[i + half]));
                let upper = b.0 < a.0 || b.0 <= a.0 && b.1 < a.1;
                (least[i], nearest[i]) = if upper { b } else { a };
            }
            half /= 2;
        }
        nearest[0].round_lanes() as usize
    }
}

/// The point of a closed polygon nearest to a given point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Foot<T> {
    pub(crate) edge: usize,
    /// Position along the edge, [0, 1].
    pub(crate) share: T,
    /// Signed distance, positive outside.
    pub(crate) distance: T,
    /// Gradient of the distance with respect to the given point.
    pub(crate) direction: [T; 2],
}

/// Finds the nearest point of the closed polygon `vertices` (the last repeats the first), which `lanes` were set to.
#[inline(always)]
pub(crate) fn foot<T: Real>(vertices: &[[T; 2]], lanes: &EdgeLanes<T>, point: [T; 2]) -> Foot<T> {
    let edges = vertices.len() - 1;
    let at = lanes.closest(point);
    let (a, b) = (vertices[at], vertices[at + 1]);
    let (step, arm) = ([b[0] - a[0], b[1] - a[1]], [point[0] - a[0], point[1] - a[1]]);
    let squared = (step[0] * step[0] + step[1] * step[1]).max(T::of(1e-9));
    let share = ((arm[0] * step[0] + arm[1] * step[1]) / squared).max(T::zero()).min(T::one());
    let offset = [arm[0] - share * step[0], arm[1] - share * step[1]];
    let mut normal = [step[1] * lanes.orientation, -step[0] * lanes.orientation];
    if share <= T::zero() || share >= T::one() {
        // Beside a vertex both its edges tell the side.
        let before = share <= T::zero();
        let (c, d) = if before { (vertices[(at + edges - 1) % edges], a) } else { (b, vertices[(at + 1) % edges + 1]) };
        let (own, other) = (length(a, b), length(c, d));
        normal = [
            normal[0] / own + (d[1] - c[1]) * lanes.orientation / other,
            normal[1] / own - (d[0] - c[0]) * lanes.orientation / other,
        ];
    }
    let distance = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
    let inside = offset[0] * normal[0] + offset[1] * normal[1] < T::zero();
    let sign = if inside { -T::one() } else { T::one() };
    let direction = if distance > T::of(1e-4) {
        [offset[0] * sign / distance, offset[1] * sign / distance]
    } else {
        let size = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt().max(T::of(1e-9));
        [normal[0] / size, normal[1] / size]
    };
    Foot { edge: at, share, distance: sign * distance, direction }
}

fn length<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    (x * x + y * y).sqrt().max(T::of(1e-9))
}
