//! Invariants of labels, traced borders and polygons, on any mask.

use dvp_core::contour::{Connectivity, contains, label, perimeter, resample, signed_area, trace_level, trace_mask};
use dvp_core::{Efd, ImageSize, Real};
use dvp_tests::strategy;
use proptest::prelude::*;

/// A mask up to 12 x 12 with any share of pixels inside, and a connectivity.
fn mask() -> impl Strategy<Value = (Vec<bool>, ImageSize, Connectivity)> {
    let connectivity = prop_oneof![Just(Connectivity::Four), Just(Connectivity::Eight)];
    (1_usize..13, 1_usize..13, 0.0..1.0, connectivity).prop_flat_map(|(width, height, share, connectivity)| {
        let size = ImageSize::new(width, height).map_err(|error| error.to_string());
        (prop::collection::vec(prop::bool::weighted(share), width * height), Just(size), Just(connectivity))
            .prop_filter_map("a size that is none", |(mask, size, connectivity)| Some((mask, size.ok()?, connectivity)))
    })
}

fn center(index: usize, size: ImageSize) -> [f64; 2] {
    [f64::of_usize(index % size.width()) + 0.5, f64::of_usize(index / size.width()) + 0.5]
}

/// Even-odd over several loops.
fn inside(loops: &[Vec<[f64; 2]>], point: [f64; 2]) -> bool {
    loops.iter().filter(|vertices| contains(vertices, point)).count() % 2 == 1
}

proptest! {
    #[test]
    fn borders_are_the_mask((mask, size, connectivity) in mask()) {
        let borders = trace_mask::<f64>(&mask, size, connectivity).unwrap();
        let area: f64 = borders.iter().map(|border| signed_area(border)).sum();
        let pixels = mask.iter().filter(|inside| **inside).count();
        prop_assert!((area - f64::of_usize(pixels)).abs() < 1e-9, "{area} for {pixels} pixels");
        for (index, &expected) in mask.iter().enumerate() {
            prop_assert_eq!(inside(&borders, center(index, size)), expected, "pixel {}", index);
        }
        // Corners only: every vertex turns. Outer borders are as many as components.
        for border in &borders {
            prop_assert!(border.len() >= 4);
            for (k, v) in border.iter().enumerate() {
                let (u, w) = (border[(k + border.len() - 1) % border.len()], border[(k + 1) % border.len()]);
                let cross = (v[0] - u[0]) * (w[1] - v[1]) - (v[1] - u[1]) * (w[0] - v[0]);
                prop_assert!(cross != 0.0, "vertex {k} of {border:?}");
            }
        }
        let outer = borders.iter().filter(|border| signed_area(border) > 0.0).count();
        prop_assert_eq!(outer, label(&mask, size, connectivity).unwrap().sizes.len());
    }

    #[test]
    fn labels_are_the_pieces((mask, size, connectivity) in mask()) {
        let components = label(&mask, size, connectivity).unwrap();
        let mut next = 1;
        for (index, &inside) in mask.iter().enumerate() {
            let number = components.labels[index];
            prop_assert_eq!(number > 0, inside);
            prop_assert!(number <= next, "labels are numbered by their first pixels");
            next = next.max(number + 1);
            let (x, y) = (index % size.width(), index / size.width());
            let mut neighbors = vec![(x + 1, y), (x, y + 1)];
            if connectivity == Connectivity::Eight {
                neighbors.extend([(x + 1, y + 1), (x.wrapping_sub(1), y + 1)]);
            }
            for (x, y) in neighbors.into_iter().filter(|&(x, y)| x < size.width() && y < size.height()) {
                let other = components.labels[y * size.width() + x];
                prop_assert!(number == 0 || other == 0 || number == other, "neighbors {number} and {other}");
            }
        }
        for (k, &size) in (1_u32..).zip(&components.sizes) {
            prop_assert_eq!(components.labels.iter().filter(|label| **label == k).count(), size);
        }
    }

    #[test]
    fn a_level_parts_the_pixels(
        (mask, size, connectivity) in mask(),
        values in prop::collection::vec(0.01..1.0_f64, 144),
        level in -0.5..0.5,
    ) {
        // Inside is above the level, outside below it, both by any amount.
        let field: Vec<f64> =
            mask.iter().zip(values).map(|(&inside, value)| if inside { level + value } else { level - value }).collect();
        let lines = trace_level(&field, size, level, connectivity).unwrap();
        for (index, &expected) in mask.iter().enumerate() {
            prop_assert_eq!(inside(&lines, center(index, size)), expected, "pixel {}", index);
        }
        let (width, height) = (f64::of_usize(size.width()), f64::of_usize(size.height()));
        for [x, y] in lines.iter().flatten() {
            prop_assert!((0.0..=width).contains(x) && (0.0..=height).contains(y), "({x}, {y}) is outside the image");
        }
    }

    #[test]
    fn a_level_line_is_the_circle(radius in 3.0..8.0_f64, x in 10.0..14.0_f64, y in 10.0..14.0_f64) {
        // The exact signed distance: interpolation errs by an eighth of its largest curvature between the two
        // pixels, which is 1 / (radius - 1) at most.
        let size = ImageSize::new(24, 24).unwrap();
        let field: Vec<f64> = (0..size.pixels())
            .map(|index| center(index, size))
            .map(|[px, py]| radius - (px - x).hypot(py - y))
            .collect();
        let lines = trace_level(&field, size, 0.0, Connectivity::Four).unwrap();
        prop_assert_eq!(lines.len(), 1);
        for v in &lines[0] {
            let error = (v[0] - x).hypot(v[1] - y) - radius;
            prop_assert!(error.abs() <= 0.125 / (radius - 1.0), "{error} px off");
        }
        let (efd, middle) = Efd::from_contour(&lines[0], 4).unwrap();
        prop_assert!((middle[0] - x).hypot(middle[1] - y) < 0.02, "{middle:?} for ({x}, {y})");
        prop_assert!((efd.normalize().unwrap().scale - radius).abs() < 0.05);
    }

    #[test]
    fn resampling_keeps_to_the_polygon(polygon in strategy::star_polygon(3..20), count in 1_usize..50) {
        let points = resample(&polygon, count);
        prop_assert_eq!(points.len(), count);
        prop_assert!((points[0][0] - polygon[0][0]).abs() + (points[0][1] - polygon[0][1]).abs() < 1e-15);
        prop_assert!(signed_area(&polygon) > 0.0);
        // A shortcut is never longer than the way along the polygon, and many points leave out little of it.
        let step = perimeter(&polygon) / f64::of_usize(count);
        for (k, p) in points.iter().enumerate() {
            let q = points[(k + 1) % count];
            prop_assert!((q[0] - p[0]).hypot(q[1] - p[1]) <= step * (1.0 + 1e-9));
        }
        let dense = resample(&polygon, 4000);
        prop_assert!((signed_area(&dense) - signed_area(&polygon)).abs() < 1e-3);
        prop_assert!((perimeter(&dense) / perimeter(&polygon) - 1.0).abs() < 1e-2);
    }
}
