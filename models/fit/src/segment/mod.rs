//! From pixels to segments: flat regions, what covers them, and distance samples along every visible outline.
//!
//! In: an image. Out: background color and, per object, color, moments and [`EdgeSample`]s. A soft pixel between two
//! regions tells the coverage of the object whose outline passes there, and the edge profile turns coverage into the
//! signed distance from the pixel center to the outline. `flat` finds regions, `region` measures them, `transition` places
//! soft pixels between them, `interpret` decides which objects cover which region.

mod flat;
mod interpret;
mod region;
mod transition;

use alloc::vec::Vec;

use dvp_core::render::EdgeProfile;
use dvp_core::{ImageView, Real};

/// Signed distance from a pixel center to the outline of an object, read from the pixel's color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeSample<T> {
    /// Pixel center (px).
    pub(crate) point: [T; 2],
    /// Distance (px), positive outside.
    pub(crate) distance: T,
    /// Change of the pixel value per px of distance, contrast x slope of the coverage: the inverse of the noise of
    /// `distance` in units of the pixel noise.
    pub(crate) weight: T,
}

/// One object as the segmentation sees it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Segment<T> {
    pub(crate) color: [T; 3],
    pub(crate) samples: Vec<EdgeSample<T>>,
    /// Flat pixels it covers.
    pub(crate) pixels: usize,
    /// Sums over those: x, y, xx, xy, yy (px).
    pub(crate) sums: [T; 5],
    /// Border pixels of the image among them.
    pub(crate) border: usize,
}

impl<T: Real> Segment<T> {
    fn clear(&mut self) {
        self.samples.clear();
        self.pixels = 0;
        self.sums = [T::zero(); 5];
        self.border = 0;
    }
}

/// Settings of the segmentation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SegmentOptions<T> {
    /// Largest channel difference between neighbors of a flat pixel.
    pub(crate) flat_tolerance: T,
    /// Largest channel distance of a soft pixel from the line between the colors of its two regions.
    pub(crate) line_tolerance: T,
    /// Smaller regions are ignored.
    pub(crate) min_pixels: u32,
}

impl<T: Real> Default for SegmentOptions<T> {
    fn default() -> Self {
        // 0.0085: just above the seams of the reference renderer (0.0067 at full contrast) and two steps of 8 bits.
        Self { flat_tolerance: T::of(0.0085), line_tolerance: T::of(0.012), min_pixels: 4 }
    }
}

/// The segmentation of one image, with its memory: kept between images, it stops allocating.
#[derive(Clone, Debug, Default)]
pub(crate) struct Segmentation<T> {
    map: flat::FlatMap,
    regions: Vec<region::Region<T>>,
    region_scratch: Vec<Vec<[T; 3]>>,
    soft: transition::SoftScratch,
    transitions: Vec<transition::Transition<T>>,
    reading: interpret::Reading<T>,
    segments: Vec<Segment<T>>,
    count: usize,
}

impl<T: Real> Segmentation<T> {
    /// Segments `image`; false if no pixel is flat.
    pub(crate) fn run(&mut self, image: &ImageView<'_, T>, edge: &EdgeProfile<T>, options: &SegmentOptions<T>) -> bool {
        self.count = 0;
        self.map.label(image, options.flat_tolerance, options.min_pixels);
        region::measure(image, &self.map, &mut self.regions, &mut self.region_scratch);
        let tolerance = options.line_tolerance;
        transition::find(image, &self.map, &self.regions, tolerance, &mut self.soft, &mut self.transitions);
        if !self.reading.read(&self.regions, &self.transitions) {
            return false;
        }
        self.count = self.reading.colors.len();
        self.segments.resize_with(self.segments.len().max(self.count), Segment::default);
        for (segment, &color) in self.segments.iter_mut().zip(&self.reading.colors) {
            segment.clear();
            segment.color = color;
        }
        self.gather_moments();
        self.gather_samples(image, edge);
        true
    }

    pub(crate) fn background(&self) -> [T; 3] {
        self.reading.background
    }

    pub(crate) fn segments(&self) -> &[Segment<T>] {
        &self.segments[..self.count]
    }

    /// Whether the pixel belongs to a flat region.
    pub(crate) fn is_flat(&self, index: usize) -> bool {
        self.map.labels.get(index).is_some_and(|&label| label != 0)
    }

    fn gather_moments(&mut self) {
        for (region, cover) in self.regions.iter().zip(&self.reading.covers) {
            for &object in cover.members() {
                let segment = &mut self.segments[object as usize];
                segment.pixels += region.pixels;
                segment.border += region.border;
                for (sum, &part) in segment.sums.iter_mut().zip(&region.sums) {
                    *sum += part;
                }
            }
        }
    }

    fn gather_samples(&mut self, image: &ImageView<'_, T>, edge: &EdgeProfile<T>) {
        let unit = T::of_usize(image.size().unit_px());
        let (one, half) = (T::one(), T::of(0.5));
        for transition in &self.transitions {
            let [a, b] = transition.pair.map(|i| i as usize);
            let (cover_a, cover_b) = (&self.reading.covers[a], &self.reading.covers[b]);
            let (object, others, along, inside, outside) = if let Some(object) = cover_b.beyond(cover_a) {
                (object, cover_a.members().len(), transition.weight, b, a)
            } else if let Some(object) = cover_a.beyond(cover_b) {
                (object, cover_b.members().len(), one - transition.weight, a, b)
            } else {
                continue;
            };
            // Along the line from the mean of n objects to the mean of n + 1, coverage p shows as p (n + 1) / (n + p).
            let n = T::of_usize(others);
            let coverage = if others == 0 { along } else { along * n / (n + one - along) };
            let Some((distance, slope)) = distance_of_coverage(coverage, edge, unit) else { continue };
            let share = if others == 0 { one } else { n * (n + one) / ((n + coverage) * (n + coverage)) };
            let (inner, outer) = (self.regions[inside].color, self.regions[outside].color);
            let contrast = (0..3).map(|c| (inner[c] - outer[c]) * (inner[c] - outer[c])).sum::<T>().sqrt();
            let [x, y] = transition.pixel.map(|v| T::of_usize(v as usize) + half);
            let sample = EdgeSample { point: [x, y], distance, weight: contrast * slope * share };
            self.segments[object as usize].samples.push(sample);
        }
    }
}

/// Inverts the edge profile: signed distance (px) at which coverage is `coverage`, and the slope of coverage there
/// (per px); none where coverage is too close to 0 or 1 to tell.
fn distance_of_coverage<T: Real>(coverage: T, edge: &EdgeProfile<T>, unit_px: T) -> Option<(T, T)> {
    if !(coverage > T::of(0.02) && coverage < T::of(0.985)) {
        return None;
    }
    let (one, two) = (T::one(), T::of(2.0));
    let doubled_px = unit_px / two;
    if edge.sigma <= T::zero() {
        // Area coverage of a half plane parallel to the pixel grid.
        return Some((T::of(0.5) - coverage, one));
    }
    let d2 = edge.offset - edge.sigma * (coverage / (one - coverage)).ln();
    let d = d2.abs().sqrt() * d2.signum();
    let slope = coverage * (one - coverage) / edge.sigma * two * d.abs() / doubled_px;
    Some((d * doubled_px, slope))
}
