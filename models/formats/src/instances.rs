//! Generic code, compiled once; see [`dvp_core::instances`].

use alloc::vec;
use alloc::vec::Vec;

use crate::format::{Picture, interleaved_bytes, interleaved_rgba_bytes};

/// What passes over every pixel of a picture, in f32, compiled in this crate: who reads and writes files may be compiled small.
#[must_use]
#[inline(never)]
pub fn single() -> Vec<*const ()> {
    vec![
        Picture::<f32>::opaque::<u8> as *const (),
        Picture::<f32>::opaque::<u16> as *const (),
        Picture::<f32>::opaque::<f32> as *const (),
        Picture::<f32>::translucent::<u8> as *const (),
        Picture::<f32>::translucent::<u16> as *const (),
        Picture::<f32>::translucent::<f32> as *const (),
        interleaved_bytes::<f32> as *const (),
        interleaved_rgba_bytes::<f32> as *const (),
    ]
}
