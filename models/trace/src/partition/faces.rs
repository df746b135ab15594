//! Pixels of one color that touch: faces.

use alloc::vec;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::geometry::DisjointSets;

use super::checker;
use super::flat::{NONE, index};
use super::mix::{Mixed, best_mixture};
use super::runs::{differing, renumber};
use super::{Partition, Reading};
use crate::tuning;

/// A connected part of the picture of one color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Index into the palette.
    pub color: usize,
    /// Pixels that are mostly of this face.
    pub area: usize,
    /// Those of them in flat blocks; a face without is thinner than two pixels.
    pub flat: usize,
    /// First column and row, and those after the last.
    pub bounds: [usize; 4],
}

impl Face {
    /// Adds pixels, of which some are flat, within columns and rows (the first, and that after the last).
    pub(super) fn take(&mut self, area: usize, flat: usize, [columns, rows]: [[usize; 2]; 2]) {
        self.area += area;
        self.flat += flat;
        let [left, top, right, bottom] = self.bounds;
        self.bounds = [left.min(columns[0]), top.min(rows[0]), right.max(columns[1]), bottom.max(rows[1])];
    }
}

/// Cuts a picture into faces; specks that a mixture of their neighbors explains nearly as well are given to these.
/// Pixels that touch in nothing but a corner are of one face where what meets there is no wider than a line, or than a square where the picture is made
/// of such (`are_squares`).
pub(super) fn cut(size: [usize; 2], pixels: Vec<[f32; 3]>, mut mixed: Mixed, are_squares: bool) -> Partition {
    let (mut labels, mut faces) = label(size, &mixed, are_squares);
    // What is given away may leave specks behind.
    for _ in 0..2 {
        if !remove_specks(size, &pixels, &mut mixed, &labels, &faces) {
            break;
        }
        (labels, faces) = label(size, &mixed, are_squares);
    }
    partition(size, pixels, mixed, labels, faces)
}

fn partition(size: [usize; 2], pixels: Vec<[f32; 3]>, mixed: Mixed, labels: Vec<u32>, faces: Vec<Face>) -> Partition {
    let Mixed { shares, palette, unexplained, noise, .. } = mixed;
    let [width, _] = size;
    let is_mixed = |i: usize| {
        let before = [Some(i), i.checked_sub(1), i.checked_sub(width)];
        before.into_iter().flatten().any(|j| shares[j] < tuning::PURE_SHARE)
    };
    // Pixels of another face than the one before or above.
    let [mut edges, mut mixed] = [0_usize; 2];
    let mut beside = Vec::new();
    for (y, row) in labels.chunks_exact(width).enumerate() {
        beside.clear();
        beside.extend(differing(&row[1..], row).map(|x| x + 1));
        if let Some(above) = y.checked_sub(1) {
            beside.extend(differing(row, &labels[above * width..y * width]));
        }
        beside.sort_unstable();
        beside.dedup();
        edges += beside.len();
        mixed += beside.iter().filter(|&x| is_mixed(y * width + x)).count();
    }
    let is_hard = (mixed as f64) < tuning::MOST_HARD * edges as f64
        && steps(&labels, size) as f64 > tuning::LEAST_STAIRS * edges as f64;
    Partition {
        size,
        pixels,
        labels,
        shares,
        faces,
        lines: Vec::new(),
        seams: Vec::new(),
        guessed: Vec::new(),
        slivers: Vec::new(),
        palette,
        reading: Reading::default(),
        ripple: 0.0,
        blur: 0.0,
        mix_noise: noise,
        sigma: tuning::ROUNDING,
        is_hard,
        unexplained,
    }
}

/// Cracks, one pixel long, that a boundary turns into and back from, with another one, to the same side, where it turns next: steps of the stairs that
/// hard edges are where they are slanted. Upright shapes on whole pixels have none, however many corners they have, and things side by side that begin
/// a pixel from one another have single ones.
fn steps(labels: &[u32], [width, height]: [usize; 2]) -> usize {
    let is_upright = |x: usize, y: usize| is_followed([x, y], [width, height], |x, y| labels[y * width + x]);
    let is_level = |x: usize, y: usize| is_followed([y, x], [height, width], |y, x| labels[y * width + x]);
    let row = |y: usize| &labels[y * width..(y + 1) * width];
    let upright = |y: usize| differing(row(y), &row(y)[1..]).filter(|&x| is_upright(x, y)).count();
    let level = |y: usize| differing(row(y), row(y + 1)).filter(|&x| is_level(x, y)).count();
    (0..height).map(upright).sum::<usize>() + (0..height.saturating_sub(1)).map(level).sum::<usize>()
}

