//! The f64 code of core and fit, compiled once.
//!
//! The command finds scenes in f32; f64 is for its laboratory and for the tests of gradients. They link this crate
//! (`use dvp_double as _;`), so that each of them need not compile renderers and fits anew, and a first build of the command
//! goes without. How that works: [`dvp_core::instances`].

extern crate alloc;

use alloc::vec::Vec;

/// The steps of core and the methods of fit for f64.
#[must_use]
#[inline(never)]
pub fn double() -> Vec<*const ()> {
    let mut all = dvp_core::instances::of::<f64>();
    all.extend(dvp_fit::instances::of::<f64>());
    all
}
