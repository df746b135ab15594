//! Extents: of an image, and of an array of any rank. Checked once, where they are made.
//!
//! | file | holds |
//! |---|---|
//! | `image_size` | [`ImageSize`], width and height in pixels |
//! | `extents` | [`Dims`], the extents of an array, row-major |

mod extents;
mod image_size;

pub use extents::{Dims, DimsError, MAX_RANK};
pub use image_size::{ImageSize, MAX_PIXELS, SizeError};
