//! Scenes and edge profiles in another precision.

use super::{EdgeProfile, Object, Pose, Scene};
use crate::real::Real;

fn number<A: Real, B: Real>(value: A) -> B {
    B::of(value.as_f64())
}

impl<T: Real> Scene<T> {
    /// The same scene in another precision, every number rounded to the nearest.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Scene<U> {
        let object = |object: &Object<T>| {
            let Pose { translation, scale, rotation } = object.pose;
            Object {
                shape: object.shape.cast(),
                pose: Pose { translation: translation.map(number), scale: number(scale), rotation: number(rotation) },
                paint: object.paint.cast(),
                confidence: number(object.confidence),
            }
        };
        Scene {
            background: self.background.map(number),
            transparent: self.transparent,
            objects: self.objects.iter().map(object).collect(),
            edge: self.edge.cast(),
            compositing: self.compositing,
        }
    }
}

impl<T: Real> EdgeProfile<T> {
    /// The same profile in another precision, every number rounded to the nearest.
    #[must_use]
    pub fn cast<U: Real>(&self) -> EdgeProfile<U> {
        let Self { law, offset, sigma, cut } = *self;
        EdgeProfile { law, offset: number(offset), sigma: number(sigma), cut: number(cut) }
    }
}
