//! What a block transform coder (JPEG, ITU-T T.81) threw away, and so what a picture that it coded can say.
//!
//! JPEG writes the cosine transform of every 8 x 8 block in whole steps, coarse ones for fine detail. Any picture whose
//! coefficients round to the same steps gives the same file: a scene explains a coded picture if no coefficient of the
//! difference exceeds half a step. Halos, ringing and colors that bleed are inside of these intervals and need no object;
//! a faint object is not.
//!
//! The steps are found from the pixels: coefficients of luma are multiples of them. Tables: annex K of T.81, scaled by
//! quality as libjpeg does.

#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::{ImageView, Real};

/// Side of a block (px).
const SIDE: usize = 8;
const AREA: usize = SIDE * SIDE;
/// Side of what is coded together if chroma has half the resolution (px).
const UNIT: usize = 2 * SIDE;
/// Steps at quality 50, row by row.
#[rustfmt::skip]
const LUMA: [u8; AREA] = [
    16, 11, 10, 16, 24, 40, 51, 61,
    12, 12, 14, 19, 26, 58, 60, 55,
    14, 13, 16, 24, 40, 57, 69, 56,
    14, 17, 22, 29, 51, 87, 80, 62,
    18, 22, 37, 56, 68, 109, 103, 77,
    24, 35, 55, 64, 81, 104, 113, 92,
    49, 64, 78, 87, 103, 121, 120, 101,
    72, 92, 95, 98, 112, 100, 103, 99,
];
#[rustfmt::skip]
const CHROMA: [u8; AREA] = [
    17, 18, 24, 47, 99, 99, 99, 99,
    18, 21, 26, 66, 99, 99, 99, 99,
    24, 26, 56, 99, 99, 99, 99, 99,
    47, 66, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
    99, 99, 99, 99, 99, 99, 99, 99,
];
/// Qualities looked for, in percent.
const QUALITIES: core::ops::RangeInclusive<u16> = 10..=95;
/// Coefficients that tell the steps, at most and at least.
const MOST_WITNESSES: usize = 4096;
const LEAST_WITNESSES: usize = 16;
/// Smaller steps (of 8 bits) say nothing: any coefficient is near a multiple.
const LEAST_STEP: f64 = 6.0;
/// Rounding to 8 bits moves a coefficient by up to about this (steps of 8 bits, four standard deviations).
const ROUNDING: f64 = 0.8;
/// Share of the coefficients that are multiples, at least; clipping at black and white spoils some. The coarsest table
/// with nearly the most is the one: every other multiple of half a step is no multiple of the step.
const MULTIPLES: f64 = 0.7;
const NEARLY: f64 = 0.9;
/// Standard deviation of a coefficient of what an outline misses.
const MODEL_NOISE: f64 = 0.04;
/// A coefficient that is not explained may be written down as it is, for this and two bits per doubling of its steps.
const WRITTEN_BITS: f64 = 20.0;

/// The steps of a coder, in units of full contrast.
#[derive(Clone, Debug)]
pub(crate) struct BlockCode<T> {
    luma: [T; AREA],
    chroma: [T; AREA],
    /// Whether chroma has half the resolution.
    halved: bool,
    basis: Basis<T>,
}

/// Rows: the cosines of an orthonormal transform.
type Basis<T> = [[T; SIDE]; SIDE];

/// Bits of each unit of the rendering last asked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct CodeScratch<T> {
    rendered: Vec<T>,
    bits: Vec<f64>,
}

impl<T: Real> CodeScratch<T> {
    /// Forgets the last picture.
    pub(crate) fn forget(&mut self) {
        self.bits.clear();
    }
}

impl<T: Real> BlockCode<T> {
    /// The coder that wrote the picture, if there is one that could.
    pub(crate) fn of(image: &ImageView<'_, T>) -> Option<Self> {
        let basis = basis();
        let quality =
            [true, false].into_iter().find_map(|whole| quality(&witnesses(image, &basis, luma, whole), &LUMA))?;
        let of_chroma = [blue, red].map(|channel| witnesses(image, &basis, channel, true)).concat();
        let full = share(&of_chroma, &CHROMA, quality).is_some_and(|(share, _)| share >= MULTIPLES);
        let scaled = |table: &[u8; AREA]| table.map(|base| T::of(step(base, quality) / 255.0));
        Some(Self { luma: scaled(&LUMA), chroma: scaled(&CHROMA), halved: !full, basis })
    }

