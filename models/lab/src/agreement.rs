//! Whether a scene found is the true one, object by object.
//!
//! In: two scenes and the size of their picture. Out: [`Agreement`], which object is which and how well they agree.
//!
//! Objects are compared by what is seen of each: the coverage that its scene's own edge profile gives it, soft edges made
//! a pixel wide about half coverage, under `over` less what later objects hide. So an outline drawn a pixel farther out
//! under a profile that is a pixel narrower is the same object, as is a sharp one in a blurred picture; objects of two
//! pixels are told apart to fractions of a pixel; and what is hidden does not count: that is a guess, and the fit says so.

use dvp_core::render::{Compositing, ContourRenderer};
use dvp_core::{ImageSize, Real, Scene};

use dvp_cli::paint::{PaintError, Painter};

/// An object of which less is seen (px) is not there.
const LEAST_SEEN_PX: f64 = 0.5;

/// An object found that is one of the true ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// Index of the object found.
    pub found: usize,
    /// Intersection over union of what is seen of the two, (0, 1].
    pub iou: f64,
}

/// Which object is which.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Agreement {
    /// Per true object, the object found that is it, if there is one; none has two.
    pub matches: Vec<Option<Match>>,
    /// Per true object, whether it is seen at all.
    pub is_seen: Vec<bool>,
    /// Objects found that are seen.
    pub found: usize,
}

impl Agreement {
    /// Compares two scenes of a picture of `size`. The best pairs are taken first: two objects of an IoU above 1/2 have no
    /// better partner unless others lie on the same pixels.
    ///
    /// # Errors
    /// [`PaintError`] if a scene cannot be drawn.
    pub fn of(truth: &Scene<f32>, found: &Scene<f32>, size: ImageSize) -> Result<Self, PaintError> {
        let [truly, found] = [Seen::of(truth, size)?, Seen::of(found, size)?];
        let mut pairs = truly.pairs(&found, size);
        pairs.sort_by(|a, b| b.1.iou.total_cmp(&a.1.iou));
        let mut matches = vec![None; truly.areas.len()];
        let mut taken = vec![false; found.areas.len()];
        for (object, pair) in pairs {
            if matches[object].is_none() && !taken[pair.found] {
                (matches[object], taken[pair.found]) = (Some(pair), true);
            }
        }
        let is_seen = |areas: &[f64]| areas.iter().map(|&area| area >= LEAST_SEEN_PX).collect::<Vec<_>>();
        let count = is_seen(&found.areas).into_iter().filter(|&seen| seen).count();
        Ok(Self { matches, is_seen: is_seen(&truly.areas), found: count })
    }

    /// True objects that are seen.
    #[must_use]
    pub fn expected(&self) -> usize {
        self.is_seen.iter().filter(|&&seen| seen).count()
    }

    /// The worst IoU of a true object that is seen, 0 where one was not found; 1 if there is none.
    #[must_use]
    pub fn worst(&self) -> f64 {
        let seen = self.matches.iter().zip(&self.is_seen).filter(|(_, seen)| **seen);
        seen.map(|(pair, _)| pair.map_or(0.0, |pair| pair.iou)).fold(1.0, f64::min)
    }

    /// Whether the count is right and every object agrees to the given IoU.
    #[must_use]
    pub fn holds(&self, iou: f64) -> bool {
        self.found == self.expected() && self.worst() >= iou
    }
}

/// What is seen of the objects of a scene.
struct Seen {
    /// Runs of pixels, object by object in painting order: object, first pixel, coverage.
    runs: Vec<(usize, usize, Vec<f32>)>,
    /// Per object, the sum of its coverage, px.
    areas: Vec<f64>,
}

impl Seen {
    fn of(scene: &Scene<f32>, size: ImageSize) -> Result<Self, PaintError> {
        let drawing = Painter::default().draw(scene, size)?;
        let renderer = ContourRenderer::new(scene.edge, scene.compositing);
        let profile = scene.edge.in_pixels(f32::of_usize(size.unit_px()));
        // Px in which coverage falls by 1, at its slope between 3/4 and 1/4.
        let width = 2.0 * (profile.distance(0.25) - profile.distance(0.75));
        let sharpened = |coverage: &f32| (0.5 + (coverage - 0.5) * width.max(1.0)).clamp(0.0, 1.0);
        let mut runs: Vec<(usize, usize, Vec<f32>)> = Vec::new();
        renderer.visit_coverage(&drawing, size, &mut Default::default(), |object, pixel, coverage| {
            runs.push((object, pixel, coverage.iter().map(sharpened).collect()));
        })?;
        if scene.compositing == Compositing::Over {
            let mut clear = vec![1.0_f32; size.pixels()];
            for (_, first, coverage) in runs.iter_mut().rev() {
                for (clear, coverage) in clear[*first..].iter_mut().zip(coverage) {
                    let covered = *coverage;
                    *coverage *= *clear;
                    *clear *= 1.0 - covered;
                }
            }
        }
        let mut areas = vec![0.0; drawing.object_count()];
        for (object, _, coverage) in &runs {
            areas[*object] += coverage.iter().map(|&v| f64::from(v)).sum::<f64>();
        }
        Ok(Self { runs, areas })
    }

