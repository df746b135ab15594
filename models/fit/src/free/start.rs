//! The first outline of an object of unknown shape, traced where its coverage crosses one half.

use alloc::vec::Vec;

use dvp_core::contour::{Connectivity, perimeter, resample, signed_area, trace_level};
use dvp_core::geometry::push_turning;
use dvp_core::{ImageSize, Real};

use super::loops::cut_loops;
use crate::segment::{Segment, Segmentation};

/// Rows and columns added around; beyond the image border they continue the border pixels, so that a cropped object closes
/// outside the view.
const MARGIN: usize = 3;

/// Memory of [`trace`].
#[derive(Clone, Debug, Default)]
pub(crate) struct StartScratch<T> {
    field: Vec<T>,
    /// Indices of pixels without a value, and the values found for some of them.
    unknown: Vec<usize>,
    filled: Vec<(usize, T)>,
    left: Vec<[T; 2]>,
    right: Vec<[T; 2]>,
}

/// The traced outline (px), largest loop; none if the object has no inside.
pub(crate) fn trace<T: Real>(
    segment: &Segment<T>,
    object: u32,
    segmentation: &Segmentation<T>,
    size: ImageSize,
    scratch: &mut StartScratch<T>,
) -> Option<Vec<[T; 2]>> {
    if segment.pixels == 0 {
        return None;
    }
    let [left, top, right, bottom] = segment.bounds.map(|v| v as usize);
    // The window in image coordinates, shifted by the margin on all sides; it may leave the image by the margin.
    let (low_x, low_y) = (left.saturating_sub(MARGIN), top.saturating_sub(MARGIN));
    let (high_x, high_y) = ((right + MARGIN).min(size.width()), (bottom + MARGIN).min(size.height()));
    let (columns, rows) = (high_x - low_x + 2 * MARGIN, high_y - low_y + 2 * MARGIN);
    let field = &mut scratch.field;
    field.clear();
    field.resize(columns * rows, T::nan());
    for y in low_y..high_y {
        let mut line = &mut field[(y - low_y + MARGIN) * columns + MARGIN..][..high_x - low_x];
        // Neighbors are mostly of one region: it is asked once.
        for same in segmentation.labels()[y * size.width()..][low_x..high_x].chunk_by(|a, b| a == b) {
            let (run, rest) = core::mem::take(&mut line).split_at_mut(same.len());
            line = rest;
            if let Some(inside) = segmentation.region_covers(same[0], object) {
                run.fill(if inside { T::one() } else { T::zero() });
            }
        }
    }
    let hidden = |x: usize, y: usize| segmentation.may_be_hidden(y * size.width() + x, object);
    if segmentation.may_go_on(object) {
        fill_hidden(field, columns, [low_x, low_y], [high_x, high_y], hidden, &mut scratch.left, &mut scratch.right);
    }
    for &([x, y], coverage) in &segment.rim {
        let (x, y) = (x as usize, y as usize);
        if (low_x..high_x).contains(&x) && (low_y..high_y).contains(&y) {
            field[(y - low_y + MARGIN) * columns + x - low_x + MARGIN] = coverage;
        }
    }
    fill_unknown(field, &mut scratch.unknown, &mut scratch.filled, columns);
    let at_border = [low_x == 0, low_y == 0, high_x == size.width(), high_y == size.height()];
    continue_beyond(field, columns, rows, at_border);
    let window = ImageSize::new(columns, rows).ok()?;
    let loops = trace_level(field, window, T::of(0.5), Connectivity::Four).ok()?;
    let mut best = loops.into_iter().max_by(|a, b| {
        let (a, b) = (signed_area(a).abs(), signed_area(b).abs());
        a.partial_cmp(&b).unwrap_or(core::cmp::Ordering::Equal)
    })?;
    let shift = |low: usize| T::of_usize(low) - T::of_usize(MARGIN);
    for vertex in &mut best {
        vertex[0] += shift(low_x);
        vertex[1] += shift(low_y);
    }
    (best.len() >= 3).then_some(best)
}

/// Moves a traced outline inward by `offset` (px, outward if negative), along normals taken over its neighbors, and cuts off the loops that
/// come of it.
pub(crate) fn shrink<T: Real>(contour: &[[T; 2]], offset: T) -> Vec<[T; 2]> {
    let count = (perimeter(contour) / T::of(1.5)).to_count().clamp(16, 256);
    let points = resample(contour, count);
    let inward = if signed_area(&points) > T::zero() { -offset } else { offset };
    let n = points.len();
    let mut shrunk: Vec<_> = (0..n)
        .map(|i| {
            let (a, b) = (points[(i + n - 1) % n], points[(i + 1) % n]);
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            let step = inward / (x * x + y * y).sqrt().max(T::of(1e-6));
            [points[i][0] + y * step, points[i][1] - x * step]
        })
        .collect();
    cut_loops(&mut shrunk);
    shrunk
}

