//! Descriptors of rings of pieces, exactly.

use super::{Boundary, Piece, sweep};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::bump::Bump;
use crate::shape::fourier::{Stretch, descriptors};
use crate::shape::{Efd, ShapeError};

impl<T: Real> Boundary<T> {
    /// The first `harmonic_count` descriptors of a ring, and its center: the mean position along the ring, which the
    /// descriptors leave out.
    ///
    /// The parameter starts where the first piece does, and every piece takes a share of it equal to its share of the perimeter:
    /// lines and arcs at constant speed, cubics in proportion to their own parameter. A whole ellipse takes its angle, so
    /// that it has one harmonic. The integrals are closed forms, computed in f64 whatever `T`; nothing is sampled. Time:
    /// pieces x harmonics.
    ///
    /// # Errors
    /// [`ShapeError::NoRing`], others as [`Efd::from_contour`].
    pub fn efd(&self, ring: usize, harmonic_count: usize) -> Result<(Efd<T>, [T; 2]), ShapeError> {
        let count = self.rings().count();
        let pieces = self.rings().nth(ring).ok_or(ShapeError::NoRing { ring, count })?;
        if let [Piece::Ellipse { center, axes: [cos, sin] }] = *pieces {
            let mut efd = Efd::zeros(harmonic_count);
            if let Some(first) = efd.rows_mut().first_mut() {
                *first = [cos.x, sin.x, cos.y, sin.y];
            }
            return Ok((efd, center.to_array()));
        }
        descriptors(pieces.iter().map(stretch), harmonic_count)
    }
}

fn stretch<T: Real>(piece: &Piece<T>) -> Stretch {
    let wide = |point: Vec2<T>| point.to_array().map(Real::as_f64);
    let (start, end) = (wide(piece.from()), wide(piece.to()));
    let step = [end[0] - start[0], end[1] - start[1]];
    let bump = match *piece {
        Piece::Arc { bulge, .. } => Some(Bump::of_arc(step, sweep(bulge.as_f64()))),
        Piece::Cubic(points) => Some(Bump::of_cubic(points.map(wide))),
        Piece::Line { .. } | Piece::Ellipse { .. } => None,
    };
    Stretch { start, step, length: piece.cast::<f64>().length(), bump }
}
