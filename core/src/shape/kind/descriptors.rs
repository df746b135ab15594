//! Elliptic Fourier descriptors as shapes, free or those of a bank's prototype.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::{PoseFreedom, Shape, check_length, check_numbers};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::curve::{Boundary, Piece};
use crate::shape::{Efd, Flattening, Outline, OutlineBasis, ShapeError};

/// Descriptors that are those of a bank's prototype.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prototype<T> {
    /// Index into the bank.
    pub index: usize,
    /// Its descriptors, or a mixture of the bank's that is nearest to it.
    pub efd: Efd<T>,
}

/// The numbers are a_1, b_1, c_1, d_1, a_2, ...
impl<T: Real> Shape<T> for Efd<T> {
    fn kind(&self) -> &'static str {
        "efd"
    }

    fn number_count(&self) -> usize {
        4 * self.harmonic_count()
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        numbers.extend_from_slice(self.rows().as_flattened());
    }

    fn number_names(&self) -> Vec<String> {
        (0..self.number_count()).map(|k| format!("efd[{}][{}]", k / 4, k % 4)).collect()
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        check_numbers(self.number_count(), numbers)?;
        self.rows_mut().as_flattened_mut().copy_from_slice(numbers);
        Ok(())
    }

    fn pose_freedom(&self) -> PoseFreedom {
        PoseFreedom::TRANSLATION
    }

    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        outline.start_ring();
        let first = outline.vertices.len();
        outline.vertices.resize(first + how.basis.vertex_count(), [T::zero(); 2]);
        how.basis.outline(self.rows(), &mut outline.vertices[first..])
    }

    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        check_length("gradient of the numbers", self.number_count(), grad_numbers.len())?;
        OutlineBasis::outline_vjp(how.basis, grad_vertices, grad_numbers.as_chunks_mut().0)
    }

    /// Cubics that have place and speed of the outline in common where they meet, and stray less than a ten-millionth of
    /// its size from it between.
    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        let zero = T::zero();
        if let Some(index) = self.rows().as_flattened().iter().position(|value| !value.is_finite()) {
            return Err(ShapeError::NotFinite { index });
        }
        let (mut size, mut fourth) = (zero, zero);
        for (n, &[a, b, c, d]) in (1..).zip(self.rows()) {
            let (amplitude, n) = (a.hypot(b).hypot(c.hypot(d)), T::of_usize(n));
            size += amplitude;
            fourth += amplitude * n * n * n * n;
        }
        // A cubic strays by the fourth derivative x step^4 / 384.
        let stray = size * T::of(384.0) * T::of(BOUNDARY_TOLERANCE).max(T::epsilon());
        let tau = T::of(core::f64::consts::TAU);
        let count = (tau * (fourth / stray).sqrt().sqrt()).to_count().clamp(8, MOST_CUBICS);
        let step = tau / T::of_usize(count);
        let nodes: Vec<_> = (0..count).map(|i| self.point_and_speed(step * T::of_usize(i))).collect();
        let ends = nodes.iter().skip(1).chain(nodes.first());
        let third = step / T::of(3.0);
        let cubics = nodes.iter().zip(ends).map(|(&[from, leaves], &[to, arrives])| {
            Piece::Cubic([from, from + leaves * third, to - arrives * third, to])
        });
        Ok(Boundary { pieces: cubics.collect(), ..Boundary::default() })
    }

    /// The descriptors themselves, around the origin.
    fn efd_of_ring(&self, ring: usize, harmonic_count: usize) -> Result<(Efd<T>, [T; 2]), ShapeError> {
        if ring > 0 {
            return Err(ShapeError::NoRing { ring, count: 1 });
        }
        Ok((self.resized(harmonic_count), [T::zero(); 2]))
    }
}

/// How far the cubics of a boundary stray from the outline of descriptors, per size of the outline.
const BOUNDARY_TOLERANCE: f64 = 1e-7;

/// Most cubics of a boundary.
const MOST_CUBICS: usize = 4096;

impl<T: Real> Efd<T> {
    /// The point of the outline at `phase` (radians, 2 pi once around), and its derivative.
    fn point_and_speed(&self, phase: T) -> [Vec2<T>; 2] {
        let step = Vec2::from_angle(phase);
        let mut turn = Vec2::new(T::one(), T::zero());
        let (mut point, mut speed) = (Vec2::default(), Vec2::default());
        for (n, &[a, b, c, d]) in (1..).zip(self.rows()) {
            turn = turn.turned(step);
            let Vec2 { x: cos, y: sin } = turn;
            point += Vec2::new(a * cos + b * sin, c * cos + d * sin);
            speed += Vec2::new(b * cos - a * sin, d * cos - c * sin) * T::of_usize(n);
        }
        [point, speed]
    }
}

/// The numbers are those of the descriptors; fits take them as given and move the pose.
impl<T: Real> Shape<T> for Prototype<T> {
    fn kind(&self) -> &'static str {
        "prototype"
    }

    fn number_count(&self) -> usize {
        self.efd.number_count()
    }

    fn numbers(&self, numbers: &mut Vec<T>) {
        self.efd.numbers(numbers);
    }

    fn number_names(&self) -> Vec<String> {
        self.efd.number_names()
    }

    fn set_numbers(&mut self, numbers: &[T]) -> Result<(), ShapeError> {
        self.efd.set_numbers(numbers)
    }

    fn pose_freedom(&self) -> PoseFreedom {
        PoseFreedom::ALL
    }

    fn is_given(&self) -> bool {
        true
    }

    fn flatten(&self, how: &Flattening<'_, T>, outline: &mut Outline<T>) -> Result<(), ShapeError> {
        self.efd.flatten(how, outline)
    }

    fn flatten_vjp(
        &self,
        how: &Flattening<'_, T>,
        grad_vertices: &[[T; 2]],
        grad_numbers: &mut [T],
    ) -> Result<(), ShapeError> {
        self.efd.flatten_vjp(how, grad_vertices, grad_numbers)
    }

    fn boundary(&self) -> Result<Boundary<T>, ShapeError> {
        self.efd.boundary()
    }

    fn efd_of_ring(&self, ring: usize, harmonic_count: usize) -> Result<(Efd<T>, [T; 2]), ShapeError> {
        self.efd.efd_of_ring(ring, harmonic_count)
    }
}
