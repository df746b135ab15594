//! The boundary of a face as one list of marks, and what lies across the face from each of them.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::{Real, Vec2};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// A sample of the boundary, with the direction in which the face lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mark {
    pub(super) point: Vec2<f64>,
    /// Across the boundary, into the face, of length 1.
    pub(super) inward: Vec2<f64>,
    /// Standard deviation across the boundary, pixels.
    pub(super) sigma: f64,
    /// The ring that it belongs to.
    ring: usize,
    /// Whether what follows on the ring is not seen: the way to the next mark is bridged by a straight line.
    is_last: bool,
}

/// Where a ray across the face leaves it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// The mark at which the step of the boundary begins that the ray crosses.
    pub(super) mark: usize,
    /// How far along that step, \[0, 1\].
    pub(super) share: f64,
    /// From the mark that sent the ray, pixels.
    pub(super) distance: f64,
}

impl Hit {
    /// Its place in the list of marks.
    pub(super) fn place(&self) -> f64 {
        self.mark as f64 + self.share
    }
}

/// All marks of a face, ring after ring.
#[derive(Debug)]
pub(super) struct Border {
    pub(super) marks: Vec<Mark>,
    /// The marks of each ring; its last one is followed by its first.
    rings: Vec<Range<usize>>,
    cells: Cells,
}

/// Squares of [`CELL`] pixels, each with the steps of the boundary that touch it.
#[derive(Debug)]
struct Cells {
    origin: Vec2<f64>,
    columns: usize,
    rows: usize,
    /// The steps of cell k are `steps[starts[k]..starts[k + 1]]`, each known by the mark at which it begins.
    starts: Vec<usize>,
    steps: Vec<usize>,
}

/// Side of a cell, pixels: a few steps of the boundary pass through one.
const CELL: f64 = 4.0;

/// Marks to both sides that say which way the boundary goes.
const REACH: usize = 2;

/// Least cosine between a ray and the opposite of the way into the face where it leaves: 45 degrees, what is left at the middle of
/// a right-angled bend whose inner side is a corner.
const LEAST_FACING: f64 = 0.7;

impl Border {
    /// The marks of rings; runs of fewer than three samples say nothing of directions and are not seen.
    pub(super) fn new(rings: &[RingSamples]) -> Self {
        let mut marks = Vec::new();
        let mut ranges = Vec::new();
        for ring in rings {
            let first = marks.len();
            for samples in ring.runs.iter().filter(|samples| samples.len() >= 3) {
                marks.extend((0..samples.len()).map(|i| {
                    let mark = mark(samples, ring.closed, i);
                    Mark { ring: ranges.len(), is_last: !ring.closed && i + 1 == samples.len(), ..mark }
                }));
            }
            if marks.len() > first {
                ranges.push(first..marks.len());
            }
        }
        let mut border = Self { marks, rings: ranges, cells: Cells::default() };
        border.cells = Cells::new(&border);
        border
    }

    /// The mark that follows on the ring.
    pub(super) fn next(&self, mark: usize) -> Option<usize> {
        let range = self.ring_of(mark)?;
        Some(if mark + 1 < range.end { mark + 1 } else { range.start })
    }

    fn ring_of(&self, mark: usize) -> Option<&Range<usize>> {
        self.rings.get(self.marks.get(mark)?.ring)
    }

    /// Whether what follows a mark on the ring is not seen.
    pub(super) fn is_last(&self, mark: usize) -> bool {
        self.marks.get(mark).is_some_and(|mark| mark.is_last)
    }

    /// The length of the boundary and the area inside, gaps bridged by straight lines.
    pub(super) fn measures(&self) -> (f64, f64) {
        let (mut length, mut twice_area) = (0.0, 0.0);
        for (i, mark) in self.marks.iter().enumerate() {
            let Some(step) = self.step_of(i) else { continue };
            length += step.length();
            twice_area += mark.point.cross(mark.point + step);
        }
        (length, 0.5 * twice_area.abs())
    }

