//! Random scenes: MDS-HR and data like Multi-dSprites.
//!
//! In: [`SceneSettings`], a bank, a seed and the number of the image. Out: a scene that depends on nothing else, so that
//! neither the order nor the number of threads changes a data set.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | [`SceneSettings`]: what scenes are drawn from |
//! | `sample` | one such scene, [`sample_scene`] |
//!
//! *Source*: MDS-HR as described in the paper and read off its implementation: 1 to 4 visible objects out of 4 slots;
//! positions are the best of 8 draws by the smallest distance between two of them; the rotation is the direction of a
//! point in a square, which is not quite uniform in the angle. The random numbers are our own, not the benchmark's.

mod sample;
mod settings;

pub use sample::sample_scene;
pub use settings::{Range, SceneSettings};

#[cfg(test)]
mod tests;
