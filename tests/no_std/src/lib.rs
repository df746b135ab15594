//! A program without std that renders, makes descriptors, matches, fits and traces.
//!
//! A library links only if everything below it does without std: std brings its own panic handler, and two of them are
//! a duplicate lang item. `check.sh` builds this crate both ways, links the clean one to `main.c` and runs it.
#![no_std]

extern crate alloc;

mod heap;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::matching::{CostMatrix, Hungarian};
use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, Efd, ImageSize, ImageView, Object, Pose, Scene};
use dvp_fit::picture::{Known, fit_picture};
use dvp_fit::{FitOptions, Fitter, fit_image};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

/// The precompiled core names it even where panics abort.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}

/// 0 if everything gave what it should, else the number of the step that did not.
#[unsafe(no_mangle)]
pub extern "C" fn dvp_no_std_proof() -> i32 {
    match proof() {
        Ok(()) => 0,
        Err(step) => step,
    }
}

fn proof() -> Result<(), i32> {
    // A rectangle twice as wide as high, as a contour.
    let contour = [[-1.0_f32, -0.5], [1.0, -0.5], [1.0, 0.5], [-1.0, 0.5]];
    let (efd, _) = Efd::from_contour(&contour, 16).map_err(|_| 1)?;
    if (efd.signed_area().abs() - 2.0).abs() > 0.05 {
        return Err(2);
    }

    let mut hungarian = Hungarian::default();
    let costs = CostMatrix::new(2, 2, &[1.0_f32, 0.0, 0.0, 1.0]).map_err(|_| 3)?;
    let assignment = hungarian.solve(costs).map_err(|_| 4)?;
    if assignment.total != 0.0 {
        return Err(5);
    }

    let size = ImageSize::new(64, 64).map_err(|_| 6)?;
    let mut scene = Scene::empty([0.1_f32, 0.2, 0.3]);
    let pose = Pose { translation: [0.5, 0.5], scale: 0.2, rotation: 0.3 };
    scene.objects.push(Object::of_efd(pose, [0.9, 0.5, 0.1], 1.0, efd, None));
    let basis = OutlineBasis::new(64, 16).map_err(|_| 7)?;
    let mut drawing = Drawing::default();
    scene.draw(&basis, &mut drawing).map_err(|_| 8)?;
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let mut image: Vec<f32> = vec![0.0; 3 * size.pixels()];
    renderer.render(&drawing, size, &mut Default::default(), &mut image).map_err(|_| 9)?;

    let view = ImageView::new(size, &image).map_err(|_| 10)?;
    let fit = fit_image(view, &FitOptions::default()).map_err(|_| 11)?;
    if fit.scene.objects.len() != 1 || fit.loss > 0.01 {
        return Err(12);
    }

    // A square with clear edges.
    let square = |i: usize| [i % 64, i / 64].iter().all(|place| (16..48).contains(place));
    for (i, value) in image.iter_mut().enumerate() {
        *value = if square(i % size.pixels()) { 1.0 } else { 0.0 };
    }
    let view = ImageView::new(size, &image).map_err(|_| 13)?;
    let traced = dvp_trace::trace(&view, &dvp_trace::Known::default()).map_err(|_| 14)?;
    if traced.scene.objects.len() != 1 {
        return Err(15);
    }

    // The same picture by the one entry that decides between the two fits; black is nothing, as in a transparent picture.
    let fitter = Fitter::new(FitOptions::default()).map_err(|_| 16)?;
    let known = Known::default().with_matte(Some([0.0; 3]));
    let fit = fit_picture(&fitter, view, &known, &mut Default::default()).map_err(|_| 17)?;
    if fit.scene.transparent && fit.scene.objects.len() == 1 { Ok(()) } else { Err(18) }
}
