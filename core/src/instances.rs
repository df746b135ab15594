//! Generic code, compiled once.
//!
//! A function that is generic over [`Real`] is compiled by the crate that says which type it means; renderers and losses
//! would so be compiled anew in the command, in every test and in every bench. A function marked `#[inline(never)]` is
//! compiled by the first crate that names it with its types, and all crates that build on that one share the code. This
//! module names those of this crate: [`single`] for f32, here; whoever computes in f64 calls [`of`] once in a crate that
//! the others build on (`dvp-double`).
//!
//! Only steps that work on a whole outline, image or scene are marked: what they call is inlined into them as ever. None of
//! the functions named here is called.

use alloc::vec;
use alloc::vec::Vec;

use crate::image::{CHANNELS, RGBA_CHANNELS, check};
use crate::loss::{Loss, SceneLoss, Ssim};
use crate::matching::Hungarian;
use crate::metric::{Ownership, Tally};
use crate::real::Real;
use crate::render::{ContourDistance, CoverageModel, ExactArea, HardMask, PixelLoss, Renderer, TileRenderer};
use crate::scene::Scene;
use crate::shape::{Efd, OutlineBasis, mdshr_bank};

/// The steps of this crate, for one number type.
#[must_use]
pub fn of<T: Real>() -> Vec<*const ()> {
    let mut all = vec![
        check::<T> as *const (),
        OutlineBasis::<T>::new as *const (),
        OutlineBasis::<T>::outline as *const (),
        OutlineBasis::<T>::outline_vjp as *const (),
        <PixelLoss as Loss<T>>::value as *const (),
        <PixelLoss as Loss<T>>::vjp as *const (),
        Efd::<T>::from_contour as *const (),
        Efd::<T>::normalize as *const (),
        Efd::<T>::symmetry as *const (),
        mdshr_bank::<T> as *const (),
        Scene::<T>::draw_flattened as *const (),
        Scene::<T>::pull_back_flattened as *const (),
        Ssim::<T>::similarity as *const (),
        <Ssim<T> as Loss<T>>::vjp as *const (),
        <SceneLoss<T> as Loss<T>>::value as *const (),
        <SceneLoss<T> as Loss<T>>::vjp as *const (),
        Hungarian::<T>::solve as *const (),
        Tally::<T>::add as *const (),
    ];
    all.extend(of_renderer::<T, ContourDistance<T>>());
    all.extend(of_renderer::<T, ExactArea>());
    all.extend(of_renderer::<T, HardMask>());
    #[cfg(feature = "triangles")]
    all.extend(of_renderer::<T, crate::render::SoftTriangles<T>>());
    all
}

fn of_renderer<T: Real, C: CoverageModel<T>>() -> [*const (); 11] {
    [
        <TileRenderer<C> as Renderer<T>>::render as *const (),
        <TileRenderer<C> as Renderer<T>>::render_vjp as *const (),
        <TileRenderer<C> as Renderer<T>>::render_rgba as *const (),
        <TileRenderer<C> as Renderer<T>>::render_rgba_vjp as *const (),
        <TileRenderer<C> as Renderer<T>>::loss::<CHANNELS> as *const (),
        <TileRenderer<C> as Renderer<T>>::loss::<RGBA_CHANNELS> as *const (),
        <TileRenderer<C> as Renderer<T>>::loss_and_grad::<CHANNELS> as *const (),
        <TileRenderer<C> as Renderer<T>>::loss_and_grad::<RGBA_CHANNELS> as *const (),
        TileRenderer::<C>::object_coverage::<T> as *const (),
        TileRenderer::<C>::visit_each::<T> as *const (),
        Ownership::fill_drawing::<T, C> as *const (),
    ]
}

/// The steps of this crate for f32, compiled in it.
#[must_use]
#[inline(never)]
pub fn single() -> Vec<*const ()> {
    of::<f32>()
}
