//! Prototypes: the few shapes that many fitted objects have.
//!
//! In: fits without a bank. Out: a [`Bank`](crate::Bank), with the evidence for its size. Nothing is learned by descent: objects are
//! fitted once, and the shapes are read off.
//!
//! ```text
//! fits -> members -> forms -> distances -> k-medoids, k by silhouette -> means -> bank -> posed members -> better bank
//! ```
//!
//! | file | comes in | goes out |
//! |---|---|---|
//! | `member` | a fit | the objects that show their whole shape, [`members`] |
//! | `form` | an outline | a [`Form`] without pose and start; distances that are the minimum over turns, starts, mirror images |
//! | `medoids` | distances | [`k_medoids`], [`silhouette`] |
//! | `learn` | members | [`Learned`]: how many shapes there are, and each as the mean of its members |
//! | `decode` | a picture of few colors, a bank | the scene whose objects have these shapes, pixel by pixel, [`Decoder`] |
//! | `pool` | images, fits with the bank | the bank from all edge samples of all members at once, [`Pool`] |
//!
//! `tests/property/prototypes.rs` proves the invariances of the distance, `tests/golden/prototypes.rs` that the shapes of
//! MDS-HR are found, and no more.
//!
//! *Source*: the reference system repeats ten rounds of 200 gradient steps and k-medoids on masks under 360 rotations.
//! Differences: descriptors instead of masks, all turns and starts instead of 360, means
//! instead of medoids, one round; and the last touch is laid by least squares on the edges of all members at once.

mod decode;
mod form;
mod learn;
mod medoids;
mod member;
mod pool;
#[cfg(test)]
mod tests;

pub use decode::{Decoded, Decoder, Undecoded, WholeObject};
pub use form::{Alignment, Form, Freedom};
pub use learn::{LearnError, Learned, Prototype, PrototypeOptions, learn};
pub use medoids::{DistanceMatrix, Partition, Silhouette, k_medoids, silhouette};
pub use member::{MIN_DIAMETER_PX, MIN_DRAWN_DIAMETER_PX, Member, is_drawing, members};
pub use pool::Pool;

/// Harmonics of a form: as many as an outline of 64 vertices carries.
const MAX_HARMONICS: usize = 31;
