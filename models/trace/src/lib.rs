//! Pictures with clear edges to drawings: what people draw, found again.
//!
//! ```text
//! image -> partition -> boundary -> stroke | outline -> layers -> scene
//! ```
//!
//! | module | comes in | goes out |
//! |---|---|---|
//! | `tuning` | | every number that was chosen, with unit and reason |
//! | `ruler` | misfits, numbers with their covariance | bits: the one price of everything |
//! | `partition` | an image | faces of one color, and mixed pixels with the shares of two faces |
//! | `boundary` | a partition | where two faces meet, to a few thousandths of a pixel |
//! | `outline` | samples of a boundary | the shortest outline through them: circle, rectangle, path, ... |
//! | `stroke` | the boundary of a face | the lines of a pen that drew it |
//! | `layers` | faces and their boundaries | objects, back to front, whole where others hide them |
//!
//! Lengths are in pixels (the center of the pixel (row r, column c) is at (c + 0.5, r + 0.5), y down) and prices in bits,
//! unless a name says otherwise. Everything is computed in f64; images come in f32. The arithmetic of f64 is inherent with std and
//! that of `num_traits` without.
#![no_std]

extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod boundary;
pub mod layers;
pub mod outline;
pub mod partition;
pub mod ruler;
pub mod sample;
pub mod scene;
pub mod stroke;
pub mod tuning;

use dvp_core::{ImageView, Scene};

use crate::partition::{NoPartition, Partition};

/// The drawing that a picture is. `matte`: the color that transparent parts are shown on, if it has such.
///
/// # Errors
/// [`NoPartition`] if the picture is no drawing of flat colors with clear edges.
pub fn trace(image: &ImageView<'_, f32>, matte: Option<[f32; 3]>) -> Result<Scene<f32>, NoPartition> {
    let partition = Partition::of(image)?;
    let rings = boundary::rings(&partition);
    let layers = layers::layers(&partition, &rings, matte.map(|matte| matte.map(f64::from)));
    Ok(scene::scene(&layers, image.size(), matte.is_some()))
}
