//! All numbers of a drawing together, by damped least squares on every mark of the boundary.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::shape::{Cap, Path, PathRing, Piece, Segment};
use dvp_core::{Shape as _, Vec2};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::border::Border;
use super::branch::BLOCK;
use super::center::run_together;
use super::draw::{Drawing, Foot, Line, gap};
use super::piece::pieces;
use crate::outline::{OutlineShape, Skyline};
use crate::ruler::Ruler;
use crate::tuning;

/// Most steps of the refinement.
const MOST_STEPS: usize = 8;
/// A step that lowers the sum of squares by less, per mark, ends it.
const LEAST_GAIN: f64 = 1e-3;
/// Price of ends and corners that do not go together, one drawing in sixteen.
const RARE_BITS: f64 = 5.0;
/// Step of differences, pixels.
const STEP: f64 = 1e-6;

/// A drawing as the marks want it.
#[derive(Debug)]
pub(super) struct Refined {
    pub(super) drawing: Drawing,
    /// Sum of squared misfits of the marks by their covariance; beyond [`tuning::OUTLINE_HUBER`] sigmas it grows linearly.
    pub(super) chi2: f64,
    /// Bits of the numbers, each given those before it.
    pub(super) bits: f64,
}

/// A mark and what it misses by.
struct Miss {
    mark: usize,
    gap: f64,
    line: usize,
    foot: Foot,
    /// Whether the window of the mark holds a corner: it tells of neither side.
    is_spoiled: bool,
}

impl Miss {
    /// In sigmas of the mark, and the weight of its square in a robust sum: none where it tells nothing.
    fn sigmas(&self, border: &Border) -> (f64, f64) {
        let sigmas = self.gap / border.marks[self.mark].sigma;
        let weight = if self.is_spoiled { 0.0 } else { (tuning::OUTLINE_HUBER / sigmas.abs()).min(1.0) };
        (sigmas, weight)
    }

    /// Its share of the robust sum of squares; as much as a good one is expected to miss by where it tells nothing.
    fn chi2(&self, border: &Border) -> f64 {
        if self.is_spoiled { 1.0 } else { huber(self.gap / border.marks[self.mark].sigma) }
    }
}

/// The drawing near this one that misses the marks least; none if nothing can be computed.
pub(super) fn refine(mut drawing: Drawing, border: &Border, offset: f64, ruler: &Ruler) -> Option<Refined> {
    let ridge = ruler.extent.max(1.0).powi(-2);
    let mut misses = misses(&drawing, border)?;
    let mut damping = 1e-3;
    let mut equations = equations(&drawing, border, &misses)?;
    for _ in 0..MOST_STEPS {
        let mut change = equations.1.clone();
        // What no mark holds moves by no more than a pixel or so.
        equations.0.factor(damping, 1.0)?.solve(&mut change);
        let then = moved(&drawing, &change).and_then(|drawing| Some((self::misses(&drawing, border)?, drawing)));
        let before = chi2(border, &misses);
        let Some((next, moved)) = then.filter(|(next, _)| chi2(border, next) < before) else {
            damping *= 10.0;
            if damping > 1e3 {
                break;
            }
            continue;
        };
        let gain = before - chi2(border, &next);
        (drawing, misses, damping) = (moved, next, damping * 0.1);
        equations = self::equations(&drawing, border, &misses)?;
        if gain < LEAST_GAIN * border.marks.len() as f64 {
            break;
        }
    }
    let bits = number_bits(&drawing, &equations.0.factor(0.0, ridge)?, ruler);
    // What is drawn in the end is measured whole, ends that other lines hide included.
    run_together(&mut drawing);
    let misses = self::misses(&drawing.uncovered(), border)?;
    Some(Refined { chi2: chi2_of_blocks(border, &misses, offset), bits, drawing })
}

/// Share of the marks that are further than `far` from what is drawn.
pub(super) fn strays(drawing: &Drawing, border: &Border, far: f64) -> f64 {
    let misses = misses(&drawing.uncovered(), border).unwrap_or_default();
    let strays = misses.iter().filter(|miss| miss.gap.abs() > far).count();
    if misses.is_empty() { 1.0 } else { strays as f64 / misses.len() as f64 }
}

fn misses(drawing: &Drawing, border: &Border) -> Option<Vec<Miss>> {
    let miss = |(mark, place): (usize, Vec2<f64>)| {
        let (line, reading) = drawing.reading(place)?;
        Some(Miss { mark, gap: reading.gap, line, foot: reading.foot, is_spoiled: reading.is_spoiled() })
    };
    border.marks.iter().map(|mark| mark.point).enumerate().map(miss).collect()
}

