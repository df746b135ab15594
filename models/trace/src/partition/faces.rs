//! Pixels of one color that touch: faces.

use alloc::vec;
use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::geometry::DisjointSets;

use super::Partition;
use super::flat::{NONE, index};
use super::mix::{Mixed, best_mixture};
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
pub(super) fn cut(size: [usize; 2], pixels: Vec<[f32; 3]>, mut mixed: Mixed) -> Partition {
    let (mut labels, mut faces) = label(size, &mixed);
    // What is given away may leave specks behind.
    for _ in 0..2 {
        if !remove_specks(size, &pixels, &mut mixed, &labels, &faces) {
            break;
        }
        (labels, faces) = label(size, &mixed);
    }
    partition(size, pixels, mixed, labels, faces)
}

fn partition(size: [usize; 2], pixels: Vec<[f32; 3]>, mixed: Mixed, labels: Vec<u32>, faces: Vec<Face>) -> Partition {
    let Mixed { shares, palette, unexplained, noise, .. } = mixed;
    let [width, _] = size;
    let is_edge =
        |&i: &usize| i % width > 0 && labels[i - 1] != labels[i] || i >= width && labels[i - width] != labels[i];
    let is_mixed = |&i: &usize| {
        let before = [Some(i), i.checked_sub(1), i.checked_sub(width)];
        before.into_iter().flatten().any(|j| shares[j] < tuning::PURE_SHARE)
    };
    let edges = (0..labels.len()).filter(is_edge).count();
    let mixed = (0..labels.len()).filter(is_edge).filter(is_mixed).count();
    let is_hard = (mixed as f64) < tuning::MOST_HARD * edges as f64
        && steps(&labels, size) as f64 > tuning::LEAST_STAIRS * edges as f64;
    Partition {
        size,
        pixels,
        labels,
        shares,
        faces,
        lines: Vec::new(),
        slivers: Vec::new(),
        palette,
        coded: false,
        mix_noise: noise,
        sigma: tuning::ROUNDING,
        is_hard,
        unexplained,
    }
}

/// Cracks, one pixel long, that a boundary turns into and back from: steps of the stairs that hard edges are where they are slanted. Upright
/// shapes on whole pixels have none, however many corners they have.
fn steps(labels: &[u32], [width, height]: [usize; 2]) -> usize {
    // Pixels (first, second) on both sides of a crack, in a picture whose rows are `across` pixels apart, and `along` it.
    let is_step = |first: usize, along: usize, across: usize| {
        let second = first + across;
        let [before, behind] = [first - along, first + along].map(|i| [labels[i], labels[i + across]]);
        let (one, other) = ([labels[first]; 2], [labels[second]; 2]);
        one != other && (before == one && behind == other || before == other && behind == one)
    };
    let inner = |side: usize| 1..side.saturating_sub(1);
    let upright = inner(height).flat_map(|y| (1..width).map(move |x| y * width + x - 1));
    let level = (1..height).flat_map(|y| inner(width).map(move |x| (y - 1) * width + x));
    upright.filter(|&i| is_step(i, width, 1)).count() + level.filter(|&i| is_step(i, 1, width)).count()
}

/// Whether, of four pixels around a corner whose diagonals are of two colors, the diagonal from upper left to lower right is
/// joined and the other one cut: that of the larger shares is.
fn falling_joins(shares: &[f32], [nw, ne, sw, se]: [usize; 4]) -> bool {
    shares[nw] + shares[se] >= shares[ne] + shares[sw]
}

/// Numbers the faces.
fn label([width, height]: [usize; 2], mixed: &Mixed) -> (Vec<u32>, Vec<Face>) {
    let colors = &mixed.colors;
    let sides = super::checker::sides(colors, &mixed.is_flat, [width, height]);
    let same = |i: usize, j: usize| colors[i] == colors[j] && (sides[i] == sides[j] || sides[i] == 0 || sides[j] == 0);
    // What a way of single steps joins needs no union of its own: in flat parts all but those down the columns.
    let is_way = |way: [usize; 3]| same(way[0], way[1]) && same(way[1], way[2]);
    let mut sets = DisjointSets::default();
    sets.reset(index(colors.len()));
    for y in 0..height {
        for x in 0..width {
            let i = y * width + x;
            let is_joined_above = || y > 0 && is_way([i, i - width, i + 1 - width]) && same(i + 1 - width, i + 1);
            if x + 1 < width && same(i, i + 1) && !is_joined_above() {
                sets.unite(index(i), index(i + 1));
            }
            if y + 1 < height && same(i, i + width) {
                sets.unite(index(i), index(i + width));
            }
            if x + 1 < width && y + 1 < height {
                let four = [i, i + 1, i + width, i + width + 1];
                let [nw, ne, sw, se] = four;
                let (falls, rises) = (same(nw, se), same(ne, sw));
                if falls && (!rises || falling_joins(&mixed.shares, four)) {
                    if !(is_way([nw, ne, se]) || is_way([nw, sw, se])) {
                        sets.unite(index(nw), index(se));
                    }
                } else if rises && !(is_way([ne, nw, sw]) || is_way([ne, se, sw])) {
                    sets.unite(index(ne), index(sw));
                }
            }
        }
    }
    let mut number = vec![NONE; colors.len()];
    let mut faces: Vec<Face> = Vec::new();
    let mut labels = vec![NONE; colors.len()];
    for i in 0..colors.len() {
        let (x, y) = (i % width, i / width);
        let root = sets.root(index(i)) as usize;
        if number[root] == NONE {
            number[root] = index(faces.len());
            faces.push(Face { color: usize::from(colors[i]), area: 0, flat: 0, bounds: [x, y, x + 1, y + 1] });
        }
        labels[i] = number[root];
        faces[number[root] as usize].take(1, usize::from(mixed.is_flat[i]), [[x, x + 1], [y, y + 1]]);
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
        let falling_wins = falls && (!rises || falling_joins(&self.shares, four));
        if falling { falling_wins } else { rises && !falling_wins }
    }
}
