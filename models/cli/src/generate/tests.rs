use dvp_core::ImageSize;
use dvp_core::contour::{contains, signed_area};
use dvp_core::shape::AnyShape;

use super::sample::closest_distance;
use super::tetrominoes::TETROMINOES;
use super::{OPENINGS_SIDE, Range, SceneSettings, TETROMINO_SIDE, sample_openings, sample_scene, sample_tetrominoes};
use crate::format::mdshr_bank;
use crate::paint::Painter;

#[test]
fn ranges_are_read() {
    assert_eq!("0.1..0.3".parse(), Ok(Range::new(0.1, 0.3)));
    assert_eq!("2".parse(), Ok(Range::new(2.0, 2.0)));
    for text in ["", "0.3..0.1", "a..b", "0..NaN", "1..inf"] {
        assert!(text.parse::<Range>().unwrap_err().contains("0.1..0.3"), "{text}");
    }
}

#[test]
fn scenes_follow_the_settings_and_their_number_only() {
    let bank = mdshr_bank();
    let size = ImageSize::new(128, 128).unwrap();
    let settings = SceneSettings::mds_hr();
    let mut counts = [0; 5];
    let mut shapes = [0; 3];
    let mut closest = 0.0;
    for index in 0..400 {
        let scene = sample_scene(&settings, &bank, size, 7, index);
        assert_eq!(scene, sample_scene(&settings, &bank, size, 7, index));
        assert_ne!(scene, sample_scene(&settings, &bank, size, 8, index));
        counts[scene.objects.len()] += 1;
        for object in &scene.objects {
            shapes[object.prototype().unwrap()] += 1;
            assert!((0.1..=0.3).contains(&object.pose.scale));
            assert!(object.pose.translation.iter().all(|v| (0.05..=0.95).contains(v)));
        }
        let slots = SceneSettings { keep_hidden: true, ..settings };
        let all = sample_scene(&slots, &bank, size, 7, index).objects;
        assert_eq!(all.len(), 4);
        let points: Vec<[f32; 2]> = all.iter().map(|o| o.pose.translation).collect();
        closest += closest_distance(&points) / 400.0;
    }
    // Expected 100 each; 3 standard deviations are 26.
    assert!(counts[0] == 0 && counts[1..].iter().all(|n| (74..=126).contains(n)), "{counts:?}");
    // Expected about 333 of 1000 each; 3 standard deviations are 45.
    assert!(shapes.iter().all(|n| (280..=390).contains(n)), "{shapes:?}");
    // One draw of four points has a smallest distance of about 0.18, the best of eight about 0.37.
    assert!(closest > 0.3, "{closest}");
}

#[test]
fn bad_settings_name_the_option() {
    let good = SceneSettings::mds_hr();
    assert_eq!(good.check(), Ok(()));
    assert_eq!(SceneSettings::multi_dsprites().check(), Ok(()));
    assert!(SceneSettings { slots: 2, ..good }.check().unwrap_err().contains("--slots"));
    assert!(SceneSettings { margin: 0.5, ..good }.check().unwrap_err().contains("--margin"));
    assert!(SceneSettings { scale: Range::new(0.0, 0.1), ..good }.check().unwrap_err().contains("--scale"));
}

#[test]
fn pieces_are_tetrominoes_and_their_corners_go_around_their_cells() {
    for (class, piece) in TETROMINOES.iter().enumerate() {
        let corners: Vec<[f64; 2]> = piece.corners.iter().map(|corner| corner.map(f64::from)).collect();
        let middle = |cell: [usize; 2]| cell.map(|v| v as f64 + 0.5);
        let inside = piece.cells.iter().filter(|cell| contains(&corners, middle(**cell))).count();
        assert_eq!((inside, signed_area(&corners).abs()), (4, 4.0), "{class}");
        let mut cells = piece.cells.to_vec();
        cells.sort_unstable();
        let is_new = TETROMINOES[..class].iter().all(|other| {
            let mut others = other.cells.to_vec();
            others.sort_unstable();
            others != cells
        });
        assert!(is_new, "{class}");
    }
}

#[test]
fn tetrominoes_lie_beside_one_another() {
    let size = ImageSize::new(TETROMINO_SIDE, TETROMINO_SIDE).unwrap();
    let mut seen = [0; 17];
    for index in 0..200 {
        let (scene, classes) = sample_tetrominoes(5, index);
        assert_eq!((&scene, &classes), (&sample_tetrominoes(5, index).0, &sample_tetrominoes(5, index).1));
        assert_eq!((scene.objects.len(), classes.len()), (3, 3));
        classes.iter().for_each(|&class| seen[class as usize] += 1);
        let image = Painter::default().paint(&scene, size).unwrap();
        let shown = (0..size.pixels()).filter(|&pixel| image.view().pixel(pixel).iter().any(|&v| v > 0.5)).count();
        // Three pieces of four cells of 25 pixels, none on another.
        assert_eq!(shown, 300, "{index}");
        let levels = image.data().iter().all(|&v| !(0.001..=0.999).contains(&v));
        assert!(levels, "a pixel of picture {index} is mixed");
    }
    // Expected 35 each; 3 standard deviations are 17.
    assert!(seen.iter().all(|n| (18..=52).contains(n)), "{seen:?}");
}

#[test]
fn shapes_with_openings_are_in_view_and_told_apart() {
    let mut counts = [0; 5];
    for index in 0..100 {
        let (scene, classes) = sample_openings(5, index);
        assert_eq!(scene, sample_openings(5, index).0);
        counts[classes.len()] += 1;
        assert_eq!(scene.objects.len(), classes.len());
        let side = OPENINGS_SIDE as f32;
        for (object, &class) in scene.objects.iter().zip(&classes) {
            let AnyShape::Polygon(polygon) = &object.shape else { panic!("{:?}", object.shape) };
            assert_eq!(polygon.rings.len(), 2);
            assert!((1.0..=1.5).contains(&object.pose.scale));
            for corner in polygon.rings.iter().flatten() {
                let at = [0, 1].map(|c| (object.pose.translation[c] + object.pose.scale * corner[c]) * side);
                assert!(at.iter().all(|v| (-0.001..=side + 0.001).contains(v)), "class {class}: {at:?}");
            }
        }
        let colors: Vec<[f32; 3]> =
            scene.objects.iter().map(|object| object.color()).chain([scene.background]).collect();
        for (i, a) in colors.iter().enumerate() {
            for b in &colors[..i] {
                assert!((0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f32>() > 0.08);
            }
        }
    }
    // Expected a third of 100 each; 3 standard deviations are 14. Pictures of many are begun anew more often.
    assert!(counts[..2] == [0, 0] && counts[2..].iter().all(|n| (15..=52).contains(n)), "{counts:?}");
}
