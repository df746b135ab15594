//! Pictures with clear edges to drawings: what people draw, found again.
//!
//! ```text
//! image -> partition -> boundary -> stroke | outline -> layers -> ties -> centers -> scene
//! ```
//!
//! | module | comes in | goes out |
//! |---|---|---|
//! | `tuning` | | every number that was chosen, with unit and reason |
//! | `ruler` | misfits, numbers with their covariance | bits: the one price of everything |
//! | `table` | what was asked for before | what was found |
//! | `noise` | an image | its noise level, and the image without noise |
//! | `ramps` | an image | colors that change from place to place, and the image without them |
//! | `regions` | an image that is not flat | regions of one color |
//! | `partition` | an image | faces of one color, and mixed pixels with the shares of two faces |
//! | `boundary` | a partition | where two faces meet, to a few thousandths of a pixel |
//! | `outline` | samples of a boundary | the shortest outline through them: circle, rectangle, path, ... |
//! | `stroke` | the boundary of a face | the lines of a pen that drew it |
//! | `layers` | faces and their boundaries | objects, back to front, whole where others hide them |
//! | `ties` | layers | the same on the grid that they were drawn on, with equal numbers equal |
//! | `centers` | layers of a picture without a mixed pixel | the same with the middle of every pixel on the right side |
//! | `missed` | a picture, and its drawing painted | things that are seen and not painted |
//!
//! Lengths are in pixels (the center of the pixel (row r, column c) is at (c + 0.5, r + 0.5), y down) and prices in bits,
//! unless a name says otherwise. Everything is computed in f64; images come in f32. The arithmetic of f64 is inherent with std and
//! that of `num_traits` without.
//!
//! # Features
//!
//! `std` (default) brings the platform's maths and the faster kernels of `dvp-core`; without it everything works with `alloc`.
#![no_std]
#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixels and faces are fewer than 2^32, since sizes of images are; coordinates become indices where they are not negative"
)]
#![allow(clippy::float_cmp, reason = "axes and colors that are compared are copies of one another, or differ")]

extern crate alloc;
#[cfg(test)]
extern crate std;

pub mod boundary;
pub mod centers;
mod elimination;
pub mod layers;
pub mod missed;
pub mod noise;
pub mod outline;
pub mod partition;
pub mod ramps;
pub mod regions;
pub mod ruler;
pub mod sample;
pub mod scene;
pub mod stroke;
mod table;
#[cfg(test)]
mod tests;
pub mod ties;
pub mod tuning;

use alloc::vec::Vec;

use dvp_core::{Image, ImageSize, ImageView, Scene};

use crate::boundary::Ring;
use crate::partition::{Face, NoPartition, Partition, Reading};
use crate::regions::Regions;
pub use crate::scene::{ObjectDoubt, PoseCovariance};

/// A picture as a drawing.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Traced {
    /// The drawing.
    pub scene: Scene<f32>,
    /// What is in doubt of its objects, one by one.
    pub doubts: Vec<ObjectDoubt>,
    /// Description length of its outlines, and of what they miss, bits.
    pub bits: f64,
    /// Share of the pixels just beyond edges that still show the other side, [0, 1]: near 0 if edges are of area coverage, as the
    /// drawing's are.
    pub stained: f64,
    /// Whether it was read as changed by a coder of photographs: known to be, or since its edges ring.
    pub coded: bool,
    /// Standard deviation of a channel that was averaged away before.
    pub noise: f64,
    /// Standard deviation of the blur that its edges show, pixels; looked for in spoiled pictures only, else 0.
    pub blur: f64,
}

/// Why a picture is no drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoDrawing {
    /// It was not cut into faces.
    Partition(NoPartition),
    /// Its edges are soft: it was blurred, or painted with another profile than area coverage.
    Soft {
        /// Share of the pixels just beyond edges that still show the other side.
        stained: f64,
        /// Faces that it would have.
        faces: usize,
    },
}

/// What is known of a picture beside its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Known {
    /// The color that transparent parts are shown on, if it has such.
    pub matte: Option<[f32; 3]>,
    /// Whether a coder of photographs (JPEG) has changed its pixels.
    pub coded: bool,
    /// Whether outlines along edges without mixed pixels may be half a pixel off where that is shorter, instead of having the middle of every
    /// pixel on the right side: so they are alike where objects share a shape.
    pub loose: bool,
    /// Whether it may have noise or soft edges: it is read then as what it was before.
    pub spoiled: bool,
    /// Whether it is made of squares of one color, [`tuning::SQUARE`] pixels wide, as a sprite is whose pixels are enlarged: nothing is mixed, and those
    /// that touch in a corner are one thing.
    pub squares: bool,
    /// Whether every thing is of one color. Unless it is, a fit looks for color ramps, takes them out before the picture is read, and puts them back.
    pub flat: bool,
}

