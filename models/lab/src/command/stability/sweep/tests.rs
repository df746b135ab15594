use dvp_core::contour::contains;
use dvp_core::{ImageSize, Real};

use super::base::{CROWD_GAP, GAP, REACH, apart, random};
use super::*;
use crate::agreement::Agreement;
use dvp_cli::format::mdshr_bank;
use dvp_cli::generate::Range;
use dvp_cli::paint::Painter;

#[test]
fn every_level_makes_a_picture_of_its_own() {
    for sweep in SWEEPS {
        let mut last: Option<Case> = None;
        for &level in sweep.levels {
            let side = |case: &Case| case.image.size().width();
            if level > 512.0 {
                continue;
            }
            let case = (sweep.make)(level, 3).unwrap();
            assert!(case.image.data().iter().all(|value| value.is_finite()), "{} {level}", sweep.name);
            assert_eq!(case.start.is_some(), sweep.who == Who::Starts, "{}", sweep.name);
            if let Some(last) = last {
                let same_picture = side(&case) == side(&last) && case.image.data() == last.image.data();
                let same =
                    same_picture && case.start.as_ref().map(|s| &s.objects) == last.start.as_ref().map(|s| &s.objects);
                // A polygon of many vertices is drawn the same however often it is run through.
                assert!(!same || sweep.name == "coincident", "{} {level}", sweep.name);
            }
            last = Some(case);
        }
        assert!(sweep.chosen(true).len() < sweep.levels.len(), "{}", sweep.name);
        assert_eq!(sweep.chosen(true).last(), Some(&(sweep.levels.len() - 1)), "{}", sweep.name);
    }
}

#[test]
fn objects_that_are_apart_do_not_touch() {
    let (mut reach, painter) = (0.0_f32, Painter::default());
    for (count, scale, gap, side) in [(3, 0.1, GAP, 128), (50, 0.028, CROWD_GAP, 256)] {
        let scene = apart(&mut random(8), count, Range::new(scale, scale), gap);
        assert_eq!(scene.objects.len(), count);
        let drawing = painter.draw(&scene, ImageSize::new(side, side).unwrap()).unwrap();
        for (k, object) in scene.objects.iter().enumerate() {
            let [x, y] = object.pose.translation;
            for vertex in drawing.outline(k) {
                reach = reach.max((vertex[0] - x).hypot(vertex[1] - y) / scale);
                assert!((0..count).all(|other| other == k || !contains(drawing.outline(other), *vertex)));
            }
        }
    }
    assert!(reach > 1.0 && reach <= REACH, "{reach} of {} shapes", mdshr_bank::<f32>().prototypes.len());
}

#[test]
fn so_much_is_hidden_as_the_level_says() {
    let size = ImageSize::new(128, 128).unwrap();
    let occlusion = SWEEPS.iter().find(|sweep| sweep.name == "occlusion").unwrap();
    for seed in 0..4 {
        let whole = (occlusion.make)(0.0, seed).unwrap();
        for level in [0.3, 0.9] {
            let case = (occlusion.make)(level, seed).unwrap();
            let seen = |scene: &Scene<f32>| {
                let agreement = Agreement::of(scene, scene, size).unwrap();
                assert_eq!(agreement.expected(), 2);
                let drawing = Painter::default().draw(scene, size).unwrap();
                let fine = 1.0 / 256.0;
                let points = (0..65536).map(|i| [(i % 256) as f32 * fine, (i / 256) as f32 * fine]);
                let rear = points.filter(|&p| contains(drawing.outline(0), p) && !contains(drawing.outline(1), p));
                f64::of_usize(rear.count())
            };
            let share = 1.0 - seen(&case.truth) / seen(&whole.truth);
            assert!((share - level).abs() < 0.02, "{share} for {level}");
        }
    }
}
