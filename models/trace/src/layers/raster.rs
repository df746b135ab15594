//! Which pixels an outline covers: the check that a layer hides nothing that lies behind it, and shows all that is its own.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::contour::signed_area;
use dvp_core::shape::{FillRule, Outline as Polygons, Path, Shape as _};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::outline::Outline;
use crate::partition::{Face, OUTSIDE, Partition};
use crate::tuning;

/// The polygon of an outline.
pub(crate) fn polygon(outline: &Outline) -> Option<Vec<[f64; 2]>> {
    let path = Path { rings: vec![outline.shape.ring()], fill: FillRule::EvenOdd };
    let mut polygons = Polygons::default();
    path.boundary().ok()?.flatten(0.1, &mut polygons).ok()?;
    (polygons.vertices.len() > 2).then_some(polygons.vertices)
}

/// Whether an outline covers so little that no pixel shows it: less than a step of 8 bits of one.
pub(super) fn is_nothing(outline: &Outline) -> bool {
    polygon(outline).is_none_or(|points| signed_area(&points).abs() < 1.0 / 255.0)
}

/// Whether what polygons (pixels, filled by the rule beside them) cover is what they should cover, but for few pixels: of all pixels of their `own` faces, and of none of
/// any face, however small it is, that must stay seen (`is_seen`, asked of those that are covered). Mixed pixels count for nothing. Else the pixels
/// [column, row] that are wrong.
pub(super) fn check(
    partition: &Partition,
    (polygons, fill): (&[Vec<[f64; 2]>], FillRule),
    own: &[u32],
    is_seen: impl Fn(u32) -> bool,
) -> Result<(), Vec<[usize; 2]>> {
    let width = partition.size[0];
    let mut wanted = vec![Wanted::NotAsked; partition.faces.len()];
    own.iter().for_each(|&face| wanted[face as usize] = Wanted::Own);
    let own = || own.iter().map(|&face| &partition.faces[face as usize]);
    let [columns, rows] = reach(partition, polygons, own());
    let mut wrong = Vec::new();
    let mut missed = 0;
    let mut hidden: BTreeMap<u32, usize> = BTreeMap::new();
    let first = rows.start;
    let mut crossings = crossings(polygons, &rows);
    for y in rows {
        let crossings = &mut crossings[y - first];
        crossings.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let (mut crossed, mut winding) = (0, 0);
        for x in columns.clone() {
            while crossed < crossings.len() && crossings[crossed].0 <= x as f64 + 0.5 {
                winding += crossings[crossed].1;
                crossed += 1;
            }
            let is_covered = match fill {
                FillRule::EvenOdd => crossed % 2 == 1,
                FillRule::NonZero => winding != 0,
            };
            let i = y * width + x;
            let label = partition.labels[i];
            let Some(wanted) = wanted.get_mut(label as usize) else { continue };
            if is_covered && *wanted == Wanted::NotAsked {
                *wanted = if is_seen(label) { Wanted::Seen } else { Wanted::Any };
            }
            let is_missed = match (*wanted, is_covered) {
                (Wanted::Own, false) => true,
                (Wanted::Seen, true) => false,
                _ => continue,
            };
            if partition.shares[i] < tuning::PURE_SHARE {
                continue;
            }
            // Where edges are hard, or a coder left some of its own, an outline may take a pixel beside them or leave it.
            if (partition.is_hard || partition.reading.coded) && is_at_edge(partition, [x, y]) {
                continue;
            }
            if is_missed {
                missed += 1;
            } else {
                *hidden.entry(label).or_default() += 1;
            }
            wrong.push([x, y]);
        }
    }
    // Nothing of squares is in doubt.
    let few = |count: usize, area: usize| match partition.reading.squares {
        true => count == 0,
        false => (count as f64) <= (tuning::MOST_WRONG * area as f64).clamp(1.0, tuning::MOST_WRONG_PIXELS),
    };
    let area = own().map(|face| face.area).sum::<usize>();
    let agrees =
        few(missed, area) && hidden.iter().all(|(&face, &count)| few(count, partition.faces[face as usize].area));
    if agrees { Ok(()) } else { Err(wrong) }
}

/// Where the middle of each row meets polygons, and which way around: 1 for downward edges of those of positive area and upward ones of others.
fn crossings(polygons: &[Vec<[f64; 2]>], rows: &Range<usize>) -> Vec<Vec<(f64, i32)>> {
    let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); rows.len()];
    for polygon in polygons {
        let is_positive = signed_area(polygon) > 0.0;
        let mut last = polygon[polygon.len() - 1];
        for &point in polygon {
            // The first row whose middle is not above a place.
            let row = |y: f64| ((y - 0.5).ceil() as usize).clamp(rows.start, rows.end);
            let way = if is_positive == (point[1] > last[1]) { 1 } else { -1 };
            for y in row(last[1].min(point[1]))..row(last[1].max(point[1])) {
                let share = (y as f64 + 0.5 - last[1]) / (point[1] - last[1]);
                crossings[y - rows.start].push((last[0] + share * (point[0] - last[0]), way));
            }
            last = point;
        }
    }
    crossings
}

/// Whether a pixel lies beside another face.
fn is_at_edge(partition: &Partition, [x, y]: [usize; 2]) -> bool {
    let own = partition.face_at([x, y]);
    let beside = [[x + 1, y], [x.wrapping_sub(1), y], [x, y + 1], [x, y.wrapping_sub(1)]];
    beside.into_iter().map(|at| partition.face_at(at)).any(|face| face != own && face != OUTSIDE)
}

/// What a layer should show of a face.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    NotAsked,
    /// All of it.
    Own,
    /// Nothing: it must stay seen.
    Seen,
    /// Whatever is easiest, since something else hides it.
    Any,
}

/// The columns and rows that the polygons, or their own faces, reach.
fn reach<'a>(
    partition: &Partition,
    polygons: &[Vec<[f64; 2]>],
    own: impl Iterator<Item = &'a Face> + Clone,
) -> [Range<usize>; 2] {
    [0, 1].map(|axis| {
        let (mut low, mut high) = own
            .clone()
            .fold((usize::MAX, 0), |(low, high), face| (low.min(face.bounds[axis]), high.max(face.bounds[axis + 2])));
        for point in polygons.iter().flatten() {
            let at = point[axis].max(0.0) as usize;
            (low, high) = (low.min(at), high.max(at + 1));
        }
        low..high.min(partition.size[axis])
    })
}
