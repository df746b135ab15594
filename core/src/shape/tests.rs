#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

use super::*;

#[test]
fn four_vertices_of_an_ellipse() {
    // x = 2 cos, y = sin at t = 0, 1/4, 1/2, 3/4, 1.
    let basis = OutlineBasis::<f64>::new(5, 3).unwrap();
    let mut outline = [[9.0; 2]; 5];
    basis.outline(&[[2.0, 0.0, 0.0, 1.0]], &mut outline).unwrap();
    let expected = [[2.0, 0.0], [0.0, 1.0], [-2.0, 0.0], [0.0, -1.0], [2.0, 0.0]];
    for (vertex, expected) in outline.iter().zip(expected) {
        assert!((vertex[0] - expected[0]).abs() < 1e-15 && (vertex[1] - expected[1]).abs() < 1e-15, "{outline:?}");
    }
    assert_eq!(outline[0], outline[4]);
}

#[test]
fn the_table_gives_the_defining_sum() {
    // Vertex counts around the block size, odd and even.
    for vertex_count in [4, 5, 15, 16, 17, 63, 64, 65, 130, 300] {
        let basis = OutlineBasis::<f64>::new(vertex_count, 7).unwrap();
        let rows: Vec<[f64; 4]> = (1..=7).map(f64::from).map(|n| [1.0 / n, 0.3, -0.2 * n, 0.1]).collect();
        let mut outline = vec![[0.0; 2]; vertex_count];
        basis.outline(&rows, &mut outline).unwrap();
        for (i, vertex) in outline.iter().enumerate() {
            let t = f64::of_usize(i) / f64::of_usize(vertex_count - 1) * core::f64::consts::TAU;
            let mut expected = [0.0; 2];
            for (n, row) in rows.iter().enumerate() {
                let (sin, cos) = num_traits::Float::sin_cos(t * f64::of_usize(n + 1));
                expected[0] += row[0] * cos + row[1] * sin;
                expected[1] += row[2] * cos + row[3] * sin;
            }
            let error = (vertex[0] - expected[0]).abs() + (vertex[1] - expected[1]).abs();
            assert!(error < 1e-12, "{vertex_count} vertices, vertex {i}: {vertex:?} against {expected:?}");
        }
    }
}

#[test]
fn wrong_lengths_are_refused() {
    assert_eq!(OutlineBasis::<f32>::new(3, 1), Err(ShapeError::TooFewPoints { len: 2 }));
    assert_eq!(OutlineBasis::<f32>::new(64, 0), Err(ShapeError::Zero { what: "harmonic_count" }));
    let basis = OutlineBasis::<f32>::new(64, 2).unwrap();
    let error = basis.outline(&[[0.0; 4]; 3], &mut [[0.0; 2]; 64]);
    assert_eq!(error, Err(ShapeError::TooManyHarmonics { harmonic_count: 3, limit: 2 }));
    let error = basis.outline_vjp(&[[0.0; 2]; 63], &mut [[0.0; 4]; 2]);
    assert_eq!(error, Err(ShapeError::Length { what: "outline", expected: 64, len: 63 }));
    let error = EfdModel::new(basis).outline(&[0.0; 7], &mut [[0.0; 2]; 64]);
    assert_eq!(error, Err(ShapeError::Length { what: "parameters", expected: 8, len: 7 }));
}

#[test]
fn descriptors_of_a_square_by_hand() {
    // Corners (1, 1), (-1, 1), (-1, -1), (1, -1): perimeter 8, so x falls along the first edge with dx/dt = -1 per unit
    // length. a_1 = 8 / (2 pi^2) sum dx/dt (cos phi_end - cos phi_start), phi = 0, pi/2, pi, 3 pi/2:
    // edge 1: -(0 - 1) = 1, edge 3: +(0 - -1) = 1, so a_1 = 8 / pi^2; b_1: edge 1: -(1 - 0), edge 3: -1 - 0: -8 / pi^2.
    let square = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let (efd, center) = Efd::<f64>::from_contour(&square, 1).unwrap();
    let k = 8.0 / (core::f64::consts::PI * core::f64::consts::PI);
    for (value, expected) in efd.rows()[0].iter().zip([k, -k, k, k]) {
        assert!((value - expected).abs() < 1e-15, "{efd:?}");
    }
    assert_eq!(center, [0.0, 0.0]);
}

#[test]
fn contours_without_an_outline_are_refused() {
    let line = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]];
    assert_eq!(Efd::<f32>::from_contour(&line, 4), Err(ShapeError::TooFewPoints { len: 2 }));
    assert_eq!(Efd::<f32>::from_contour(&[], 4), Err(ShapeError::TooFewPoints { len: 0 }));
    let broken = [[0.0, 0.0], [1.0, f32::NAN], [1.0, 1.0]];
    assert_eq!(Efd::from_contour(&broken, 4), Err(ShapeError::NotFinite { index: 1 }));
    let huge = [[0.0, 0.0], [1e308, 0.0], [0.0, 1e308]];
    assert_eq!(Efd::<f64>::from_contour(&huge, 4), Err(ShapeError::TooLarge));
    assert_eq!(Efd::<f32>::zeros(3).normalize(), Err(ShapeError::Degenerate));
    assert_eq!(Efd::<f32>::zeros(0).normalize(), Err(ShapeError::Degenerate));
}

