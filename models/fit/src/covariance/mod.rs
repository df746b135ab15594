//! What a fit cannot tell: covariance of the pose of one object, from the samples along its outline.
//!
//! Four things leave a pose in doubt, and each adds its part. *Noise* is another one in every sample, so many samples tell much. What
//! samples miss beyond it is *systematic*: an edge that is not the one of the profile, a coder's blocks, a shape that is nearly the true
//! one. Neighbors miss alike, and no count of them averages it away. Edges that may be *blurred* lie farther in where outlines bend. And
//! the *unseen* part of an outline that no shape tells is a guess.

mod seen;
#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::contour::signed_area;
use dvp_core::{Real, simd};

pub(crate) use seen::Displaced;

use crate::free::foot::EdgeLanes;
use crate::segment::EdgeSample;
use crate::tuning::{COVARIANCE_ASTRAY_PX, SYSTEMATIC_PX};

/// Variances of (x, y in scene units, log scale, rotation) assumed before looking: 1, 1, 1, and pi^2 / 3, that of a uniform
/// angle. They keep the covariance finite where the image says nothing (the angle of a disk).
pub(crate) const PRIOR_VARIANCE: [f64; 4] = [1.0, 1.0, 1.0, 3.29];

/// Parts of an outline that miss alike, each on its own, beside what the whole outline misses: of objects of a few tens of pixels an eighth is
/// about as long as the blocks of a coder. Half or twice as many change little (`tests/report/sensitivity.md`).
pub(crate) const ARCS: usize = 8;
/// Numbers of a pose that keeps its stretch.
const NUMBERS: usize = 4;

/// An object whose pose is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outlined<'a, T> {
    /// The closed posed outline (px).
    pub(crate) outline: &'a [[T; 2]],
    /// The point it turns and grows about (px).
    pub(crate) center: [T; 2],
    pub(crate) samples: &'a [EdgeSample<T>],
    /// Pixels per scene unit.
    pub(crate) unit_px: T,
    /// Standard deviation of a channel.
    pub(crate) pixel_noise: T,
    /// Standard deviation (px) of what may have blurred the edge; 0 if its profile is known.
    pub(crate) blur_px: T,
    /// Whether only samples tell where the outline runs: its shape is its own, or may be another one of those known.
    pub(crate) is_free: bool,
    /// What is seen of it (px^2).
    pub(crate) area: T,
}

/// Covariance of (x, y in scene units, log scale, rotation, log stretch), row-major, and the IoU to expect of what is seen.
pub(crate) fn covariance<T: Real>(object: &Outlined<'_, T>, lanes: &mut EdgeLanes<T>) -> ([T; 25], T) {
    lanes.set(object.outline);
    let mut seen = vec![false; object.outline.len().saturating_sub(1)];
    let sums = simd::dispatch(Gather { object, lanes, seen: &mut seen });
    let mut information = sums.information;
    for (i, &variance) in PRIOR_VARIANCE.iter().enumerate() {
        information[i][i] += T::of(1.0 / variance);
    }
    let inverse = inverse4(information);
    let area = signed_area(object.outline).abs().max(T::of(1e-3));
    let missing = |systematic: T| sums.missing(&inverse, systematic, bend(object, area));
    let systematic = sums.systematic(sums.misfit);
    let mut block = missing(systematic);
    let unseen = unseen_runs(object.outline, &seen);
    let iou = {
        let &Outlined { outline, center, unit_px, .. } = object;
        // A shape of its own may be off in each part by what the samples of that part leave open.
        let own = systematic + if object.is_free { T::of_usize(ARCS) / sums.weight } else { T::zero() };
        let all: T = (0..seen.len()).map(|edge| length_of(outline, edge)).sum();
        let length = all - unseen.iter().map(|run| run.length).sum();
        let displaced = Displaced { outline, center, unit_px, covariance: &block, stride: NUMBERS, own };
        displaced.expected_iou(|edge| seen[edge], length, object.area.min(area))
    };
    if object.is_free {
        // Corners tell where the middle of a shape of its own is, and samples beside one do not say which of its edges they are of.
        block = missing(sums.systematic(sums.continued));
        for run in unseen {
            let arm = [0, 1].map(|c| (run.middle[c] - object.center[c]) / object.unit_px);
            // As large again is as little as can be known.
            widen(&mut block, [arm[0], arm[1], T::of(0.5), T::zero()], (run.area() / area).min(T::one()));
        }
    }
    (with_stretch(block), iou)
}

