//! The plane: the one vocabulary of points, distances and maps that shapes, scenes and fits share.
//!
//! | file | holds |
//! |---|---|
//! | `vec2` | [`Vec2`], points and directions |
//! | `bounds` | [`Bounds`], upright boxes |
//! | `px` | [`Px`], pixels told apart from scene units |
//! | `line_segment` | [`LineSegment`], and the point of it that is nearest to a given point |
//! | `similarity` | [`Similarity`]: turns, growth, shifts, reflections |
//! | `hull` | [`convex_hull`] |
//! | `disjoint` | [`DisjointSets`]: union-find |
//!
//! Proved by `tests.rs` in this folder and `tests/property/geometry.rs`.

mod bounds;
mod disjoint;
mod hull;
mod line_segment;
mod px;
mod similarity;
#[cfg(test)]
mod tests;
mod vec2;

pub use bounds::Bounds;
pub use disjoint::DisjointSets;
pub use hull::{convex_hull, push_turning};
pub use line_segment::{LineSegment, Nearest};
pub use px::Px;
pub use similarity::Similarity;
pub use vec2::Vec2;
