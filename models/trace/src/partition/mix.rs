//! Pixels that are in no flat block: mixtures of colors nearby.
//!
//! A pixel across an edge is a mixture of the two colors beside it, one at a junction of three. What no mixture of colors nearby
//! explains belongs to something thinner than a flat block: its color is one of the palette's, or a new one.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::image::{distance, mixture};

use super::Color;
use super::flat::{Flats, NONE, Noise};
use super::palette::Palette;
use super::runs::runs;
use crate::tuning;

/// The main color of every pixel.
#[derive(Debug)]
pub(super) struct Mixed {
    /// Index into `palette`.
    pub(super) colors: Vec<u16>,
    /// Share of that color; 1 for flat pixels.
    pub(super) shares: Vec<f32>,
    /// Whether the pixel is in a flat block.
    pub(super) is_flat: Vec<bool>,
    pub(super) palette: Vec<Color>,
    pub(super) unexplained: f64,
    /// Most difference of a channel from the mixture that explains a pixel.
    pub(super) noise: f64,
}

/// A mixture: the color of the largest share, that share, and what is left of the pixel, the most that a channel differs.
#[derive(Clone, Copy)]
pub(super) struct Mixture {
    pub(super) color: u16,
    pub(super) share: f64,
    pub(super) misfit: f64,
}

/// How far (pixels) from a mixed pixel the colors that it is made of are looked for; and again where these do not explain it, since
/// coders stain further, and blur further still.
const REACH: [usize; 3] = [2, tuning::CODED_REACH, tuning::SOFT_REACH];

pub(super) fn explain(pixels: &[[f32; 3]], size: [usize; 2], flats: &Flats, palette: Palette, noise: &Noise) -> Mixed {
    let of_region: Vec<u16> = palette.of_region.iter().map(|&color| narrow(color)).collect();
    let mut mixed = Mixed {
        colors: vec![u16::MAX; pixels.len()],
        shares: vec![1.0; pixels.len()],
        is_flat: vec![false; pixels.len()],
        palette: palette.colors,
        unexplained: 0.0,
        noise: f64::from(noise.mixed),
    };
    for (region, pixels) in runs(&flats.regions).filter(|&(region, _)| region != NONE) {
        mixed.colors[pixels.clone()].fill(of_region[region as usize]);
        mixed.is_flat[pixels].fill(true);
    }
    let flat_colors = mixed.colors.clone();
    let mut open = Vec::new();
    let mut near = Vec::new();
    for i in runs(&flats.regions).filter(|&(region, _)| region == NONE).flat_map(|(_, pixels)| pixels) {
        let best = REACH[..noise.reaches()].iter().find_map(|&reach| {
            colors_near(&flat_colors, size, (i, reach), &mut near);
            let best = best_mixture(pixels[i].map(f64::from), &near, &mixed.palette);
            best.filter(|best| best.misfit <= mixed.noise)
        });
        match best {
            Some(best) => mixed.give(i, best),
            None => open.push(i),
        }
    }
    mixed.explain_thin(pixels, size, &flat_colors, (noise.contrast, noise.fewest), &mut open);
    for &i in &open {
        let all: Vec<u16> = (0..mixed.palette.len()).map(narrow).collect();
        if let Some(best) = best_mixture(pixels[i].map(f64::from), &all, &mixed.palette) {
            mixed.give(i, best);
        }
    }
    mixed.unexplained = open.len() as f64 / pixels.len() as f64;
    mixed
}

impl Mixed {
    fn give(&mut self, i: usize, mixture: Mixture) {
        self.colors[i] = mixture.color;
        self.shares[i] = mixture.share as f32;
    }

