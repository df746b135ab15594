//! Training: what a model learns from, and the steps in which it does.
//!
//! | file | holds |
//! |---|---|
//! | `mode` | [`Mode`]: the paper's regimes |
//! | `batch` | [`Batch`]: images, scenes, [`Features`] |
//! | `judge` | [`Judge`]: the loss of a batch in each mode |
//! | `schedule` | [`Schedule`]: the learning rate |
//! | `checkpoint` | [`Checkpoint`]: a model in a file |
//! | `weights_file` | [`WeightsFile`]: a network in a file |
//! | `gradients` | gradients over all weights |
//! | `decomposer`, `decomposer_file` | [`DecomposerTrainer`], [`DecomposerFile`]: the same for networks without shapes |
//! | `looker`, `look_file`, `shake` | [`LookTrainer`], [`LookFile`]: the same for second looks; what they learn from |
//! | `trainer` | [`Trainer`]: steps of Adam, over threads |

mod batch;
mod checkpoint;
mod decomposer;
mod decomposer_file;
mod gradients;
#[cfg(test)]
mod half_tests;
mod judge;
mod look_file;
#[cfg(test)]
mod look_tests;
mod looker;
mod mode;
mod schedule;
mod shake;
#[cfg(test)]
mod tests;
mod trainer;
mod weights_file;

pub use batch::{Batch, Features};
pub use checkpoint::Checkpoint;
pub use decomposer::{DecomposerStep, DecomposerTrainer};
pub use decomposer_file::DecomposerFile;
pub use judge::{Judge, Judged};
pub use look_file::LookFile;
pub use looker::{LookStep, LookTrainer};
pub use mode::{Mode, Source};
pub use schedule::Schedule;
pub use trainer::{Step, Trainer};
pub use weights_file::WeightsFile;
