//! How much each pixel counts: LIVE's loss guided by the unsigned distance to the outlines (UDF).
//!
//! In: a drawing. Out: a weight per pixel, which falls from the outlines to 0 at some distance, and the squared error so
//! weighted. What a shape does far from its outline no step of its outline can mend; without these pixels a shape is not
//! drawn toward the mean color of a region that other shapes are to explain.

use alloc::vec::Vec;

use dvp_core::geometry::{LineSegment, Px, Vec2};
use dvp_core::simd::{Kernel, dispatch};
use dvp_core::{Drawing, ImageSize, ImageView, Real};

use super::descent::Errors;

/// Weights of pixels; keeps its memory from step to step.
#[derive(Clone, Debug, Default)]
pub struct Focus<T> {
    /// Per pixel, row by row; their sum is 1.
    weights: Vec<T>,
    /// The numbers of the columns.
    columns: Vec<T>,
}

impl<T: Real> Focus<T> {
    /// Weights without memory yet.
    #[must_use]
    pub fn new() -> Self {
        Self { weights: Vec::new(), columns: Vec::new() }
    }

    /// The weights of the pixels, row by row; their sum is 1.
    #[must_use]
    pub fn weights(&self) -> &[T] {
        &self.weights
    }

    /// Weighs a pixel by max(0, `reach` - d), d the distance of its center to the nearest outline of `drawing`, over the sum of these of
    /// all pixels; all alike where no outline is near any pixel.
    ///
    /// *Units*: pixels. *Derivative*: none, weights count as constant.
    ///
    /// *Source*: Ma et al., Towards Layer-wise Image Vectorization, CVPR 2022, where the reach is 10.
    pub fn measure(&mut self, drawing: &Drawing<T>, size: ImageSize, reach: Px<T>) {
        let squared = reach.0 * reach.0;
        self.columns.clear();
        self.columns.extend((0..size.width()).map(T::of_usize));
        self.weights.clear();
        self.weights.resize(size.pixels(), squared);
        // The center of the first pixel is the origin.
        let half = T::of(0.5);
        let to_px = |point: Vec2<T>| Px::of_point(point, size).0 - Vec2::new(half, half);
        for object in 0..drawing.object_count() {
            for ring in drawing.rings(object).iter() {
                for edge in LineSegment::closed(ring) {
                    let edge = LineSegment::new(to_px(edge.from), to_px(edge.from + edge.along));
                    dispatch(Near { edge, reach: reach.0, columns: &self.columns, squared: &mut self.weights });
                }
            }
        }
        let mut sum = 0.0;
        for row in self.weights.chunks_exact_mut(size.width()) {
            row.iter_mut().for_each(|weight| *weight = reach.0 - weight.sqrt());
            sum += row.iter().copied().sum::<T>().as_f64();
        }
        if sum > 0.0 {
            let share = T::of(1.0 / sum);
            self.weights.iter_mut().for_each(|weight| *weight *= share);
        } else {
            self.weights.fill(T::of(1.0 / f64::of_usize(size.pixels())));
        }
    }

    /// The mean of the squared differences of planar `painted` and `image`, pixels weighted and the three channels counting
    /// alike, and the same without weights; writes the gradient of the first by `painted` to `grad`.
    ///
    /// *Dimensions*: `painted` and `grad` as long as the image's data; what is beyond the shortest is left out.
    pub(super) fn errors_and_grad(&self, image: ImageView<'_, T>, painted: &[T], grad: &mut [T]) -> Errors<T> {
        let pixels = self.weights.len().max(1);
        let third = T::of(1.0 / 3.0);
        let (mut focused, mut even) = (0.0, 0.0);
        let planes = image.data().chunks_exact(pixels).zip(painted.chunks_exact(pixels));
        for ((target, painted), grad) in planes.zip(grad.chunks_exact_mut(pixels)) {
            let width = image.size().width();
            let rows = target.chunks(width).zip(painted.chunks(width)).zip(self.weights.chunks(width));
            for (((target, painted), weights), grad) in rows.zip(grad.chunks_mut(width)) {
                let (mut weighted, mut plain) = (T::zero(), T::zero());
                for (((&a, &b), &weight), grad) in target.iter().zip(painted).zip(weights).zip(grad) {
                    let difference = b - a;
                    let pull = weight * third * difference;
                    *grad = pull + pull;
                    weighted += pull * difference;
                    plain += difference * difference;
                }
                focused += weighted.as_f64();
                even += plain.as_f64();
            }
        }
        Errors { objective: T::of(focused), even: T::of(even / f64::of_usize(3 * pixels)) }
    }
}

/// Lowers squared distances to those from an edge, in the box around it that the reach makes.
struct Near<'a, T> {
    edge: LineSegment<T>,
    reach: T,
    columns: &'a [T],
    squared: &'a mut [T],
}

impl<T: Real> Kernel for Near<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { edge: LineSegment { from, along, inverse_squared }, reach, columns, squared } = self;
        let (zero, one, width) = (T::zero(), T::one(), columns.len());
        let range = |from: T, along: T, count: usize| {
            let [low, high] = if along < zero { [from + along, from] } else { [from, from + along] };
            let end = (high + reach + one).to_count().min(count);
            (low - reach).ceil().to_count().min(end)..end
        };
        let across = range(from.x, along.x, width);
        for row in range(from.y, along.y, squared.len() / width.max(1)) {
            let y = T::of_usize(row) - from.y;
            let line = &mut squared[row * width..][..width];
            for (squared, &column) in line[across.clone()].iter_mut().zip(&columns[across.clone()]) {
                let x = column - from.x;
                // Comparisons rather than `min` and `max`: they become single instructions.
                let share = (x * along.x + y * along.y) * inverse_squared;
                let share = if share > zero { share } else { zero };
                let share = if share < one { share } else { one };
                let (off_x, off_y) = (x - along.x * share, y - along.y * share);
                let own = off_x * off_x + off_y * off_y;
                *squared = if own < *squared { own } else { *squared };
            }
        }
    }
}
