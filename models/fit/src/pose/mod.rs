//! From edge samples to the pose of a known shape.
//!
//! In: the samples of one segment and the prototypes. Out: candidate poses, best first. `field` knows exact distances to
//! a unit outline, `gauss_newton` moves a pose until its outline lies at the sampled distances, `search` finds starts.

#[expect(clippy::needless_range_loop, reason = "indices of lanes and of a 4 x 4 matrix")]
pub(crate) mod equations;
#[expect(clippy::needless_range_loop, reason = "indices of lanes")]
pub(crate) mod field;
#[expect(clippy::needless_range_loop, reason = "indices of a 4 x 4 matrix")]
pub(crate) mod gauss_newton;
pub(crate) mod search;
#[cfg(test)]
mod tests;