impl Known {
    /// The same with a color that transparent parts are shown on, or none.
    #[must_use]
    pub fn with_matte(self, matte: Option<[f32; 3]>) -> Self {
        Self { matte, ..self }
    }

    /// The same, outlines half a pixel off or not.
    #[must_use]
    pub fn with_loose(self, loose: bool) -> Self {
        Self { loose, ..self }
    }

    /// The same, with noise and soft edges or not.
    #[must_use]
    pub fn with_spoiled(self, spoiled: bool) -> Self {
        Self { spoiled, ..self }
    }

    /// The same, changed by a coder of photographs or not.
    #[must_use]
    pub fn with_coded(self, coded: bool) -> Self {
        Self { coded, ..self }
    }

    /// The same, made of squares or not.
    #[must_use]
    pub fn with_squares(self, squares: bool) -> Self {
        Self { squares, ..self }
    }

    /// The same, every thing of one color or not.
    #[must_use]
    pub fn with_flat(self, flat: bool) -> Self {
        Self { flat, ..self }
    }
}

/// A picture in the colors of its faces: without noise, without what a coder left beside edges, and without a mixed pixel; none if it is no drawing of
/// flat colors.
#[must_use]
#[inline(never)]
pub fn flat(image: &ImageView<'_, f32>, known: &Known) -> Option<Image<f32>> {
    let partition = read_as(image, &known.with_spoiled(true)).ok()?.partition;
    let color = |face: &Face| partition.rgb(partition.palette[face.color]).map(|value| value as f32);
    let colors: Vec<[f32; 3]> = partition.faces.iter().map(color).collect();
    let pixels: Option<Vec<[f32; 3]>> =
        partition.labels.iter().map(|&face| colors.get(face as usize).copied()).collect();
    Image::from_interleaved(image.size(), pixels?.as_flattened()).ok()
}

/// The drawing that a picture is.
///
/// # Errors
/// [`NoDrawing`] if the picture is no drawing of flat colors, or, unless it may be spoiled, has noise or soft edges.
#[inline(never)]
pub fn trace(image: &ImageView<'_, f32>, known: &Known) -> Result<Traced, NoDrawing> {
    draw(read_as(image, known).map_err(NoDrawing::Partition)?, image.size(), known)
}

/// The drawing of the regions that a picture was cut into.
///
/// # Errors
/// [`NoDrawing::Partition`] if there are 2^16 regions or more.
#[inline(never)]
pub fn trace_regions(regions: &Regions) -> Result<Traced, NoDrawing> {
    let partition = Partition::of_regions(regions).map_err(NoDrawing::Partition)?;
    let rings = boundary::rings(&partition);
    let known = Known::default().with_spoiled(true).with_loose(true);
    draw(Read { partition, others: Vec::new(), rings }, regions.image.size(), &known)
}

/// Reads a picture as what is known of it.
fn read_as(image: &ImageView<'_, f32>, known: &Known) -> Result<Read, NoPartition> {
    let reading = Reading { coded: known.coded, soft: known.spoiled, squares: known.squares, ..Reading::default() };
    match read(image, reading) {
        // What is no drawing as it is may be one under noise, or under what a coder left beside edges.
        Err(_) if known.spoiled && !known.coded => read_spoiled(image, reading),
        read => read,
    }
}

/// Reads a picture as it was before it got noise, or what a coder left beside edges. What has too many faces has texture, which is noise of a larger
/// scale: what is left of it must be larger by as much.
#[inline(never)]
fn read_spoiled(image: &ImageView<'_, f32>, reading: Reading) -> Result<Read, NoPartition> {
    let Some(level) = noise::level_above_rounding(image) else { return read(image, reading.with_coded(true)) };
    let mut found = Err(NoPartition::Noisy);
    for texture in tuning::TEXTURES {
        let noise = texture as f32 * level;
        let Some(smooth) = noise::averaged(image, noise) else { break };
        let read = read(&smooth.view(), Reading { noise, ..reading });
        found = read.and_then(|read| read.partition.check_faces(texture).map(|()| read));
        if !matches!(found, Err(NoPartition::TooManyFaces { .. })) {
            break;
        }
    }
    found
}

/// A picture as faces, in one way or two.
struct Read {
    partition: Partition,
    /// Other ways to cut it.
    others: Vec<Partition>,
    rings: Vec<Vec<Ring>>,
}

