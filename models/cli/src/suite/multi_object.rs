//! Records of `multi_object_datasets` to scenes.

use std::path::Path;

use dvp_core::ImageSize;

use super::SuiteScene;
use crate::format::{Example, FormatError, Place, TfRecords};

/// How a set lays its pictures out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    /// Columns, and rows.
    side: usize,
    /// Whether the numbers of a mask stand together; else all masks of a pixel do.
    is_mask_by_mask: bool,
}

/// `image` 64 x 64 x 3 (x 1 of the binarized variant), `mask` 64 x 64 x entities x 1.
pub(super) const MULTI_DSPRITES: Layout = Layout { side: 64, is_mask_by_mask: false };
/// `image` 35 x 35 x 3, `mask` 4 x 35 x 35 x 1.
pub(super) const TETROMINOES: Layout = Layout { side: 35, is_mask_by_mask: true };

/// A mask is set from here on: files hold 0 and 255.
const SET: u8 = 128;

/// The first `count` scenes of a file.
///
/// # Errors
/// [`FormatError`] with the record that is wrong.
pub(super) fn read(path: &Path, count: usize, layout: Layout) -> Result<Vec<SuiteScene>, FormatError> {
    let mut scenes = Vec::new();
    for (number, record) in (1..=count).zip(TfRecords::open(path)?) {
        let scene = Example::read(&record?).and_then(|example| scene(&example, layout));
        scenes.push(scene.map_err(|problem| {
            let field = format!("record {number}");
            FormatError::Field { place: Place::file(path), field, problem }
        })?);
    }
    Ok(scenes)
}

/// The scene of a record. The first entity is the background; others are there if `visibility` says so.
fn scene(example: &Example, layout: Layout) -> Result<SuiteScene, String> {
    let size = ImageSize::new(layout.side, layout.side).map_err(|error| error.to_string())?;
    let pixels = size.pixels();
    let entities = example.float_count("visibility");
    let visibility = example.floats("visibility", entities)?;
    let shapes = example.floats("shape", entities)?;
    // One channel stands for all three.
    let image = match example.bytes("image", 3 * pixels) {
        Ok(colors) => colors,
        Err(problem) => {
            let gray = example.bytes("image", pixels).map_err(|_| problem)?;
            gray.into_iter().flat_map(|value| [value; 3]).collect()
        }
    };
    let masks = example.bytes("mask", pixels * entities)?;
    let is_set = |entity: usize, pixel: usize| {
        let place = if layout.is_mask_by_mask { entity * pixels + pixel } else { pixel * entities + entity };
        masks[place] >= SET
    };
    let objects: Vec<usize> = (1..entities).filter(|&entity| visibility[entity] > 0.5).collect();
    let label = |pixel| (1..).zip(&objects).find(|&(_, &entity)| is_set(entity, pixel)).map_or(0, |(label, _)| label);
    let class = |&entity: &usize| -> Result<u32, String> {
        let shape = shapes[entity].round();
        let is_class = (0.0..1e6).contains(&shape);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole and in range")]
        let class = shape as u32;
        if is_class { Ok(class) } else { Err(format!("has the shape {shape}, must be a number of a class")) }
    };
    Ok(SuiteScene {
        size,
        pixels: image,
        labels: (0..pixels).map(label).collect(),
        whole: Vec::new(),
        classes: objects.iter().map(class).collect::<Result<_, _>>()?,
    })
}
