//! Training: what a model learns from, and the steps in which it does.
//!
//! | file | holds |
//! |---|---|
//! | `mode` | [`Mode`]: the paper's regimes |
//! | `judge` | [`Judge`]: the loss of a [`Batch`] in each mode |
//! | `schedule` | [`Schedule`]: the learning rate |
//! | `checkpoint` | [`Checkpoint`]: a model in a file |
//! | `trainer` | [`Trainer`]: steps of Adam, over threads |

mod checkpoint;
mod judge;
mod mode;
mod schedule;
#[cfg(test)]
mod tests;
mod trainer;

pub use checkpoint::Checkpoint;
pub use judge::{Batch, Judge, Judged};
pub use mode::{Mode, Source};
pub use schedule::Schedule;
pub use trainer::{Step, Trainer};
