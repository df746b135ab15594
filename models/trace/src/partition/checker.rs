//! Where four fields meet in a corner, like those of a chess board: what is of one color across the corner is two things.

use alloc::vec;
use alloc::vec::Vec;

use super::runs::runs;
use crate::tuning;

/// How far (pixels) from the corner the fields are asked for their color: beyond what is mixed there.
const NEAR: usize = 2;
/// How far they reach at least along their sides: no line that runs across the corner is as wide.
const FAR: usize = 6;

/// How far fields without a mixed pixel reach at least along both of their sides. Steps of a line are a pixel wide, twice or three times enlarged two or
/// three.
const REACH: usize = 4;

/// Whether two pixels across a corner, of one color, are of two fields that meet there without a mixed pixel: each reaches away from it to both sides.
/// Where the picture is made of squares (`are_squares`) it does so by two of them.
pub(super) fn are_fields(
    colors: &[u16],
    is_flat: &[bool],
    [width, height]: [usize; 2],
    [upper, lower]: [usize; 2],
    are_squares: bool,
) -> bool {
    let least = if are_squares { 2 * tuning::SQUARE } else { REACH };
    let falls = upper % width < lower % width;
    // The columns, and the rows, of which each ends or begins beside the corner.
    let reaches = |pixel: usize, leftwards: bool, upwards: bool| {
        let along = |at: usize, backwards: bool, size: usize, step: usize| {
            let is_inside = if backwards { at + 1 >= least } else { at + least <= size };
            let is_own = |k: usize| {
                let i = if backwards { pixel - k * step } else { pixel + k * step };
                is_flat[i] && colors[i] == colors[pixel]
            };
            is_inside && (0..least).all(is_own)
        };
        along(pixel % width, leftwards, width, 1) && along(pixel / width, upwards, height, width)
    };
    reaches(upper, falls, true) && reaches(lower, !falls, false)
}

/// Side of the corner, 1 or 2, of the pixels around one; 0 of all others. Pixels of one color that are on different sides are no neighbors.
pub(super) fn sides(colors: &[u16], is_flat: &[bool], [width, height]: [usize; 2]) -> Vec<u8> {
    let mut sides = vec![0; colors.len()];
    let flat = |x: usize, y: usize| is_flat[y * width + x].then(|| colors[y * width + x]);
    let corner = |x: usize, y: usize| -> Option<[bool; 2]> {
        let (l, r, t, b) = (x - NEAR, x + NEAR, y - NEAR, y + NEAR);
        let [nw, ne, sw, se] = [flat(l, t)?, flat(r, t)?, flat(l, b)?, flat(r, b)?];
        if ne == se || se == sw || sw == nw {
            return None;
        }
        let is = |x: usize, y: usize, color: u16| flat(x, y) == Some(color);
        let rises = ne == sw && is(x + FAR, t, ne) && is(r, y - FAR, ne) && is(x - FAR, b, sw) && is(l, y + FAR, sw);
        let falls = nw == se && is(x - FAR, t, nw) && is(l, y - FAR, nw) && is(x + FAR, b, se) && is(r, y + FAR, se);
        (rises || falls).then_some([rises, falls])
    };
    for y in FAR..height.saturating_sub(FAR) {
        // Nearly all of a picture lies where the row above goes on in one color.
        let upper = runs(&colors[(y - NEAR) * width..][..width]).skip(1);
        let changes = upper.flat_map(|(_, columns)| columns.start.saturating_sub(NEAR)..columns.start + NEAR);
        let mut next = FAR;
        for x in changes {
            if x < next || x + FAR >= width || sides[y * width + x] != 0 {
                continue;
            }
            let Some([rises, falls]) = corner(x, y) else { continue };
            // The corner is in the middle of the places that see it.
            let columns = (x..width - FAR).take_while(|&x| corner(x, y).is_some()).count();
            let rows = (y..height - FAR).take_while(|&y| corner(x, y).is_some()).count();
            let [cx, cy] = [x + columns / 2, y + rows / 2];
            let (ne, nw) = (colors[(y - NEAR) * width + x + NEAR], colors[(y - NEAR) * width + x - NEAR]);
            let [columns_near, rows_near] = [(cx, width), (cy, height)]
                .map(|(middle, side)| middle.saturating_sub(NEAR + 1)..(middle + NEAR + 2).min(side));
            // Fields that nothing of their color joins are apart as they are; what flat pixels of it join, side by side, is one thing. A seam may have any
            // color, but is not flat.
            let meet = |from: [usize; 2], to| {
                let is_own = |[px, py]: [usize; 2]| {
                    let is_near = columns_near.contains(&px) && rows_near.contains(&py);
                    is_near && colors[py * width + px] == colors[from[1] * width + from[0]]
                };
                let is_way = |at: [usize; 2]| is_own(at) && is_flat[at[1] * width + at[0]];
                leads(from, to, is_own, true) && !leads(from, to, is_way, false)
            };
            let [rises, falls] = [
                rises && meet([x + NEAR, y - NEAR], [x - NEAR, y + NEAR]),
                falls && meet([x - NEAR, y - NEAR], [x + NEAR, y + NEAR]),
            ];
            for py in rows_near.clone() {
                for px in columns_near.clone() {
                    let i = py * width + px;
                    let first = if rises && colors[i] == ne {
                        px + cy >= cx + py
                    } else if falls && colors[i] == nw {
                        px + py >= cx + cy
                    } else {
                        true
                    };
                    sides[i] = if first { 1 } else { 2 };
                }
            }
            next = x + columns;
        }
    }
    sides
}

/// Whether steps to the pixels beside one, or also to those at its corners, lead from one pixel to another where these are `open`; both may lie beyond.
fn leads(from: [usize; 2], to: [usize; 2], open: impl Fn([usize; 2]) -> bool, at_corners: bool) -> bool {
    let mut seen = vec![from];
    let mut next = 0;
    while let Some(&[x, y]) = seen.get(next) {
        next += 1;
        for at in (y.saturating_sub(1)..=y + 1).flat_map(|v| (x.saturating_sub(1)..=x + 1).map(move |u| [u, v])) {
            if !at_corners && at[0] != x && at[1] != y {
                continue;
            }
            if at == to {
                return true;
            }
            if open(at) && !seen.contains(&at) {
                seen.push(at);
            }
        }
    }
    false
}
