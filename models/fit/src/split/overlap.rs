//! What is seen of two objects of one color where both have a share in a pixel.
//!
//! Neither outline is where the pixel says then: it shows 1 - (1 - c) (1 - c') of coverages c and c', as if one outline were
//! nearer than both.

use dvp_core::Real;
use dvp_core::scene::PixelProfile;

/// Least coverage of the other object that shows.
const SHOWS: f64 = 1e-3;

/// How coverages of the picture go by distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Overlap<T>(pub(crate) PixelProfile<T>);

impl<T: Real> Overlap<T> {
    /// The distance (px) that the pixel of two outlines at these distances shows, and its derivatives by them.
    pub(super) fn union(&self, distances: [T; 2]) -> (T, [T; 2]) {
        let Self(profile) = self;
        let [one, zero] = [T::one(), T::zero()];
        let nearest = usize::from(distances[1] < distances[0]);
        let alone = (distances[nearest], if nearest == 0 { [one, zero] } else { [zero, one] });
        let [near, far] = [nearest, 1 - nearest].map(|k| profile.coverage(distances[k]));
        // Where the nearer one covers all or nothing the pixel tells no distance.
        if far.0 < T::of(SHOWS) || near.0 > one - T::of(SHOWS) {
            return alone;
        }
        let distance = profile.distance(one - (one - near.0) * (one - far.0));
        let slope = profile.coverage(distance).1;
        // On the outline squared distances have no slope to divide by.
        if slope.abs() < T::of(SHOWS) {
            return alone;
        }
        let [near, far] = [near.1 * (one - far.0) / slope, far.1 * (one - near.0) / slope];
        (distance, if nearest == 0 { [near, far] } else { [far, near] })
    }

    /// The distance (px) of one outline where the pixel shows `seen`, and the other one is at `other`, and its derivative by
    /// what is seen; none where the other covers most of what is seen.
    pub(super) fn alone(&self, seen: T, other: T) -> Option<(T, T)> {
        let Self(profile) = self;
        let one = T::one();
        let other = profile.coverage(other).0;
        if other < T::of(SHOWS) {
            return Some((seen, one));
        }
        let all = profile.coverage(seen);
        let own = one - (one - all.0) / (one - other);
        // Also none of what is no number, where the other covers all.
        let is_most = own >= T::of(0.5) * all.0 && own >= T::of(0.02);
        if !is_most {
            return None;
        }
        let distance = profile.distance(own);
        Some((distance, all.1 / ((one - other) * profile.coverage(distance).1)))
    }
}
