//! Forms: outlines without place, size, angle, starting point and direction of travel; distances between them.

use alloc::vec;
use alloc::vec::Vec;

use core::f64::consts::{PI, TAU};

use dvp_core::shape::{OutlineBasis, ShapeError};
use dvp_core::{Efd, Real};
use num_traits::Float;

use super::MAX_HARMONICS;

/// Vertices of the polygon that a form is measured on.
const VERTICES: usize = 257;
/// Shifts of the starting point tried first: more than two per period of the highest frequency of |G|^2, 2 x 31.
const SHIFTS: usize = 128;
/// Newton steps from the best shifts; each doubles the digits.
const NEWTON_STEPS: usize = 6;
/// Shifts whose correlation is below this share of the best one are not refined.
const WORTH_REFINING: f64 = 0.9;

/// A closed outline in its own frame: complex Fourier coefficients over arc length, area pi, turning from +x to +y.
///
/// Place, size, starting phase and direction of travel are taken out; what remains free is the angle and the start,
/// which [`Self::align`] takes the minimum over.
#[derive(Clone, Debug, PartialEq)]
pub struct Form {
    /// (re, im) of the frequencies 1, -1, 2, -2, ...
    spectrum: Vec<[f64; 2]>,
}

/// What may be done to a form before it is compared with another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Freedom {
    /// It may be turned.
    pub turn: bool,
    /// It may be mirrored.
    pub mirror: bool,
}

/// How one form is laid on another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// Root mean square distance of corresponding points, in radii of the disk of the same area.
    pub distance: f64,
    /// Start, as an angle of the parameter.
    pub phase: f64,
    /// Turn, radians.
    pub rotation: f64,
    /// Whether the form was mirrored (x and y exchanged) first.
    pub mirrored: bool,
}

impl Form {
    /// The form of an outline.
    ///
    /// # Errors
    /// [`ShapeError`] if the outline is no closed curve or encloses nothing ([`ShapeError::Degenerate`]).
    #[inline(never)]
    pub fn new<T: Real>(efd: &Efd<T>) -> Result<Self, ShapeError> {
        let rows: Vec<[f64; 4]> = efd.rows().iter().map(|row| row.map(Real::as_f64)).collect();
        let basis = OutlineBasis::<f64>::new(VERTICES, rows.len().max(1))?;
        let mut outline = vec![[0.0; 2]; VERTICES];
        basis.outline(&rows, &mut outline)?;
        Self::of_polygon(&outline)
    }

