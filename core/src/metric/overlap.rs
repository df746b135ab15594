//! Intersection over union of masks, pooled over images.

/// Counts of pixels in both masks and in either, summed over images: large objects count more than small ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaskOverlap {
    intersection: u64,
    union: u64,
}

impl MaskOverlap {
    /// Adds the pixels of one image; pixels without a partner are left out.
    pub fn add(&mut self, a: impl IntoIterator<Item = bool>, b: impl IntoIterator<Item = bool>) {
        for (a, b) in a.into_iter().zip(b) {
            self.intersection += u64::from(a && b);
            self.union += u64::from(a || b);
        }
    }

    /// Adds the counts of another part of the data.
    pub fn merge(&mut self, other: &Self) {
        self.intersection += other.intersection;
        self.union += other.union;
    }

    /// Intersection over union; 1 if both masks are empty.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "below 2^53 pixels the counts are exact")]
    pub fn iou(&self) -> f64 {
        if self.union == 0 { 1.0 } else { self.intersection as f64 / self.union as f64 }
    }
}