/// Takes hidden pixels in the convex hull of the visible ones for covered: a straight line is the simplest way to go on.
fn fill_hidden<T: Real>(
    field: &mut [T],
    columns: usize,
    low: [usize; 2],
    high: [usize; 2],
    hidden: impl Fn(usize, usize) -> bool,
    left: &mut Vec<[T; 2]>,
    right: &mut Vec<[T; 2]>,
) {
    left.clear();
    right.clear();
    for y in low[1]..high[1] {
        let row = (y - low[1] + MARGIN) * columns;
        let covered = |&x: &usize| field[row + x - low[0] + MARGIN] == T::one();
        if let (Some(first), Some(last)) = ((low[0]..high[0]).find(covered), (low[0]..high[0]).rfind(covered)) {
            // Mirrored on the left, so that both chains turn to the same side.
            push_turning(left, 0, [-T::of_usize(first), T::of_usize(y)]);
            push_turning(right, 0, [T::of_usize(last), T::of_usize(y)]);
        }
    }
    for y in low[1]..high[1] {
        let (Some(from), Some(to)) = (at_row(left, y).map(|x| -x), at_row(right, y)) else { continue };
        let row = (y - low[1] + MARGIN) * columns;
        for x in from.ceil().to_count().max(low[0])..(to.floor().to_count() + 1).min(high[0]) {
            let value = &mut field[row + x - low[0] + MARGIN];
            if value.is_nan() && hidden(x, y) {
                *value = T::one();
            }
        }
    }
}

/// Where the chain crosses the middle of a row.
fn at_row<T: Real>(chain: &[[T; 2]], row: usize) -> Option<T> {
    let y = T::of_usize(row);
    let next = chain.partition_point(|point| point[1] < y);
    let &[x, below] = chain.get(next)?;
    let Some(&[before, above]) = next.checked_sub(1).and_then(|i| chain.get(i)) else {
        return (below <= y).then_some(x);
    };
    Some(before + (x - before) * (y - above) / (below - above))
}

/// Gives soft pixels without a sample the mean of their known neighbors, ring by ring.
fn fill_unknown<T: Real>(field: &mut [T], unknown: &mut Vec<usize>, filled: &mut Vec<(usize, T)>, columns: usize) {
    unknown.clear();
    unknown.extend((columns..field.len().saturating_sub(columns)).filter(|&i| field[i].is_nan()));
    for _ in 0..4 {
        filled.clear();
        unknown.retain(|&i| {
            let known = [i - 1, i + 1, i - columns, i + columns].map(|j| field[j]);
            let (mut sum, mut count) = (T::zero(), 0);
            for value in known.into_iter().filter(|value| !value.is_nan()) {
                sum += value;
                count += 1;
            }
            if count > 0 {
                filled.push((i, sum / T::of_usize(count)));
            }
            count == 0
        });
        for &(i, value) in filled.iter() {
            field[i] = value;
        }
        if filled.is_empty() || unknown.is_empty() {
            break;
        }
    }
}

/// Copies border pixels of the image outward and clears the outermost ring.
fn continue_beyond<T: Real>(field: &mut [T], columns: usize, rows: usize, at_border: [bool; 4]) {
    let [left, top, right, bottom] = at_border;
    for line in field.chunks_exact_mut(columns) {
        if left {
            let first = line[MARGIN];
            line[..MARGIN].fill(first);
        }
        if right {
            let last = line[columns - MARGIN - 1];
            line[columns - MARGIN..].fill(last);
        }
        line.iter_mut().for_each(|value| *value = if value.is_nan() { T::zero() } else { *value });
        line[0] = T::zero();
        line[columns - 1] = T::zero();
    }
    let line = |row: usize| row * columns..(row + 1) * columns;
    for row in 1..MARGIN {
        if top {
            field.copy_within(line(MARGIN), row * columns);
        }
        if bottom {
            field.copy_within(line(rows - MARGIN - 1), (rows - 1 - row) * columns);
        }
    }
    field[line(0)].fill(T::zero());
    field[line(rows - 1)].fill(T::zero());
}