/// Adds an error that moves the numbers together, of this standard deviation.
fn widen<T: Real>(block: &mut [T; 16], moved: [T; NUMBERS], deviation: T) {
    for i in 0..NUMBERS {
        for j in 0..NUMBERS {
            block[NUMBERS * i + j] += deviation * deviation * moved[i] * moved[j];
        }
    }
}

/// The covariance of the pose of a shape that keeps its stretch, from that of (x, y, log scale, rotation).
pub(crate) fn with_stretch<T: Real>(block: [T; 16]) -> [T; 25] {
    core::array::from_fn(|k| if k / 5 < 4 && k % 5 < 4 { block[4 * (k / 5) + k % 5] } else { T::zero() })
}

/// Standard deviation of the log scale of an outline of this area (px^2) by what bends in it. Pixels are read as if it were straight in
/// each: over the diagonal of a pixel a circle of radius R px bends by 1 / (4 R) px. Known shapes have no freedom to follow that: those
/// of 2 to 4 px came to an IoU of .93 and more, where free outlines came to .81 to .95. A blur of standard deviation s moves half coverage
/// by s^2 / (2 R) px, and nothing but the profile of the edge, which is not known beforehand, tells a blur from an edge that is as wide.
fn bend<T: Real>(object: &Outlined<'_, T>, area: T) -> T {
    let pixel = if object.is_free { T::of(0.25) } else { T::zero() };
    (pixel + T::of(0.5) * object.blur_px * object.blur_px) * T::of(core::f64::consts::PI) / area
}

/// A part of an outline that no sample tells.
struct Unseen<T> {
    /// Its length (px).
    length: T,
    /// The vertex in its middle (px).
    middle: [T; 2],
}

impl<T: Real> Unseen<T> {
    /// Standard deviation of the area (px^2) on its inner side: that of a triangle over it, a quarter as high as it is long.
    fn area(&self) -> T {
        T::of(0.125) * self.length * self.length
    }
}

/// The parts of a closed outline without samples that are longer than the reach of a sample to either side; none if there is no sample.
fn unseen_runs<T: Real>(outline: &[[T; 2]], seen: &[bool]) -> Vec<Unseen<T>> {
    let edges = seen.len();
    let Some(first) = seen.iter().position(|&is| is) else { return Vec::new() };
    let mut runs = Vec::new();
    let (mut start, mut sum) = (first, T::zero());
    for step in 1..=edges {
        let edge = (first + step) % edges;
        if !seen[edge] {
            sum += length_of(outline, edge);
            continue;
        }
        if sum > T::of(2.0 * COVARIANCE_ASTRAY_PX) {
            runs.push(Unseen { length: sum, middle: outline[(start + (first + step - start).div_ceil(2)) % edges] });
        }
        (start, sum) = (first + step, T::zero());
    }
    runs
}

/// Length (px) of an edge.
fn length_of<T: Real>(outline: &[[T; 2]], edge: usize) -> T {
    let [a, b] = [outline[edge], outline[edge + 1]];
    (b[0] - a[0]).hypot(b[1] - a[1])
}

/// Sums over the samples that lie on the outline.
struct Sums<T> {
    /// The normal equations of a pose in scene units.
    information: [[T; NUMBERS]; NUMBERS],
    /// Per part of the outline, what a displacement of all of its samples (px) does to the right side of the equations.
    arcs: [[T; NUMBERS]; ARCS],
    /// Squared misfits in units of the noise.
    misfit: T,
    /// The same against the nearest edge as if it went on straight beyond its ends.
    continued: T,
    /// Inverse variances of the distances (1 / px^2).
    weight: T,
    count: usize,
}

impl<T: Real> Sums<T> {
    /// Variance (px^2) of what samples miss beyond the noise; `misfit`: one of those of the sums.
    fn systematic(&self, misfit: T) -> T {
        let excess = (misfit - T::of_usize(self.count)).max(T::zero());
        let rest = if self.weight > T::zero() { excess / self.weight } else { T::zero() };
        rest + T::of(SYSTEMATIC_PX * SYSTEMATIC_PX)
    }

