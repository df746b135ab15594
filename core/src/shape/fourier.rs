//! Descriptors of a closed line, by the exact integrals of Kuhl and Giardina (1982), and by those of arcs and cubics.

use alloc::vec;
use alloc::vec::Vec;

use num_traits::Float;

use super::bump::Bump;
use super::{Efd, ShapeError};
use crate::real::Real;

/// A piece of a closed line: its chord, and what it is more than its chord.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) start: [f64; 2],
    /// From its start to its end.
    pub(super) step: [f64; 2],
    /// Of the piece, not of its chord.
    pub(super) length: f64,
    /// None for a straight line.
    pub(super) bump: Option<Bump>,
}

/// Where a chord starts along the outline, and how the velocity turns there.
struct Corner {
    /// Arc length, 0 to 2 pi around the outline.
    phase: f64,
    /// Chord per length of the piece before, minus that of the piece after.
    turn: [f64; 2],
}

impl<T: Real> Efd<T> {
    /// The first `harmonic_count` descriptors of a closed polygon parametrized by arc length from its first vertex, and
    /// its center: the mean position along the outline, which the descriptors leave out.
    ///
    /// The edge from the last vertex to the first is part of the polygon, whether or not the first vertex is repeated at
    /// the end; repeated vertices are skipped. Computed in f64 whatever `T`. Time: vertices x harmonics.
    ///
    /// *Source*: Kuhl and Giardina, "Elliptic Fourier features of a closed contour", 1982. Their sum over edges
    /// of (dx/dt)(cos phi_end - cos phi_start) is taken here over corners, as the sum of cos phi times the change of dx/dt,
    /// which is the same sum in another order.
    ///
    /// # Errors
    /// [`ShapeError::NotFinite`], [`ShapeError::TooFewPoints`] below three distinct neighbors, [`ShapeError::TooLarge`] if lengths
    /// overflow.
    ///
    /// # Examples
    /// ```
    /// let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    /// let (efd, center) = dvp_core::Efd::<f64>::from_contour(&square, 64)?;
    /// assert_eq!(center, [0.5, 0.5]);
    /// assert!((efd.signed_area() - 1.0).abs() < 1e-4);
    /// # Ok::<(), dvp_core::shape::ShapeError>(())
    /// ```
    #[inline(never)]
    pub fn from_contour(contour: &[[T; 2]], harmonic_count: usize) -> Result<(Self, [T; 2]), ShapeError> {
        if let Some(index) = contour.iter().position(|[x, y]| !(x.is_finite() && y.is_finite())) {
            return Err(ShapeError::NotFinite { index });
        }
        let points = || contour.iter().map(|p| p.map(Real::as_f64));
        let ends = points().cycle().skip(1);
        let edges = points().zip(ends).map(|(start, end)| {
            let step = [end[0] - start[0], end[1] - start[1]];
            Stretch { start, step, length: Float::hypot(step[0], step[1]), bump: None }
        });
        descriptors(edges, harmonic_count)
    }
}

/// The first `harmonic_count` descriptors of the closed line of `stretches` and its mean position, each stretch taking a share
/// of the parameter equal to its share of the length; those without length are skipped.
///
/// # Errors
/// [`ShapeError::TooFewPoints`] below three straight stretches, [`ShapeError::TooLarge`] if lengths overflow.
pub(super) fn descriptors<T: Real>(
    stretches: impl Iterator<Item = Stretch> + Clone,
    harmonic_count: usize,
) -> Result<(Efd<T>, [T; 2]), ShapeError> {
    let stretches = stretches.filter(|stretch| stretch.length > 0.0);
    let (count, perimeter) = stretches.clone().fold((0, 0.0), |(n, sum), stretch| (n + 1, sum + stretch.length));
    let is_curved = stretches.clone().any(|stretch| stretch.bump.is_some());
    let Some(last) = stretches.clone().last().filter(|_| count > 2 || is_curved) else {
        return Err(ShapeError::TooFewPoints { len: count });
    };
    let mut before = [last.step[0] / last.length, last.step[1] / last.length];
    let mut along = 0.0;
    let mut moment = [0.0; 2];
    let mut rows = vec![[0.0; 4]; harmonic_count];
    for Stretch { start, step, length, .. } in stretches.clone() {
        let after = [step[0] / length, step[1] / length];
        let turn = [before[0] - after[0], before[1] - after[1]];
        add_corner(&Corner { phase: core::f64::consts::TAU * along / perimeter, turn }, &mut rows);
        moment[0] += (start[0] + step[0] / 2.0) * length;
        moment[1] += (start[1] + step[1] / 2.0) * length;
        along += length;
        before = after;
    }
    for (n, row) in (1..).zip(&mut rows) {
        let n = f64::of_usize(n) * core::f64::consts::PI;
        row.iter_mut().for_each(|value| *value *= perimeter / (2.0 * n * n));
    }
    if is_curved {
        let mut along = 0.0;
        for Stretch { length, bump, .. } in stretches {
            if let Some(bump) = bump {
                let phase = core::f64::consts::TAU * (along + length / 2.0) / perimeter;
                bump.add(phase, core::f64::consts::PI * length / perimeter, &mut rows);
                let mean = bump.mean();
                moment[0] += mean[0] * length;
                moment[1] += mean[1] * length;
            }
            along += length;
        }
    }
    let rows: Vec<[T; 4]> = rows.into_iter().map(|row| row.map(T::of)).collect();
    let center = moment.map(|sum| T::of(sum / perimeter));
    if !rows.as_flattened().iter().chain(&center).all(|value| value.is_finite()) {
        return Err(ShapeError::TooLarge);
    }
    Ok((Efd { rows }, center))
}

/// Adds turn x cos(n phase), turn x sin(n phase) to row n; the angle goes up by one complex product per harmonic.
fn add_corner(corner: &Corner, rows: &mut [[f64; 4]]) {
    let (sin_1, cos_1) = Float::sin_cos(corner.phase);
    let (mut sin, mut cos) = (sin_1, cos_1);
    for row in rows {
        row[0] += corner.turn[0] * cos;
        row[1] += corner.turn[0] * sin;
        row[2] += corner.turn[1] * cos;
        row[3] += corner.turn[1] * sin;
        (sin, cos) = (sin * cos_1 + cos * sin_1, cos * cos_1 - sin * sin_1);
    }
}
