//! Shapes that pictures are commonly made of, tried where an outline looks like a union and no bank says which shapes to
//! expect.

use alloc::vec::Vec;

use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Efd, Real};

use crate::pose::search::Prototype;

/// Short axis over long axis of the ellipses and rectangles; shapes in between are fitted from the nearest.
const ELLIPSES: [f64; 4] = [1.0, 0.75, 0.5, 0.33];
const RECTANGLES: [f64; 3] = [1.0, 0.6, 0.35];
/// Harmonics of shapes with corners.
const HARMONICS: usize = 20;

/// Descriptors and outlines of the simple shapes.
#[derive(Clone, Debug, Default)]
pub(crate) struct SimpleShapes<T> {
    pub(crate) rows: Vec<Vec<[T; 4]>>,
    pub(crate) prototypes: Vec<Prototype<T>>,
}

impl<T: Real> SimpleShapes<T> {
    /// Prepares the shapes, once.
    pub(crate) fn prepare(&mut self) {
        if !self.prototypes.is_empty() {
            return;
        }
        let Ok(basis) = OutlineBasis::new(REFERENCE_VERTICES, HARMONICS) else { return };
        for efd in shapes::<T>() {
            if let Ok(Some(prototype)) = Prototype::new(&efd, &basis) {
                self.prototypes.push(prototype);
                self.rows.push(efd.rows().to_vec());
            }
        }
    }

    /// Bits of the choice among them.
    pub(crate) fn bits(&self) -> f64 {
        num_traits::Float::log2(f64::of_usize(self.rows.len().max(1)))
    }
}

fn shapes<T: Real>() -> Vec<Efd<T>> {
    let ellipse = |short: f64| Efd::new([[T::one(), T::zero(), T::zero(), T::of(-short)]].into());
    let (one, zero) = (T::one(), T::zero());
    let rectangle = |short: f64| {
        let y = T::of(short);
        Efd::from_contour(&[[one, -y], [one, y], [-one, y], [-one, -y]], HARMONICS).map(|(efd, _)| efd)
    };
    let height = T::of(1.5);
    let width = T::of(0.866);
    let triangle = Efd::from_contour(&[[one, zero], [one - height, width], [one - height, -width]], HARMONICS);
    let polygons = RECTANGLES.into_iter().filter_map(|short| rectangle(short).ok());
    ELLIPSES.into_iter().map(ellipse).chain(polygons).chain(triangle.ok().map(|(efd, _)| efd)).collect()
}
