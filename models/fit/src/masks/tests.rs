use alloc::vec;
use alloc::vec::Vec;

use dvp_core::ImageSize;
use dvp_core::contour::{contains, perimeter, signed_area};
use dvp_core::shape::{AnyShape, Outline, OutlineBasis, REFERENCE_VERTICES, Shape as _};

use super::{LabelMapError, LabelOutline, outlines_of_labels};

const SIDE: usize = 64;

fn size() -> ImageSize {
    ImageSize::new(SIDE, SIDE).unwrap()
}

/// Labels by the centers of pixels, px.
fn drawn(label: impl Fn([f64; 2]) -> u32) -> Vec<u32> {
    let center = |i: usize| {
        [f64::from(u32::try_from(i % SIDE).unwrap()) + 0.5, f64::from(u32::try_from(i / SIDE).unwrap()) + 0.5]
    };
    (0..SIDE * SIDE).map(|i| label(center(i))).collect()
}

/// The rings of an outline, px.
fn rings(found: &LabelOutline<f64>) -> Vec<Vec<[f64; 2]>> {
    let basis = OutlineBasis::new(REFERENCE_VERTICES, 31).unwrap();
    let mut outline = Outline::default();
    found.shape.flatten(&(&basis).into(), &mut outline).unwrap();
    found.pose.transform(&mut outline.vertices);
    outline.rings().iter().map(|ring| ring.iter().map(|vertex| vertex.map(|x| 64.0 * x)).collect()).collect()
}

fn is_in_disk([x, y]: [f64; 2], [cx, cy]: [f64; 2], radius: f64) -> bool {
    (x - cx).hypot(y - cy) < radius
}

#[test]
fn disks_are_found_finer_than_pixels() {
    for (at, radius, limit) in [([31.3, 30.2], 20.4, 0.1), ([30.2, 31.9], 9.7, 0.15), ([33.1, 28.6], 4.3, 0.25)] {
        let labels = drawn(|point| 7 * u32::from(is_in_disk(point, at, radius)));
        let found = outlines_of_labels::<f64>(&labels, size()).unwrap();
        let [disk] = &*found else { panic!("{found:?}") };
        assert_eq!((disk.label, disk.shape.number_count()), (7, 4), "one harmonic is enough");
        let rings = rings(disk);
        let distances = rings[0].iter().map(|&[x, y]| (x - at[0]).hypot(y - at[1]) - radius);
        // The pixels alone are off by up to half a pixel; the fewer there are, the less they tell together.
        let farthest = distances.fold(0.0_f64, |most, distance| most.max(distance.abs()));
        assert!(farthest < limit, "{radius}: {farthest}");
        let area = signed_area(&rings[0]).abs();
        assert!((area / (core::f64::consts::PI * radius * radius) - 1.0).abs() < 0.015, "{radius}: {area}");
    }
}

#[test]
fn every_pixel_center_stays_on_its_side() {
    let egg = |[x, y]: [f64; 2]| {
        let (dx, dy) = (x - 32.2, y - 31.1);
        let angle = dy.atan2(dx);
        dx.hypot(dy) < 18.0 + 2.5 * (2.0 * angle + 0.4).cos() + 1.5 * (3.0 * angle).sin()
    };
    let labels = drawn(|point| u32::from(egg(point)));
    let found = outlines_of_labels::<f64>(&labels, size()).unwrap();
    assert!(matches!(found[0].shape, AnyShape::Efd(_)), "{found:?}");
    let rings = rings(&found[0]);
    let again = drawn(|point| u32::from(contains(&rings[0], point)));
    let off = labels.iter().zip(&again).filter(|(a, b)| a != b).count();
    // A center within 0.05 px of the outline may change sides: of some hundred beside it, a few.
    assert!(off <= 6, "{off} centers");
    // Smooth: the stairs are a quarter longer than the outline.
    let length = perimeter(&rings[0]);
    assert!(length < 1.02 * core::f64::consts::TAU * 18.5, "{length}");
}

