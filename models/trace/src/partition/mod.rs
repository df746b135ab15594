//! Pixels to faces: which color each pixel belongs to, and by how much.
//!
//! Every pixel is pure (of one face) or mixed (of two, rarely three, with shares). `flat` finds what is of one color beyond doubt,
//! `palette` the colors, `mix` explains every other pixel as a mixture of colors nearby, `faces` joins pixels to faces.

mod faces;
mod flat;
mod mix;
mod palette;

use alloc::vec::Vec;

use dvp_core::ImageView;

pub use faces::Face;
pub(crate) use mix::coverage;

/// Colors as the picture stores them, RGB.
pub type Color = [f64; 3];

/// Marks a pixel of no face, and what lies beyond the border.
pub const OUTSIDE: u32 = u32::MAX;

/// A picture as faces of one color.
#[derive(Clone, Debug)]
pub struct Partition {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Color of every pixel, row by row.
    pub pixels: Vec<[f32; 3]>,
    /// Face of every pixel: an index into `faces`.
    pub labels: Vec<u32>,
    /// Share of a pixel that is of its own face's color, as far as that can be told; 1 for pure ones.
    pub shares: Vec<f32>,
    /// What the picture is made of.
    pub faces: Vec<Face>,
    /// The colors; faces name one of them.
    pub palette: Vec<Color>,
    /// Most difference of a channel between a pixel and the mixture that explains it.
    pub mix_noise: f64,
    /// Whether edges are steps from pixel to pixel, without mixtures: boundaries are then known no better than the cracks between pixels.
    pub is_hard: bool,
    /// Share of the pixels that no mixture of the palette explains, [0, 1].
    pub unexplained: f64,
}

/// Why a picture was not cut into faces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoPartition {
    /// So little of it is of one color that it is no drawing.
    NotFlat {
        /// Share of the pixels that belong to a flat face.
        flat: f64,
    },
    /// More colors than drawings have.
    TooManyColors,
}

impl Partition {
    /// Cuts a picture into faces.
    ///
    /// # Errors
    /// [`NoPartition`] if it is no drawing of flat colors.
    pub fn of(image: &ImageView<'_, f32>) -> Result<Self, NoPartition> {
        let size = [image.size().width(), image.size().height()];
        let pixels: Vec<[f32; 3]> = (0..image.size().pixels()).map(|i| image.pixel(i)).collect();
        let noise = flat::Noise::of(&pixels, size);
        let flats = flat::find(&pixels, size, &noise);
        let share = flats.pure_count() as f64 / pixels.len() as f64;
        if share < crate::tuning::LEAST_FLAT {
            return Err(NoPartition::NotFlat { flat: share });
        }
        let colors = palette::Palette::of(&flats, &noise)?;
        let mixed = mix::explain(&pixels, size, &flats, colors, &noise);
        Ok(faces::cut(size, pixels, mixed))
    }

    /// Color of a face.
    #[must_use]
    pub fn color(&self, face: u32) -> Color {
        self.palette[self.faces[face as usize].color]
    }

    /// Face of a pixel; [`OUTSIDE`] beyond the border.
    #[inline]
    #[must_use]
    pub fn face_at(&self, [x, y]: [usize; 2]) -> u32 {
        if x < self.size[0] && y < self.size[1] { self.labels[y * self.size[0] + x] } else { OUTSIDE }
    }
}
