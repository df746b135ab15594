use super::*;

#[test]
fn a_frame_is_measured_with_its_hole() {
    let [object] = &measured(vec![frame()])[..] else { panic!("one object") };
    let moments = object.moments.unwrap();
    // 6 x 6 less 2 x 2; 4 x 6 around and 4 x 2 inside.
    assert!(close(moments.area, 32.0, 5) && close(object.perimeter, 32.0, 5), "{object:?}");
    assert!(moments.centroid.iter().all(|&x| close(x, 5.0, 5)));
    // (36 x 36 / 12 - 4 x 4 / 12) / 32 = 10/3 along both axes.
    let axes = object.axes.unwrap();
    assert!(close(axes.major, 4.0 * (10.0_f64 / 3.0).sqrt(), 4) && close(axes.minor, axes.major, 4), "{axes:?}");
    assert_eq!(object.angle, None, "a square has no longer axis");
    let bounds = object.bounds.unwrap();
    assert!(close(bounds.min.x, 2.0, 5) && close(bounds.size().y, 6.0, 5));
    assert!(close(object.circularity().unwrap(), 4.0 * core::f64::consts::PI * 32.0 / 1024.0, 5));
    assert_eq!((object.color, object.number, object.kind), ([255, 0, 51], 1, "polygon"));
    assert!(object.region.has_holes() && object.region.polygons.len() == 1);
    assert!(close(object.visible, 1.0, 5) && object.deviations.is_none());
}

#[test]
fn rings_that_cross_become_simple_ones() {
    // A bow tie: two triangles that meet at (5, 5), each with a base of 6 and a height of 3.
    let bow = polygons(&[&[[2.0, 2.0], [8.0, 2.0], [2.0, 8.0], [8.0, 8.0]]], [0.0; 3]);
    // What two squares of one object have in common, 2 x 2, is outside of it.
    let overlap = polygons(&[&corners([1.0, 1.0], [5.0, 5.0]), &corners([3.0, 3.0], [7.0, 7.0])], [0.0; 3]);
    let [bow, overlap] = &measured(vec![bow, overlap])[..] else { panic!("two objects") };
    assert!(close(bow.moments.unwrap().area, 18.0, 5), "{bow:?}");
    assert!(close(overlap.moments.unwrap().area, 16.0 + 16.0 - 2.0 * 4.0, 5), "{overlap:?}");
    for object in [bow, overlap] {
        let all_positive = object.region.polygons.iter().all(|p| dvp_core::contour::signed_area(&p.outer) > 0.0);
        assert!(all_positive, "{object:?}");
    }
}

#[test]
fn a_part_in_a_hole_is_a_part_of_its_own() {
    let island = polygons(
        &[&corners([1.0, 1.0], [9.0, 9.0]), &corners([2.0, 2.0], [8.0, 8.0]), &corners([4.0, 4.0], [6.0, 6.0])],
        [0.0; 3],
    );
    let [island] = &measured(vec![island])[..] else { panic!("one object") };
    // 64 - 36 + 4.
    assert!(close(island.moments.unwrap().area, 32.0, 5));
    let holes: Vec<usize> = island.region.polygons.iter().map(|polygon| polygon.holes.len()).collect();
    assert_eq!(holes, [1, 0], "the largest one first");
}

#[test]
fn angles_run_from_x_to_y() {
    // From (2, 2) down to the right at 45 degrees, 4 sqrt 2 long, sqrt 2 wide.
    let slanted = polygons(&[&[[3.0, 2.0], [7.0, 6.0], [6.0, 7.0], [2.0, 3.0]]], [0.0; 3]);
    let upright = polygons(&[&corners([4.0, 1.0], [6.0, 9.0])], [0.0; 3]);
    let [slanted, upright] = &measured(vec![slanted, upright])[..] else { panic!("two objects") };
    assert!(close(slanted.angle.unwrap(), 45.0, 4), "{slanted:?}");
    // The axes of a rectangle are its sides times 2 / sqrt 3.
    assert!(close(slanted.axes.unwrap().major, 4.0 * 2.0_f64.sqrt() * 2.0 / 3.0_f64.sqrt(), 4));
    assert!(close(upright.angle.unwrap().abs(), 90.0, 4), "{upright:?}");
}

#[test]
fn a_disk_keeps_its_area_and_has_no_angle() {
    let [disk] = &measured(vec![disk([5.0, 4.5], 3.0)])[..] else { panic!("one object") };
    let moments = disk.moments.unwrap();
    assert!((moments.area / (9.0 * core::f64::consts::PI) - 1.0).abs() < 1e-6, "{moments:?}");
    assert!(close(disk.axes.unwrap().major, 6.0, 2) && close(disk.circularity().unwrap(), 1.0, 3));
    assert_eq!(disk.angle, None);
}

