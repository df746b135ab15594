//! What a fit cannot tell: covariance of poses, and how much of an outline is out of sight.

use alloc::vec::Vec;

use dvp_core::contour::contains;
use dvp_core::geometry::{Bounds, LineSegment};
use dvp_core::{ImageSize, Real, simd};

use crate::free::foot::EdgeLanes;
use crate::segment::EdgeSample;
use crate::tuning::COVARIANCE_ASTRAY_PX;

/// Variances of (x, y in scene units, log scale, rotation) assumed before looking: 1, 1, 1, and pi^2 / 3, that of a uniform
/// angle. They keep the covariance finite where the image says nothing (the angle of a disk).
pub(crate) const PRIOR_VARIANCE: [f64; 4] = [1.0, 1.0, 1.0, 3.29];

/// Covariance of (x, y in scene units, log scale, rotation, log stretch), row-major, from the normal equations of the samples.
///
/// `outline_px` is the closed posed outline, `center_px` the point it turns and grows about; `pixel_noise` the standard
/// deviation of a channel. Samples are taken as independent. Where they miss the outline by more than noise explains, they
/// tell so much less of it: chi squared per sample, if above 1, is a factor of the covariance.
pub(crate) fn covariance<T: Real>(
    outline_px: &[[T; 2]],
    center_px: [T; 2],
    samples: &[EdgeSample<T>],
    unit_px: T,
    pixel_noise: T,
    lanes: &mut EdgeLanes<T>,
) -> [T; 25] {
    lanes.set(outline_px);
    let noise = T::one() / (pixel_noise * pixel_noise);
    let (mut information, misfit, count) =
        simd::dispatch(Information { outline_px, center_px, samples, unit_px, noise, lanes });
    let factor = (misfit / T::of_usize(count.max(1))).max(T::one());
    information.iter_mut().flatten().for_each(|value| *value /= factor);
    for (i, &variance) in PRIOR_VARIANCE.iter().enumerate() {
        information[i][i] += T::of(1.0 / variance);
    }
    with_stretch(inverse4(information))
}

/// The covariance of the pose of a shape that keeps its stretch, from that of (x, y, log scale, rotation).
pub(crate) fn with_stretch<T: Real>(block: [T; 16]) -> [T; 25] {
    core::array::from_fn(|k| if k / 5 < 4 && k % 5 < 4 { block[4 * (k / 5) + k % 5] } else { T::zero() })
}

/// Makes the normal equations of a pose in scene units, the sum of its squared misfits, and the number of samples in them.
struct Information<'a, T> {
    outline_px: &'a [[T; 2]],
    center_px: [T; 2],
    samples: &'a [EdgeSample<T>],
    unit_px: T,
    /// Inverse variance of a channel.
    noise: T,
    lanes: &'a EdgeLanes<T>,
}

impl<T: Real> simd::Kernel for Information<'_, T> {
    type Output = ([[T; 4]; 4], T, usize);

    #[inline(always)]
    fn run(self) -> Self::Output {
        let Self { outline_px, center_px, samples, unit_px, noise, lanes } = self;
        let mut information = [[T::zero(); 4]; 4];
        let (mut misfit, mut count) = (T::zero(), 0);
        for sample in samples {
            let at = lanes.closest(sample.point);
            let (a, b) = (outline_px[at], outline_px[at + 1]);
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            let length = (x * x + y * y).sqrt();
            if length <= T::of(1e-6) {
                continue;
            }
            let n = [y / length, -x / length];
            // Where the outline is hidden by another of its color, the samples nearest to it are that one's.
            let across = (n[0] * (sample.point[0] - a[0]) + n[1] * (sample.point[1] - a[1])).abs();
            let off = across - sample.distance.abs();
            if off.abs() > T::of(COVARIANCE_ASTRAY_PX) {
                continue;
            }
            let arm = [sample.point[0] - center_px[0], sample.point[1] - center_px[1]];
            // The outline moves across itself by n for a shift (in scene units: times the unit), n.arm for a growth, and
            // n x arm for a turn.
            let row = [n[0] * unit_px, n[1] * unit_px, n[0] * arm[0] + n[1] * arm[1], n[1] * arm[0] - n[0] * arm[1]];
            let weight = sample.weight * sample.weight * noise;
            misfit += weight * off * off;
            count += 1;
            for i in 0..4 {
                for j in 0..4 {
                    information[i][j] += weight * row[i] * row[j];
                }
            }
        }
        (information, misfit, count)
    }
}

