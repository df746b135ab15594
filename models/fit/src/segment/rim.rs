//! Soft pixels as parts of outlines: whose outline passes there, how much of the pixel it covers, and how far away it is.

use dvp_core::render::Compositing;
use dvp_core::{ImageSize, Real};

use super::{EdgeKind, EdgeSample, Segmentation, transition};

impl<T: Real> Segmentation<T> {
    /// Turns soft pixels into samples of one object under the given edge kind.
    pub(crate) fn gather_object(&mut self, object: u32, size: ImageSize, edge: &EdgeKind<T>) {
        let mut segment = core::mem::take(&mut self.segments[object as usize]);
        segment.samples.clear();
        segment.rim.clear();
        for transition in &self.transitions {
            let ours = transition.pair.iter().any(|&i| self.reading.covers[i as usize].members().contains(&object));
            if ours
                && let Some(rim) = self.rim(transition)
                && rim.object == object as usize
            {
                segment.rim.push((transition.pixel, rim.coverage));
                segment.samples.extend(sample(&rim, transition, edge, size, self.noise, self.is_compressed()));
            }
        }
        self.segments[object as usize] = segment;
    }

    /// Turns soft pixels into samples under the given edge kind.
    pub(crate) fn gather(&mut self, size: ImageSize, edge: &EdgeKind<T>) {
        for segment in &mut self.segments {
            segment.samples.clear();
            segment.rim.clear();
        }
        for at in 0..self.transitions.len() {
            let transition = self.transitions[at];
            let Some(rim) = self.rim(&transition) else {
                self.share_between(&transition);
                continue;
            };
            let sample = sample(&rim, &transition, edge, size, self.noise, self.is_compressed());
            let segment = &mut self.segments[rim.object];
            segment.rim.push((transition.pixel, rim.coverage));
            segment.samples.extend(sample);
        }
    }

    /// A soft pixel from one object to another, without their overlap between: it belongs to each in part. That is good
    /// enough to trace outlines by, but tells no distance.
    fn share_between(&mut self, transition: &transition::Transition<T>) {
        if self.reading.compositing == Compositing::Over {
            return;
        }
        let covers = transition.pair.map(|i| self.reading.covers[i as usize]);
        if covers.iter().all(|cover| cover.known) {
            for (own, other, share) in [(0, 1, T::one() - transition.weight), (1, 0, transition.weight)] {
                for &object in covers[own].members() {
                    if !covers[other].members().contains(&object) {
                        self.segments[object as usize].rim.push((transition.pixel, share));
                    }
                }
            }
        }
    }

    /// Whose outline passes through a soft pixel, and how much of it that object covers.
    pub(super) fn rim(&self, transition: &transition::Transition<T>) -> Option<Rim<T>> {
        let one = T::one();
        let [a, b] = transition.pair.map(|i| i as usize);
        let (cover_a, cover_b) = (&self.reading.covers[a], &self.reading.covers[b]);
        let (object, others, along) = if let Some(object) = cover_b.beyond(cover_a) {
            (object, cover_a.members().len(), transition.weight)
        } else if let Some(object) = cover_a.beyond(cover_b) {
            (object, cover_b.members().len(), one - transition.weight)
        } else {
            // One object beside the other: the outline is that of the one in front.
            let ([x], [y]) = (cover_a.members(), cover_b.members()) else { return None };
            let front = self.border(*x, *y)?.front?;
            (front, 0, if front == *y { transition.weight } else { one - transition.weight })
        };
        // Under `over` coverage is the way from one color to the other. Along the line from the mean of n objects to the
        // mean of n + 1, coverage p shows as p (n + 1) / (n + p).
        let others = if self.reading.compositing == Compositing::Over { 0 } else { others };
        let n = T::of_usize(others);
        let coverage = if others == 0 { along } else { along * n / (n + one - along) };
        let (from, to) = (self.regions[a].color, self.regions[b].color);
        let contrast = (0..3).map(|c| (from[c] - to[c]) * (from[c] - to[c])).sum::<T>().sqrt();
        Some(Rim { object: object as usize, others, coverage, contrast })
    }
}

/// The distance that a soft pixel, of a picture that may be `coded`, tells; none where coverage is too close to 0 or 1.
pub(super) fn sample<T: Real>(
    rim: &Rim<T>,
    transition: &transition::Transition<T>,
    edge: &EdgeKind<T>,
    size: ImageSize,
    pixel_noise: T,
    coded: bool,
) -> Option<EdgeSample<T>> {
    let own = edge.distance_noise();
    let (one, half) = (T::one(), T::of(0.5));
    let unit = T::of_usize(size.unit_px());
    let known = edge.distance(rim.coverage, unit);
    // Pixels that are covered in whole beside ones not covered at all: the outline runs between them.
    let between = || {
        let to_nearest = (rim.coverage - rim.coverage.round()).abs();
        let exact = transition.step && *edge == EdgeKind::Area && to_nearest < T::of(0.02);
        exact.then_some((half - rim.coverage, one))
    };
    let (distance, slope) = known.or_else(between)?;
    let n = T::of_usize(rim.others);
    let share = if rim.others == 0 { one } else { n * (n + one) / ((n + rim.coverage) * (n + rim.coverage)) };
    let [x, y] = transition.pixel.map(|v| T::of_usize(v as usize) + half);
    // Pixel noise over the slope, and the noise of the distance itself.
    let from_pixel = pixel_noise / (rim.contrast * slope * share).max(T::of(1e-6));
    // A coder spreads edges by about their own width: only in their middle are they where they were.
    let spread =
        if coded { distance - edge.distance(half, unit).map_or(distance, |(middle, _)| middle) } else { T::zero() };
    let weight = pixel_noise / (from_pixel * from_pixel + own * own + spread * spread).sqrt();
    Some(EdgeSample { point: [x, y], distance, weight })
}

/// A soft pixel as part of an object's rim.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim<T> {
    pub(super) object: usize,
    /// Objects below it there.
    pub(super) others: usize,
    pub(super) coverage: T,
    pub(super) contrast: T,
}
