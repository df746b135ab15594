//! Generic code, compiled once; see [`dvp_core::instances`].

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::tensor::Host;

use crate::model::Model;
use crate::scene_steps::image_tensor;
use crate::train::{Checkpoint, Trainer};

/// Models and their training on the host in f32, compiled in this crate.
#[must_use]
#[inline(never)]
pub fn single() -> Vec<*const ()> {
    vec![
        image_tensor::<f32, Host> as *const (),
        Model::<Host>::load::<f32> as *const (),
        Model::<Host>::features as *const (),
        Model::<Host>::latents as *const (),
        Model::<Host>::scenes::<f32> as *const (),
        Trainer::<Host, f32>::new as *const (),
        Trainer::<Host, f32>::set_weights as *const (),
        Trainer::<Host, f32>::step as *const (),
        Trainer::<Host, f32>::validate as *const (),
        Trainer::<Host, f32>::reconstruct as *const (),
        Trainer::<Host, f32>::features as *const (),
        Checkpoint::of::<Host, f32> as *const (),
        Checkpoint::resume::<Host, f32> as *const (),
        Checkpoint::weights::<Host> as *const (),
    ]
}