    /// The form of a closed polygon.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_polygon(polygon: &[[f64; 2]]) -> Result<Self, ShapeError> {
        let (efd, _) = Efd::from_contour(polygon, MAX_HARMONICS)?;
        let mut spectrum = spectrum_of(&efd);
        // Against +x to +y: the other way round, z(-t).
        if area(&spectrum) < 0.0 {
            spectrum.chunks_exact_mut(2).for_each(|pair| pair.swap(0, 1));
        }
        let area = area(&spectrum);
        if !(area > 0.0 && area.is_finite()) {
            return Err(ShapeError::Degenerate);
        }
        let scale = Float::sqrt(PI / area);
        spectrum.as_flattened_mut().iter_mut().for_each(|value| *value *= scale);
        Ok(Self { spectrum })
    }

    /// The form of descriptors that run from +x to +y, with the starting point and the speed that they have.
    pub(super) fn as_it_runs(efd: &Efd<f64>) -> Self {
        Self { spectrum: spectrum_of(&efd.resized(MAX_HARMONICS)) }
    }

    /// Descriptors of the outline as it stands, with as many harmonics as hold all but `tolerance` (root mean square).
    #[must_use]
    pub fn efd(&self, tolerance: f64) -> Efd<f64> {
        // z = sum c_m e^(imt): a = re(c+ + c-), b = im(c- - c+), c = im(c+ + c-), d = re(c+ - c-)
        let rows = self.spectrum.chunks_exact(2).map(|pair| {
            let [[p, q], [r, s]] = [pair[0], pair[1]];
            [p + r, s - q, q + s, p - r]
        });
        let efd = Efd::new(rows.collect());
        efd.resized(efd.harmonics_needed(tolerance).max(1))
    }

    /// The mirror image.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        // conj z(-t): the direction of travel stays.
        Self { spectrum: self.spectrum.iter().map(|&[re, im]| [re, -im]).collect() }
    }

    /// Lays `other` on `self`: the minimum of the distance over turns and starting points, and over mirror images if
    /// `mirror` is set.
    ///
    /// The mean square distance is |a|^2 + |b|^2 - 2 Re(e^(i turn) G(phase)) with G(phase) = sum conj(a_m) b_m
    /// e^(i m phase): the best turn is the angle of G, the best phase is where |G| is largest, found on a grid and by
    /// Newton's method.
    #[must_use]
    pub fn align(&self, other: &Self, mirror: bool) -> Alignment {
        self.align_by(other, Freedom { turn: true, mirror })
    }

    /// As [`Self::align`], with less freedom: without turns, the minimum is over starting points alone, and the best phase is where
    /// the real part of G is largest.
    #[must_use]
    pub fn align_by(&self, other: &Self, Freedom { turn, mirror }: Freedom) -> Alignment {
        let plain = self.align_one(other, turn, false);
        if !mirror {
            return plain;
        }
        let reflected = self.align_one(&other.mirrored(), turn, true);
        if reflected.distance < plain.distance { reflected } else { plain }
    }

    /// Distance alone; see [`Self::align`].
    #[must_use]
    pub fn distance(&self, other: &Self, mirror: bool) -> f64 {
        self.align(other, mirror).distance
    }

    fn align_one(&self, other: &Self, turn: bool, mirrored: bool) -> Alignment {
        let products: Vec<[f64; 2]> =
            self.spectrum.iter().zip(&other.spectrum).map(|(&a, &b)| times([a[0], -a[1]], b)).collect();
        // Without turns, G is only worth what of it points along the real axis.
        let worth = |g: [f64; 2]| if turn { square(g) } else { Float::abs(g[0]) * g[0] };
        let on_grid: Vec<f64> = (0..SHIFTS).map(|i| worth(correlation(&products, grid_phase(i))[0])).collect();
        let best = on_grid.iter().copied().fold(0.0, f64::max);
        let mut found = Alignment { distance: f64::INFINITY, phase: 0.0, rotation: 0.0, mirrored };
        for i in 0..SHIFTS {
            let (before, after) = (on_grid[(i + SHIFTS - 1) % SHIFTS], on_grid[(i + 1) % SHIFTS]);
            if on_grid[i] < WORTH_REFINING * best || on_grid[i] < before || on_grid[i] < after {
                continue;
            }
            let phase = climb(&products, grid_phase(i), turn);
            let [re, im] = correlation(&products, phase)[0];
            let rotation = if turn { -Float::atan2(im, re) } else { 0.0 };
            let laid = other.laid(phase, rotation);
            let squared: f64 = self.spectrum.iter().zip(&laid).map(|(a, b)| square([a[0] - b[0], a[1] - b[1]])).sum();
            let distance = Float::sqrt(squared);
            if distance < found.distance {
                found = Alignment { distance, phase, rotation, mirrored };
            }
        }
        found
    }

    /// This form as `alignment` lays it on the other.
    #[must_use]
    pub fn aligned(&self, alignment: &Alignment) -> Self {
        let form = if alignment.mirrored { self.mirrored() } else { self.clone() };
        Self { spectrum: form.laid(alignment.phase, alignment.rotation) }
    }

    /// The mean of forms that lie on each other, with weights; none if they cancel out.
    #[must_use]
    pub fn mean<'a>(forms: impl IntoIterator<Item = (&'a Self, f64)>) -> Option<Self> {
        let mut spectrum = vec![[0.0; 2]; 2 * MAX_HARMONICS];
        for (form, weight) in forms {
            for (sum, &value) in spectrum.as_flattened_mut().iter_mut().zip(form.spectrum.as_flattened()) {
                *sum += weight * value;
            }
        }
        let area = area(&spectrum);
        let scale = Float::sqrt(PI / area);
        spectrum.as_flattened_mut().iter_mut().for_each(|value| *value *= scale);
        (area > 0.0 && scale.is_finite()).then_some(Self { spectrum })
    }

    /// The form with the symmetry that it evidently has: turns by 2 pi / order, and reflection, where they move the
    /// outline by less than `tolerance` (root mean square, radii). Returns the order (0: a disk) and whether it is its own
    /// mirror image.
    #[must_use]
    pub fn symmetrized(&self, tolerance: f64) -> (Self, usize, bool) {
        let mut form = self.clone();
        // Orders beyond the highest frequency are a disk's.
        let order = (2..=MAX_HARMONICS + 1).rev().find(|&order| form.off_pattern(order) < tolerance).unwrap_or(1);
        for (m, value) in frequencies().zip(&mut form.spectrum) {
            if !in_pattern(m, order) {
                *value = [0.0; 2];
            }
        }
        let disk = form.off_pattern(MAX_HARMONICS + 2) < tolerance;
        let order = if disk { 0 } else { order };
        if disk {
            form.spectrum.iter_mut().skip(1).for_each(|value| *value = [0.0; 2]);
        }
        let reflection = form.align_one(&form.mirrored(), true, true);
        let own_mirror = reflection.distance < tolerance;
        if own_mirror {
            let image = form.aligned(&reflection);
            form = Self::mean([(&form, 0.5), (&image, 0.5)]).unwrap_or(form);
        }
        (Self::mean([(&form, 1.0)]).unwrap_or(form), order, own_mirror)
    }

    /// Root mean square of what does not repeat after a turn by 2 pi / `order`.
    fn off_pattern(&self, order: usize) -> f64 {
        let off = frequencies().zip(&self.spectrum).filter(|&(m, _)| !in_pattern(m, order));
        Float::sqrt(off.map(|(_, &value)| square(value)).sum())
    }

    fn laid(&self, phase: f64, rotation: f64) -> Vec<[f64; 2]> {
        let turned = frequencies().zip(&self.spectrum).map(|(m, &value)| {
            let (sin, cos) = Float::sin_cos(m * phase + rotation);
            times(value, [cos, sin])
        });
        turned.collect()
    }
}

