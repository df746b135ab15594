//! Generic code, compiled once; see [`dvp_core::instances`].

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::image::{CHANNELS, RGBA_CHANNELS};
use dvp_core::render::ContourRenderer;

use crate::adam::descent::Descent;
use crate::live::Live;
use crate::masks::outlines_of_labels;
use crate::opt_iter::OptIter;
use crate::opt_p::OptP;
use crate::prototypes::{Decoder, Form, Learned, Pool, members};
use crate::rand_opt_p::{RandOptP, random_scene};
use crate::refine::Refine;
use crate::scene_refine::SceneRefine;
use crate::{Fit, Fitter, Unexplained, scene_bits};

/// The methods of this crate, for one number type.
#[must_use]
pub fn of<T: Real>() -> Vec<*const ()> {
    vec![
        Fitter::<T>::new as *const (),
        Fitter::<T>::fit as *const (),
        Refine::fit::<T> as *const (),
        Descent::<T, ContourRenderer<T>>::new as *const (),
        Descent::<T, ContourRenderer<T>>::run as *const (),
        Descent::<T, ContourRenderer<T>>::paint as *const (),
        Live::fit::<T> as *const (),
        OptIter::fit::<T, ContourRenderer<T>> as *const (),
        OptP::fit::<T, ContourRenderer<T>> as *const (),
        RandOptP::fit::<T, ContourRenderer<T>> as *const (),
        random_scene::<T> as *const (),
        Fit::<T>::of_painted as *const (),
        Unexplained::<T>::of as *const (),
        scene_bits::<T> as *const (),
        Pool::<T>::new as *const (),
        Pool::<T>::add as *const (),
        Pool::<T>::add_whole as *const (),
        Pool::<T>::merge as *const (),
        Pool::<T>::bank as *const (),
        Form::new::<T> as *const (),
        Learned::bank::<T> as *const (),
        members::<T> as *const (),
        Decoder::<T>::whole_objects as *const (),
    ]
}

/// The methods of this crate for f32, compiled in it.
#[must_use]
#[inline(never)]
pub fn single() -> Vec<*const ()> {
    let mut all = of::<f32>();
    // Nobody asks for these in f64.
    all.extend([
        outlines_of_labels::<f32> as *const (),
        SceneRefine::fit_watched::<f32, CHANNELS> as *const (),
        SceneRefine::fit_watched::<f32, RGBA_CHANNELS> as *const (),
    ]);
    all
}
