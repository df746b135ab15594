//! Things of a drawing that was read under noise, or a blur, which the noise or a dead pixel of a camera explains as well.
//!
//! What is averaged keeps spots and stripes of it, and some become things. Such a thing brings the drawing nearer to the picture by less than a thing costs
//! beside its outline.

#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::LN_2;

use dvp_core::render::ContourRenderer;
use dvp_core::{Image, ImageView, Scene};
use dvp_trace::Traced;
use dvp_trace::noise::{ROUNDED, noise_level};
use dvp_trace::tuning::{PIXEL_BITS, THING_BITS};

use crate::FitError;
use crate::colors::repeated;
use crate::marginal_gain::squared_errors;
use crate::paint::Canvas;

/// Things that pay so many times what they cost by a first count, in whole pixels, are not asked again.
const CLEARLY: f64 = 3.0;

/// Leaves out of a drawing, painted with the edges of `scene`, what does not pay for itself. A pixel that is told as it is costs no more than that: a
/// camera's dead ones are no things.
#[inline(never)]
pub(super) fn leave_out(
    traced: &mut Traced,
    scene: &Scene<f32>,
    image: &ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<(), FitError> {
    // Squares to bits, at the noise of the picture: of textures more was averaged away, which they show.
    let noise = f64::from(noise_level(image, &mut Vec::new())).min(traced.noise).max(ROUNDED);
    let bits = 0.5 / (noise * noise * LN_2 * repeated(image));
    let (painted, drawing) = canvas.paint(scene, image.size())?;
    let before = painted.clone();
    let gains = squared_errors(&drawing, image, scene.compositing);
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let mut pixels = vec![0.0; gains.len()];
    renderer.visit_coverage(&drawing, image.size(), &mut Default::default(), |object, _, coverage| {
        pixels[object] += coverage.iter().map(|&share| f64::from(share)).sum::<f64>();
    })?;
    let most = gains.into_iter().zip(pixels).map(|(gain, pixels)| (bits * gain).min(PIXEL_BITS * pixels));
    let is_asked: Vec<bool> = most.map(|most| most < CLEARLY * THING_BITS).collect();
    if !is_asked.contains(&true) {
        return Ok(());
    }
    let rest = scene.objects.iter().zip(&is_asked).filter(|(_, is_asked)| !**is_asked);
    let rest = Scene { objects: rest.map(|(object, _)| object.clone()).collect(), ..scene.clone() };
    let (after, _) = canvas.paint(&rest, image.size())?;
    let missed = |painted: &Image<f32>, i: usize| {
        let (shown, seen) = (painted.view().pixel(i), image.pixel(i));
        let off = [0, 1, 2].map(|c| f64::from(shown[c] - seen[c]));
        (bits * off.iter().map(|off| off * off).sum::<f64>()).min(PIXEL_BITS)
    };
    let mut saved = vec![0.0; is_asked.len()];
    renderer.visit_coverage(&drawing, image.size(), &mut Default::default(), |object, first, coverage| {
        if is_asked[object] {
            let covered = (first..).zip(coverage).filter(|(_, coverage)| **coverage > 0.0);
            saved[object] += covered.map(|(i, _)| missed(after, i) - missed(&before, i)).sum::<f64>();
        }
    })?;
    let is_left: Vec<bool> =
        is_asked.iter().zip(saved).map(|(is_asked, saved)| !is_asked || saved >= THING_BITS).collect();
    let [mut of_objects, mut of_doubts] = [is_left.iter(), is_left.iter()];
    traced.scene.objects.retain(|_| of_objects.next() == Some(&true));
    traced.doubts.retain(|_| of_doubts.next() == Some(&true));
    Ok(())
}