/// Reads a picture; where edges ring or are wide, as changed by a coder if that makes fewer faces with shorter boundaries, and loses less than that.
/// Of either way it must not have too many faces.
#[inline(never)]
fn read(image: &ImageView<'_, f32>, reading: Reading) -> Result<Read, NoPartition> {
    let of = |reading: Reading| {
        let (mut partition, mut others) = Partition::readings(image, reading)?;
        let mut rings = boundary::rings(&partition);
        if reading.soft {
            partition.blur = boundary::blur(&partition, &rings);
            others.iter_mut().for_each(|other| other.blur = partition.blur);
            rings = boundary::rings(&partition);
        }
        Ok(Read { partition, others, rings })
    };
    let length = |read: &Read| read.rings.iter().flatten().map(|ring| ring.steps.len()).sum::<usize>() as f64;
    let is_less = |coded: &Read, plain: &Read| {
        let is_shorter = length(coded) < (1.0 - tuning::RINGING) * length(plain);
        let saved = plain.partition.faces.len().saturating_sub(coded.partition.faces.len());
        is_shorter && coded.partition.lost_blocks(&plain.partition) < saved
    };
    let plain = of(reading)?;
    // Ramps of a blur are no things either.
    let is_plain = plain.partition.ripple <= tuning::RIPPLED && plain.partition.blur <= tuning::WIDE_BLUR;
    let coded = if is_plain { None } else { of(reading.with_coded(true)).ok() };
    let read = coded.filter(|coded| is_less(coded, &plain)).unwrap_or(plain);
    read.partition.check_faces(1).map(|()| read)
}

/// The drawing of faces.
#[inline(never)]
fn draw(read: Read, size: ImageSize, known: &Known) -> Result<Traced, NoDrawing> {
    let Read { partition, others, rings } = read;
    let stained = match partition.reading.coded {
        // Coders stain what is beside an edge, whatever its profile is: in large pictures one of their own is seen as blur, small ones leave a doubt,
        // and so do those that only look as if there had been a coder.
        true if !known.coded || size.width().min(size.height()) < tuning::CODED_SMALL => tuning::UNKNOWN_STAINED,
        true => 0.0,
        false => boundary::stained(&partition, &rings).unwrap_or(tuning::UNKNOWN_STAINED),
    };
    let wobble =
        if partition.reading.coded || partition.is_hard { 0.0 } else { boundary::wobble(&rings).unwrap_or(0.0) };
    if !known.spoiled && !partition.reading.coded && !partition.is_hard && is_soft(stained, wobble) {
        return Err(NoDrawing::Soft { stained, faces: partition.faces.len() });
    }
    // Renderers that count few places in each pixel are as steep as those with a profile of their own.
    let stained = if wobble < -tuning::SURE_WOBBLE { stained.max(tuning::UNKNOWN_STAINED) } else { stained };
    let matte = known.matte.map(|matte| matte.map(f64::from));
    let memo = layers::Memo::default();
    let mut layers = layers::layers(&partition, &rings, matte, &memo);
    // What slivers are, lines that cross, and gaps, the shorter description tells.
    let with_slivers = core::iter::once(&partition).chain(&others).filter_map(Partition::with_slivers);
    let mut read = &partition;
    let others: Vec<Partition> = with_slivers.collect::<Vec<_>>().into_iter().chain(others).collect();
    for other in &others {
        let of_other = layers::layers(other, &boundary::rings(other), matte, &memo);
        // Stairs say less, and cost less, than edges that are known: they are the last thing to believe.
        let key = |read: &Partition, layers: &layers::Layers| (read.is_hard, layers.bits_of_things());
        if key(other, &of_other) < key(read, &layers) {
            (layers, read) = (of_other, other);
        }
    }
    ties::tie(&mut layers, partition.size);
    if read.is_hard && !known.loose {
        centers::meet(&mut layers, read);
    }
    let bits = layers.bits();
    let (scene, doubts) = scene::scene(&layers, size, known.matte.is_some(), read.is_hard && !read.reading.regions);
    Ok(Traced {
        scene,
        doubts,
        bits,
        stained,
        coded: partition.reading.coded,
        noise: f64::from(partition.reading.noise),
        blur: partition.blur,
    })
}

/// Whether edges have another profile than area coverage: wider, or steeper with stains beyond.
fn is_soft(stained: f64, wobble: f64) -> bool {
    stained > tuning::SOFT_STAINED || wobble < -tuning::STEEP_WOBBLE && stained > tuning::DOUBTFUL_STAINED
}

impl core::fmt::Display for NoDrawing {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Partition(NoPartition::NotFlat { flat }) => {
                write!(f, "only {:.0} % of the picture are of flat colors", 100.0 * flat)
            }
            Self::Partition(NoPartition::Noisy) => write!(f, "the flat parts of the picture are noisy"),
            Self::Partition(NoPartition::TooManyColors) => {
                write!(f, "the picture has more than {} flat colors", tuning::MOST_COLORS)
            }
            Self::Partition(NoPartition::TooManyFaces { faces }) => {
                write!(f, "the picture would have {faces} faces, most of them smaller than noise can be told from")
            }
            Self::Soft { stained, .. } => {
                write!(f, "edges are soft: {:.0} % of the pixels beside them are stained", 100.0 * stained)
            }
        }
    }
}

impl core::error::Error for NoDrawing {}