    /// How many marks `to` comes before `from`, if both are on the same ring; the shorter way around.
    pub(super) fn steps_back(&self, from: &Hit, to: &Hit) -> Option<f64> {
        let range = self.ring_of(from.mark).filter(|range| range.contains(&to.mark))?;
        let (back, count) = (from.place() - to.place(), range.len() as f64);
        Some(back - (back / count).round() * count)
    }

    /// The marks from `back` marks before a hit up to it, in their order; rings go on before their start.
    pub(super) fn before(&self, hit: &Hit, back: f64) -> Vec<usize> {
        let range = self.ring_of(hit.mark).cloned().unwrap_or(0..1);
        let count = Real::to_count(hit.share + back + 1.0).min(range.len());
        let last = hit.mark - range.start + range.len();
        (0..count).rev().map(|k| range.start + (last - k) % range.len()).collect()
    }

    /// Where the ray from a mark into the face leaves it, no further than `limit`, if it meets the boundary there about at right
    /// angles.
    pub(super) fn across(&self, from: usize, limit: f64) -> Option<Hit> {
        let mark = self.marks.get(from)?;
        let mut nearest: Option<Hit> = None;
        let mut walk = Walk::new(&self.cells, mark.point, mark.inward);
        while let Some((cell, leaves)) = walk.step(&self.cells) {
            for &step in self.cells.steps_in(cell) {
                let hit = self.crossing(from, mark, step);
                nearest = match (hit, nearest) {
                    (Some(hit), Some(old)) if hit.distance < old.distance => Some(hit),
                    (Some(hit), None) => Some(hit),
                    _ => nearest,
                };
            }
            if nearest.is_some_and(|hit| hit.distance <= leaves) || leaves > limit {
                break;
            }
        }
        let hit = nearest.filter(|hit| hit.distance <= limit)?;
        let along = self.step_of(hit.mark)?;
        (along.perp().dot(mark.inward) <= -LEAST_FACING * along.length()).then_some(hit)
    }

    fn step_of(&self, mark: usize) -> Option<Vec2<f64>> {
        Some(self.marks.get(self.next(mark)?)?.point - self.marks.get(mark)?.point)
    }

    /// Where the ray of a mark leaves the face through one step of the boundary.
    fn crossing(&self, from: usize, mark: &Mark, step: usize) -> Option<Hit> {
        let (along, start) = (self.step_of(step)?, self.marks.get(step)?.point - mark.point);
        let slope = along.cross(mark.inward);
        // Steps that face the ray's way are entered, not left.
        if along.perp().dot(mark.inward) >= 0.0 || slope == 0.0 {
            return None;
        }
        let share = -start.cross(mark.inward) / slope;
        let distance = (start + along * share).dot(mark.inward);
        // The noise of the marks beside it may put the boundary before the mark itself.
        let is_beside = from.abs_diff(step) <= REACH + 1 && distance < 0.7;
        ((0.0..=1.0).contains(&share) && distance > 1e-9 && !is_beside).then_some(Hit { mark: step, share, distance })
    }
}

/// The mark of one sample of a run, alone on its ring.
fn mark(samples: &[Sample], is_closed: bool, i: usize) -> Mark {
    let count = samples.len();
    let at = |step: isize| {
        let moved = i.wrapping_add_signed(step);
        let moved = if is_closed { (i + count).wrapping_add_signed(step) % count } else { moved };
        samples.get(moved).map(|sample| sample.point)
    };
    let sample = samples[i];
    // The slope of the parabola through the neighbors: distant ones weigh more.
    let mut along = Vec2::default();
    for k in 1..=REACH {
        let step = k.cast_signed();
        if let (Some(before), Some(after)) = (at(-step), at(step)) {
            along += (after - before) * step as f64;
        }
    }
    if along == Vec2::default() {
        let ends = [at(-1), at(1)].map(|point| point.unwrap_or(sample.point));
        along = ends[1] - ends[0];
    }
    let inward = along.perp().normalized().unwrap_or(Vec2::new(1.0, 0.0));
    // A window along an axis sees a slanted boundary move by more than across it.
    let along_axis = sample.sigma.hypot(tuning::RENDERER_SIGMA);
    let sigma = along_axis * inward.dot(sample.axis).abs().max(0.5);
    Mark { point: sample.point, inward, sigma, ring: 0, is_last: false }
}

