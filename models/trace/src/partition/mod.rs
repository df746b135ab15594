//! Pixels to faces: which color each pixel belongs to, and by how much.
//!
//! Every pixel is pure (of one face) or mixed (of two, rarely three, with shares). `flat` finds what is of one color beyond doubt,
//! `palette` the colors, `seam` mends what renderers let through between things side by side, `thin` (windows of `cross`, colors of `ink`
//! and, where windows side by side tell better, of `shade`, joined by `chain`, and by `pair` where two lines fill a window; all `found`
//! together) finds and `erase` takes out lines without a pixel of their own (`sliver` puts some back), `mix` explains every other pixel as
//! a mixture of colors nearby, `faces` joins pixels to faces, but not across the corners of `checker`. `runs` are what all read instead
//! of single pixels. Of squares and regions every pixel is `pure`.

mod chain;
mod checker;
mod clipped;
mod coded;
mod cross;
mod erase;
mod faces;
mod flat;
mod found;
mod ink;
mod mix;
mod pair;
mod palette;
mod pure;
mod runs;
mod seam;
mod shade;
mod sliver;
#[cfg(test)]
mod tests;
mod thin;

use alloc::vec::Vec;

use dvp_core::ImageView;
use dvp_core::image::distance;

use crate::regions::Regions;
use crate::tuning;

pub use faces::Face;
use flat::Noise;
use found::Found;
pub(crate) use seam::{BEHIND, Seam};
pub use thin::ThinLine;

/// Colors as the picture stores them, RGB.
pub type Color = [f64; 3];

/// Marks a pixel of no face, and what lies beyond the border.
pub const OUTSIDE: u32 = u32::MAX;

/// A picture as faces of one color.
#[derive(Clone, Debug)]
pub struct Partition {
    /// Columns and rows.
    pub size: [usize; 2],
    /// Color of every pixel, row by row; of a coded picture weighted, as `palette` is.
    pub pixels: Vec<[f32; 3]>,
    /// Face of every pixel: an index into `faces`.
    pub labels: Vec<u32>,
    /// Share of a pixel that is of its own face's color, as far as that can be told; 1 for pure ones.
    pub shares: Vec<f32>,
    /// What the picture is made of.
    pub faces: Vec<Face>,
    /// Lines that were taken out before the cut.
    pub lines: Vec<ThinLine>,
    /// Pixels under lines that were taken out which say nothing of what lies there, and are as what is nearest.
    pub(crate) guessed: Vec<usize>,
    /// Pixels (ascending) where two things that lie edge to edge let through what is behind both; none of pictures that went through a coder.
    pub(crate) seams: Vec<Seam>,
    /// Lines that are faces.
    pub(crate) slivers: Vec<sliver::Sliver>,
    /// The colors; faces name one of them. [`Self::rgb`] makes colors of them.
    pub palette: Vec<Color>,
    /// How the picture was read.
    pub reading: Reading,
    /// Blocks of two by two pixels that differ a little, or values that turn back by a little, whichever is less, per block that differs much:
    /// what coders and filters leave beside edges. 0 where it was not counted.
    pub(crate) ripple: f64,
    /// Standard deviation of the blur of its edges, pixels; 0 where it was not looked for.
    pub blur: f64,
    /// Most difference of a channel between a pixel and the mixture that explains it.
    pub mix_noise: f64,
    /// Standard deviation of a channel in a pixel of an edge.
    pub sigma: f64,
    /// Whether edges are steps from pixel to pixel, without mixtures: boundaries are then known no better than the cracks between pixels.
    pub is_hard: bool,
    /// Share of the pixels that no mixture of the palette explains, [0, 1].
    pub unexplained: f64,
}

/// How a picture is read: what was done to it after it was drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Reading {
    /// Whether a coder of photographs (JPEG) has changed its pixels.
    pub coded: bool,
    /// Standard deviation of a channel that was averaged away before.
    pub noise: f32,
    /// Whether its edges may be wider than those of area coverage.
    pub soft: bool,
    /// Whether it is made of squares of one color: see [`Known`](crate::Known).
    pub squares: bool,
    /// Whether its colors are those of regions that a picture which is not flat was cut into: no pixel is mixed, but boundaries lie about there only.
    pub regions: bool,
}

impl Reading {
    /// Whether something was, or may have been, done to the picture after it was drawn.
    fn is_spoiled(self) -> bool {
        self.coded || self.soft || self.noise > 0.0
    }

    /// The same, changed by a coder of photographs or not.
    #[must_use]
    pub fn with_coded(self, coded: bool) -> Self {
        Self { coded, ..self }
    }
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
    /// Its flat parts are noisy.
    Noisy,
    /// More colors than drawings have.
    TooManyColors,
    /// More faces than can be told from what was done to it since it was drawn.
    TooManyFaces {
        /// How many it has.
        faces: usize,
    },
}

