//! From pixels to segments: flat regions, what covers them, and distance samples along every visible outline.
//!
//! In: an image. Out: background color and, per object, color, moments and [`EdgeSample`]s. A soft pixel between two
//! regions tells the coverage of the object whose outline passes there, and the edge profile turns coverage into the
//! signed distance from the pixel center to the outline. `flat` finds regions, `region` measures them, `transition` places
//! soft pixels between them, `thin` finds what has no flat pixel, `interpret` decides which objects cover which region, `rim`
//! turns soft pixels into samples; `noisy` and `robust` do the same for noisy pictures.

pub(crate) mod color;
mod edge_kind;
mod flat;
mod interpret;
mod noisy;
mod region;
mod rim;
mod robust;
#[cfg(test)]
mod tests;
mod thin;
mod transition;

use alloc::vec::Vec;

use dvp_core::render::Compositing;
use dvp_core::{ImageView, Real};

pub(crate) use edge_kind::EdgeKind;
pub(crate) use interpret::{Border, Evidence, Stacking};
pub(crate) use noisy::NoisyOptions;

/// Signed distance from a pixel center to the outline of an object, read from the pixel's color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EdgeSample<T> {
    /// Pixel center (px).
    pub(crate) point: [T; 2],
    /// Distance (px), positive outside.
    pub(crate) distance: T,
    /// Noise of a pixel value over that of `distance`: about the change of the pixel value per px.
    pub(crate) weight: T,
}

/// Noise of a pixel value that no outline explains, at least: rounding to 8 bits and the seams of the reference renderer.
pub(crate) const PIXEL_NOISE: f64 = dvp_trace::noise::ROUNDED;

/// One object as the segmentation sees it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Segment<T> {
    pub(crate) color: [T; 3],
    /// Standard deviation of each channel of the color, that of its surest region.
    pub(crate) doubt: T,
    /// Below 1 for translucent objects.
    pub(crate) confidence: T,
    pub(crate) samples: Vec<EdgeSample<T>>,
    /// Coverage of each soft pixel at its rim: column, row, share.
    pub(crate) rim: Vec<([u32; 2], T)>,
    /// Flat pixels it covers.
    pub(crate) pixels: usize,
    /// Sums over those: x, y, xx, xy, yy (px).
    pub(crate) sums: [T; 5],
    /// Border pixels of the image among them.
    pub(crate) border: usize,
    /// Box of those pixels: first column, first row, last column + 1, last row + 1.
    pub(crate) bounds: [u32; 4],
}

impl<T: Real> Segment<T> {
    fn clear(&mut self) {
        self.samples.clear();
        self.rim.clear();
        self.doubt = T::infinity();
        self.pixels = 0;
        self.sums = [T::zero(); 5];
        self.border = 0;
        self.bounds = [u32::MAX, u32::MAX, 0, 0];
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
    /// Standard deviation of a channel that no outline explains.
    pub(crate) noise: T,
}

impl<T: Real> Default for SegmentOptions<T> {
    fn default() -> Self {
        // Flat, 0.0085: just above the seams of the reference renderer (0.0067 at full contrast) and two steps of 8 bits
        // (0.0078). Line, 0.012: three steps; seams take 1.7 of them, the rounding of the pixel and of the two colors takes 1.
        // The 4 pixels have no measured reason.
        Self { flat_tolerance: T::of(0.0085), line_tolerance: T::of(0.012), min_pixels: 4, noise: T::of(PIXEL_NOISE) }
    }
}

/// The segmentation of one image, with its memory: kept between images, it stops allocating.
#[derive(Clone, Debug, Default)]
pub(crate) struct Segmentation<T> {
    map: flat::FlatMap,
    regions: Vec<region::Region<T>>,
    region_scratch: Vec<Vec<[T; 3]>>,
    soft: transition::SoftScratch<T>,
    transitions: Vec<transition::Transition<T>>,
    reading: interpret::Reading<T>,
    segments: Vec<Segment<T>>,
    robust: robust::RobustScratch<T>,
    noise: T,
    compressed: bool,
    count: usize,
}

impl<T: Real> Segmentation<T> {
    /// Segments `image`; false if no pixel is flat. [`Self::interpret`] and [`Self::gather`] must follow.
    pub(crate) fn read(&mut self, image: &ImageView<'_, T>, options: &SegmentOptions<T>) -> bool {
        self.map.label(image, options.flat_tolerance, options.min_pixels);
        region::measure(image, &self.map, T::zero(), &mut self.regions, &mut self.region_scratch);
        let tolerance = options.line_tolerance;
        transition::find(image, &self.map, &self.regions, tolerance, &mut self.soft, &mut self.transitions);
        let thin = thin::label_thin(image, &mut self.map, &self.regions, &self.soft, tolerance);
        if let Some(thin) = thin {
            region::measure(image, &self.map, T::zero(), &mut self.regions, &mut self.region_scratch);
            let first = self.regions.len() - thin.len();
            for (region, color) in self.regions[first..].iter_mut().zip(thin) {
                region.color = color;
            }
            transition::find(image, &self.map, &self.regions, tolerance, &mut self.soft, &mut self.transitions);
        }
        self.noise = options.noise;
        self.compressed = false;
        self.reading.prepare(&self.regions, &self.transitions)
    }

