//! The learning rate of each step.

use core::f64::consts::PI;

/// A learning rate that rises over a warm-up and then stays, or falls to 0 along half a cosine.
///
/// *Source*: the fall: Loshchilov and Hutter: SGDR: Stochastic Gradient Descent with Warm Restarts (2017), without
/// restarts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Schedule {
    /// The largest rate.
    pub learning_rate: f64,
    /// Steps over which it rises in a straight line.
    pub warm_up: u64,
    /// The step at which it has fallen to 0; it does not fall if there is none.
    pub end: Option<u64>,
}

impl Schedule {
    /// The same rate at every step.
    #[must_use]
    pub fn constant(learning_rate: f64) -> Self {
        Self { learning_rate, warm_up: 0, end: None }
    }

    /// The same with [`Self::warm_up`].
    #[must_use]
    pub fn with_warm_up(self, warm_up: u64) -> Self {
        Self { warm_up, ..self }
    }

    /// The same with [`Self::end`].
    #[must_use]
    pub fn with_end(self, end: Option<u64>) -> Self {
        Self { end, ..self }
    }

    /// The rate of step `step`, from 1.
    #[must_use]
    pub fn rate(&self, step: u64) -> f64 {
        if step <= self.warm_up {
            return self.learning_rate * step as f64 / self.warm_up as f64;
        }
        let Some(end) = self.end else { return self.learning_rate };
        let share = (step - self.warm_up) as f64 / end.saturating_sub(self.warm_up).max(1) as f64;
        self.learning_rate * 0.5 * (1.0 + (PI * share.min(1.0)).cos())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rises_and_falls() {
        let schedule = Schedule { learning_rate: 2.0, warm_up: 4, end: Some(14) };
        for (step, rate) in [(1, 0.5), (2, 1.0), (4, 2.0), (9, 1.0), (14, 0.0), (20, 0.0)] {
            assert!((schedule.rate(step) - rate).abs() < 1e-12, "step {step}");
        }
        let constant = Schedule { warm_up: 0, end: None, ..schedule };
        assert!([1, 1000].iter().all(|&step| (constant.rate(step) - 2.0).abs() < 1e-12));
    }
}