    /// Explains the pixels of `open` as mixtures of a color nearby and any other, new ones included; what is left stays in `open`.
    fn explain_thin(
        &mut self,
        pixels: &[[f32; 3]],
        size: [usize; 2],
        flat_colors: &[u16],
        (contrast, fewest): (f64, usize),
        open: &mut Vec<usize>,
    ) {
        let mut near = Vec::new();
        let mut tried_from = 0;
        let mut given_up = Vec::new();
        loop {
            let count = self.palette.len();
            let mut left = Vec::new();
            let mut extreme: Option<(f64, usize)> = None;
            for &i in open.iter() {
                let pixel = pixels[i].map(f64::from);
                colors_near(flat_colors, size, (i, REACH[0]), &mut near);
                if near.is_empty() {
                    near.extend((0..tried_from.max(1).min(count)).map(narrow));
                }
                let bases = near.clone();
                let others = (tried_from..count).map(narrow);
                let mut best: Option<Mixture> = None;
                for other in others {
                    for &base in bases.iter().filter(|&&base| base != other) {
                        let mixture = pair(pixel, base, other, &self.palette);
                        if best.is_none_or(|best| mixture.misfit < best.misfit) {
                            best = Some(mixture);
                        }
                    }
                }
                // A sliver of a color between two others: of a known one, or every such row would make a color of its own.
                if tried_from == 0 && best.is_none_or(|best| best.misfit > self.noise) {
                    let colors = bases.iter().enumerate().flat_map(|(k, &a)| bases[..k].iter().map(move |&b| [a, b]));
                    for ([a, b], c) in colors.flat_map(|two| (0..count).map(move |other| (two, narrow(other)))) {
                        if c != a
                            && c != b
                            && let Some(mixture) = triple(pixel, [a, b, c], &self.palette)
                            && best.is_none_or(|best| mixture.misfit < best.misfit)
                        {
                            best = Some(mixture);
                        }
                    }
                    // What the border cuts off may show any two of them.
                    if is_cut_off(pixels, size, i, self.noise)
                        && let Some(mixture) = best_pair(pixel, &self.palette)
                        && best.is_none_or(|best| mixture.misfit < best.misfit)
                    {
                        best = Some(mixture);
                    }
                }
                if let Some(best) = best.filter(|best| best.misfit <= self.noise) {
                    self.give(i, best);
                    continue;
                }
                left.push(i);
                let away =
                    bases.iter().map(|&k| distance(self.palette[k as usize], pixel)).fold(f64::INFINITY, f64::min);
                if extreme.is_none_or(|(most, _)| away > most) {
                    extreme = Some((away, i));
                }
            }
            let progressed = left.len() < open.len();
            *open = left;
            let Some((away, i)) = extreme else { break };
            if away <= contrast || (!progressed && tried_from > 0 && open.len() < fewest) {
                break;
            }
            if self.palette.len() >= tuning::MOST_COLORS {
                break;
            }
            tried_from = self.palette.len();
            self.palette.push(pixels[i].map(f64::from));
            // A color that explains its own pixel alone is a mixture of what is not known.
            let added = narrow(tried_from);
            let is_of = |&&j: &&usize| {
                colors_near(flat_colors, size, (j, REACH[0]), &mut near);
                let pixel = pixels[j].map(f64::from);
                near.iter().any(|&base| pair(pixel, base, added, &self.palette).misfit <= self.noise)
                    || distance(self.palette[tried_from], pixel) <= self.noise
            };
            if open.iter().filter(is_of).take(fewest).count() < fewest {
                self.palette.pop();
                open.retain(|&j| j != i);
                given_up.push(i);
            }
        }
        open.extend(given_up);
    }
}

/// The best explanation by one, two or three of some colors.
pub(super) fn best_mixture(pixel: Color, colors: &[u16], palette: &[Color]) -> Option<Mixture> {
    let one = |&color: &u16| Mixture { color, share: 1.0, misfit: distance(palette[color as usize], pixel) };
    let mut best = colors.iter().map(one).min_by(|a, b| a.misfit.total_cmp(&b.misfit))?;
    for (k, &a) in colors.iter().enumerate() {
        for &b in &colors[..k] {
            let mixture = pair(pixel, a, b, palette);
            if mixture.misfit < best.misfit {
                best = mixture;
            }
        }
    }
    if (3..=tuning::MOST_OF_THREE).contains(&colors.len()) && best.misfit > tuning::LEAST_CONTRAST / 2.0 {
        for (k, &a) in colors.iter().enumerate() {
            for (l, &b) in colors[..k].iter().enumerate() {
                for &c in &colors[..l] {
                    if let Some(mixture) = triple(pixel, [a, b, c], palette)
                        && mixture.misfit < best.misfit / 2.0
                    {
                        best = mixture;
                    }
                }
            }
        }
    }
    Some(best)
}