impl Default for Cells {
    fn default() -> Self {
        Self { origin: Vec2::default(), columns: 0, rows: 0, starts: vec![0], steps: Vec::new() }
    }
}

impl Cells {
    fn new(border: &Border) -> Self {
        let Some(bounds) = dvp_core::geometry::Bounds::of(border.marks.iter().map(|mark| mark.point)) else {
            return Self::default();
        };
        let mut cells = Self { origin: bounds.min, ..Self::default() };
        let corner = cells.place(bounds.max).map(Real::to_count);
        (cells.columns, cells.rows) = (corner[0] + 1, corner[1] + 1);
        // Count, sum up, fill: no list per cell.
        let count = cells.columns * cells.rows;
        let mut starts = vec![0; count + 1];
        cells.visit(border, |cell, _| starts[cell + 1] += 1);
        for cell in 0..count {
            starts[cell + 1] += starts[cell];
        }
        let mut steps = vec![0; starts[count]];
        let mut filled = starts.clone();
        cells.visit(border, |cell, step| {
            steps[filled[cell]] = step;
            filled[cell] += 1;
        });
        Self { starts, steps, ..cells }
    }

    /// Calls `each` with every cell that the box of a step touches.
    fn visit(&self, border: &Border, mut each: impl FnMut(usize, usize)) {
        for (i, mark) in border.marks.iter().enumerate() {
            let Some(next) = border.next(i).and_then(|next| border.marks.get(next)) else { continue };
            let ends = [mark, next].map(|mark| self.place(mark.point).map(Real::to_count));
            for row in ends[0][1].min(ends[1][1])..=ends[0][1].max(ends[1][1]) {
                for column in ends[0][0].min(ends[1][0])..=ends[0][0].max(ends[1][0]) {
                    each(row * self.columns + column, i);
                }
            }
        }
    }

    fn place(&self, point: Vec2<f64>) -> [f64; 2] {
        let from = point - self.origin;
        [from.x / CELL, from.y / CELL]
    }

    fn steps_in(&self, cell: usize) -> &[usize] {
        match (self.starts.get(cell), self.starts.get(cell + 1)) {
            (Some(&start), Some(&end)) => self.steps.get(start..end).unwrap_or_default(),
            _ => &[],
        }
    }
}

/// A walk along a ray from cell to cell.
struct Walk {
    cell: [isize; 2],
    step: [isize; 2],
    /// Where the ray crosses the next border of columns and of rows, and how far that is from one to the next, pixels.
    next: [f64; 2],
    pace: [f64; 2],
}

impl Walk {
    fn new(cells: &Cells, from: Vec2<f64>, direction: Vec2<f64>) -> Self {
        let (place, way) = (cells.place(from), [direction.x, direction.y]);
        let cell = place.map(|place| Real::to_count(place).cast_signed());
        let pace = way.map(|way| if way == 0.0 { f64::INFINITY } else { (CELL / way).abs() });
        let next = [0, 1].map(|axis| {
            let inside = place[axis] - cell[axis] as f64;
            let rest = if way[axis] > 0.0 { 1.0 - inside } else { inside };
            if pace[axis].is_finite() { rest * pace[axis] } else { f64::INFINITY }
        });
        Self { cell, step: way.map(|way| if way > 0.0 { 1 } else { -1 }), next, pace }
    }

    /// The cell that the walk is in and how far along the ray it leaves it; then goes on to the next one.
    fn step(&mut self, cells: &Cells) -> Option<(usize, f64)> {
        let [column, row] = self.cell.map(|place| usize::try_from(place).unwrap_or(usize::MAX));
        if column >= cells.columns || row >= cells.rows {
            return None;
        }
        let axis = usize::from(self.next[1] < self.next[0]);
        let leaves = self.next[axis];
        self.cell[axis] += self.step[axis];
        self.next[axis] += self.pace[axis];
        Some((row * cells.columns + column, leaves))
    }
}
