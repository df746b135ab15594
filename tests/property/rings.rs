//! What holds for objects of several rings, by any renderer.

use core::fmt::Debug;

use dvp_core::ImageSize;
use dvp_core::contour::signed_area;
use dvp_core::render::{ContourDistance, CoverageModel, EdgeProfile, ExactArea, HardMask, SoftTriangles};
use dvp_core::shape::Outline;
use dvp_tests::coverage::coverage_of_rings;
use dvp_tests::strategy::{self, outline_of};
use proptest::prelude::*;

const SIDE: usize = 24;

fn covered<C: CoverageModel<f64> + Debug>(model: C, outline: &Outline<f64>) -> Vec<f64> {
    coverage_of_rings(model, outline.rings(), ImageSize::new(SIDE, SIDE).unwrap()).unwrap()
}

fn exact(outline: &Outline<f64>) -> Vec<f64> {
    covered(ExactArea, outline)
}

/// Largest difference between two planes.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// By every renderer.
fn each(outline: &Outline<f64>) -> [(&'static str, Vec<f64>); 5] {
    [
        ("contour", covered(ContourDistance::default(), outline)),
        ("blurred contour", covered(ContourDistance::new(EdgeProfile::distance(0.1)), outline)),
        ("exact", exact(outline)),
        ("hard", covered(HardMask, outline)),
        ("triangles", covered(SoftTriangles::default(), outline)),
    ]
}

/// Coverage by counting 32 x 32 samples in each pixel.
fn supersampled(outline: &Outline<f64>) -> Vec<f64> {
    const FINE: usize = 32;
    let vertices = outline.vertices.iter().map(|v| v.map(|x| x * 32.0)).collect();
    let fine = Outline { vertices, breaks: outline.breaks.clone() };
    let size = ImageSize::new(SIDE * FINE, SIDE * FINE).unwrap();
    let samples = coverage_of_rings(HardMask, fine.rings(), size).unwrap();
    let mut mean = vec![0.0; SIDE * SIDE];
    for (i, sample) in samples.iter().enumerate() {
        mean[i / (SIDE * FINE) / FINE * SIDE + i % (SIDE * FINE) / FINE] += sample / 1024.0;
    }
    mean
}

proptest! {
    #[test]
    fn nested_rings_cover_what_lies_between_them(rings in strategy::nested_rings_px()) {
        let area: f64 =
            rings.iter().enumerate().map(|(k, ring)| signed_area(ring).abs() * if k % 2 == 0 { 1.0 } else { -1.0 }).sum();
        let sum: f64 = exact(&outline_of(rings)).iter().sum();
        prop_assert!((sum - area).abs() < 1e-9, "{sum} instead of {area}");
    }

    #[test]
    fn exact_areas_agree_with_supersampling(rings in strategy::nested_rings_px()) {
        let outline = outline_of(rings.clone());
        let (exact, sampled) = (exact(&outline), supersampled(&outline));
        // Off by at most half a sample per edge and line of 32 samples, 1/64 of the pixel. Errors of the edges of one ring
        // are independent; those of nested rings are not where the rings are alike.
        let most = 4.0 / 64.0 * rings.len() as f64;
        prop_assert!(largest(&exact, &sampled) < most, "{}", largest(&exact, &sampled));
    }

    #[test]
    fn a_hole_takes_away_what_it_covers_itself(rings in strategy::nested_rings_px()) {
        let whole = [exact(&outline_of(rings.clone())), covered(HardMask, &outline_of(rings.clone()))];
        let mut sums = [0, 1].map(|_| vec![0.0; SIDE * SIDE]);
        for (k, ring) in rings.into_iter().enumerate() {
            let (alone, sign) = (outline_of([ring]), if k % 2 == 0 { 1.0 } else { -1.0 });
            for (sum, part) in sums.iter_mut().zip([exact(&alone), covered(HardMask, &alone)]) {
                sum.iter_mut().zip(part).for_each(|(sum, p)| *sum += sign * p);
            }
        }
        for (whole, sum) in whole.iter().zip(&sums) {
            prop_assert!(largest(whole, sum) < 1e-10, "{}", largest(whole, sum));
        }
    }

    #[test]
    fn order_direction_and_first_vertex_of_rings_do_not_matter(
        outline in strategy::rings_px(),
        turn in any::<prop::sample::Index>(),
        changes in prop::collection::vec((any::<bool>(), any::<prop::sample::Index>()), 6),
    ) {
        let mut rings: Vec<Vec<_>> = outline.rings().iter().map(<[_]>::to_vec).collect();
        for (ring, (reverse, start)) in rings.iter_mut().zip(changes) {
            let start = start.index(ring.len());
            ring.rotate_left(start);
            if reverse {
                ring.reverse();
            }
        }
        let turn = turn.index(rings.len());
        rings.rotate_left(turn);
        for ((name, before), (_, after)) in each(&outline).iter().zip(&each(&outline_of(rings))) {
            // Triangles that meet crossing rings depend on which edge was first: see the test of nested ones.
            if *name != "triangles" {
                prop_assert!(largest(before, after) < 1e-8, "{}: {}", name, largest(before, after));
            }
        }
    }

    #[test]
    fn triangles_of_nested_rings_do_not_depend_on_their_order(rings in strategy::nested_rings_px()) {
        let mut turned = rings.clone();
        turned.reverse();
        turned.iter_mut().for_each(|ring| ring.reverse());
        let [before, after] = [rings, turned].map(|rings| covered(SoftTriangles::default(), &outline_of(rings)));
        prop_assert!(largest(&before, &after) < 1e-8, "{}", largest(&before, &after));
    }

    #[test]
    fn a_ring_outside_of_the_view_changes_nothing(
        outline in strategy::rings_px(),
        star in strategy::star_px(),
        (side, reversed) in (0_usize..4, any::<bool>()),
        far in prop_oneof![Just(40.0), Just(1e6)],
    ) {
        let [dx, dy] = [[far, 0.0], [-far, 0.0], [0.0, far], [0.0, -far]][side];
        let mut ring: Vec<_> = star.iter().map(|[x, y]| [x + dx, y + dy]).collect();
        if reversed {
            ring.reverse();
        }
        let mut more = outline.clone();
        more.push_ring(ring);
        for ((name, before), (_, after)) in each(&outline).iter().zip(&each(&more)) {
            // Far vertices join the triangulation: seams run elsewhere.
            let most = if *name == "triangles" { 0.01 } else { 1e-9 };
            prop_assert!(largest(before, after) < most, "{}: {}", name, largest(before, after));
        }
    }

    #[test]
    fn a_ring_around_the_view_turns_it_inside_out(outline in strategy::rings_px(), reversed in any::<bool>(), first in any::<bool>()) {
        let mut frame = vec![[-30.0, -40.0], [70.0, -30.0], [60.0, 50.0], [-50.0, 60.0]];
        if reversed {
            frame.reverse();
        }
        let rings: Vec<Vec<_>> = outline.rings().iter().map(<[_]>::to_vec).collect();
        let inverse = if first { outline_of([frame].into_iter().chain(rings)) } else { outline_of(rings.into_iter().chain([frame])) };
        for [inside, outside] in
            [[exact(&outline), exact(&inverse)], [covered(HardMask, &outline), covered(HardMask, &inverse)]]
        {
            let sum: Vec<f64> = inside.iter().zip(&outside).map(|(a, b)| a + b).collect();
            prop_assert!(largest(&sum, &[1.0; SIDE * SIDE]) < 1e-9, "{}", largest(&sum, &[1.0; SIDE * SIDE]));
        }
    }

    #[test]
    fn a_hole_as_large_as_its_object_leaves_nothing(
        star in strategy::star_px(),
        start in any::<prop::sample::Index>(),
        reversed in any::<bool>(),
    ) {
        let mut hole = star.clone();
        hole.rotate_left(start.index(star.len()));
        if reversed {
            hole.reverse();
        }
        let outline = outline_of([star, hole]);
        for coverage in [exact(&outline), covered(HardMask, &outline), covered(SoftTriangles::default(), &outline)] {
            prop_assert!(coverage.iter().all(|p| p.abs() < 1e-12));
        }
    }

    #[test]
    fn rings_that_enclose_nothing_change_nothing(
        outline in strategy::rings_px(),
        point in prop::array::uniform2(0.0..24.0),
        end in prop::array::uniform2(0.0..24.0),
        at in any::<prop::sample::Index>(),
    ) {
        let mut rings: Vec<Vec<_>> = outline.rings().iter().map(<[_]>::to_vec).collect();
        let at = at.index(rings.len() + 1);
        rings.insert(at, vec![point]);
        let mut dotted = outline_of(rings.clone());
        let empty = *dotted.breaks.last().unwrap();
        dotted.breaks.push(empty);
        for ((name, before), (_, after)) in each(&outline).iter().zip(&each(&dotted)) {
            prop_assert!(largest(before, after) < 1e-12, "{}: {}", name, largest(before, after));
        }
        // To a distance the border of two vertices is a line; areas and masks have no lines.
        rings[at].push(end);
        let lined = outline_of(rings);
        prop_assert!(largest(&exact(&outline), &exact(&lined)) < 1e-12);
        prop_assert!(largest(&covered(HardMask, &outline), &covered(HardMask, &lined)) < 1e-12);
    }

    #[test]
    fn wild_rings_stay_in_range(outline in strategy::wild_rings()) {
        for (name, coverage) in each(&outline) {
            prop_assert!(coverage.iter().all(|p| (0.0..=1.0).contains(p)), "{}", name);
        }
    }
}
