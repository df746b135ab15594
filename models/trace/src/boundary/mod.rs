//! Where two faces meet, to a few hundredths of a pixel or better.
//!
//! `profile` tells whether edges are clear, `ring` walks around faces along the cracks between pixels, `window` reads at every crack where the
//! boundary passes, `uneven` how far that is off, and `hard` where no pixel is mixed.

mod hard;
mod profile;
mod ring;
mod uneven;
mod window;

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::Crack;

use crate::partition::Partition;
use crate::sample::Sample;
use crate::tuning;

pub use profile::{blur, stained, wobble};

/// A step along the boundary of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The edge between two pixels.
    pub crack: Crack,
    /// Face on the right hand.
    pub inner: u32,
    /// Face on the left hand; [`OUTSIDE`](crate::partition::OUTSIDE) beyond the border.
    pub other: u32,
    /// What the window across the crack tells.
    pub sample: Option<Sample>,
    /// Whether the boundary leads across it on the whole, there: it is of a side too short to tell where that goes on.
    pub is_across: bool,
}

/// A closed boundary of a face, with the face on its right hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// Crack after crack.
    pub steps: Vec<Step>,
    /// Signed area in pixels: positive around a face, negative around a hole of it.
    pub area: f64,
}

impl Ring {
    /// Where a crack has its middle, pixels.
    #[must_use]
    pub fn middle(crack: Crack) -> Vec2<f64> {
        let [from, to] = [crack.start, crack.end()].map(|[x, y]| Vec2::new(x as f64, y as f64));
        from.lerp(to, 0.5)
    }
}

/// The boundaries of every face, its outer one first.
#[must_use]
pub fn rings(partition: &Partition) -> Vec<Vec<Ring>> {
    let mut rings = ring::walk_faces(partition);
    for ring in rings.iter_mut().flatten() {
        read(partition, ring);
    }
    let uneven = uneven::unevenness(partition, &rings);
    if uneven > tuning::RENDERER_SIGMA {
        for sample in
            rings.iter_mut().flatten().flat_map(|ring| &mut ring.steps).filter_map(|step| step.sample.as_mut())
        {
            (sample.sigma, sample.is_exact) = (sample.sigma.max(uneven), false);
        }
    }
    rings.iter_mut().flatten().for_each(|ring| hard::read_upright(partition, ring));
    rings
}

/// The rings around the pixels of some faces, with samples where they border on others. `inside` is asked for pixels within `bounds` (first
/// column and row, and those after the last).
#[must_use]
pub fn walk_mask(partition: &Partition, inside: impl Fn([usize; 2]) -> bool, bounds: [usize; 4]) -> Vec<Ring> {
    let mut rings = ring::walk_mask(partition, inside, bounds);
    for ring in &mut rings {
        read(partition, ring);
        hard::read_upright(partition, ring);
    }
    rings
}

fn read(partition: &Partition, ring: &mut Ring) {
    window::read(partition, ring);
    if partition.is_hard {
        for sample in ring.steps.iter_mut().filter_map(|step| step.sample.as_mut()) {
            sample.sigma = sample.sigma.max(tuning::CRACK_SIGMA);
        }
    }
}
