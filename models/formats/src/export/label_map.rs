//! Label maps: which object is seen in each pixel.

use dvp_core::image::{distance, mixture};
use dvp_core::metric::{Ownership, OwnershipRule};
use dvp_core::render::{Compositing, ContourRenderer};
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Drawing, Image, ImageSize, ImageView, Scene};
use dvp_fit::paint::{Canvas, drawing_of};

use super::error::ExportError;

/// The object that is seen in each pixel, row by row: 0 for the background, else its number in `numbers`, which has one per object.
///
/// An object is seen where it covers at least half of a pixel, by the edges of the scene, and no later object does, whatever
/// the opacity of that: what `dvp evaluate` compares with for scenes that hide. Where the objects of a scene that
/// `blend`s overlap they are all seen; the pixel goes to the last one.
///
/// # Errors
/// [`ExportError::Draw`] and [`ExportError::Owners`] if the scene cannot be drawn.
pub fn label_map(scene: &Scene<f32>, numbers: &[u32], size: ImageSize) -> Result<Vec<u32>, ExportError> {
    let drawing = drawing_of(scene, size, REFERENCE_VERTICES).map_err(ExportError::Draw)?;
    Ok(numbered(&owners(scene, &drawing, size)?, numbers))
}

/// As [`label_map`], but where the scene is refuted by the picture that it was read from, the picture says who is seen.
///
/// Outlines are smooth where the edges of a picture are jagged, so that pixels that are about half covered go to the wrong side. Such a pixel
/// is more than three times the `noise` (standard deviation of a channel, \[0, 1\]) away from what the scene paints. It goes to the
/// one with the larger share, if two of those beside it mix to its color. Scenes that `blend`, and objects that one can see
/// through, are left as they are painted.
///
/// # Errors
/// As [`label_map`], and [`ExportError::Render`] if the scene cannot be painted.
pub fn label_map_in(
    scene: &Scene<f32>,
    numbers: &[u32],
    image: ImageView<'_, f32>,
    noise: f32,
) -> Result<Vec<u32>, ExportError> {
    let size = image.size();
    let drawing = drawing_of(scene, size, REFERENCE_VERTICES).map_err(ExportError::Draw)?;
    let drawn = owners(scene, &drawing, size)?;
    let mut painted = Image::zeros(size);
    Canvas::default().paint_to(scene, &drawing, &mut painted)?;
    let mut seen = drawn.clone();
    if scene.compositing == Compositing::Over && noise.is_finite() {
        let [width, height] = [size.width(), size.height()];
        for (pixel, seen) in seen.iter_mut().enumerate() {
            let color = image.pixel(pixel);
            if distance(color, painted.view().pixel(pixel)) <= REFUTED * noise {
                continue;
            }
            // The pixel's own object first, so that it stays where another explains it no better.
            let mut beside = [*seen; 9];
            let mut count = 1;
            let [x, y] = [pixel % width, pixel / width];
            for row in y.saturating_sub(1)..height.min(y + 2) {
                for &other in &drawn[row * width + x.saturating_sub(1)..row * width + width.min(x + 2)] {
                    if !beside[..count].contains(&other) {
                        beside[count] = other;
                        count += 1;
                    }
                }
            }
            *seen = larger_share(color, &beside[..count], &drawing, REFUTED * noise).unwrap_or(*seen);
        }
    }
    Ok(numbered(&seen, numbers))
}

/// How many standard deviations of the noise a pixel is from what the scene paints, if it says otherwise.
const REFUTED: f32 = 3.0;

/// The larger of two objects (0: the background, else from 1) whose mixture is nearest to the color; none if no mixture comes within `tolerance`.
fn larger_share(color: [f32; 3], beside: &[u32], drawing: &Drawing<f32>, tolerance: f32) -> Option<u32> {
    let of = |object: u32| match (object as usize).checked_sub(1) {
        None => Some(drawing.background),
        Some(k) => (drawing.confidences[k] >= 1.0).then_some(drawing.colors[k]),
    };
    let mut best = (tolerance, None);
    for (k, &a) in beside.iter().enumerate() {
        for &b in &beside[k + 1..] {
            let Some((from, to)) = of(a).zip(of(b)).filter(|&(from, to)| distance(from, to) > 0.0) else { continue };
            let (share, misfit) = mixture(color, from, to);
            if misfit < best.0 {
                best = (misfit, Some(if share < 0.5 { a } else { b }));
            }
        }
    }
    best.1
}

/// Per pixel 1 + the object that is seen, else 0.
fn owners(scene: &Scene<f32>, drawing: &Drawing<f32>, size: ImageSize) -> Result<Vec<u32>, ExportError> {
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    let mut owners = Ownership::default();
    let rule = OwnershipRule::Seen(Compositing::Over);
    owners.fill_drawing(rule, &renderer, drawing, size, &mut Default::default())?;
    Ok(owners.index().to_vec())
}

/// The numbers of the objects that own pixels.
fn numbered(owners: &[u32], numbers: &[u32]) -> Vec<u32> {
    let number = |&index: &u32| (index as usize).checked_sub(1).and_then(|k| numbers.get(k)).copied();
    owners.iter().map(|index| number(index).unwrap_or(0)).collect()
}
