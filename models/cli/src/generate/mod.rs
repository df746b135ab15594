//! Random scenes: MDS-HR, and the like of Multi-dSprites, Tetrominoes and the suites of compositional scene representation.
//!
//! In: [`SceneSettings`], a bank, a seed and the number of the image. Out: a scene that depends on nothing else, so that
//! neither the order nor the number of threads changes a data set.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | [`SceneSettings`]: what scenes are drawn from |
//! | `sample` | one such scene, [`sample_scene`] |
//! | `tetrominoes` | three pieces beside one another, [`sample_tetrominoes`] |
//! | `openings` | squares and triangles with openings, [`sample_openings`] |
//! | `chance` | random numbers |
//!
//! *Source*: MDS-HR as described in the paper and read off its implementation: 1 to 4 visible objects out of 4 slots;
//! positions are the best of 8 draws by the smallest distance between two of them; the rotation is the direction of a
//! point in a square, which is not quite uniform in the angle. The random numbers are our own, not the benchmark's.

mod chance;
mod openings;
mod sample;
mod settings;
mod tetrominoes;

pub use openings::{OPENINGS_SIDE, sample_openings};
pub use sample::sample_scene;
pub use settings::{Range, SceneSettings};
pub use tetrominoes::{TETROMINO_SIDE, sample_tetrominoes};

#[cfg(test)]
mod tests;
