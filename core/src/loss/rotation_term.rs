//! The price of a turn.

use super::scene_match::{Match, OrderCount};
use crate::real::Real;

/// How an angle difference D is priced, with k the symmetry order of the true shape by the reference's rule.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum RotationTerm {
    /// (1 - cos(k D))^2, the paper's text: right modulo 2 pi / k.
    #[default]
    Modulo,
    /// As [`Self::Modulo`], but each D is priced with the k of *every* object of all scenes with the same number of
    /// objects, and the mean is taken: what the reference implementation computes. The same where all k are equal.
    EveryOrder,
    /// (1 - k cos D)^2, the paper's formula as printed; not 0 at D = 0 unless k = 1.
    Printed,
}

impl RotationTerm {
    /// The price of a match in a scene of `objects` true objects, and its derivative with respect to D.
    pub(super) fn price<T: Real>(self, found: &Match<T>, objects: usize, orders: &[OrderCount]) -> [T; 2] {
        match self {
            Self::Modulo => modulo(found.order, found.turn),
            Self::EveryOrder => {
                let group = || orders.iter().filter(|entry| entry.objects == objects);
                let total = T::of_usize(group().map(|entry| entry.count).sum());
                group().fold([T::zero(); 2], |[price, slope], entry| {
                    let share = T::of_usize(entry.count) / total;
                    let [own_price, own_slope] = modulo(entry.order, found.turn);
                    [price + share * own_price, slope + share * own_slope]
                })
            }
            Self::Printed => {
                let (k, (sin, cos)) = (T::of_usize(found.order), found.turn.sin_cos());
                let root = T::one() - k * cos;
                [root * root, T::of(2.0) * root * k * sin]
            }
        }
    }
}

/// (1 - cos(k D))^2 and its derivative.
fn modulo<T: Real>(order: usize, turn: T) -> [T; 2] {
    let k = T::of_usize(order);
    let (sin, cos) = (k * turn).sin_cos();
    let root = T::one() - cos;
    [root * root, T::of(2.0) * root * k * sin]
}
