//! The plane: the one vocabulary of points and directions that shapes, scenes and fits share.
//!
//! | file | holds |
//! |---|---|
//! | `vec2` | [`Vec2`], points and directions |
//!
//! Proved by `tests.rs` in this folder.

#[cfg(test)]
mod tests;
mod vec2;

pub use vec2::Vec2;