#[test]
fn a_shape_drawn_twice_is_the_shape() {
    // e^(2it) + e^(6it) / 4 is e^(it) + e^(3it) / 4 run twice: two-fold, as its frequencies 1 and 3 say.
    let twice = Efd::new(vec![[0.0; 4], [1.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4], [0.0; 4], [0.25, 0.0, 0.0, 0.25]]);
    assert_eq!(twice.symmetry(0.01), Symmetry::Finite(2));
    assert_eq!(Efd::<f64>::zeros(3).symmetry(0.01), Symmetry::Continuous);
}

#[test]
fn the_square_of_the_data_runs_clockwise_and_has_four_turns() {
    // Frequencies -1 and 3, whose difference is 4; differences from +1 would say 2.
    let square = Efd::new(vec![[1.0, 0.0, 0.0, -1.0], [0.0; 4], [0.109, 0.0, 0.0, 0.109]]);
    assert_eq!(square.symmetry(0.02), Symmetry::Finite(4));
}

#[test]
fn the_built_in_bank() {
    let bank = mdshr_bank::<f64>(16);
    assert_eq!((bank.prototypes().len(), bank.harmonic_count()), (MDSHR_NAMES.len(), 16));
    let orders = [1, 4, 2];
    for ((efd, order), name) in bank.prototypes().iter().zip(orders).zip(MDSHR_NAMES) {
        assert_eq!(efd.rows()[0][..3], [1.0, 0.0, 0.0], "{name} is not normalized");
        assert_eq!(efd.symmetry(SYMMETRY_TOLERANCE), Symmetry::Finite(order), "{name}");
        assert_eq!(efd.reference_symmetry_order(5, REFERENCE_SYMMETRY_THRESHOLD), order, "{name}");
    }
    // More harmonics than are known are zero. A square of side 2 has a first harmonic of radius 8 sqrt(2) / pi^2, so that the
    // normalized one has the area 4 pi^4 / 128 = 3.044; the traced one differs in the third digit.
    let bank = mdshr_bank::<f32>(70);
    assert_eq!(bank.prototypes()[1].rows()[69], [0.0; 4]);
    assert!((bank.prototypes()[1].signed_area() + 3.044).abs() < 0.01, "{}", bank.prototypes()[1].signed_area());
}

#[test]
fn mixing_and_choosing() {
    let bank = PrototypeBank::new(vec![Efd::new(vec![[1.0; 4]]), Efd::new(vec![[2.0; 4], [4.0; 4]])]);
    let mut rows = [[9.0; 4]; 2];
    bank.mix(&[0.5, 0.25], &mut rows).unwrap();
    assert_eq!(rows, [[1.0; 4], [1.0; 4]]);
    let refused = bank.mix(&[0.5], &mut rows);
    assert_eq!(refused, Err(ShapeError::Length { what: "weights", expected: 2, len: 1 }));
    assert_eq!(PrototypeBank::strongest(&[0.1, 0.6, 0.6]), Some(1));
    assert_eq!(PrototypeBank::strongest(&[f64::NAN, 0.3]), Some(1));
    assert_eq!(PrototypeBank::<f64>::strongest(&[]), None);
}

#[test]
fn normal_forms_of_tiny_and_huge_shapes() {
    // Squares of these numbers leave the range of f32.
    for scale in [1e-30_f32, 1.0, 1e30] {
        let normalized = Efd::new(vec![[0.0, 2.0 * scale, scale, 0.0]]).normalize().unwrap();
        assert!((normalized.efd.rows()[0][3] + 0.5).abs() < 1e-6, "{normalized:?}");
        assert!((normalized.scale / scale - 2.0).abs() < 1e-6, "{normalized:?}");
    }
}

#[test]
fn breaks_that_fall_or_pass_the_end_give_no_rings() {
    let vertices = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    for breaks in [&[2, 1][..], &[9], &[3, 0]] {
        let rings = Rings { breaks, ..Rings::one(&vertices) };
        assert!(rings.iter().all(|ring| ring.len() <= 3), "{breaks:?}");
        assert!(rings.resolved(FillRule::EvenOdd).is_ok(), "{breaks:?}");
        let pieces = vertices.map(|v| Piece::Line { from: v.into(), to: v.into() }).to_vec();
        let boundary = Boundary { pieces, breaks: breaks.to_vec(), fill: FillRule::EvenOdd };
        assert!(boundary.rings().count() <= 3, "{breaks:?}");
    }
}
