//! Flat pixels and their connected regions.
//!
//! A pixel is flat if no channel differs from a direct neighbor's by more than a tolerance; two neighbors that are both
//! flat therefore belong together, and regions are found from runs of flat pixels alone.

use alloc::vec::Vec;

use dvp_core::geometry::DisjointSets;
use dvp_core::{ImageSize, ImageView, Real, simd};

/// A run of flat pixels of one row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub(crate) row: u32,
    pub(crate) start: u32,
    pub(crate) end: u32,
    /// Region (from 1); while labeling, the index of another run of the same region.
    pub(crate) label: u32,
}

/// Labels of all pixels; 0 is soft, regions count from 1 in reading order.
#[derive(Clone, Debug, Default)]
pub(crate) struct FlatMap {
    pub(crate) runs: Vec<Run>,
    pub(crate) labels: Vec<u32>,
    pub(crate) region_count: usize,
    /// Runs that belong to one region, by their indices.
    sets: DisjointSets,
    sizes: Vec<u32>,
    horizontal: Vec<u8>,
    vertical: Vec<u8>,
    /// 0 for the flat pixels of a row, and 1 behind its end.
    soft: Vec<u8>,
}

/// Marks where two pixels one `step` apart differ by more than the tolerance in some channel.
struct MarkSteps<'a, T> {
    image: &'a ImageView<'a, T>,
    step: usize,
    tolerance: T,
    marks: &'a mut Vec<u8>,
}

impl<T: Real> simd::Kernel for MarkSteps<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let pixels = self.image.size().pixels();
        self.marks.clear();
        self.marks.resize(pixels, 0);
        let count = pixels.saturating_sub(self.step);
        let [r, g, b] = [0, 1, 2].map(|c| self.image.channel(c));
        let marks = &mut self.marks[..count];
        let (r0, g0, b0) = (&r[..count], &g[..count], &b[..count]);
        let [r1, g1, b1] = [r, g, b].map(|channel| &channel[pixels - count..]);
        for i in 0..count {
            let d = (r0[i] - r1[i]).abs().max((g0[i] - g1[i]).abs()).max((b0[i] - b1[i]).abs());
            marks[i] = u8::from(d > self.tolerance);
        }
    }
}

impl FlatMap {
    /// Labels `image`; regions below `min_pixels` count as soft.
    pub(crate) fn label<T: Real>(&mut self, image: &ImageView<'_, T>, tolerance: T, min_pixels: u32) {
        let (width, height) = (image.size().width(), image.size().height());
        simd::dispatch(MarkSteps { image, step: 1, tolerance, marks: &mut self.horizontal });
        simd::dispatch(MarkSteps { image, step: width, tolerance, marks: &mut self.vertical });
        self.collect_runs(width, height);
        self.link_runs(min_pixels);
        self.labels.clear();
        self.labels.resize(width * height, 0);
        for run in &self.runs {
            let row = run.row as usize * width;
            self.labels[row + run.start as usize..row + run.end as usize].fill(run.label);
        }
    }

    /// Takes the regions of a partition: pixels of one label, connected or not, are one region; those labeled `soft` belong
    /// to none.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
    pub(crate) fn set(&mut self, size: ImageSize, labels: &[u32], soft: u32) {
        self.runs.clear();
        self.labels.clear();
        self.labels.resize(labels.len(), 0);
        // Numbers in reading order, from 1.
        let most = labels.iter().copied().filter(|&label| label != soft).max().map_or(0, |most| most as usize + 1);
        self.sizes.clear();
        self.sizes.resize(most, 0);
        self.region_count = 0;
        for (row, line) in labels.chunks_exact(size.width()).enumerate() {
            let mut start = 0;
            for same in line.chunk_by(|a, b| a == b) {
                let end = start + same.len();
                if same[0] != soft {
                    let name = &mut self.sizes[same[0] as usize];
                    if *name == 0 {
                        self.region_count += 1;
                        *name = self.region_count as u32;
                    }
                    self.runs.push(Run { row: row as u32, start: start as u32, end: end as u32, label: *name });
                    self.labels[row * size.width() + start..row * size.width() + end].fill(*name);
                }
                start = end;
            }
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
    fn collect_runs(&mut self, width: usize, height: usize) {
        self.runs.clear();
        self.sets.reset(0);
        let (mut above, mut above_next) = (0usize, 0usize);
        for row in 0..height {
            self.mark_soft(row, width, height);
            // Behind the end of a row stands a soft pixel.
            let mut next = 0;
            while let Some(skipped) = self.soft[next..].iter().position(|&soft| soft == 0) {
                let start = next + skipped;
                let length = self.soft[start..].iter().position(|&soft| soft != 0);
                let end = length.map_or(width, |length| start + length);
                next = end;
                let id = self.sets.push();
                self.runs.push(Run { row: row as u32, start: start as u32, end: end as u32, label: id });
                // Runs of the row above that overlap this one are the same region.
                while above < above_next && self.runs[above].end <= start as u32 {
                    above += 1;
                }
                let mut other = above;
                while other < above_next && self.runs[other].start < end as u32 {
                    self.sets.unite(other as u32, id);
                    other += 1;
                }
            }
            above = self.runs.partition_point(|run| (run.row as usize) < row);
            above_next = self.runs.len();
        }
    }

    /// Fills `soft` for one row: a pixel is soft if it steps to any neighbor.
    fn mark_soft(&mut self, row: usize, width: usize, height: usize) {
        let right = &self.horizontal[row * width..(row + 1) * width];
        self.soft.clear();
        self.soft.extend_from_slice(right);
        // The last pixel of a row has no right neighbor; its mark looks at the next row.
        self.soft[width - 1] = 0;
        self.soft.push(1);
        for (soft, &left) in self.soft[1..width].iter_mut().zip(right) {
            *soft |= left;
        }
        if row > 0 {
            for (soft, &up) in self.soft.iter_mut().zip(&self.vertical[(row - 1) * width..row * width]) {
                *soft |= up;
            }
        }
        if row + 1 < height {
            for (soft, &down) in self.soft.iter_mut().zip(&self.vertical[row * width..(row + 1) * width]) {
                *soft |= down;
            }
        }
    }

    fn link_runs(&mut self, min_pixels: u32) {
        self.sizes.clear();
        self.sizes.resize(self.runs.len(), 0);
        for i in 0..self.runs.len() {
            #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 pixels")]
            let top = self.sets.root(i as u32);
            self.runs[i].label = top;
            self.sizes[top as usize] += self.runs[i].end - self.runs[i].start;
        }
        // The first run of a region is its root: its size makes room for the number.
        let mut count = 0;
        for i in 0..self.runs.len() {
            let top = self.runs[i].label as usize;
            if top == i {
                self.sizes[i] = if self.sizes[i] >= min_pixels {
                    count += 1;
                    count
                } else {
                    0
                };
            }
            self.runs[i].label = self.sizes[top];
        }
        self.runs.retain(|run| run.label != 0);
        self.region_count = count as usize;
    }
}
