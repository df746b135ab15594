//! `dvp fit --masks`: label maps of other programs to scenes.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use dvp_core::image::RgbaImage;
use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::{Compositing, EdgeProfile, PixelLoss};
use dvp_core::{Image, Object, Real as _, Scene};
use dvp_fit::masks::{LabelOutline, outlines_of_labels};
use dvp_fit::{Fit, StopReason};

use super::exports::Measurable;
use super::inputs::{self, Input};
use super::report::{FoundScene, Report};
use super::{Arguments, finish, refuse_overwriting, report_of};
use crate::format::{BitDepth, Picture, read_labels, read_picture, read_picture_rgba};
use crate::method::timed;
use crate::paint::{PaintScratch, Painter};

/// A label map, and the picture that its objects have their colors from.
#[derive(Debug)]
struct MaskInput {
    input: Input,
    picture: Option<PathBuf>,
}

impl MaskInput {
    /// The picture that the objects are on; without one the label map stands for it.
    fn picture_name(&self) -> String {
        self.picture.as_ref().map_or_else(|| self.input.name(), |picture| picture.display().to_string())
    }
}

/// What came of every label map, and of what led to none.
pub(super) fn fit_all(arguments: &Arguments, masks: &Path) -> Result<(Vec<Report>, Vec<String>)> {
    let (found, failures) = find(masks, &arguments.pictures)?;
    let pictures = found.iter().filter_map(|masks| masks.picture.as_ref());
    refuse_overwriting(arguments, found.iter().map(|masks| &masks.input), pictures)?;
    let name = |masks: &MaskInput| masks.input.name();
    let one = |scratch: &mut PaintScratch<f32>, _: usize, masks: &MaskInput| {
        report_of(&masks.input, masks.picture_name(), try_fit(arguments, masks, scratch))
    };
    Ok((arguments.batch.each(&found, name, one)?, failures))
}

fn try_fit(arguments: &Arguments, masks: &MaskInput, scratch: &mut PaintScratch<f32>) -> Result<FoundScene> {
    let (MaskFit { fit, picture, labels }, time) = timed(|| fit(arguments, masks))?;
    let scene = Measurable::of_labels(&fit, picture.image.size(), &labels);
    finish(arguments, [&*masks.picture_name(), &masks.input.stem], &picture, &scene, time, scratch)
}

/// The label maps that `masks` names, with their pictures among `pictures`: with the only one if there is one label map, else
/// with the longest stem that begins the stem of the label map.
fn find(masks: &Path, pictures: &[PathBuf]) -> Result<(Vec<MaskInput>, Vec<String>)> {
    if masks.is_dir() {
        bail!("{}: --masks takes a file or a pattern, such as '{0}/*.tif'", masks.display());
    }
    let (masks, pictures) = (inputs::find(&[masks.to_path_buf()]), inputs::find(pictures));
    let mut failures = [masks.failures, pictures.failures].concat();
    let alone = masks.paths.len() == 1 && pictures.paths.len() == 1;
    let named = inputs::name(&masks.paths.into_iter().map(|path| (path, None)).collect::<Vec<_>>());
    let mut found = Vec::new();
    for input in named {
        let stem = lossy_stem(&input.path);
        let candidates = pictures.paths.iter().filter(|path| alone || begins(&stem, &lossy_stem(path)));
        let picture = candidates.max_by_key(|path| lossy_stem(path).len()).cloned();
        if picture.is_none() && !pictures.paths.is_empty() {
            failures
                .push(format!("{}: none of the pictures has a name that this one begins with", input.path.display()));
        } else {
            found.push(MaskInput { input, picture });
        }
    }
    Ok((found, failures))
}

/// Whether the stem of a label map begins with that of a picture, and with no other word: `cell10_mask` with `cell10`, not with
/// `cell1`.
fn begins(stem: &str, picture: &str) -> bool {
    stem.strip_prefix(picture).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric))
}

fn lossy_stem(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned())
}

/// The scene of a label map, and the label of each object.
struct MaskFit {
    fit: Fit<f32>,
    picture: Picture<f32>,
    labels: Vec<u32>,
}

/// Reads a label map and fits outlines to its labels; colors are the means of the picture, or else those of a palette.
fn fit(arguments: &Arguments, masks: &MaskInput) -> Result<MaskFit> {
    let path = &masks.input.path;
    let (size, labels) = read_labels(path, arguments.batch.max_pixels)?;
    let outlines = outlines_of_labels::<f32>(&labels, size)?;
    let known: Vec<u32> = core::iter::once(0).chain(outlines.iter().map(|outline| outline.label)).collect();
    // Which of the known labels each pixel has; one whose outline encloses nothing counts as background.
    let owner = |label: &u32| known.binary_search(label).unwrap_or(0);
    let (picture, colors) = match &masks.picture {
        Some(picture) => {
            let read = read_picture::<f32>(picture, arguments.batch.max_pixels)?;
            if read.image.size() != size {
                let [found, wanted] =
                    [read.image.size(), size].map(|size| format!("{} x {}", size.width(), size.height()));
                bail!("{}: has {wanted} pixels, its picture {} has {found}", path.display(), picture.display());
            }
            let alpha = read_picture_rgba(picture, arguments.batch.max_pixels)?;
            let colors = means(&read, &alpha, &labels, owner, known.len());
            (read, colors)
        }
        None => {
            let colors: Vec<[f32; 3]> = (0..known.len()).map(palette).collect();
            let pixels: Vec<f32> = labels.iter().flat_map(|label| colors[owner(label)]).collect();
            let image = Image::from_interleaved(size, &pixels)?;
            (Picture { bits: BitDepth::Eight, ..Picture::from(image) }, colors)
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
    let fit = Fit::of_painted(scene, &drawing, &image.view(), painted.data());
    Ok(MaskFit { fit: Fit { loss: mae, stop: StopReason::Converged, ..fit }, picture, labels: known[1..].to_vec() })
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