    /// Which objects cover which region, if objects overlap in the given way.
    pub(crate) fn interpret(&mut self, compositing: Compositing) {
        match compositing {
            Compositing::Blend => self.reading.read_blend(&self.regions),
            Compositing::Over => self.reading.read_over(&self.regions),
        }
        self.count = self.reading.colors.len();
        self.segments.resize_with(self.segments.len().max(self.count), Segment::default);
        let objects = self.reading.colors.iter().zip(&self.reading.confidences);
        for (segment, (&color, &confidence)) in self.segments.iter_mut().zip(objects) {
            segment.color = color;
            segment.confidence = confidence;
        }
        self.gather_moments();
    }

    /// The way in which objects overlap in the present reading.
    pub(crate) fn compositing(&self) -> Compositing {
        self.reading.compositing
    }

    /// What the regions say of compositing; to be asked after interpreting them as blended.
    pub(crate) fn evidence(&self) -> Evidence {
        self.reading.evidence(&self.regions)
    }

    /// Whether the object may go on behind what is seen at the pixel.
    pub(crate) fn may_be_hidden(&self, index: usize, object: u32) -> bool {
        let label = self.map.labels.get(index).copied().unwrap_or(0);
        let cover = (label as usize).checked_sub(1).and_then(|region| self.reading.covers.get(region));
        cover.is_some_and(|cover| {
            cover.known && !cover.members().contains(&object) && self.covers(index, object).is_none()
        })
    }

    /// Which objects touch, and which of them are in front.
    pub(crate) fn borders(&self) -> &[Border] {
        &self.reading.borders
    }

    /// Whether the object may go on behind another one.
    pub(crate) fn may_go_on(&self, object: u32) -> bool {
        self.borders().iter().any(|border| border.front != Some(object) && border.objects.contains(&object))
    }

    /// Whether an object neither borders on another one nor overlaps with one.
    pub(crate) fn stands_alone(&self, object: u32) -> bool {
        !self.reading.meets_another(object)
    }

    /// Decides a border, or leaves it open.
    pub(crate) fn set_front(&mut self, border: usize, front: Option<u32>) {
        if let Some(border) = self.reading.borders.get_mut(border) {
            border.front = front;
        }
    }

    /// Makes the objects one, the first; returns what [`Self::part`] takes to undo that.
    pub(crate) fn join(&mut self, objects: &[u32]) -> Stacking {
        let before = self.reading.join(objects);
        self.gather_moments();
        before
    }

    /// Undoes [`Self::join`].
    pub(crate) fn part(&mut self, before: Stacking) {
        self.reading.restore(before);
        self.gather_moments();
    }

    pub(crate) fn background(&self) -> [T; 3] {
        self.reading.background
    }

    pub(crate) fn segments(&self) -> &[Segment<T>] {
        &self.segments[..self.count]
    }

    /// Colors of all flat regions.
    pub(crate) fn region_colors(&self) -> impl Iterator<Item = [T; 3]> + '_ {
        self.regions.iter().map(|region| region.color)
    }

    /// Indices of the pixels that speak for one object hiding another; to be asked after interpreting as blended.
    pub(crate) fn direct_pixels(&self, width: usize) -> Vec<usize> {
        let pairs = self.reading.direct_pairs(&self.regions);
        let direct = self.transitions.iter().filter(|transition| pairs.contains(&transition.pair));
        direct.map(|transition| transition.pixel[1] as usize * width + transition.pixel[0] as usize).collect()
    }

    /// Indices of the pixels between two regions, for an image of `width` columns.
    pub(crate) fn soft_pixels(&self, width: usize) -> impl Iterator<Item = usize> + '_ {
        self.transitions.iter().map(move |transition| {
            let [x, y] = transition.pixel.map(|v| v as usize);
            y * width + x
        })
    }

    /// Whether the object covers a flat pixel; none for soft pixels, regions that were not understood, and regions of
    /// objects that it may go on behind.
    pub(crate) fn covers(&self, index: usize, object: u32) -> Option<bool> {
        self.region_covers(self.map.labels.get(index).copied()?, object)
    }

    /// Per pixel its region, counted from 1; 0 for soft pixels.
    pub(crate) fn labels(&self) -> &[u32] {
        &self.map.labels
    }

    /// As [`Self::covers`], for the pixels of a label.
    pub(crate) fn region_covers(&self, label: u32, object: u32) -> Option<bool> {
        let cover = self.reading.covers.get((label as usize).checked_sub(1)?)?;
        if !cover.known {
            return None;
        }
        let inside = cover.members().contains(&object);
        (inside || !cover.members().iter().any(|&other| self.may_hide(other, object))).then_some(inside)
    }

    /// Whether `object` may go on behind `other`.
    fn may_hide(&self, other: u32, object: u32) -> bool {
        self.border(other, object).is_some_and(|border| border.front != Some(object))
    }

    fn border(&self, a: u32, b: u32) -> Option<&Border> {
        let borders = &self.reading.borders;
        let at = borders.binary_search_by_key(&[a.min(b), a.max(b)], |border| border.objects).ok()?;
        borders.get(at)
    }

    fn gather_moments(&mut self) {
        self.segments.iter_mut().take(self.count).for_each(Segment::clear);
        for (region, cover) in self.regions.iter().zip(&self.reading.covers) {
            for &object in cover.members() {
                let segment = &mut self.segments[object as usize];
                segment.doubt = segment.doubt.min(region.doubt);
                segment.pixels += region.pixels;
                segment.border += region.border;
                let [left, top, right, bottom] = region.bounds;
                let [l, t, r, b] = segment.bounds;
                segment.bounds = [l.min(left), t.min(top), r.max(right), b.max(bottom)];
                for (sum, &part) in segment.sums.iter_mut().zip(&region.sums) {
                    *sum += part;
                }
            }
        }
    }
}
