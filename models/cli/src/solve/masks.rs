//! Label maps of other programs to scenes.

use dvp_core::image::RgbaImage;
use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::{Compositing, EdgeProfile, PixelLoss};
use dvp_core::{Image, ImageSize, Object, Real as _, Scene};
use dvp_fit::masks::{LabelOutline, outlines_of_labels};
use dvp_fit::{Fit, StopReason};

use super::error::SolveError;
use crate::format::{BitDepth, Picture};
use crate::paint::Painter;

/// The scene of a label map.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MaskFit {
    /// The scene, one object per label, and how near its rendering comes to the picture.
    pub fit: Fit<f32>,
    /// The picture that the objects are on; without one, the label map in the colors of a palette.
    pub picture: Picture<f32>,
    /// The label of each object, rising.
    pub labels: Vec<u32>,
}

/// Fits outlines to the labels of a label map; 0 is the background. Colors are the means of `picture`, which comes with its own
/// pixels and alpha, or else those of a palette.
///
/// *Dimensions*: `labels` holds one per pixel of `size`, row by row; the picture has the same size.
///
/// # Errors
/// [`SolveError::Labels`] if there is not one label per pixel, [`SolveError::Size`] for a picture of another size.
pub fn fit_masks(
    size: ImageSize,
    labels: &[u32],
    picture: Option<(Picture<f32>, &RgbaImage<f32>)>,
) -> Result<MaskFit, SolveError> {
    let outlines = outlines_of_labels::<f32>(labels, size)?;
    let known: Vec<u32> = core::iter::once(0).chain(outlines.iter().map(|outline| outline.label)).collect();
    // Which of the known labels each pixel has; one whose outline encloses nothing counts as background.
    let owner = |label: &u32| known.binary_search(label).unwrap_or(0);
    let (picture, colors) = match picture {
        Some((picture, alpha)) => {
            for own in [picture.image.size(), alpha.size()] {
                if own != size {
                    let [masks, picture] = [size, own].map(|size| [size.width(), size.height()]);
                    return Err(SolveError::Size { masks, picture });
                }
            }
            let colors = means(&picture, alpha, labels, owner, known.len());
            (picture, colors)
        }
        None => {
            let colors: Vec<[f32; 3]> = (0..known.len()).map(palette).collect();
            let pixels: Vec<f32> = labels.iter().flat_map(|label| colors[owner(label)]).collect();
            let image = Image::from_interleaved(size, &pixels)?;
            (Picture::from(image).with_bits(BitDepth::Eight), colors)
        }
    };
    let objects = outlines
        .into_iter()
        .zip(colors.iter().skip(1))
        .map(|(LabelOutline { shape, pose, .. }, &color)| Object { shape, pose, paint: color.into(), confidence: 1.0 });
    let scene = Scene {
        background: colors[0],
        transparent: picture.transparent,
        objects: objects.collect(),
        edge: EdgeProfile::area(),
        compositing: Compositing::Over,
    };
    let (drawing, painted) = (Painter::default().draw(&scene, size)?, Painter::default().paint(&scene, size)?);
    let image = &picture.image;
    let mae = PixelLoss::Mae.value(ImagePair::new(painted.view(), image.view())?, &mut ())?;
    let mut fit = Fit::of_painted(scene, &drawing, &image.view(), painted.data());
    (fit.loss, fit.stop) = (mae, StopReason::Converged);
    Ok(MaskFit { fit, picture, labels: known[1..].to_vec() })
}

/// The mean color of the pixels of each owner, by their alpha; white for none. The background of a transparent picture is the color
/// that the picture was put over.
fn means(
    picture: &Picture<f32>,
    alpha: &RgbaImage<f32>,
    labels: &[u32],
    owner: impl Fn(&u32) -> usize,
    owners: usize,
) -> Vec<[f32; 3]> {
    let mut sums = vec![([0.0_f64; 3], 0.0_f64); owners];
    let mut add = |owner: usize, values: [f32; 3], weight: f32| {
        let (sum, total) = &mut sums[owner];
        *total += f64::from(weight);
        sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += f64::from(value));
    };
    for (pixel, label) in labels.iter().enumerate() {
        // Colors come times their alpha.
        let [red, green, blue, alpha] = [0, 1, 2, 3].map(|c| alpha.data()[c * labels.len() + pixel]);
        let (seen, owner) = ([red, green, blue], owner(label));
        if owner > 0 || !picture.transparent {
            add(owner, seen, alpha);
        }
        if picture.transparent {
            let mixed = picture.image.view().pixel(pixel);
            add(0, [0, 1, 2].map(|c| mixed[c] - seen[c]), 1.0 - alpha);
        }
    }
    #[expect(clippy::cast_possible_truncation, reason = "colors in [0, 1]")]
    let mean = |(sum, count): ([f64; 3], f64)| sum.map(|sum| if count > 0.0 { (sum / count) as f32 } else { 1.0 });
    sums.into_iter().map(mean).collect()
}

/// White for the background, then colors whose hues are a golden angle apart, so that neighbors differ.
fn palette(k: usize) -> [f32; 3] {
    if k == 0 {
        return [1.0; 3];
    }
    let hue = f32::of_usize(k % 1024) * 0.618_034;
    // Around the hexagon of hues: a channel is 1 within a sixth of a turn of its primary and 0 beyond a third.
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|shift| {
        let apart = ((hue + shift).fract() - 0.5).abs();
        0.15 + 0.7 * (6.0 * apart - 1.0).clamp(0.0, 1.0)
    })
}