/// Inverse of a symmetric positive definite matrix, row-major, by Gauss-Jordan with scaled rows.
fn inverse4<T: Real>(matrix: [[T; 4]; 4]) -> [T; 16] {
    // Unit diagonal first: the entries span many orders of magnitude.
    let scale: [T; 4] = core::array::from_fn(|i| T::one() / matrix[i][i].sqrt());
    let mut left: [[T; 4]; 4] = core::array::from_fn(|i| core::array::from_fn(|j| matrix[i][j] * scale[i] * scale[j]));
    let mut right = [[T::zero(); 4]; 4];
    for (i, row) in right.iter_mut().enumerate() {
        row[i] = T::one();
    }
    for i in 0..4 {
        let pivot = left[i][i].max(T::epsilon());
        for j in 0..4 {
            left[i][j] /= pivot;
            right[i][j] /= pivot;
        }
        for k in 0..4 {
            if k != i {
                let factor = left[k][i];
                for j in 0..4 {
                    let (l, r) = (left[i][j], right[i][j]);
                    left[k][j] -= factor * l;
                    right[k][j] -= factor * r;
                }
            }
        }
    }
    let mut out = [T::zero(); 16];
    for i in 0..4 {
        for j in 0..4 {
            out[4 * i + j] = T::of(0.5) * (right[i][j] + right[j][i]) * scale[i] * scale[j];
        }
    }
    out
}

/// Share of the vertices that lie in the image.
pub(crate) fn visible_share<T: Real>(outline_px: &[[T; 2]], size: ImageSize) -> f64 {
    let (width, height) = (T::of_usize(size.width()), T::of_usize(size.height()));
    let inside = |&&[x, y]: &&[T; 2]| x >= T::zero() && y >= T::zero() && x < width && y < height;
    let seen = outline_px.iter().filter(inside).count();
    T::of_usize(seen).as_f64() / T::of_usize(outline_px.len().max(1)).as_f64()
}

/// What lies no deeper (px) behind another outline than this may as well touch it.
const TOUCHING_PX: f64 = 1.0;
/// Points looked at on each edge of an outline.
const POINTS: usize = 4;

/// Share of the length of a closed outline (scene units) that lies in the image but inside of `covers`.
pub(crate) fn hidden_share<'a, T: Real>(
    outline: &[[T; 2]],
    covers: impl Iterator<Item = &'a [[T; 2]]>,
    size: ImageSize,
) -> f64 {
    let unit = T::of_usize(size.unit_px());
    let limits = [size.width(), size.height()].map(|v| T::of_usize(v) / unit);
    let Some(bounds) = Bounds::of_vertices(outline) else { return 0.0 };
    let reaches = |cover: &&[[T; 2]]| Bounds::of_vertices(cover).is_some_and(|cover| cover.meets(&bounds, T::zero()));
    let covers: Vec<&[[T; 2]]> = covers.filter(reaches).collect();
    if covers.is_empty() {
        return 0.0;
    }
    let deep = T::of(TOUCHING_PX) / unit;
    let is_hidden = |point: [T; 2]| {
        (0..2).all(|c| point[c] > T::zero() && point[c] < limits[c])
            && covers.iter().any(|cover| contains(cover, point) && is_farther(cover, point, deep))
    };
    let (mut hidden, mut total) = (T::zero(), T::zero());
    for edge in outline.windows(2) {
        let step = [0, 1].map(|c| edge[1][c] - edge[0][c]);
        let length = step[0].hypot(step[1]);
        total += length;
        for i in 0..POINTS {
            let t = (T::of_usize(i) + T::of(0.5)) / T::of_usize(POINTS);
            if is_hidden([0, 1].map(|c| edge[0][c] + t * step[c])) {
                hidden += length / T::of_usize(POINTS);
            }
        }
    }
    if total > T::zero() { (hidden / total).as_f64() } else { 0.0 }
}

/// Whether every edge of a closed outline is farther from the point than `distance`.
fn is_farther<T: Real>(outline: &[[T; 2]], point: [T; 2], distance: T) -> bool {
    let mut edges = outline.windows(2).map(|edge| LineSegment::new(edge[0].into(), edge[1].into()));
    edges.all(|edge| edge.nearest(point.into()).distance() > distance)
}