/// Whether the crack on the right of a pixel is a step that another one follows. For level cracks rows and columns change places.
fn is_followed([x, y]: [usize; 2], [columns, rows]: [usize; 2], label: impl Fn(usize, usize) -> u32) -> bool {
    // The sides of a step, left and right, and whether the boundary is lower on its right.
    let step = |x: usize, y: usize| {
        if x + 1 >= columns || y == 0 || y + 1 >= rows {
            return None;
        }
        let row = |y: usize| [label(x, y), label(x + 1, y)];
        let [left, right] = row(y);
        if left == right {
            return None;
        }
        let (above, below) = (row(y - 1), row(y + 1));
        let falls = [above, below] == [[right; 2], [left; 2]];
        let rises = [above, below] == [[left; 2], [right; 2]];
        (falls || rises).then_some((left, right, falls))
    };
    let Some((left, right, falls)) = step(x, y) else { return false };
    // The boundary goes on to the right between this row and the one that has the left side's label.
    let beyond = if falls { y + 1 } else { y - 1 };
    let goes_on = |&x: &usize| label(x, y) == right && label(x, beyond) == left;
    let last = (x + 1..columns).take_while(goes_on).last();
    last.is_some_and(|last| step(last, beyond) == Some((left, right, falls)))
}

/// Whether, of four pixels around a corner whose diagonals are of two colors, the diagonal from upper left to lower right is
/// joined and the other one cut: that of the larger shares is, and of equal ones of squares that of the color that fewer have, which
/// is what was drawn (`is_later`: that this one is no earlier in the palette).
fn falling_joins(shares: &[f32], [nw, ne, sw, se]: [usize; 4], is_later: bool) -> bool {
    shares[nw] + shares[se] >= shares[ne] + shares[sw] && is_later
}

/// Numbers the faces: runs of pixels side by side, joined with those of the row above.
fn label([width, height]: [usize; 2], mixed: &Mixed, are_squares: bool) -> (Vec<u32>, Vec<Face>) {
    let colors = &mixed.colors;
    let sides = match are_squares {
        // No corner is mixed.
        true => vec![0; colors.len()],
        false => checker::sides(colors, &mixed.is_flat, [width, height]),
    };
    let same = |i: usize, j: usize| colors[i] == colors[j] && (sides[i] == sides[j] || sides[i] == 0 || sides[j] == 0);
    let meet = |upper: usize, lower: usize| {
        same(upper, lower) && !checker::are_fields(colors, &mixed.is_flat, [width, height], [upper, lower], are_squares)
    };
    let mut sets = DisjointSets::default();
    let mut labels = vec![NONE; colors.len()];
    // Whether a run begins in a column, of the row above and of this one.
    let [mut above, mut begins] = [vec![true; width], vec![true; width]];
    for first in (0..height).map(|y| y * width) {
        core::mem::swap(&mut above, &mut begins);
        // What does not join the pixel before it begins a run.
        let row = first..first + width;
        let [before, after] = [first..first + width - 1, first + 1..first + width];
        let pairs =
            colors[before.clone()].iter().zip(&colors[after.clone()]).zip(sides[before].iter().zip(&sides[after]));
        for (begins, ((color, other), (side, its))) in begins[1..].iter_mut().zip(pairs) {
            *begins = color != other || side != its && *side != 0 && *its != 0;
        }
        let mut run = NONE;
        for (label, &begins) in labels[row].iter_mut().zip(&begins) {
            if begins {
                run = sets.push();
            }
            *label = run;
        }
        let Some(upper) = first.checked_sub(width) else { continue };
        // Where no run begins four pixels are of two runs, and what joins these was seen before; but sides begin and end inside of runs.
        let is_plain = sides[upper..first + width].iter().fold(0, |all, side| all | side) == 0;
        for x in (0..width).filter(|&x| above[x] || begins[x] || !is_plain) {
            let (ne, se) = (upper + x, first + x);
            if same(ne, se) {
                sets.unite(labels[ne], labels[se]);
            }
            if x == 0 {
                continue;
            }
            let four = [ne - 1, ne, se - 1, se];
            let [nw, ne, sw, se] = four;
            let (falls, rises) = (meet(nw, se), meet(ne, sw));
            let is_later = !are_squares || colors[nw] >= colors[ne];
            if falls && (!rises || falling_joins(&mixed.shares, four, is_later)) {
                sets.unite(labels[nw], labels[se]);
            } else if rises {
                sets.unite(labels[ne], labels[sw]);
            }
        }
    }
    let mut number = vec![NONE; sets.len()];
    let mut faces: Vec<Face> = Vec::new();
    for (y, labels) in labels.chunks_exact_mut(width).enumerate() {
        renumber(labels, |run, columns| {
            let root = sets.root(run) as usize;
            let (x, pixels) = (columns.start, y * width + columns.start..y * width + columns.end);
            if number[root] == NONE {
                number[root] = index(faces.len());
                let color = usize::from(colors[pixels.start]);
                faces.push(Face { color, area: 0, flat: 0, bounds: [x, y, x + 1, y + 1] });
            }
            let flat = mixed.is_flat[pixels].iter().filter(|&&is_flat| is_flat).count();
            faces[number[root] as usize].take(columns.len(), flat, [[x, columns.end], [y, y + 1]]);
            number[root]
        });
    }
    (labels, faces)
}

