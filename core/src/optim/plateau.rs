//! A learning rate that is cut when the loss stops falling.
//!
//! In: the loss after each step. Out: the rate for the next. `tests/golden/optim.rs` holds PyTorch's sequence.

/// Settings of [`Plateau`]; the defaults are the paper's, and PyTorch's for what it does not say. To change some: start
/// with the default, set fields.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PlateauSettings {
    /// The rate is multiplied by this, (0, 1).
    pub factor: f64,
    /// Losses without progress that are borne before a cut.
    pub patience: usize,
    /// Losses after a cut that are not counted against it.
    pub cooldown: usize,
    /// Progress is a loss below (1 - `threshold`) times the best.
    pub threshold: f64,
}

impl Default for PlateauSettings {
    fn default() -> Self {
        Self { factor: 0.5, patience: 10, cooldown: 10, threshold: 1e-4 }
    }
}

/// PyTorch's `ReduceLROnPlateau` in mode `min` with a relative threshold.
///
/// *Source*: the paper, training details (patience 10, cooldown 10, factor 0.5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plateau {
    settings: PlateauSettings,
    learning_rate: f64,
    best: f64,
    bad: usize,
    cooldown: usize,
}

impl Plateau {
    // PyTorch leaves the rate alone when a cut would change it by no more than its `eps`.
    const LEAST_CHANGE: f64 = 1e-8;

    /// A schedule that starts at `learning_rate`.
    #[must_use]
    pub fn new(settings: PlateauSettings, learning_rate: f64) -> Self {
        Self { settings, learning_rate, best: f64::INFINITY, bad: 0, cooldown: 0 }
    }

    /// The rate for the next step.
    #[must_use]
    pub fn learning_rate(&self) -> f64 {
        self.learning_rate
    }

    /// Takes note of a loss; cuts the rate if it was one too many without progress.
    pub fn observe(&mut self, loss: f64) {
        if loss < self.best * (1.0 - self.settings.threshold) {
            self.best = loss;
            self.bad = 0;
        } else {
            self.bad += 1;
        }
        if self.cooldown > 0 {
            self.cooldown -= 1;
            self.bad = 0;
        }
        if self.bad > self.settings.patience {
            let next = self.learning_rate * self.settings.factor;
            if self.learning_rate - next > Self::LEAST_CHANGE {
                self.learning_rate = next;
            }
            self.cooldown = self.settings.cooldown;
            self.bad = 0;
        }
    }
}
