//! Starts near a truth, as optimizers are compared from.

use dvp_core::Scene;
use rand::{Rng, RngExt};

/// The truth with t + N(0, 0.02), s (1 + N(0, 0.1)), angle + N(0, 0.2), colors and background + N(0, 0.05).
pub fn perturbed(truth: &Scene<f32>, rng: &mut impl Rng) -> Scene<f32> {
    // Box and Muller's transform of two uniform numbers.
    let mut normal = |sigma: f32| {
        let (u, v): (f32, f32) = (1.0 - rng.random::<f32>(), rng.random());
        sigma * (-2.0 * u.ln()).sqrt() * (core::f32::consts::TAU * v).cos()
    };
    let mut scene = truth.clone();
    for object in &mut scene.objects {
        object.pose.translation.iter_mut().for_each(|value| *value += normal(0.02));
        object.pose.scale *= 1.0 + normal(0.1);
        object.pose.rotation += normal(0.2);
        object.paint.colors_mut().flatten().for_each(|value| *value += normal(0.05));
    }
    scene.background.iter_mut().for_each(|value| *value += normal(0.05));
    scene
}