#[test]
fn what_is_seen_is_a_share_of_the_area() {
    let below = polygons(&[&corners([1.0, 1.0], [5.0, 5.0])], [0.0; 3]);
    let mut above = polygons(&[&corners([3.0, 1.0], [7.0, 5.0])], [1.0; 3]);
    let outside = polygons(&[&corners([8.0, 8.0], [12.0, 10.0])], [1.0; 3]);
    let share = |objects| measured(objects).iter().map(|object| object.visible).collect::<Vec<_>>();
    let shares = share(vec![below.clone(), above.clone(), outside]);
    // Half of the first lies behind the second; half of the third is outside of the picture.
    assert!(shares.iter().zip([0.5, 1.0, 0.5]).all(|(&share, known)| close(share, known, 5)), "{shares:?}");
    above.confidence = 0.5;
    assert!(close(share(vec![below, above])[0], 0.75, 5), "what is half opaque hides half");
}

#[test]
fn standard_deviations_follow_the_pose() {
    // (x, y) to 0.001 and 0.002 units of 10 px, scale to 1 %, angle to 0.1 radians; independent.
    let mut covariance = [0.0_f32; 25];
    for (at, deviation) in [0.001_f32, 0.002, 0.01, 0.1].into_iter().enumerate() {
        covariance[6 * at] = deviation * deviation;
    }
    // Twice as wide as high; the pose stands in its upper left corner, the centroid (0.2, 0.1) units from there.
    let mut bar = polygons(&[&corners([0.0, 0.0], [4.0, 2.0])], [0.0; 3]);
    bar.pose.translation = [0.3, 0.3];
    let objects = measure(&scene(vec![bar]), &[covariance], None, &[1], size()).unwrap();
    let deviations = objects[0].deviations.unwrap();
    // x moves with the scale by 0.2 and with the angle by -0.1, y by 0.1 and 0.2.
    let x = 10.0 * (0.001_f64.powi(2) + (0.2_f64 * 0.01).powi(2) + (0.1_f64 * 0.1).powi(2)).sqrt();
    let y = 10.0 * (0.002_f64.powi(2) + (0.1_f64 * 0.01).powi(2) + (0.2_f64 * 0.1).powi(2)).sqrt();
    assert!(close(deviations.centroid[0], x, 5) && close(deviations.centroid[1], y, 5), "{deviations:?}");
    assert!(close(deviations.area, 2.0 * 8.0 * 0.01, 5) && close(deviations.angle, 0.1_f64.to_degrees(), 4));
    // The axes of a rectangle are its sides times 2 / sqrt 3; lengths change as the scale does, by 1 %.
    let [major, minor] = [4.0, 2.0].map(|side| side * 2.0 / 3.0_f64.sqrt() * 0.01);
    assert!(close(deviations.axes[0], major, 5) && close(deviations.axes[1], minor, 5), "{deviations:?}");
    assert!(close(deviations.perimeter, 12.0 * 0.01, 5), "{deviations:?}");
}

#[test]
fn axes_change_with_the_stretch() {
    // Radii of 4 and 2 px, turned by 30 degrees, their logarithms known to .01 and .02, independent: scale is half of their sum, stretch half of
    // their difference.
    let [wide, high] = [0.01_f32, 0.02].map(|deviation| deviation * deviation);
    let mut covariance = [0.0_f32; 25];
    (covariance[12], covariance[24]) = (0.25 * (wide + high), 0.25 * (wide + high));
    (covariance[14], covariance[22]) = (0.25 * (wide - high), 0.25 * (wide - high));
    let of = |radii: [f32; 2]| {
        let mut ellipse = polygons(&[&corners([0.0, 0.0], [1.0, 1.0])], [0.0; 3]);
        ellipse.shape = dvp_core::shape::Ellipse { radii }.into();
        (ellipse.pose.translation, ellipse.pose.rotation) = ([0.5, 0.5], core::f32::consts::FRAC_PI_6);
        measure(&scene(vec![ellipse]), &[covariance], None, &[1], size()).unwrap()[0].deviations.unwrap()
    };
    let wide = of([0.4, 0.2]);
    assert!(close(wide.axes[0], 8.0 * 0.01, 4) && close(wide.axes[1], 4.0 * 0.02, 4), "{wide:?}");
    assert!(close(wide.area, core::f64::consts::PI * 8.0 * 0.01_f64.hypot(0.02), 3), "{wide:?}");
    // The longer axis is the second.
    let high = of([0.2, 0.4]);
    assert!(close(high.axes[0], 8.0 * 0.02, 4) && close(high.axes[1], 4.0 * 0.01, 4), "{high:?}");
}

#[test]
fn what_encloses_nothing_has_an_area_of_0_and_nothing_else() {
    let line = polygons(&[&[[1.0, 1.0], [5.0, 1.0], [9.0, 1.0]]], [0.0; 3]);
    let [line] = &measured(vec![line])[..] else { panic!("one object") };
    assert!(line.moments.is_none() && line.bounds.is_none() && line.circularity().is_none());
    assert_eq!((line.visible, line.region.polygons.len()), (0.0, 0));
}

#[test]
fn scales_have_units() {
    assert_eq!("0.12mm/px".parse(), Ok(Scale { mm_per_px: 0.12 }));
    assert_eq!("8 px/mm".parse(), Ok(Scale { mm_per_px: 0.125 }));
    for text in ["8", "0.12mm", "mm/px", "-1mm/px", "0px/mm", "nanmm/px", "infpx/mm", "8px/cm"] {
        let error = text.parse::<Scale>().unwrap_err();
        assert!(error.to_string().contains("0.12mm/px"), "{text}");
    }
}