fn chi2(border: &Border, misses: &[Miss]) -> f64 {
    misses.iter().map(|miss| miss.chi2(border)).sum()
}

/// The same if marks side by side are off by something in common, of standard deviation `offset`, beside what each is off by itself.
fn chi2_of_blocks(border: &Border, misses: &[Miss], offset: f64) -> f64 {
    let stretches = misses.chunk_by(|a, b| a.line == b.line && a.foot.is_beside(b.foot));
    let blocks = stretches.flat_map(|stretch| stretch.chunks(BLOCK));
    let of_block = |block: &[Miss]| {
        let mut gaps: Vec<_> = block.iter().filter(|miss| !miss.is_spoiled).map(|miss| miss.gap).collect();
        let middle = gaps.len() / 2;
        let sigma = border.marks[block[block.len() / 2].mark].sigma;
        let share = gaps.len() as f64 * offset * offset / (gaps.len() as f64 * offset * offset + sigma * sigma);
        let common = if gaps.is_empty() { 0.0 } else { share * *gaps.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let singles = block.iter().map(|miss| Miss { gap: miss.gap - common, ..*miss }.chi2(border));
        singles.sum::<f64>() + huber(common / offset)
    };
    blocks.map(of_block).sum()
}

/// The share of a misfit of so many sigmas in a robust sum of squares.
fn huber(sigmas: f64) -> f64 {
    let weight = (tuning::OUTLINE_HUBER / sigmas.abs()).min(1.0);
    sigmas * sigmas * weight * (2.0 - weight)
}

/// The numbers of a line: those of its figure, or else of its ring.
fn numbers(line: &Line) -> Vec<f64> {
    line.figure.as_ref().and_then(OutlineShape::numbers).unwrap_or_else(|| {
        let mut numbers = Vec::new();
        Path { rings: vec![line.ring.clone()], ..Path::default() }.numbers(&mut numbers);
        numbers
    })
}

/// The line with other numbers.
fn with_numbers(line: &Line, numbers: &[f64]) -> Option<Line> {
    let (ring, figure) = ring_of(line, numbers)?;
    Some(line.with_ring(ring)?.with_figure(figure))
}

/// The ring of a line with other numbers, and the figure that it is, if it is one.
fn ring_of(line: &Line, numbers: &[f64]) -> Option<(PathRing<f64>, Option<OutlineShape>)> {
    if let Some(figure) = &line.figure {
        let figure = figure.with_numbers(numbers)?;
        return Some((figure.ring(), Some(figure)));
    }
    let mut path = Path { rings: vec![line.ring.clone()], ..Path::default() };
    path.set_numbers(numbers).ok()?;
    Some((path.rings.pop()?, None))
}

/// The drawing after a change of all numbers: those of its lines, and half the width.
fn moved(drawing: &Drawing, change: &[f64]) -> Option<Drawing> {
    let mut change = change.iter().copied();
    let mut lines = Vec::with_capacity(drawing.lines.len());
    for line in &drawing.lines {
        let mut numbers = numbers(line);
        numbers.iter_mut().zip(change.by_ref()).for_each(|(number, change)| *number += change);
        lines.push(with_numbers(line, &numbers)?);
    }
    let half_width = drawing.half_width + change.next()?;
    (half_width > 0.0).then_some(Drawing { lines, half_width, ..*drawing })
}

/// The normal equations and their right side.
fn equations(drawing: &Drawing, border: &Border, misses: &[Miss]) -> Option<(Skyline, Vec<f64>)> {
    let counts: Vec<_> = drawing.lines.iter().map(|line| numbers(line).len()).collect();
    let count = counts.iter().sum::<usize>() + 1;
    // Numbers of a line meet each other, and all of them the width.
    let mut firsts = Vec::with_capacity(count);
    for &own in &counts {
        firsts.extend(core::iter::repeat_n(firsts.len(), own));
    }
    firsts.push(0);
    let (mut normal, mut right) = (Skyline::new(firsts), vec![0.0; count]);
    let mut first = 0;
    for (index, line) in drawing.lines.iter().enumerate() {
        let own: Vec<_> = misses.iter().filter(|miss| miss.line == index).collect();
        let slopes = slopes(line, drawing.half_width, border, &own);
        for (miss, mut slopes) in own.into_iter().zip(slopes) {
            let sigma = border.marks[miss.mark].sigma;
            slopes.iter_mut().for_each(|entry| *entry = (first + entry.0, entry.1 / sigma));
            if !matches!(miss.foot, Foot::Face { .. }) {
                slopes.push((count - 1, -1.0 / sigma));
            }
            let (sigmas, weight) = miss.sigmas(border);
            normal.add_outer(&slopes, weight);
            slopes.iter().for_each(|&(place, slope)| right[place] -= weight * slope * sigmas);
        }
        first += counts[index];
    }
    right.iter().all(|value| value.is_finite()).then_some((normal, right))
}

/// How the gap of each mark beside a line changes with the line's numbers: numbers and slopes.
fn slopes(line: &Line, half: f64, border: &Border, misses: &[&Miss]) -> Vec<Vec<(usize, f64)>> {
    let mut slopes = vec![Vec::new(); misses.len()];
    let mut numbers = numbers(line);
    let measured = |pieces: &[Piece<f64>], miss: &Miss| gap(pieces, miss.foot, border.marks[miss.mark].point, half);
    let gaps: Vec<f64> = misses.iter().map(|miss| measured(&line.pieces, miss)).collect();
    for number in 0..numbers.len() {
        let old = numbers[number];
        numbers[number] = old + STEP;
        let moved = ring_of(line, &numbers).map(|(ring, _)| pieces(&ring));
        numbers[number] = old;
        let Some(moved) = moved.filter(|moved| moved.len() == line.pieces.len()) else { continue };
        let is_moved: Vec<_> = line.pieces.iter().zip(&moved).map(|(a, b)| a != b).collect();
        for ((slopes, miss), before) in slopes.iter_mut().zip(misses).zip(&gaps) {
            let piece = match miss.foot {
                Foot::Body { piece, .. } | Foot::Tangent { piece, .. } => piece,
                Foot::Face { at_finish } => {
                    if at_finish {
                        is_moved.len() - 1
                    } else {
                        0
                    }
                }
            };
            if is_moved.get(piece) == Some(&true) {
                slopes.push((number, (measured(&moved, miss) - before) / STEP));
            }
        }
    }
    slopes
}

/// Bits of all numbers: half the logarithm of the determinant of their inverse covariance, of those that can be seen.
fn number_bits(drawing: &Drawing, factor: &Skyline, ruler: &Ruler) -> f64 {
    let mut bits = 0.0;
    let mut roots = factor.diagonal();
    let mut price = |lever: f64| roots.next().map_or(0.0, |root| ruler.number(lever / root));
    for line in &drawing.lines {
        if let Some(numbers) = line.figure.as_ref().and_then(OutlineShape::numbers) {
            bits += tuning::OUTLINE_PIECE_BITS + numbers.iter().map(|_| price(1.0)).sum::<f64>();
            continue;
        }
        (0..2 * line.ring.points.len()).for_each(|_| bits += price(1.0));
        for (segment, piece) in line.ring.segments.iter().zip(&line.pieces) {
            bits += tuning::OUTLINE_PIECE_BITS;
            bits += match segment {
                Segment::Line | Segment::SmoothArc => 0.0,
                // A bulge moves the middle of its arc by half the chord.
                Segment::Arc { .. } => price(0.5 * (piece.to() - piece.from()).length()),
                Segment::Cubic { .. } => (0..4).map(|_| price(1.0)).sum(),
                Segment::SmoothCubic { .. } => (0..3).map(|_| price(1.0)).sum(),
            };
        }
    }
    // The width itself, which is twice the half; the cap is one of two, and round ends rarely come with sharp corners.
    let is_rare = drawing.lines.iter().all(|line| (line.cap == Cap::Round) == drawing.is_mitered);
    bits + price(2.0) + if is_rare { RARE_BITS } else { 1.0 }
}

/// The same drawing with the other kind of corners, if there are such and they do not speak clearly against it.
pub(super) fn other_join(drawing: &Drawing, border: &Border) -> Option<Drawing> {
    let sum = |drawing: &Drawing| misses(drawing, border).map_or(f64::INFINITY, |misses| chi2(border, &misses));
    let other = Drawing { is_mitered: !drawing.is_mitered, ..drawing.clone() };
    let (own, others) = (sum(drawing), sum(&other));
    ((own - others).abs() > 1e-6 && others < 2.0 * own).then_some(other)
}
