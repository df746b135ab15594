//! `dvp fit --masks`: label maps of other programs to scenes.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use dvp_fit::paint::Canvas;

use super::exports::Measurable;
use super::inputs::{self, Input};
use super::report::{FoundScene, Report};
use super::{Arguments, finish, refuse_overwriting, report_of};
use crate::format::{read_labels, read_picture, read_picture_rgba};
use crate::method::timed;
use crate::solve::{MaskFit, fit_masks};

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
    let one = |canvas: &mut Canvas<f32>, _: usize, masks: &MaskInput| {
        report_of(&masks.input, masks.picture_name(), try_fit(arguments, masks, canvas))
    };
    Ok((arguments.batch.each(&found, name, one)?, failures))
}

fn try_fit(arguments: &Arguments, masks: &MaskInput, canvas: &mut Canvas<f32>) -> Result<FoundScene> {
    let (MaskFit { fit, picture, labels }, time) = timed(|| fit(arguments, masks))?;
    let scene = Measurable::of_labels(&fit, picture.image.size(), &labels);
    finish(arguments, [&*masks.picture_name(), &masks.input.stem], &picture, &scene, time, canvas)
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

/// Reads a label map and its picture, if it has one, and fits outlines to the labels.
fn fit(arguments: &Arguments, masks: &MaskInput) -> Result<MaskFit> {
    let path = &masks.input.path;
    let (size, labels) = read_labels(path, arguments.batch.max_pixels)?;
    let Some(picture) = &masks.picture else { return Ok(fit_masks(size, &labels, None)?) };
    let read = read_picture::<f32>(picture, arguments.batch.max_pixels)?;
    if read.image.size() != size {
        let [found, wanted] = [read.image.size(), size].map(|size| format!("{} x {}", size.width(), size.height()));
        bail!("{}: has {wanted} pixels, its picture {} has {found}", path.display(), picture.display());
    }
    let alpha = read_picture_rgba(picture, arguments.batch.max_pixels)?;
    Ok(fit_masks(size, &labels, Some((read, &alpha)))?)
}
