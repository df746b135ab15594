//! Banks in another precision than they came in.

use clap::ValueEnum;
use dvp_core::Real;
use dvp_fit::Bank;

/// Numbers to compute with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, ValueEnum)]
pub enum Precision {
    /// 32 bits
    #[default]
    F32,
    /// 64 bits
    #[cfg(feature = "double")]
    F64,
}

pub(super) fn bank<A: Real, B: Real>(bank: &Bank<A>) -> Bank<B> {
    Bank { prototypes: bank.prototypes.iter().map(|(name, shape)| (name.clone(), shape.cast())).collect() }
}