/// 1, -1, 2, -2, ...
fn frequencies() -> impl Iterator<Item = f64> {
    (1..=MAX_HARMONICS).flat_map(|n| [f64::of_usize(n), -f64::of_usize(n)])
}

/// Whether frequency `m` repeats after a turn by 2 pi / `order`: m = 1 modulo the order.
fn in_pattern(m: f64, order: usize) -> bool {
    let order = f64::of_usize(order);
    let turns = (m - 1.0) / order;
    Float::abs(turns - Float::round(turns)) < 0.5 / order
}

fn spectrum_of(efd: &Efd<f64>) -> Vec<[f64; 2]> {
    let pairs =
        efd.rows().iter().flat_map(|&[a, b, c, d]| [[(a + d) / 2.0, (c - b) / 2.0], [(a - d) / 2.0, (c + b) / 2.0]]);
    pairs.collect()
}

/// pi sum m |c_m|^2.
fn area(spectrum: &[[f64; 2]]) -> f64 {
    PI * frequencies().zip(spectrum).map(|(m, &value)| m * square(value)).sum::<f64>()
}

fn grid_phase(i: usize) -> f64 {
    TAU * f64::of_usize(i) / f64::of_usize(SHIFTS)
}

/// G(phase) and its first two derivatives.
fn correlation(products: &[[f64; 2]], phase: f64) -> [[f64; 2]; 3] {
    let (sin_1, cos_1) = Float::sin_cos(phase);
    let (mut wave, mut n) = ([1.0, 0.0], 0.0);
    let mut sums = [[0.0; 2]; 3];
    for pair in products.chunks_exact(2) {
        wave = times(wave, [cos_1, sin_1]);
        n += 1.0;
        let (ahead, back) = (times(pair[0], wave), times(pair[1], [wave[0], -wave[1]]));
        for c in 0..2 {
            sums[0][c] += ahead[c] + back[c];
            sums[2][c] -= n * n * (ahead[c] + back[c]);
        }
        // i m w
        sums[1][0] -= n * (ahead[1] - back[1]);
        sums[1][1] += n * (ahead[0] - back[0]);
    }
    sums
}

/// The phase near `phase` where |G|^2 is largest, or, without turns, the real part of G.
fn climb(products: &[[f64; 2]], mut phase: f64, turn: bool) -> f64 {
    let step_limit = TAU / f64::of_usize(SHIFTS);
    for _ in 0..NEWTON_STEPS {
        let [g, first, second] = correlation(products, phase);
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let (slope, bend) = if turn { (dot(g, first), square(first) + dot(g, second)) } else { (first[0], second[0]) };
        // Not a summit (a disk: |G| is constant): stay.
        if bend >= 0.0 {
            break;
        }
        phase -= (slope / bend).clamp(-step_limit, step_limit);
    }
    phase
}

fn times(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn square([re, im]: [f64; 2]) -> f64 {
    re * re + im * im
}
