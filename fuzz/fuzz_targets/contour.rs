//! Masks and polygons to descriptors: finite where they are given, areas as counted.
#![no_main]

use arbitrary::Arbitrary;
use dvp_core::contour::{Connectivity, signed_area, trace_level, trace_mask};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Efd, ImageSize};
use dvp_fuzz::Points;
use libfuzzer_sys::fuzz_target;

#[derive(Arbitrary, Debug)]
struct Input {
    width: u8,
    bits: Vec<bool>,
    polygon: Points,
    harmonics: u8,
    tolerance: f32,
}

fn describe(polygon: &[[f32; 2]], harmonics: usize, tolerance: f32) {
    let Ok((efd, center)) = Efd::from_contour(polygon, harmonics) else { return };
    assert!(efd.rows().as_flattened().iter().chain(&center).all(|v| v.is_finite()));
    let _ = efd.symmetry(tolerance);
    let _ = efd.reference_symmetry_order(5, 0.075);
    if let Ok(normalized) = efd.normalize() {
        let rows = normalized.efd.rows();
        assert!(rows.is_empty() || (rows[0][0] - 1.0).abs() < 1e-3, "{rows:?}");
    }
    if let Ok(basis) = OutlineBasis::new(16, harmonics.max(1)) {
        let mut outline = [[0.0; 2]; 16];
        basis.outline(efd.rows(), &mut outline).expect("as many harmonics as the basis");
    }
}

fuzz_target!(|input: Input| {
    let harmonics = usize::from(input.harmonics % 40);
    describe(&input.polygon.0, harmonics, input.tolerance);
    let width = usize::from(input.width % 32) + 1;
    let height = input.bits.len() / width;
    let Ok(size) = ImageSize::new(width, height) else { return };
    let mask = &input.bits[..size.pixels()];
    for connectivity in [Connectivity::Four, Connectivity::Eight] {
        let borders = trace_mask::<f32>(mask, size, connectivity).expect("a value per pixel");
        let area: f32 = borders.iter().map(|border| signed_area(border)).sum();
        assert_eq!(area, mask.iter().filter(|&&inside| inside).count() as f32);
        borders.iter().for_each(|border| describe(border, harmonics, input.tolerance));
        let field: Vec<f32> = (0..mask.len()).map(|i| if mask[i] { input.tolerance } else { 0.3 }).collect();
        let lines = trace_level(&field, size, 0.5, connectivity).expect("a value per pixel");
        lines.iter().for_each(|line| describe(line, harmonics, input.tolerance));
    }
});