impl Partition {
    /// Cuts a picture into faces.
    ///
    /// # Errors
    /// [`NoPartition`] if it is no drawing of flat colors.
    pub fn of(image: &ImageView<'_, f32>, reading: Reading) -> Result<Self, NoPartition> {
        Ok(Self::readings(image, reading)?.0)
    }

    /// An error if it has more faces than can be told in a picture that something was done to: what is smaller than the windows that noise is averaged
    /// over is noise, or a part of a photograph, for the most part. As many as a drawing may have colors are not too many. `texture`: what was averaged
    /// away, in units of the noise.
    pub(crate) fn check_faces(&self, texture: usize) -> Result<(), NoPartition> {
        let window = (2 * tuning::DENOISE_REACH + 1).pow(2) * texture;
        let faces = self.faces.len();
        let has_too_many = self.reading.is_spoiled() && faces > tuning::MOST_COLORS.max(self.pixels.len() / window);
        if has_too_many { Err(NoPartition::TooManyFaces { faces }) } else { Ok(()) }
    }

    /// Whether a face has one of the eight colors of which every channel is none or full, as black and white are: many things do.
    pub(crate) fn is_plain(&self, face: u32) -> bool {
        let is_end = |value: f64| value.min(1.0 - value) <= self.mix_noise;
        self.rgb(self.color(face)).into_iter().all(is_end)
    }

    /// Whether pixels beside an edge that show no mixture have the edge exactly between them.
    pub(crate) fn has_exact_edges(&self) -> bool {
        !(self.is_hard || self.reading.is_spoiled())
    }

    /// The ways to cut a picture into faces: lines that cross taken out of it, and, if there are such with pixels of their own, as faces; and lines
    /// that what lies behind may show through as gaps.
    ///
    /// # Errors
    /// As [`Self::of`].
    #[inline(never)]
    pub fn readings(image: &ImageView<'_, f32>, reading: Reading) -> Result<(Self, Vec<Self>), NoPartition> {
        let size = [image.size().width(), image.size().height()];
        let [red, green, blue] = [0, 1, 2].map(|c| image.channel(c));
        let mut pixels: Vec<[f32; 3]> =
            red.iter().zip(green).zip(blue).map(|((&red, &green), &blue)| [red, green, blue]).collect();
        let noise = Noise::of(reading);
        if reading.squares {
            let mixed = pure::mixed(&pixels, &noise, tuning::MOST_COLORS)?;
            return Ok((Self { reading, sigma: noise.sigma, ..faces::cut(size, pixels, mixed, true) }, Vec::new()));
        }
        let weighted = |pixels: &mut [[f32; 3]]| pixels.iter_mut().for_each(|pixel| *pixel = coded::weighted(*pixel));
        if reading.coded {
            weighted(&mut pixels);
        }
        let find = |pixels: &[[f32; 3]]| {
            let mut flats = flat::find(pixels, size, &noise);
            if reading.coded {
                coded::part(pixels, size, &mut flats, &noise);
                coded::dissolve(pixels, size, &mut flats);
            }
            flats
        };
        let mut flats = find(&pixels);
        let ripple = if noise.is_clean() { flats.ripple(&pixels, size)? } else { 0.0 };
        let share = flats.pure_count() as f64 / pixels.len() as f64;
        if share < tuning::LEAST_FLAT {
            return Err(NoPartition::NotFlat { flat: share });
        }
        let mut colors = palette::Palette::of(&flats, &noise)?;
        let finish = |pixels: Vec<[f32; 3]>, flats: &flat::Flats, colors, lines, mut seams: Vec<Seam>| {
            seams.sort_unstable_by_key(|seam| seam.pixel);
            let mixed = mix::explain(&pixels, size, flats, colors, &noise);
            let mut cut = Self {
                reading,
                ripple,
                sigma: noise.sigma,
                lines,
                seams,
                ..faces::cut(size, pixels, mixed, reading.squares)
            };
            if reading.coded {
                coded::color_patterns(&mut cut);
            }
            cut
        };
        let mut lines = Vec::new();
        let mut seams = Vec::new();
        let mut others = Vec::new();
        let mut guessed = Vec::new();
        for widest in [tuning::THIN_WIDTH, tuning::CROSSING_WIDTH] {
            // Lines that cross have two colors, and lie on a third.
            if widest > tuning::THIN_WIDTH && colors.colors.len() < 3 {
                continue;
            }
            let found = Found::of(&mut pixels, size, &flats, &colors, &noise, widest);
            if !found.mended.is_empty() {
                // What a coder leaves along edges is as much as what shows through.
                if !reading.coded {
                    seams.extend(&found.mended);
                }
                if found.mended.iter().any(|seam| flat::is_flat_at(&pixels, size, &noise, seam.pixel as usize)) {
                    flats = find(&pixels);
                    colors = palette::Palette::of(&flats, &noise)?;
                }
            }
            if widest > tuning::THIN_WIDTH && !found.lines.is_empty() {
                others.push(finish(pixels.clone(), &flats, colors.clone(), lines.clone(), seams.clone()));
            }
            if widest == tuning::THIN_WIDTH
                && let Some(rest) = found.without_gaps(size)
            {
                let mut pixels = pixels.clone();
                let (lines, guessed) = rest.erase(&mut pixels, size);
                let lines = lines.collect();
                let flats = find(&pixels);
                if let Ok(colors) = palette::Palette::of(&flats, &noise) {
                    others.push(Self { guessed, ..finish(pixels, &flats, colors, lines, seams.clone()) });
                }
            }
            if !found.lines.is_empty() {
                // Wide lines may pass under thin ones.
                let (erased, holes) = found.erase(&mut pixels, size);
                lines.splice(0..0, erased);
                guessed.extend(holes);
                flats = find(&pixels);
                colors = palette::Palette::of(&flats, &noise)?;
            }
        }
        Ok((Self { guessed, ..finish(pixels, &flats, colors, lines, seams) }, others))
    }

