//! Lines in a picture, and taking them out of it.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::image::distance;

use super::flat::{Flats, Noise};
use super::{Color, Seam, ThinLine, chain, coded, cross, erase, mix, palette, seam, thin};
use crate::tuning;

/// Lines in a picture, and what is known of the pixels that they leave.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) lines: Vec<(ThinLine, chain::Chain)>,
    /// Pixels (ascending) that no mixture of flat colors nearby explains, and the colors of those that are flat.
    open: Vec<usize>,
    flat: Vec<u16>,
    /// Colors of flat pixels when the lines were found.
    palette: Vec<Color>,
    /// Pixels that were seams, which are others than before.
    pub(super) mended: Vec<Seam>,
    /// Of a channel, as [`cross::Canvas`] has them.
    noise: f64,
    contrast: f64,
}

impl Found {
    /// Mends seams, and finds lines up to some width, pixels.
    pub(super) fn of(
        pixels: &mut [[f32; 3]],
        size: [usize; 2],
        flats: &Flats,
        colors: &palette::Palette,
        noise: &Noise,
        widest: f64,
    ) -> Self {
        let flat = cross::thick(&flats.regions, size[0], &colors.of_region, widest as u16 + 1);
        let (contrast, white) =
            (noise.contrast, if noise.reading.coded { coded::weighted([1.0; 3]) } else { [1.0; 3] });
        let mut open = mix::open(pixels, size, &flat, &colors.colors, noise);
        let noise = f64::from(noise.mixed);
        let white = white.map(f64::from);
        let mended = seam::mend(pixels, size, &flat, &mut open, [&colors.colors, &[white]], noise);
        let canvas = cross::Canvas { pixels, size, flat: &flat, open: &open, noise, contrast, white, widest };
        let mut lines = thin::find(&canvas, &colors.colors);
        let ground = colors.colors[0];
        if widest > tuning::THIN_WIDTH {
            lines = thin::crossing_lines(lines, ground);
        }
        Self { lines, open, flat, palette: colors.colors.clone(), mended, noise, contrast }
    }

    /// The same without lines that may be gaps between things, through which what lies behind all shows: they lead to it, and are as wide as a pixel. None if
    /// there is no such line.
    pub(super) fn without_gaps(&self, size: [usize; 2]) -> Option<Self> {
        let is_gap = |(line, chain): &(ThinLine, chain::Chain)| {
            let leads_out = |[tip, out]: [Vec2<f64>; 2]| {
                (1..=tuning::GAP_REACH).any(|k| {
                    let [x, y] = (tip + out * k as f64).to_array().map(|at| at.max(0.0) as usize);
                    x < size[0] && y < size[1] && self.flat[y * size[0] + x] == 0
                })
            };
            let is_ground = distance(self.palette[0], line.color) <= self.noise;
            is_ground && !chain.is_closed && chain.width >= tuning::GAP_LEAST && chain.ends().into_iter().any(leads_out)
        };
        let lines: Vec<_> = self.lines.iter().filter(|line| !is_gap(line)).cloned().collect();
        (lines.len() < self.lines.len()).then(|| Self { lines, ..self.clone() })
    }

    /// Takes the lines out of the picture: them, and the pixels under which it says nothing.
    pub(super) fn erase(
        self,
        pixels: &mut [[f32; 3]],
        size: [usize; 2],
    ) -> (impl Iterator<Item = ThinLine>, Vec<usize>) {
        let Self { mut lines, open, flat, palette, noise, contrast, .. } = self;
        let known = flat.iter().map(|&color| color != u16::MAX).collect();
        let mut eraser = erase::Eraser { pixels, size, open: &open, known, palette: &palette, noise, contrast };
        let guessed = eraser.erase(&mut lines);
        (lines.into_iter().map(|(line, _)| line), guessed)
    }
}
