//! Where a number may go, and what saying so costs.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::classes::Class;
use super::grid::{Grid, LEVELS};
use super::numbers::{Kind, SIGMA};
use crate::ruler::Ruler;
use crate::tuning;

/// What is drawn moves by no more than this, pixels: twice its doubt. The offset of a renderer's lattice is at most 1.73 times its
/// standard deviation.
pub(super) const LIMIT: f64 = 2.0 * SIGMA;

/// A place and the bits of saying that a number is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) value: f64,
    pub(super) bits: f64,
}

/// The places of a drawing.
pub(super) struct Places<'a> {
    /// Classes of several numbers by kind, on the grid where that is likely.
    shared: [Vec<Class>; 3],
    grid: Option<Grid>,
    pub(super) ruler: &'a Ruler,
}

impl<'a> Places<'a> {
    pub(super) fn new(classes: &[Vec<Class>; 3], grid: Option<Grid>, ruler: &'a Ruler) -> Self {
        let shared = |classes: &Vec<Class>| {
            let place =
                |class: &Class| Class { value: grid.map_or(class.value, |grid| grid.snap(class, ruler)), ..*class };
            let count = classes.iter().map(|class| class.count).sum();
            classes.iter().filter(|class| is_sure(class, count, ruler)).map(place).collect()
        };
        Self { shared: [0, 1, 2].map(|kind: usize| shared(&classes[kind])), grid, ruler }
    }

    /// Whether no number can move.
    pub(super) fn are_none(&self) -> bool {
        self.grid.is_none() && self.shared.iter().all(Vec::is_empty)
    }

    /// Bits of a number that is nowhere in particular.
    pub(super) fn free_bits(&self) -> f64 {
        self.ruler.number(SIGMA) + self.grid.map_or(0.0, |grid| grid.bits[LEVELS])
    }

    /// A value as it is, and the places within `reach` of it.
    pub(super) fn near(&self, kind: Kind, value: f64, reach: f64) -> Vec<Place> {
        let free = self.free_bits();
        let mut places = Vec::from([Place { value, bits: free }]);
        let mut push = |place: Place| {
            // What is there already is cheaper.
            if (place.value - value).abs() <= reach
                && places.iter().skip(1).all(|other| (other.value - place.value).abs() > 1e-6)
            {
                places.push(place);
            }
        };
        if let Some(grid) = self.grid {
            for level in (0..LEVELS).filter(|&level| grid.bits[level].is_finite()) {
                push(Place { value: grid.nearest(level, value), bits: grid.bits[level] });
            }
        }
        let shared = &self.shared[kind as usize];
        let nearest = shared.iter().min_by(|a, b| (a.value - value).abs().total_cmp(&(b.value - value).abs()));
        if let Some(class) = nearest {
            // The class costs a number, each of its members which one it is.
            push(Place { value: class.value, bits: free / class.count as f64 + (shared.len() as f64).log2() });
        }
        places
    }

    /// The place of fewest bits, misfit among them, that a value of some doubt may move to.
    pub(super) fn cheapest(&self, kind: Kind, value: f64, limit: f64) -> f64 {
        let sigma = 0.5 * limit;
        let bits = |place: &Place| place.bits + self.ruler.misfit(((place.value - value) / sigma).powi(2));
        let places = self.near(kind, value, limit);
        places.iter().min_by(|a, b| bits(a).total_cmp(&bits(b))).map_or(value, |place| place.value)
    }
}

/// Whether a class of so many numbers is no coincidence: each of its members but one saves a number, which they are has to be told.
fn is_sure(class: &Class, count: usize, ruler: &Ruler) -> bool {
    let told: f64 = (0..class.count).map(|k| ((count - k) as f64 / (k + 1) as f64).log2()).sum();
    (class.count as f64 - 1.0) * ruler.number(class.sigma) > told + tuning::TIES_BITS
}