    /// The covariance of the pose, `inverse` that of noise alone, if parts and the whole miss alike by this variance (px^2), and the size is off
    /// by what bends.
    #[inline(never)]
    fn missing(&self, inverse: &[T; 16], systematic: T, bend: T) -> [T; 16] {
        // What a displacement by a pixel does to the pose, if all samples of a part share it.
        let moved = |weights: &[T; NUMBERS]| -> [T; NUMBERS] {
            core::array::from_fn(|i| (0..NUMBERS).map(|j| inverse[NUMBERS * i + j] * weights[j]).sum())
        };
        let whole: [T; NUMBERS] = core::array::from_fn(|i| self.arcs.iter().map(|arc| arc[i]).sum());
        let mut block = *inverse;
        for part in self.arcs.iter().chain([&whole]) {
            widen(&mut block, moved(part), systematic.sqrt());
        }
        widen(&mut block, [T::zero(), T::zero(), T::one(), T::zero()], bend);
        block
    }
}

/// Makes the sums.
struct Gather<'a, T> {
    object: &'a Outlined<'a, T>,
    lanes: &'a EdgeLanes<T>,
    /// Per edge of the outline, whether it has a sample.
    seen: &'a mut [bool],
}

impl<T: Real> simd::Kernel for Gather<'_, T> {
    type Output = Sums<T>;

    #[inline(always)]
    fn run(self) -> Sums<T> {
        let Self { object: Outlined { outline, center, samples, unit_px, pixel_noise, .. }, lanes, seen } = self;
        let noise = T::one() / (*pixel_noise * *pixel_noise);
        let mut sums = Sums {
            information: [[T::zero(); NUMBERS]; NUMBERS],
            arcs: [[T::zero(); NUMBERS]; ARCS],
            misfit: T::zero(),
            continued: T::zero(),
            weight: T::zero(),
            count: 0,
        };
        for sample in *samples {
            let at = lanes.closest(sample.point);
            let (a, b) = (outline[at], outline[at + 1]);
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            let length = (x * x + y * y).sqrt();
            if length <= T::of(1e-6) {
                continue;
            }
            let to = [sample.point[0] - a[0], sample.point[1] - a[1]];
            let along = ((x * to[0] + y * to[1]) / (length * length)).max(T::zero()).min(T::one());
            let foot = [a[0] + along * x, a[1] + along * y];
            let off = [sample.point[0] - foot[0], sample.point[1] - foot[1]];
            let far = (off[0] * off[0] + off[1] * off[1]).sqrt();
            let outward = [y / length, -x / length];
            let across = outward[0] * to[0] + outward[1] * to[1];
            // Across the edge; beyond its ends, at a corner, the nearest point is a vertex, which is seen from elsewhere.
            let n = if far > T::of(1e-3) { off.map(|d| d * across.signum() / far) } else { outward };
            let missed = far - sample.distance.abs();
            // Where the outline is hidden by another of its color, the samples nearest to it are that one's.
            if missed.abs() > T::of(COVARIANCE_ASTRAY_PX) {
                continue;
            }
            let arm = [foot[0] - center[0], foot[1] - center[1]];
            // The outline moves across itself by n for a shift (in scene units: times the unit), n.arm for a growth, and
            // n x arm for a turn.
            let row = [n[0] * *unit_px, n[1] * *unit_px, n[0] * arm[0] + n[1] * arm[1], n[1] * arm[0] - n[0] * arm[1]];
            let weight = sample.weight * sample.weight * noise;
            let continued = across.abs() - sample.distance.abs();
            sums.misfit += weight * missed * missed;
            sums.continued += weight * continued * continued;
            sums.weight += weight;
            sums.count += 1;
            let arc = &mut sums.arcs[at * ARCS / seen.len()];
            for i in 0..NUMBERS {
                arc[i] += weight * row[i];
                for j in 0..NUMBERS {
                    sums.information[i][j] += weight * row[i] * row[j];
                }
            }
            seen[at] = true;
        }
        sums
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
