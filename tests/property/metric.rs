//! Metrics: 1 (or 0) at equality, unchanged by the order of objects, and against direct counts.

use dvp_core::metric::{MaskOverlap, Ownership, OwnershipRule, RandIndexScratch, adjusted_rand_index};
use dvp_core::render::hard::object_index;
use dvp_core::render::{Compositing, ContourRenderer};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, ImageSize, Scene};
use dvp_tests::strategy;
use proptest::collection::vec;
use proptest::prelude::*;

const PIXELS: usize = 24;

fn ari(a: &[u32], b: &[u32]) -> f64 {
    adjusted_rand_index(a, b, &mut RandIndexScratch::default()).unwrap()
}

fn labels() -> impl Strategy<Value = Vec<u32>> {
    vec(0..5_u32, PIXELS)
}

/// Coverage planes, most of them empty in most pixels, and confidences.
fn objects() -> impl Strategy<Value = Vec<(Vec<f64>, f64)>> {
    let coverage = prop_oneof![3 => Just(0.0), 1 => 0.0..1.0];
    vec((vec(coverage, PIXELS), 0.0..1.0), 0..5)
}

fn owned(objects: &[(Vec<f64>, f64)]) -> Ownership {
    let coverage: Vec<f64> = objects.iter().flat_map(|(plane, _)| plane.clone()).collect();
    let confidences: Vec<f64> = objects.iter().map(|(_, confidence)| *confidence).collect();
    let mut owned = Ownership::default();
    owned.fill(PIXELS, &coverage, &confidences).unwrap();
    owned
}

/// A scene's drawing, and its planes of coverage.
fn drawn(scene: &Scene<f64>, renderer: &ContourRenderer<f64>, size: ImageSize) -> (Drawing<f64>, Vec<f64>) {
    let mut drawing = Drawing::default();
    scene.draw(&OutlineBasis::new(32, 4).unwrap(), &mut drawing).unwrap();
    let mut planes = vec![0.0; drawing.object_count() * size.pixels()];
    renderer.object_coverage(&drawing, size, &mut Default::default(), &mut planes).unwrap();
    (drawing, planes)
}

proptest! {
    #[test]
    fn ownership_of_a_drawing_equals_that_of_its_planes(mut scene in strategy::scene(0..6, 1..5), width in 20..50_usize) {
        let size = ImageSize::new(width, 32).unwrap();
        let renderer = ContourRenderer::new(scene.edge, Compositing::Over);
        let mut owned = Ownership::default();
        let (drawing, planes) = drawn(&scene, &renderer, size);
        owned.fill_drawing(OwnershipRule::Reached, &renderer, &drawing, size, &mut Default::default()).unwrap();
        let mut expected = Ownership::default();
        expected.fill(size.pixels(), &planes, &drawing.confidences).unwrap();
        prop_assert_eq!(&owned, &expected);

        // The topmost object that covers half a pixel; all of them opaque enough for an index of masks.
        scene.objects.iter_mut().for_each(|object| object.confidence = object.confidence.max(0.5));
        let (drawing, planes) = drawn(&scene, &renderer, size);
        let seen = OwnershipRule::Seen(Compositing::Over);
        owned.fill_drawing(seen, &renderer, &drawing, size, &mut Default::default()).unwrap();
        let mut index = vec![0; size.pixels()];
        object_index(&planes, &drawing.confidences, &mut index).unwrap();
        prop_assert_eq!(owned.index(), &index[..]);
        index.sort_unstable();
        index.dedup();
        prop_assert_eq!(owned.objects(), index.iter().filter(|&&label| label > 0).count());
        prop_assert_eq!(owned.union().filter(|&union| union).count(), owned.index().iter().filter(|&&k| k > 0).count());
    }

    /// Over all pairs of pixels: 2 (s d' - ...) in the form of Hubert and Arabie, from four counts.
    #[test]
    fn rand_index_equals_the_count_over_pairs(a in labels(), b in labels()) {
        let mut counts = [[0.0_f64; 2]; 2];
        for i in 0..PIXELS {
            for j in 0..i {
                counts[usize::from(a[i] == a[j])][usize::from(b[i] == b[j])] += 1.0;
            }
        }
        let [[apart, only_b], [only_a, both]] = counts;
        let spread = (both + only_a) * (only_a + apart) + (both + only_b) * (only_b + apart);
        let direct = if spread > 0.0 { 2.0 * (both * apart - only_a * only_b) / spread } else { 1.0 };
        prop_assert!((ari(&a, &b) - direct).abs() < 1e-12);
        prop_assert!((ari(&a, &b) - ari(&b, &a)).abs() < 1e-12);
    }

    #[test]
    fn names_of_labels_do_not_matter(a in labels(), names in Just(vec![3_u32, 9, 0, 70_000, 7]).prop_shuffle()) {
        let renamed: Vec<u32> = a.iter().map(|&label| names[usize::try_from(label).unwrap()]).collect();
        prop_assert!((ari(&a, &renamed) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn ownership_is_blind_to_the_order_of_objects(objects in objects()) {
        let reversed: Vec<_> = objects.iter().rev().cloned().collect();
        let (a, b) = (owned(&objects), owned(&reversed));
        prop_assert!(a.union().eq(b.union()));
        prop_assert!((ari(a.index(), b.index()) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn ownership_equals_a_count_per_pixel(objects in objects()) {
        let result = owned(&objects);
        for pixel in 0..PIXELS {
            let owners: Vec<u32> = (1_u32..)
                .zip(&objects)
                .filter(|(_, (plane, confidence))| plane[pixel] > 0.0 && confidence.round() > 0.0)
                .map(|(label, _)| label)
                .collect();
            let expected = if let [only] = owners[..] { only } else { 0 };
            prop_assert_eq!(result.index()[pixel], expected);
            prop_assert_eq!(result.union().nth(pixel).unwrap(), !owners.is_empty());
        }
    }

    #[test]
    fn overlap_is_one_at_equality_and_symmetric(a in vec(any::<bool>(), PIXELS), b in vec(any::<bool>(), PIXELS)) {
        let iou = |a: &[bool], b: &[bool]| {
            let mut overlap = MaskOverlap::default();
            overlap.add(a.iter().copied(), b.iter().copied());
            overlap.iou()
        };
        prop_assert!((iou(&a, &a) - 1.0).abs() < 1e-15);
        prop_assert!((iou(&a, &b) - iou(&b, &a)).abs() < 1e-15);
        prop_assert!((0.0..=1.0).contains(&iou(&a, &b)));
    }
}