    /// Bits of what the rendering (planar) leaves of the picture beyond what the coder threw away.
    pub(crate) fn bits(&self, image: &ImageView<'_, T>, rendered: &[T], scratch: &mut CodeScratch<T>) -> f64 {
        let (width, height) = (image.size().width(), image.size().height());
        let [columns, rows] = [width, height].map(|side| side.div_ceil(UNIT));
        let known = scratch.bits.len() == columns * rows && scratch.rendered.len() == rendered.len();
        if !known {
            scratch.bits.clear();
            scratch.bits.resize(columns * rows, 0.0);
        }
        for (at, bits) in scratch.bits.iter_mut().enumerate() {
            let [left, top] = [at % columns * UNIT, at / columns * UNIT];
            let unit = [left, top];
            if !known || changed(&scratch.rendered, rendered, [width, height], unit) {
                *bits = self.unit_bits(image, rendered, unit);
            }
        }
        scratch.rendered.clear();
        scratch.rendered.extend_from_slice(rendered);
        scratch.bits.iter().sum()
    }

    fn unit_bits(&self, image: &ImageView<'_, T>, rendered: &[T], [left, top]: [usize; 2]) -> f64 {
        let (width, height) = (image.size().width(), image.size().height());
        let planes: [(&[T], &[T]); 3] =
            core::array::from_fn(|c| (image.channel(c), &rendered[c * width * height..(c + 1) * width * height]));
        // Luma and chroma of the difference; beyond the border it goes on as at the border, as coders have it.
        let mut difference = [[T::zero(); UNIT * UNIT]; 3];
        let [luma_plane, blue_plane, red_plane] = &mut difference;
        let pixels = luma_plane.iter_mut().zip(blue_plane.iter_mut()).zip(red_plane.iter_mut());
        for (i, ((luma_at, blue_at), red_at)) in pixels.enumerate() {
            let at = (top + i / UNIT).min(height - 1) * width + (left + i % UNIT).min(width - 1);
            let color = planes.map(|(image, rendered)| image[at] - rendered[at]);
            *luma_at = luma(color);
            *blue_at = blue(color);
            *red_at = red(color);
        }
        let mut bits = 0.0;
        for (c, plane) in difference.iter().enumerate() {
            let table = if c == 0 { &self.luma } else { &self.chroma };
            if c > 0 && self.halved {
                let quarter = T::of(0.25);
                let block = core::array::from_fn(|i| {
                    let at = 2 * (i / SIDE) * UNIT + 2 * (i % SIDE);
                    (plane[at] + plane[at + 1] + plane[at + UNIT] + plane[at + UNIT + 1]) * quarter
                });
                bits += self.block_bits(&block, table);
            } else {
                for start in [0, SIDE, SIDE * UNIT, SIDE * UNIT + SIDE] {
                    let block = core::array::from_fn(|i| plane[start + i / SIDE * UNIT + i % SIDE]);
                    bits += self.block_bits(&block, table);
                }
            }
        }
        bits
    }

    fn block_bits(&self, block: &[T; AREA], table: &[T; AREA]) -> f64 {
        let half = T::of(0.5);
        let scale = T::of(0.5 * core::f64::consts::LOG2_E / (MODEL_NOISE * MODEL_NOISE));
        let mut bits = T::zero();
        for (value, &step) in transform(&self.basis, block).into_iter().zip(table) {
            let excess = value.abs() - half * step;
            if excess > T::zero() {
                let written = T::of(WRITTEN_BITS) + T::of(2.0) * (value.abs() / step).max(T::one()).log2();
                bits += (scale * excess * excess).min(written);
            }
        }
        bits.as_f64()
    }
}

fn luma<T: Real>([r, g, b]: [T; 3]) -> T {
    T::of(0.299) * r + T::of(0.587) * g + T::of(0.114) * b
}

fn blue<T: Real>(color: [T; 3]) -> T {
    (color[2] - luma(color)) * T::of(1.0 / 1.772)
}

fn red<T: Real>(color: [T; 3]) -> T {
    (color[0] - luma(color)) * T::of(1.0 / 1.402)
}

/// Whether two renderings differ in the unit that starts at a pixel.
fn changed<T: Real>(old: &[T], new: &[T], [width, height]: [usize; 2], [left, top]: [usize; 2]) -> bool {
    let right = (left + UNIT).min(width);
    (0..3).any(|c| {
        (top..(top + UNIT).min(height)).any(|row| {
            let line = (c * height + row) * width + left..(c * height + row) * width + right;
            old[line.clone()] != new[line]
        })
    })
}

