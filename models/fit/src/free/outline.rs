//! An outline of unknown shape as center and harmonics in pixels: where it starts, what it looks like, how it becomes an object.

use alloc::vec::Vec;

use dvp_core::scene::Pose;
use dvp_core::{Efd, Real};

use super::basis::Basis;

/// Center (px) and rows (a, b, c, d) in px: x = cx + sum a cos + b sin, y = cy + sum c cos + d sin.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FreeOutline<T> {
    pub(crate) center: [T; 2],
    pub(crate) rows: Vec<[T; 4]>,
}

impl<T: Real> FreeOutline<T> {
    /// The same outline started on the long axis of its first harmonic, as the normal form of descriptors is: what is fitted from
    /// there is drawn with the vertices that it was fitted with.
    pub(crate) fn aligned(self) -> Self {
        let mut efd = Efd::new(self.rows);
        if let Ok(normal) = efd.normalize() {
            efd.shift(normal.phase);
        }
        Self { center: self.center, rows: efd.rows().to_vec() }
    }

    /// Its first `harmonics`.
    pub(crate) fn cut(&self, harmonics: usize) -> Self {
        Self { center: self.center, rows: self.rows[..harmonics].to_vec() }
    }

    /// Pose in scene units of `unit` px and descriptors of an outline that was aligned before it was fitted. Its vertices stay where they
    /// are: a second search for the long axis would move them, far where the first harmonic is nearly a circle. None if it has no size.
    pub(crate) fn posed(&self, unit: T) -> Option<(Pose<T>, Efd<T>)> {
        let &[a, _, c, _] = self.rows.first()?;
        let size = a.hypot(c);
        if !(size.is_normal() && self.rows.iter().flatten().all(|value| value.is_finite())) {
            return None;
        }
        let rotation = c.atan2(a);
        let mut efd = Efd::new(self.rows.clone());
        efd.rotate_scale(-rotation, size.recip());
        let translation = self.center.map(|v| v / unit);
        Some((Pose { translation, scale: size / unit, rotation }, efd))
    }

    pub(crate) fn write_vertices(&self, basis: &Basis<T>, vertex_count: usize, vertices: &mut Vec<[T; 2]>) {
        vertices.clear();
        for i in 0..vertex_count {
            let row = basis.row(i, self.rows.len());
            let [mut x, mut y] = self.center;
            for (pair, &[a, b, c, d]) in row[1..].chunks_exact(2).zip(&self.rows) {
                x += a * pair[0] + b * pair[1];
                y += c * pair[0] + d * pair[1];
            }
            vertices.push([x, y]);
        }
    }
}
