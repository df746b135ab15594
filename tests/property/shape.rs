//! Invariants of every kind of shape.

use dvp_core::shape::{
    AnyShape, Circle, Ellipse, Flattening, Outline, OutlineBasis, Path, PathRing, Segment, Shape as _,
};
use dvp_tests::shape_strategy;
use proptest::prelude::*;

fn flattened(shape: &AnyShape<f64>, tolerance: f64) -> Outline<f64> {
    let basis = OutlineBasis::new(32, 8).unwrap();
    let mut outline = Outline::default();
    shape.flatten(&Flattening::new(&basis, tolerance), &mut outline).unwrap();
    outline
}

fn signed_area(polygon: &[[f64; 2]]) -> f64 {
    dvp_core::contour::signed_area(polygon)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn numbers_come_back(shape in shape_strategy::shape(), seed in prop::collection::vec(0.1..1.0, 97)) {
        let mut numbers = Vec::new();
        shape.numbers(&mut numbers);
        prop_assert_eq!(numbers.len(), shape.number_count());
        let names = shape.number_names();
        prop_assert_eq!(names.len(), numbers.len());
        let distinct: std::collections::BTreeSet<_> = names.iter().collect();
        prop_assert_eq!(distinct.len(), names.len());
        let mut copy = shape.clone();
        let others: Vec<f64> = seed.into_iter().cycle().take(numbers.len()).collect();
        copy.set_numbers(&others).unwrap();
        let mut read = Vec::new();
        copy.numbers(&mut read);
        prop_assert_eq!(read, others);
        copy.set_numbers(&numbers).unwrap();
        prop_assert_eq!(&copy, &shape);
        prop_assert!(copy.set_numbers(&numbers[1..]).is_err());
        numbers[0] = f64::NAN;
        prop_assert!(copy.set_numbers(&numbers).is_err());
        prop_assert_eq!(copy, shape);
    }

    #[test]
    fn circles_ellipses_and_arcs_keep_their_area(
        radii in prop::array::uniform2(1.0..500.0_f64),
        bulge in -3.0..3.0_f64,
        tolerance in prop_oneof![Just(0.01), Just(0.1), Just(1.0)],
    ) {
        let close = |area: f64, exact: f64| (area / exact - 1.0).abs() < 1e-12;
        let circle = flattened(&Circle { radius: radii[0] }.into(), tolerance);
        prop_assert!(close(signed_area(&circle.vertices), core::f64::consts::PI * radii[0] * radii[0]));
        for &[x, y] in &circle.vertices {
            let off = x.hypot(y) - radii[0];
            prop_assert!((0.0..=tolerance).contains(&off), "{off}");
        }
        let ellipse = flattened(&Ellipse { radii }.into(), tolerance);
        prop_assert!(close(signed_area(&ellipse.vertices), core::f64::consts::PI * radii[0] * radii[1]));
        // A segment of a circle: radius^2 (sweep - sin sweep) / 2, with the chord 2 radius sin(sweep / 2).
        prop_assume!(bulge.abs() > 0.01);
        let points = vec![[3.0, -2.0], [3.0 + radii[0], -2.0 + radii[1]]];
        let path = Path::new(vec![PathRing { points, segments: vec![Segment::Arc { bulge }, Segment::Line] }]).unwrap();
        let arc = flattened(&path.into(), tolerance);
        let sweep = 4.0 * bulge.atan();
        let radius = radii[0].hypot(radii[1]) / (2.0 * (sweep / 2.0).sin());
        let area = radius * radius * (sweep - sweep.sin()) / 2.0;
        prop_assert!((signed_area(&arc.vertices) / area - 1.0).abs() < 1e-9, "{} against {area}", signed_area(&arc.vertices));
        let middle = [3.0 + radii[0] / 2.0, -2.0 + radii[1] / 2.0];
        let height = radius * (sweep / 2.0).cos() / radii[0].hypot(radii[1]);
        let center = [middle[0] - radii[1] * height, middle[1] + radii[0] * height];
        for &[x, y] in &arc.vertices[1..arc.vertices.len() - 1] {
            let off = (x - center[0]).hypot(y - center[1]) - radius.abs();
            prop_assert!((0.0..=tolerance).contains(&off), "{off}");
        }
    }
}
