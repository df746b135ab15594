//! The learning rate of each step.

use core::f64::consts::PI;

/// A learning rate that rises over a warm-up and then stays, or falls to 0 along half a cosine.
///
/// *Source*: the fall: Loshchilov and Hutter: SGDR: Stochastic Gradient Descent with Warm Restarts (2017), without
/// restarts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// The largest rate.
    pub learning_rate: f64,
    /// Steps over which it rises in a straight line.
    pub warm_up: u64,
    /// The step at which it has fallen to 0; it does not fall if there is none.
    pub end: Option<u64>,
}

impl Schedule {
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
        assert_eq!([1, 2, 4].map(|step| schedule.rate(step)), [0.5, 1.0, 2.0]);
        assert!((schedule.rate(9) - 1.0).abs() < 1e-12 && schedule.rate(14) < 1e-12 && schedule.rate(20) < 1e-12);
        let constant = Schedule { warm_up: 0, end: None, ..schedule };
        assert_eq!([1, 1000].map(|step| constant.rate(step)), [2.0; 2]);
    }
}
