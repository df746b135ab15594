//! Banks and fits in another precision than they came in.

use clap::ValueEnum;
use dvp_core::Real;
use dvp_fit::Bank;
#[cfg(feature = "double")]
use dvp_fit::Fit;

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

#[cfg(feature = "double")]
fn number<A: Real, B: Real>(value: A) -> B {
    B::of(value.as_f64())
}

pub(super) fn bank<A: Real, B: Real>(bank: &Bank<A>) -> Bank<B> {
    Bank { prototypes: bank.prototypes.iter().map(|(name, shape)| (name.clone(), shape.cast())).collect() }
}

#[cfg(feature = "double")]
pub(super) fn fit<A: Real, B: Real>(fit: &Fit<A>) -> Fit<B> {
    Fit {
        scene: fit.scene.cast(),
        loss: number(fit.loss),
        steps: fit.steps,
        stop: fit.stop,
        covariance: fit.covariance.iter().map(|block| block.map(number)).collect(),
        ambiguity: fit.ambiguity.clone(),
        unexplained: fit.unexplained,
        marginal_gain: fit.marginal_gain.clone(),
        noise: number(fit.noise),
        bits: fit.bits,
    }
}