    /// The regions that a picture was cut into.
    ///
    /// # Errors
    /// [`NoPartition::TooManyColors`] if there are 2^16 regions or more.
    pub fn of_regions(regions: &Regions) -> Result<Self, NoPartition> {
        let (image, reading) = (regions.image.view(), Reading { regions: true, ..Reading::default() });
        let size = [image.size().width(), image.size().height()];
        let pixels: Vec<[f32; 3]> = (0..image.size().pixels()).map(|i| image.pixel(i)).collect();
        let mixed = pure::mixed(&pixels, &Noise::of(reading), usize::from(u16::MAX))?;
        Ok(Self { reading, is_hard: true, ..faces::cut(size, pixels, mixed, false) })
    }

    /// Color of a face.
    #[must_use]
    pub fn color(&self, face: u32) -> Color {
        self.palette[self.faces[face as usize].color]
    }

    /// Blocks of two by two pixels that are of one color in another reading of the picture, but of a color here that differs by more than coders make
    /// of it. Rims beside edges, which are a pixel wide, have none.
    pub(crate) fn lost_blocks(&self, other: &Self) -> usize {
        let colors = |of: &Self| of.faces.iter().map(|face| of.rgb(of.palette[face.color])).collect::<Vec<_>>();
        let [here, there] = [self, other].map(colors);
        let is_lost = |i: usize| {
            let [here, there] = [here.get(self.labels[i] as usize), there.get(other.labels[i] as usize)];
            let differ = |(here, there): (&Color, &Color)| distance(*here, *there) > tuning::CODED_CONTRAST;
            other.shares[i] >= tuning::PURE_SHARE && here.zip(there).is_some_and(differ)
        };
        let [width, height] = self.size;
        let corners = (1..height).flat_map(|y| (1..width).map(move |x| y * width + x));
        corners.filter(|&i| [i, i - 1, i - width, i - width - 1].into_iter().all(is_lost)).count()
    }

    /// What a pixel (its index) shows of what is behind two things that lie edge to edge, if it does.
    pub(crate) fn seam(&self, pixel: usize) -> Option<Seam> {
        let at = self.seams.binary_search_by_key(&pixel, |seam| seam.pixel as usize).ok()?;
        Some(self.seams[at])
    }

    /// A color of the palette, or of a line, as the picture stores it.
    #[must_use]
    pub fn rgb(&self, color: Color) -> Color {
        match self.reading.noise {
            _ if self.reading.coded => coded::as_rgb(color),
            noise if noise > 0.0 => color.map(|mean| clipped::level(mean, f64::from(noise))),
            _ => color,
        }
    }

    /// A color that the picture stores as its palette has it.
    #[must_use]
    pub fn as_palette(&self, rgb: Color) -> Color {
        if self.reading.coded { coded::weighted(rgb.map(|value| value as f32)).map(f64::from) } else { rgb }
    }

    /// Face of a pixel; [`OUTSIDE`] beyond the border.
    #[inline]
    #[must_use]
    pub fn face_at(&self, [x, y]: [usize; 2]) -> u32 {
        if x < self.size[0] && y < self.size[1] { self.labels[y * self.size[0] + x] } else { OUTSIDE }
    }
}