/// Whether a pixel lies at a border of the picture that has its color in a part, at most: what goes along all of a border is a line.
fn is_cut_off(pixels: &[[f32; 3]], [width, height]: [usize; 2], i: usize, noise: f64) -> bool {
    let [x, y] = [i % width, i / width];
    let color = pixels[i].map(f64::from);
    let is_part = |first: usize, step: usize, side: usize| {
        let border = pixels[first..].iter().step_by(step).take(side);
        4 * border.filter(|pixel| distance(pixel.map(f64::from), color) <= noise).count() <= 3 * side
    };
    (y == 0 || y + 1 == height) && is_part(y * width, 1, width)
        || (x == 0 || x + 1 == width) && is_part(x, width, height)
}

/// A pixel as a mixture of any two colors.
fn best_pair(pixel: Color, palette: &[Color]) -> Option<Mixture> {
    let pairs = (0..palette.len()).flat_map(|a| (0..a).map(move |b| pair(pixel, narrow(a), narrow(b), palette)));
    pairs.min_by(|a, b| a.misfit.total_cmp(&b.misfit))
}

/// A pixel as a mixture of two colors.
fn pair(pixel: Color, a: u16, b: u16, palette: &[Color]) -> Mixture {
    let (share, misfit) = mixture(pixel, palette[a as usize], palette[b as usize]);
    if share > 0.5 { Mixture { color: b, share, misfit } } else { Mixture { color: a, share: 1.0 - share, misfit } }
}

/// A pixel as a mixture of three colors; none if they lie on a line or a share is negative.
fn triple(pixel: Color, colors: [u16; 3], palette: &[Color]) -> Option<Mixture> {
    let [a, b, c] = colors.map(|k| palette[k as usize]);
    let minus = |p: Color, q: Color| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let dot = |p: Color, q: Color| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (u, v, w) = (minus(b, a), minus(c, a), minus(pixel, a));
    let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
    let determinant = uu * vv - uv * uv;
    if determinant <= 1e-4 * uu * vv {
        return None;
    }
    let s = (dot(u, w) * vv - dot(v, w) * uv) / determinant;
    let t = (dot(v, w) * uu - dot(u, w) * uv) / determinant;
    let shares = [1.0 - s - t, s, t];
    if shares.iter().any(|&share| share < 0.0) {
        return None;
    }
    let misfit = (0..3).map(|k| (w[k] - s * u[k] - t * v[k]).abs()).fold(0.0, f64::max);
    let most = (0..3).max_by(|&k, &l| shares[k].total_cmp(&shares[l]))?;
    Some(Mixture { color: colors[most], share: shares[most], misfit })
}

/// A list of colors, used again and again.
#[derive(Debug, Default)]
pub(super) struct Near(Vec<u16>);

impl Near {
    /// The colors of flat pixels within reach of pixel `i`.
    pub(super) fn around(&mut self, flat_colors: &[u16], size: [usize; 2], i: usize) -> &[u16] {
        self.within(REACH[0], flat_colors, size, i)
    }

    fn within(&mut self, reach: usize, flat_colors: &[u16], size: [usize; 2], i: usize) -> &[u16] {
        colors_near(flat_colors, size, (i, reach), &mut self.0);
        &self.0
    }
}

/// The pixels, ascending, that no mixture of flat colors nearby explains.
pub(super) fn open(
    pixels: &[[f32; 3]],
    size: [usize; 2],
    flat_colors: &[u16],
    palette: &[Color],
    noise: &Noise,
) -> Vec<usize> {
    let mut near = Near::default();
    let is_open = |&i: &usize| -> bool {
        let mut is_left = |&reach: &usize| {
            best_mixture(pixels[i].map(f64::from), near.within(reach, flat_colors, size, i), palette)
                .is_none_or(|best| best.misfit > f64::from(noise.mixed))
        };
        flat_colors[i] == u16::MAX && REACH[..noise.reaches()].iter().all(&mut is_left)
    };
    (0..pixels.len()).filter(is_open).collect()
}

fn colors_near(flat_colors: &[u16], [width, height]: [usize; 2], (i, reach): (usize, usize), near: &mut Vec<u16>) {
    let (x, y) = (i % width, i / width);
    near.clear();
    for row in y.saturating_sub(reach)..(y + reach + 1).min(height) {
        for &color in &flat_colors[row * width + x.saturating_sub(reach)..row * width + (x + reach + 1).min(width)] {
            if color != u16::MAX && !near.contains(&color) {
                near.push(color);
            }
        }
    }
}

/// An index into the palette, which is short.
pub(super) fn narrow(color: usize) -> u16 {
    u16::try_from(color).unwrap_or(u16::MAX)
}
