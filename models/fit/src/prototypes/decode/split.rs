//! Several objects of one color that have run together.
//!
//! Pieces are taken off one after the other: one of them covers the first pixel, so every prototype is laid upright wherever it covers that
//! pixel and nothing but the part, and what is left is explained in turn. Pieces are taken to be of one area: what the part is made of.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::demand::{Demand, covered};
use super::flat::{FlatPicture, Part};
use super::search::{Effort, Posed, Shapes};
use crate::pose::gauss_newton::PosePx;

/// Most pieces of a part.
const MOST_PIECES: usize = 3;
/// Share of the area of a piece that may be wrong.
const TOLERANCE: f64 = 0.02;
/// Sizes of pieces, relative to what a part of so many equal ones gives, that are tried.
const LEAST_AREA_PX: f64 = 20.0;

/// The fewest pieces that explain a part; none if up to three do not.
pub(super) fn split(picture: &FlatPicture, part: &[usize], shapes: &Shapes) -> Option<Vec<(Part, Posed)>> {
    (2..=MOST_PIECES).find_map(|pieces| {
        let area = f64::of_usize(part.len()) / f64::of_usize(pieces);
        if area < LEAST_AREA_PX { None } else { taken_off(picture, part.to_vec(), area, pieces, shapes) }
    })
}

/// Whether a pose explains its pixels.
pub(super) fn explains(posed: &Posed, area: f64) -> bool {
    f64::of_usize(posed.verdict.wrong) <= (TOLERANCE * area).max(1.0)
}

fn taken_off(
    picture: &FlatPicture,
    part: Part,
    area: f64,
    pieces: usize,
    shapes: &Shapes,
) -> Option<Vec<(Part, Posed)>> {
    if pieces == 1 {
        let demand = Demand::new(picture, &part);
        let posed = shapes.best(&demand, Effort::Usual).filter(|posed| explains(posed, area))?;
        return Some(vec![(part, posed)]);
    }
    let first = *part.iter().min()?;
    let mut is_part = vec![false; picture.color_of.len()];
    part.iter().for_each(|&pixel| is_part[pixel] = true);
    for prototype in 0..shapes.count() {
        for pose in poses(picture, first, prototype, area, shapes) {
            let field = shapes.field(prototype);
            let piece = covered(picture, &pose, field);
            // Ground must not be covered, nor what shows another color: a piece that lies behind is explained otherwise.
            let beside = piece.iter().filter(|&&pixel| !is_part[pixel]).count();
            if f64::of_usize(beside) > TOLERANCE * area || !piece.contains(&first) {
                continue;
            }
            let mut is_left = is_part.clone();
            piece.iter().for_each(|&pixel| is_left[pixel] = false);
            let left: Part = part.iter().copied().filter(|&pixel| is_left[pixel]).collect();
            let rest = f64::of_usize(pieces - 1) * area;
            if (f64::of_usize(left.len()) - rest).abs() > 2.0 * TOLERANCE * rest {
                continue;
            }
            let own: Part = piece.into_iter().filter(|&pixel| is_part[pixel]).collect();
            let demand = Demand::new(picture, &own);
            let posed = shapes.refined(prototype, pose, &demand);
            if !explains(&posed, area) {
                continue;
            }
            if let Some(mut found) = taken_off(picture, left, area, pieces - 1, shapes) {
                found.push((own, posed));
                return Some(found);
            }
        }
    }
    None
}

/// Upright poses of a prototype that may cover a pixel which is the upper left one of a part: its box at whole pixels.
fn poses(
    picture: &FlatPicture,
    first: usize,
    prototype: usize,
    area: f64,
    shapes: &Shapes,
) -> impl Iterator<Item = PosePx<f64>> + use<> {
    let field = shapes.field(prototype);
    let scale = (area / field.area).sqrt();
    let log_scale = scale.ln();
    let [low, high] = shapes.bounds(prototype).map(|corner| corner.map(|v| v * scale));
    let [x, y] = picture.middle(first).map(|v| v - 0.5);
    // The pixel lies in the uppermost row of the piece, or the piece would cover something above it.
    let top = y - low[1];
    let reach = (high[0] - low[0]).ceil().to_count();
    (0..=reach).map(move |left| PosePx {
        translation: [x - f64::of_usize(left) - low[0], top],
        log_scale,
        rotation: 0.0,
    })
}