    /// All pairs of a true object and one found that have pixels in common.
    fn pairs(&self, found: &Self, size: ImageSize) -> Vec<(usize, Match)> {
        let mut plane = vec![0.0_f32; size.pixels()];
        let mut pairs = Vec::new();
        for object in 0..found.areas.len() {
            plane.fill(0.0);
            for (_, first, coverage) in found.runs.iter().filter(|run| run.0 == object) {
                plane[*first..][..coverage.len()].copy_from_slice(coverage);
            }
            let mut both = vec![0.0; self.areas.len()];
            for (truly, first, coverage) in &self.runs {
                let common = coverage.iter().zip(&plane[*first..]).map(|(a, b)| f64::from(a.min(*b)));
                both[*truly] += common.sum::<f64>();
            }
            for (truly, both) in both.into_iter().enumerate().filter(|(_, both)| *both > 0.0) {
                let iou = both / (self.areas[truly] + found.areas[object] - both);
                pairs.push((truly, Match { found: object, iou: iou.min(1.0) }));
            }
        }
        pairs
    }
}

#[cfg(test)]
mod tests {
    use dvp_core::render::EdgeProfile;
    use dvp_core::{Efd, Object, Pose};

    use super::*;

    /// A disk at `x` (px of 64) of radius `r` px, under edges of no width.
    fn disks(places: &[(f32, f32)]) -> Scene<f32> {
        let object = |&(x, r): &(f32, f32)| {
            let pose = Pose { translation: [x / 64.0, 0.5], scale: r / 64.0, rotation: 0.0 };
            Object::of_efd(pose, [0.0; 3], 1.0, Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]), None)
        };
        let objects = places.iter().map(object).collect();
        Scene { objects, edge: EdgeProfile::area(), compositing: Compositing::Over, ..Scene::empty([1.0; 3]) }
    }

    fn compare(truth: &[(f32, f32)], found: &[(f32, f32)]) -> Agreement {
        Agreement::of(&disks(truth), &disks(found), ImageSize::new(64, 64).unwrap()).unwrap()
    }

    #[test]
    fn disks_by_hand() {
        // Radii 10 and 9 about one center: IoU 0.81. The order does not matter.
        let found = compare(&[(15.0, 10.0), (45.0, 10.0)], &[(45.0, 10.0), (15.0, 9.0)]);
        assert_eq!((found.matches[0].unwrap().found, found.matches[1].unwrap().found), (1, 0));
        assert!((found.worst() - 0.81).abs() < 0.005, "{}", found.worst());
        assert!(found.holds(0.8) && !found.holds(0.82));
        // One too many, one too few, one elsewhere.
        assert!(!compare(&[(15.0, 9.0)], &[(15.0, 9.0), (45.0, 9.0)]).holds(0.5));
        assert!(!compare(&[(15.0, 9.0), (45.0, 9.0)], &[(15.0, 9.0)]).holds(0.5));
        assert!(compare(&[(15.0, 9.0)], &[(45.0, 9.0)]).worst() < 1e-9);
        assert!(compare(&[], &[]).holds(1.0));
    }

    #[test]
    fn what_is_hidden_does_not_count() {
        // The first disk lies wholly under the second one, wherever in there.
        let found = compare(&[(30.0, 5.0), (32.0, 12.0)], &[(34.0, 3.0), (32.0, 12.0)]);
        assert_eq!((found.expected(), found.found, &*found.is_seen), (1, 1, &[false, true][..]));
        assert!(found.holds(0.999));
    }

    #[test]
    fn fractions_of_a_pixel_count() {
        // A disk of radius 1 that is off by 0.1 px: of 3.14 px both have 2.94 in common, 0.88 of the union.
        let worst = compare(&[(32.5, 1.0)], &[(32.6, 1.0)]).worst();
        assert!((0.82..0.92).contains(&worst), "{worst}");
        // Another profile that looks the same is the same: the reference's outline lies 1.43 px inside at 128 px.
        let truth = disks(&[(32.0, 10.0)]);
        let mut found = disks(&[(32.0, 10.0)]);
        found.edge = EdgeProfile::reference();
        found.objects[0].pose.scale -= EdgeProfile::<f32>::reference().half_coverage();
        let agreement = Agreement::of(&truth, &found, ImageSize::new(64, 64).unwrap()).unwrap();
        assert!(agreement.holds(0.97), "{agreement:?}");
        // So is one that looks blurred: by six pixels from full to nothing.
        found = disks(&[(32.0, 10.0)]);
        found.edge = EdgeProfile::distance(1.5 / 32.0);
        assert!(Agreement::of(&truth, &found, ImageSize::new(64, 64).unwrap()).unwrap().holds(0.97));
    }
}