/// Gives specks, faces without a flat pixel, to the faces around them where mixtures of those are the shorter description.
/// Whether there were any.
fn remove_specks(size: [usize; 2], pixels: &[[f32; 3]], mixed: &mut Mixed, labels: &[u32], faces: &[Face]) -> bool {
    let mut of_speck: Vec<Vec<usize>> = vec![Vec::new(); faces.len()];
    for (i, &label) in labels.iter().enumerate() {
        if faces[label as usize].flat == 0 {
            of_speck[label as usize].push(i);
        }
    }
    // A picture of more specks than anything else means them.
    let flat = faces.iter().filter(|face| face.flat > 0).count();
    let is_detailed = faces.len() > 3 * flat;
    let mut changed = false;
    let mut around: Vec<u16> = Vec::new();
    for (face, speck) in of_speck.iter().enumerate().filter(|(_, speck)| !speck.is_empty()) {
        // What lies further off may have a share in a pixel where a wedge of it ends, and where faces meet a few pixels may be mixtures
        // of more than three colors, or their ends: they are no things of their own.
        let is_other = |other: usize| other != face && (faces[other].flat > 0 || faces[other].area > speck.len());
        let reach = if speck.len() <= tuning::MOST_SPECK { 3 } else { 1 };
        colors_around(size, mixed, labels, (speck, reach), is_other, &mut around);
        let is_lost = !is_detailed && around.len() > 1 && speck.len() <= around.len();
        if is_lost {
            colors_around(size, mixed, labels, (speck, 1), is_other, &mut around);
        }
        around.retain(|&color| usize::from(color) != faces[face].color);
        let mixtures: Option<Vec<_>> =
            speck.iter().map(|&i| best_mixture(pixels[i].map(f64::from), &around, &mixed.palette)).collect();
        let bits = |misfit: f64| 1.5 * core::f64::consts::LOG2_E * (misfit / mixed.noise).powi(2);
        let mixtures = mixtures.filter(|mixtures| {
            is_lost || mixtures.iter().map(|mixture| bits(mixture.misfit)).sum::<f64>() < tuning::SPECK_BITS
        });
        if let Some(mixtures) = mixtures {
            for (&i, mixture) in speck.iter().zip(mixtures) {
                mixed.colors[i] = mixture.color;
                mixed.shares[i] = mixture.share as f32;
            }
            changed = true;
        }
    }
    changed
}

/// The colors of the faces that are `wanted` within some pixels' reach.
fn colors_around(
    [width, height]: [usize; 2],
    mixed: &Mixed,
    labels: &[u32],
    (speck, reach): (&[usize], usize),
    wanted: impl Fn(usize) -> bool,
    around: &mut Vec<u16>,
) {
    around.clear();
    for &i in speck {
        let (x, y) = (i % width, i / width);
        for row in y.saturating_sub(reach)..(y + reach + 1).min(height) {
            let range = (row * width + x.saturating_sub(reach))..(row * width + (x + reach + 1).min(width));
            for (&label, color) in labels[range.clone()].iter().zip(&mixed.colors[range]) {
                if wanted(label as usize) && !around.contains(color) {
                    around.push(*color);
                }
            }
        }
    }
}

impl Partition {
    /// Whether faces that only touch at a corner (column and row of the pixel to its lower right) are one there: the pixels to its upper left
    /// and lower right if `falling`, else those to its upper right and lower left.
    #[must_use]
    pub fn joins_at(&self, [x, y]: [usize; 2], falling: bool) -> bool {
        let [width, height] = self.size;
        if x == 0 || y == 0 || x >= width || y >= height {
            return false;
        }
        let se = y * width + x;
        let four = [se - width - 1, se - width, se - 1, se];
        let [nw, ne, sw, se] = four;
        let (falls, rises) = (self.labels[nw] == self.labels[se], self.labels[ne] == self.labels[sw]);
        let color = |i: usize| self.faces[self.labels[i] as usize].color;
        let is_later = !self.reading.squares || !rises || !falls || color(nw) >= color(ne);
        let falling_wins = falls && (!rises || falling_joins(&self.shares, four, is_later));
        if falling { falling_wins } else { rises && !falling_wins }
    }
}
