//! Scenes and fits in another precision than they came in.

use clap::ValueEnum;
use dvp_core::render::EdgeProfile;
use dvp_core::{Object, Pose, Real, Scene};
use dvp_fit::Bank;
#[cfg(feature = "lab")]
use dvp_fit::Fit;

/// Numbers to compute with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, ValueEnum)]
pub enum Precision {
    /// 32 bits
    #[default]
    F32,
    /// 64 bits
    #[cfg(feature = "lab")]
    F64,
}

fn number<A: Real, B: Real>(value: A) -> B {
    B::of(value.as_f64())
}

pub(super) fn bank<A: Real, B: Real>(bank: &Bank<A>) -> Bank<B> {
    Bank { prototypes: bank.prototypes.iter().map(|(name, shape)| (name.clone(), shape.cast())).collect() }
}

/// A scene in another precision.
#[must_use]
pub fn scene<A: Real, B: Real>(scene: &Scene<A>) -> Scene<B> {
    let object = |object: &Object<A>| {
        let Pose { translation, scale, rotation } = object.pose;
        Object {
            shape: object.shape.cast(),
            pose: Pose { translation: translation.map(number), scale: number(scale), rotation: number(rotation) },
            paint: object.color().map(number).into(),
            confidence: number(object.confidence),
        }
    };
    let EdgeProfile { law, offset, sigma, cut } = scene.edge;
    Scene {
        background: scene.background.map(number),
        transparent: scene.transparent,
        objects: scene.objects.iter().map(object).collect(),
        edge: EdgeProfile { law, offset: number(offset), sigma: number(sigma), cut: number(cut) },
        compositing: scene.compositing,
    }
}

#[cfg(feature = "lab")]
pub(super) fn fit<A: Real, B: Real>(fit: &Fit<A>) -> Fit<B> {
    Fit {
        scene: scene(&fit.scene),
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
