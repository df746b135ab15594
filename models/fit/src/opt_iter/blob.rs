//! The largest blob of an error map: where, in which color and orientation the next object starts.

use alloc::vec::Vec;

use dvp_core::image::CHANNELS;
use dvp_core::{ImageSize, ImageView, Real};

/// Mean absolute error over the channels below which a pixel counts as explained.
const EXPLAINED: f64 = 0.02;

/// Largest difference of a channel between neighbors of one blob: objects that touch in different colors are two blobs,
/// and noise of a few 8-bit steps tears none apart.
const SAME_COLOR: f64 = 0.04;

/// Which of two blobs is the larger one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BlobSize {
    /// That with the larger sum of errors.
    Error,
    /// That with more pixels.
    Pixels,
}

/// A connected region of one color that the scene does not explain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blob<T> {
    /// Mean position, scene units.
    pub center: [T; 2],
    /// Center of the pixel of the region that is nearest to the mean position, scene units.
    pub inside: [T; 2],
    /// Direction of the long axis, radians in (-pi/2, pi/2\].
    pub orientation: T,
    /// Half the long and the short axis of the ellipse with the same second moments, scene units; above 0.
    pub half_axes: [T; 2],
    /// Mean color of the image in the region.
    pub color: [T; CHANNELS],
    /// Sum over the region of the mean absolute error per pixel.
    pub error: T,
    /// Pixels of the region.
    pub pixels: usize,
}

/// Finds blobs; keeps its memory from call to call.
#[derive(Clone, Debug, Default)]
pub struct BlobFinder<T> {
    error: Vec<T>,
    /// Per pixel, the seed of its blob plus 1; 0 for explained pixels.
    labels: Vec<usize>,
    stack: Vec<usize>,
    /// Label of the largest blob; 0 if there was none.
    largest: usize,
}

impl<T: Real> BlobFinder<T> {
    /// A finder without memory yet.
    #[must_use]
    pub fn new() -> Self {
        Self { error: Vec::new(), labels: Vec::new(), stack: Vec::new(), largest: 0 }
    }

    /// The blob with the largest summed error of `image` against planar `painted`; none if they are equal.
    ///
    /// A pixel is unexplained if its error is above 0.02, or above half the largest error where that is less. Blobs are
    /// connected through edges of pixels.
    pub fn largest(&mut self, image: ImageView<'_, T>, painted: &[T]) -> Option<Blob<T>> {
        self.largest_by(BlobSize::Error, image, painted)
    }

    /// As [`Self::largest`], by the measure of `size`; of equal ones the first, row by row.
    pub fn largest_by(&mut self, size: BlobSize, image: ImageView<'_, T>, painted: &[T]) -> Option<Blob<T>> {
        let pixels = image.size().pixels();
        let third = T::of(1.0 / 3.0);
        self.error.clear();
        self.error.resize(pixels, T::zero());
        for (target, painted) in image.data().chunks_exact(pixels).zip(painted.chunks_exact(pixels)) {
            for ((error, &a), &b) in self.error.iter_mut().zip(target).zip(painted) {
                *error += (a - b).abs() * third;
            }
        }
        let largest = self.error.iter().copied().fold(T::zero(), T::max);
        let threshold = T::of(EXPLAINED).min(largest / T::of(2.0));
        self.labels.clear();
        self.labels.resize(pixels, 0);
        self.largest = 0;
        let mut best = None;
        for seed in 0..pixels {
            if self.error[seed] > threshold && self.labels[seed] == 0 {
                let sums = self.flood(image, seed, threshold);
                let is_larger = |best: &Sums<T>| match size {
                    BlobSize::Error => sums.error > best.error,
                    BlobSize::Pixels => sums.count > best.count,
                };
                if best.as_ref().is_none_or(is_larger) {
                    best = Some(sums);
                    self.largest = seed + 1;
                }
            }
        }
        best.map(|sums| {
            let nearest = self.nearest(image.size(), sums.mean());
            sums.blob(image.size(), nearest)
        })
    }