fn basis<T: Real>() -> Basis<T> {
    let side = f64::of_usize(SIDE);
    core::array::from_fn(|k| {
        let size = if k == 0 { 1.0 / side } else { 2.0 / side };
        let turn = core::f64::consts::PI * f64::of_usize(k) / side;
        core::array::from_fn(|i| T::of(size).sqrt() * T::of(turn * (f64::of_usize(i) + 0.5)).cos())
    })
}

/// The cosine transform of a block, orthonormal.
#[inline]
fn transform<T: Real>(basis: &Basis<T>, block: &[T; AREA]) -> [T; AREA] {
    let mut rows = [T::zero(); AREA];
    for (k, line) in rows.chunks_exact_mut(SIDE).enumerate() {
        for (&weight, source) in basis[k].iter().zip(block.chunks_exact(SIDE)) {
            for (sum, &value) in line.iter_mut().zip(source) {
                *sum += weight * value;
            }
        }
    }
    let mut out = [T::zero(); AREA];
    for (line, source) in out.chunks_exact_mut(SIDE).zip(rows.chunks_exact(SIDE)) {
        for (value, row) in line.iter_mut().zip(basis) {
            *value = row.iter().zip(source).map(|(&a, &b)| a * b).sum();
        }
    }
    out
}

/// Coefficients (steps of 8 bits) of a channel that are not small, with their places in a block; from blocks all over the
/// picture, or those that black and white cut nothing off. Means say nothing: they have an offset.
fn witnesses<T: Real>(
    image: &ImageView<'_, T>,
    basis: &Basis<T>,
    channel: impl Fn([T; 3]) -> T,
    whole: bool,
) -> Vec<(usize, f64)> {
    let width = image.size().width();
    let [columns, rows] = [width, image.size().height()].map(|side| side / SIDE);
    let mut found = Vec::new();
    let stride = 1 + columns * rows / MOST_WITNESSES;
    for at in (0..columns * rows).step_by(stride) {
        let first = at / columns * SIDE * width + at % columns * SIDE;
        let color = |i: usize| image.pixel(first + i / SIDE * width + i % SIDE);
        let is_cut = |color: [T; 3]| color.iter().any(|&value| value <= T::zero() || value >= T::one());
        if whole && (0..AREA).any(|i| is_cut(color(i))) {
            continue;
        }
        let block = core::array::from_fn(|i| channel(color(i)));
        let coefficients = transform(basis, &block).into_iter().enumerate().skip(1);
        let large = coefficients.map(|(place, value)| (place, 255.0 * value.as_f64()));
        found.extend(large.filter(|(_, value)| value.abs() > 0.5 * LEAST_STEP));
        if found.len() > MOST_WITNESSES {
            break;
        }
    }
    found
}

/// The step that libjpeg makes of a table's entry, in steps of 8 bits.
fn step(base: u8, quality: u16) -> f64 {
    let scale = if quality < 50 { 5000 / quality } else { 200 - 2 * quality };
    f64::from(((u16::from(base) * scale + 50) / 100).clamp(1, 255))
}

/// Share of the witnesses that are multiples of their steps, of those that say anything, and how many those are; none if
/// they are too few.
fn share(witnesses: &[(usize, f64)], table: &[u8; AREA], quality: u16) -> Option<(f64, usize)> {
    let (mut multiples, mut all) = (0, 0);
    for &(place, value) in witnesses {
        let step = step(table[place], quality);
        if step < LEAST_STEP {
            continue;
        }
        let count = num_traits::Float::round(value / step);
        all += 1;
        multiples += usize::from(count.abs() > 0.5 && (value - count * step).abs() <= ROUNDING);
    }
    (all >= LEAST_WITNESSES).then(|| (f64::of_usize(multiples) / f64::of_usize(all), all))
}

/// The coarsest quality whose steps explain nearly as many witnesses as any.
fn quality(witnesses: &[(usize, f64)], table: &[u8; AREA]) -> Option<u16> {
    let shares: Vec<(u16, f64)> =
        QUALITIES.filter_map(|quality| Some((quality, share(witnesses, table, quality)?.0))).collect();
    let best = shares.iter().map(|&(_, share)| share).fold(0.0, f64::max);
    let found = shares.iter().find(|&&(_, share)| share >= MULTIPLES.max(NEARLY * best));
    found.map(|&(quality, _)| quality)
}
