//! A COCO data set of all pictures of a run.
//!
//! One category per class of objects (the prototype's name, or else the kind of shape). Outlines are whole, also where they
//! are hidden or leave the picture. What has holes, which polygons of COCO cannot have, is a mask instead: run lengths down the
//! columns, of the pixels whose center is inside.
//!
//! *Source*: "Data format" at cocodataset.org, and what pycocotools reads.

use alloc::collections::BTreeSet;

use dvp_core::render::{Compositing, HardMask, HardRenderer};
use dvp_core::shape::Outline;
use dvp_core::{Drawing, ImageSize};
use dvp_formats::export::decimals;
use serde::Serialize;

use super::ExportError;
use super::{Found, MeasuredObject, MeasuredPicture, Region};

#[derive(Serialize)]
struct DataSet<'a> {
    info: Info,
    images: Vec<Image<'a>>,
    annotations: Vec<Annotation>,
    categories: Vec<Category<'a>>,
}

#[derive(Serialize)]
struct Info {
    description: &'static str,
}

#[derive(Serialize)]
struct Image<'a> {
    id: usize,
    file_name: &'a str,
    width: usize,
    height: usize,
}

#[derive(Serialize)]
struct Category<'a> {
    id: usize,
    name: &'a str,
    supercategory: &'static str,
}

#[derive(Serialize)]
struct Annotation {
    id: usize,
    image_id: usize,
    category_id: usize,
    segmentation: Segmentation,
    area: f64,
    /// x, y, width, height.
    bbox: [f64; 4],
    iscrowd: u8,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Segmentation {
    /// x, y, x, y, ... of each part.
    Polygons(Vec<Vec<f64>>),
    RunLengths {
        counts: Vec<usize>,
        /// Height, width.
        size: [usize; 2],
    },
}

/// The data set as JSON. Pictures that failed and objects that enclose nothing are left out; numbers count from 1.
///
/// # Errors
/// [`ExportError::Render`] if a mask cannot be drawn, [`ExportError::Json`].
pub fn coco(pictures: &[MeasuredPicture]) -> Result<Vec<u8>, ExportError> {
    let classes: BTreeSet<&str> =
        pictures.iter().flat_map(|picture| picture.objects().iter().map(|o| o.class())).collect();
    let classes: Vec<&str> = classes.into_iter().collect();
    let (mut images, mut annotations) = (Vec::new(), Vec::new());
    for picture in pictures {
        let Ok(Found { size, objects }) = &picture.found else { continue };
        let image_id = images.len() + 1;
        images.push(Image { id: image_id, file_name: &picture.picture, width: size.width(), height: size.height() });
        for object in objects {
            let (Some(moments), Some(bounds)) = (object.moments, object.bounds) else { continue };
            annotations.push(Annotation {
                id: annotations.len() + 1,
                image_id,
                category_id: classes.partition_point(|&class| class < object.class()) + 1,
                segmentation: segmentation(object, *size)?,
                area: decimals(moments.area),
                bbox: [bounds.min.x, bounds.min.y, bounds.size().x, bounds.size().y].map(decimals),
                iscrowd: 0,
            });
        }
    }
    let categories = (1..).zip(classes).map(|(id, name)| Category { id, name, supercategory: "object" }).collect();
    let info =
        Info { description: "Outlines found by dvp: pixels, x right, y down, (0, 0) the corner of the first pixel" };
    Ok(serde_json::to_vec(&DataSet { info, images, annotations, categories })?)
}

fn segmentation(object: &MeasuredObject, size: ImageSize) -> Result<Segmentation, ExportError> {
    let region = &object.region;
    if region.has_holes() {
        let counts = run_lengths(&mask(region, size)?, size);
        return Ok(Segmentation::RunLengths { counts, size: [size.height(), size.width()] });
    }
    let flat = |ring: &[[f64; 2]]| ring.as_flattened().iter().copied().map(decimals).collect();
    Ok(Segmentation::Polygons(region.rings().map(flat).collect()))
}

/// Whether the center of each pixel is inside, row by row.
fn mask(region: &Region, size: ImageSize) -> Result<Vec<bool>, ExportError> {
    let unit = f64::from(u32::try_from(size.unit_px()).unwrap_or(u32::MAX));
    let mut outline = Outline::default();
    for ring in region.rings() {
        outline.push_ring(ring.iter().map(|vertex| vertex.map(|x| x / unit)));
    }
    let mut drawing = Drawing::default();
    drawing.push_rings(outline.rings(), [0.0; 3], 1.0);
    let renderer = HardRenderer { coverage: HardMask, compositing: Compositing::Over };
    let mut mask = vec![false; size.pixels()];
    renderer.visit_coverage(&drawing, size, &mut Default::default(), |_, pixel, coverage| {
        mask[pixel..].iter_mut().zip(coverage).for_each(|(inside, &coverage)| *inside = coverage > 0.5);
    })?;
    Ok(mask)
}

/// How many pixels outside, inside, outside, ... follow one another, column by column; the first number may be 0.
pub(super) fn run_lengths(mask: &[bool], size: ImageSize) -> Vec<usize> {
    let (mut counts, mut inside) = (vec![0], false);
    for column in 0..size.width() {
        for &pixel in mask.iter().skip(column).step_by(size.width()) {
            if pixel != inside {
                inside = pixel;
                counts.push(0);
            }
            if let Some(count) = counts.last_mut() {
                *count += 1;
            }
        }
    }
    counts
}