#[test]
fn rectangles_are_kept_as_they_are() {
    let labels = drawn(|[x, y]| 3 * u32::from((10.0..40.0).contains(&x) && (20.0..25.0).contains(&y)));
    let found = outlines_of_labels::<f64>(&labels, size()).unwrap();
    let AnyShape::Rectangle(rectangle) = &found[0].shape else { panic!("{found:?}") };
    assert!((rectangle.size[0] * 64.0 - 30.0).abs() < 1e-12 && (rectangle.size[1] * 64.0 - 5.0).abs() < 1e-12);
    assert!((found[0].pose.translation[0] * 64.0 - 25.0).abs() < 1e-12);
}

#[test]
fn holes_and_parts_are_rings() {
    let hole = |point| is_in_disk(point, [22.4, 24.7], 7.1);
    let labels = drawn(|point| {
        let ring = is_in_disk(point, [20.3, 23.8], 15.2) && !hole(point);
        u32::from(ring || is_in_disk(point, [50.4, 49.7], 6.1)) * 9
    });
    let found = outlines_of_labels::<f64>(&labels, size()).unwrap();
    let [one] = &*found else { panic!("{found:?}") };
    let rings = rings(one);
    assert_eq!(rings.len(), 3);
    let area = rings.iter().map(|ring| signed_area(ring)).sum::<f64>();
    let known = core::f64::consts::PI * (15.2_f64.powi(2) - 7.1_f64.powi(2) + 6.1_f64.powi(2));
    assert!((area - known).abs() < 5.0, "{area} {known}");
}

#[test]
fn long_winding_borders_become_polygons() {
    // A spiral, 4 px wide, more than 64 vertices can follow.
    let labels = drawn(|[x, y]| {
        let (dx, dy) = (x - 32.0, y - 32.0);
        let (radius, angle) = (dx.hypot(dy), dy.atan2(dx) / core::f64::consts::TAU);
        u32::from(radius > 4.0 && radius < 30.0 && (radius / 8.0 - angle).rem_euclid(1.0) < 0.5)
    });
    let found = outlines_of_labels::<f64>(&labels, size()).unwrap();
    let AnyShape::Polygon(polygon) = &found[0].shape else { panic!("{found:?}") };
    let pixels: u32 = labels.iter().sum();
    let rings = rings(&found[0]);
    let area = rings.iter().map(|ring| signed_area(ring)).sum::<f64>();
    assert!((area - f64::from(pixels)).abs() < 0.5, "{area} {pixels}");
    assert!(polygon.rings.iter().map(Vec::len).sum::<usize>() > 64);
    let again = drawn(|point| u32::from(rings.iter().filter(|ring| contains(ring, point)).count() % 2 == 1));
    let off = labels.iter().zip(&again).filter(|(a, b)| a != b).count();
    assert!(off < 40, "{off} of {pixels} pixels");
}

#[test]
fn every_label_has_an_outline_however_small() {
    // Single pixels, pairs, a diagonal pair (two parts), a pixel in each corner of the image.
    let mut labels = vec![0; SIDE * SIDE];
    for (label, pixels) in [
        (1, vec![0]),
        (2, vec![SIDE - 1]),
        (3, vec![SIDE * SIDE - 1]),
        (4, vec![10 * SIDE + 10, 10 * SIDE + 11]),
        (500, vec![20 * SIDE + 20, 21 * SIDE + 21]),
        (u32::MAX, vec![30 * SIDE + 30, 31 * SIDE + 30, 31 * SIDE + 31]),
    ] {
        pixels.into_iter().for_each(|pixel| labels[pixel] = label);
    }
    let found = outlines_of_labels::<f64>(&labels, size()).unwrap();
    let numbers: Vec<u32> = found.iter().map(|found| found.label).collect();
    assert_eq!(numbers, [1, 2, 3, 4, 500, u32::MAX]);
    for found in &found {
        let area = rings(found).iter().map(|ring| signed_area(ring)).sum::<f64>().abs();
        let pixels = labels.iter().filter(|&&label| label == found.label).count();
        assert!((area - f64::from(u32::try_from(pixels).unwrap())).abs() < 0.9, "{found:?}: {area}");
    }
    assert!(outlines_of_labels::<f64>(&vec![0; SIDE * SIDE], size()).unwrap().is_empty());
}

#[test]
fn wrong_lengths_are_refused() {
    let error = outlines_of_labels::<f64>(&[1, 2, 3], size()).unwrap_err();
    assert_eq!(error, LabelMapError::Length { expected: 4096, len: 3 });
}
