//! Levels of which noise was cut off at black or white.

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Steps of the midpoint rule on either side, out to six standard deviations.
const STEPS: i32 = 64;
/// Standard deviations of noise beyond which nothing is cut off.
const REACH: f64 = 4.0;
/// Halvings of the interval that a level is looked for in: to a millionth of the noise.
const HALVINGS: usize = 22;

/// The level that noise of a standard deviation makes pixels of with some mean, between 0 (black) and 1 (white), where it is cut off.
pub(super) fn level(mean: f64, noise: f64) -> f64 {
    if mean > REACH * noise && mean < 1.0 - REACH * noise {
        return mean;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if clipped_mean(middle, noise) < mean { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Mean of normal values around a level, cut off at 0 and 1: by the midpoint rule.
fn clipped_mean(level: f64, noise: f64) -> f64 {
    let [mut sum, mut weights] = [0.0; 2];
    for k in -STEPS..STEPS {
        let sigmas = (f64::from(k) + 0.5) * (6.0 / f64::from(STEPS));
        let weight = (-0.5 * sigmas * sigmas).exp();
        sum += weight * (level + noise * sigmas).clamp(0.0, 1.0);
        weights += weight;
    }
    sum / weights
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Mean of a normal distribution cut off at 0 and 1, in closed form.
    fn closed(level: f64, noise: f64) -> f64 {
        // What cutting off at so many standard deviations below the mean adds to it.
        let shortfall = |sigmas: f64| {
            (-0.5 * sigmas * sigmas).exp() / core::f64::consts::TAU.sqrt()
                - sigmas * 0.5 * libm::erfc(sigmas * core::f64::consts::FRAC_1_SQRT_2)
        };
        level + noise * (shortfall(level / noise) - shortfall((1.0 - level) / noise))
    }

    proptest! {
        #[test]
        fn levels_come_back(at in 0.0f64..=1.0, noise in 0.005f64..0.2) {
            let mean = closed(at, noise);
            // The rule has ten steps in a standard deviation, in one of which the cut lies: 1/10 squared, over 8.
            prop_assert!((level(mean, noise) - at).abs() < 2e-3 * noise, "{} instead of {at}", level(mean, noise));
        }
    }
}