    /// The pixel of the blob last found that is nearest to a place; places and pixels as column and row.
    fn nearest(&self, size: ImageSize, [x, y]: [f64; 2]) -> [f64; 2] {
        let own = self.labels.iter().enumerate().filter(|&(_, &label)| label == self.largest);
        let places = own.map(|(index, _)| [index % size.width(), index / size.width()].map(f64::of_usize));
        let squared = |[column, row]: [f64; 2]| (column - x) * (column - x) + (row - y) * (row - y);
        places.min_by(|&a, &b| squared(a).total_cmp(&squared(b))).unwrap_or([x, y])
    }

    /// Replaces every unexplained pixel of planar `pixels` that is not in the blob last found by that of `painted`.
    pub fn hide_others(&self, painted: &[T], pixels: &mut [T]) {
        let planes =
            pixels.chunks_exact_mut(self.labels.len().max(1)).zip(painted.chunks_exact(self.labels.len().max(1)));
        for (plane, painted) in planes {
            for ((pixel, &painted), &label) in plane.iter_mut().zip(painted).zip(&self.labels) {
                if label != 0 && label != self.largest {
                    *pixel = painted;
                }
            }
        }
    }

    /// Sums over the blob of `seed`; its pixels get its label.
    fn flood(&mut self, image: ImageView<'_, T>, seed: usize, threshold: T) -> Sums<T> {
        let (width, height) = (image.size().width(), image.size().height());
        let tolerance = T::of(SAME_COLOR);
        let mut sums = Sums::default();
        let (error, labels, stack) = (&self.error, &mut self.labels, &mut self.stack);
        let mut enter = |stack: &mut Vec<usize>, index: usize, from: [T; CHANNELS]| {
            let color = image.pixel(index);
            let same = color.iter().zip(from).all(|(&a, b)| (a - b).abs() <= tolerance);
            if labels[index] == 0 && error[index] > threshold && same {
                sums.add(index % width, index / width, color, error[index]);
                labels[index] = seed + 1;
                stack.push(index);
            }
        };
        enter(stack, seed, image.pixel(seed));
        while let Some(index) = stack.pop() {
            let color = image.pixel(index);
            let (x, y) = (index % width, index / width);
            if x > 0 {
                enter(stack, index - 1, color);
            }
            if x + 1 < width {
                enter(stack, index + 1, color);
            }
            if y > 0 {
                enter(stack, index - width, color);
            }
            if y + 1 < height {
                enter(stack, index + width, color);
            }
        }
        sums
    }
}

/// Moments of a blob up to order 2, in pixels.
#[derive(Clone, Debug, Default)]
struct Sums<T> {
    count: usize,
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
    color: [T; CHANNELS],
    error: T,
}

impl<T: Real> Sums<T> {
    fn add(&mut self, x: usize, y: usize, color: [T; CHANNELS], error: T) {
        let (x, y) = (f64::of_usize(x), f64::of_usize(y));
        self.count += 1;
        self.x += x;
        self.y += y;
        self.xx += x * x;
        self.xy += x * y;
        self.yy += y * y;
        for (sum, value) in self.color.iter_mut().zip(color) {
            *sum += value;
        }
        self.error += error;
    }

    /// Mean column and row.
    fn mean(&self) -> [f64; 2] {
        let count = f64::of_usize(self.count);
        [self.x / count, self.y / count]
    }

    fn blob(&self, size: ImageSize, inside: [f64; 2]) -> Blob<T> {
        let count = f64::of_usize(self.count);
        let [x, y] = self.mean();
        let (xx, xy, yy) = (self.xx / count - x * x, self.xy / count - x * y, self.yy / count - y * y);
        let unit = f64::of_usize(size.unit_px());
        // The variances along the axes; a pixel has one of its own. That of an ellipse is a quarter of the half axis squared.
        let (middle, off) = ((xx + yy) / 2.0 + 1.0 / 12.0, num_traits::Float::hypot((xx - yy) / 2.0, xy));
        let half_axis = |variance: f64| T::of(2.0 * num_traits::Float::sqrt(variance.max(1.0 / 12.0)) / unit);
        let place = |place: [f64; 2]| place.map(|value| T::of((value + 0.5) / unit));
        Blob {
            center: place([x, y]),
            inside: place(inside),
            orientation: T::of(0.5 * num_traits::Float::atan2(2.0 * xy, xx - yy)),
            half_axes: [half_axis(middle + off), half_axis(middle - off)],
            color: self.color.map(|sum| sum / T::of(count)),
            error: self.error,
            pixels: self.count,
        }
    }
}
