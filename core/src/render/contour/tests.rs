use alloc::vec;
use alloc::vec::Vec;

use super::{ContourDistance, ContourRenderer};
use crate::dims::ImageSize;
use crate::render::tile::TileRenderer;
use crate::render::{Compositing, EdgeLaw, EdgeProfile, RenderError};
use crate::scene::Drawing;
use crate::shape::{Outline, Rings};

/// Coverage pixel by pixel and edge by edge, from the definition.
fn by_definition(rings: Rings<'_, f64>, edge: EdgeProfile<f64>, size: ImageSize) -> Vec<f64> {
    let unit = size.unit_px() as f64;
    let edges = || rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let pixels = (0..size.height()).flat_map(|row| (0..size.width()).map(move |column| (row as f64, column as f64)));
    let coverage = pixels.map(|(row, column)| {
        let p = [(column + 0.5) / unit, (row + 0.5) / unit];
        let (mut nearest, mut inside) = (f64::INFINITY, false);
        for (a, b) in edges() {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            if (a[1] > p[1]) != (b[1] > p[1]) && p[0] > a[0] + (p[1] - a[1]) * dx / dy {
                inside = !inside;
            }
            let u = (((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / (dx * dx + dy * dy)).clamp(0.0, 1.0);
            let (ex, ey) = (p[0] - a[0] - u * dx, p[1] - a[1] - u * dy);
            // The doubled frame: lengths twice those of the scene.
            nearest = nearest.min(4.0 * (ex * ex + ey * ey));
        }
        let far = if edge.law == EdgeLaw::SquaredDistance { nearest } else { nearest.sqrt() };
        let d = if inside { -far } else { far };
        if d > edge.cut { 0.0 } else { 1.0 / (1.0 + ((d - edge.offset) / edge.sigma).exp()) }
    });
    coverage.collect()
}

fn assert_by_definition(rings: Rings<'_, f64>, edge: EdgeProfile<f64>, size: ImageSize) {
    let mut drawing = Drawing::default();
    drawing.push_rings(rings, [1.0; 3], 1.0);
    let mut coverage = vec![f64::NAN; size.pixels()];
    let renderer = ContourRenderer::new(edge, Compositing::Blend);
    renderer.object_coverage(&drawing, size, &mut Default::default(), &mut coverage).unwrap();
    for (i, (found, expected)) in coverage.iter().zip(by_definition(rings, edge, size)).enumerate() {
        let (row, column) = (i / size.width(), i % size.width());
        // Saturation is 1e-6 from the logistic.
        assert!((found - expected).abs() < 1.1e-6, "({row}, {column}): {found}, not {expected}");
    }
}

/// A pentagram: edges longer than a block in all directions, crossing each other, with a hole in the middle.
fn pentagram(center: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    (0..5)
        .map(|i| {
            let angle = 0.3 + f64::from(2 * i) * core::f64::consts::TAU / 5.0;
            [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
        })
        .collect()
}

#[test]
fn coverage_is_that_of_the_definition() {
    let size = ImageSize::new(150, 101).unwrap();
    let edges = [
        EdgeProfile::reference(),
        // A wide ramp, one that is half covered on the outline, and one inside of it: half covered 0.1 inward.
        EdgeProfile { offset: 0.01, sigma: 0.004, cut: 0.03, ..EdgeProfile::reference() },
        EdgeProfile { offset: 0.0, sigma: 1e-4, cut: 6e-4, ..EdgeProfile::reference() },
        EdgeProfile { offset: -0.01, sigma: 1e-3, cut: -0.004, ..EdgeProfile::reference() },
        // At 101 px the doubled frame has 50.5 px per unit: blur of a Gaussian of 1.7 and of 0.34 px, and one fattened.
        EdgeProfile::distance(0.02),
        EdgeProfile::distance(0.004),
        EdgeProfile { offset: 0.03, ..EdgeProfile::distance(0.01) },
    ];
    for edge in edges {
        for outline in [pentagram([0.7, 0.5], 0.45), pentagram([0.05, 0.95], 0.4), pentagram([0.5, 0.5], 3.0)] {
            assert_by_definition(Rings::one(&outline), edge, size);
        }
    }
}

#[test]
fn thin_outlines_in_small_images_are_covered() {
    for (width, height) in [(1, 1), (1, 40), (40, 1), (16, 16), (17, 33)] {
        let size = ImageSize::new(width, height).unwrap();
        let edge = EdgeProfile { offset: 0.02, sigma: 0.004, cut: 0.04, ..EdgeProfile::reference() };
        assert_by_definition(Rings::one(&[[0.1, 0.2], [0.9, 0.25], [0.5, 0.3]]), edge, size);
    }
}

#[test]
fn every_ring_counts() {
    let size = ImageSize::new(70, 61).unwrap();
    let square = |low: f64, high: f64| [[low, low], [high, low], [high, high], [low, high]];
    let mut outline = Outline::default();
    // A frame whose hole is drawn the same way round, with an island that is not, a ring that crosses the frame, one outside
    // of the view and one of two vertices, which is a line.
    outline.push_ring(square(0.1, 0.9));
    outline.push_ring(square(0.25, 0.75));
    outline.push_ring(square(0.4, 0.6).into_iter().rev());
    outline.push_ring(pentagram([0.95, 0.5], 0.15));
    outline.push_ring(pentagram([7.0, 0.5], 0.4));
    outline.push_ring([[0.15, 0.05], [0.2, 0.95]]);
    for edge in [EdgeProfile::reference(), EdgeProfile::distance(0.02)] {
        assert_by_definition(outline.rings(), edge, size);
    }
}

#[test]
fn repeated_vertices_are_no_edges() {
    let size = ImageSize::new(32, 32).unwrap();
    let once = [[0.2, 0.2], [0.8, 0.3], [0.5, 0.8]];
    let twice = [once[0], once[0], once[1], once[2], once[2], once[0]];
    let covered = |outline: &[[f64; 2]]| {
        let mut drawing = Drawing::default();
        drawing.push(outline, [1.0; 3], 1.0);
        let mut coverage = vec![0.0; size.pixels()];
        ContourRenderer::default().object_coverage(&drawing, size, &mut Default::default(), &mut coverage).unwrap();
        coverage
    };
    let difference = covered(&once).iter().zip(covered(&twice)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-12, "{difference}");
    assert!(covered(&[once[0]; 4]).iter().all(|&p| p <= 0.0), "a point has no edge");
}

#[test]
fn a_narrower_band_leaves_out_no_more_than_it_says() {
    let size = ImageSize::new(150, 101).unwrap();
    let mut drawing = Drawing::default();
    drawing.push(&pentagram([0.7, 0.5], 0.45), [1.0; 3], 1.0);
    let covered = |saturation| {
        let coverage = ContourDistance { saturation, ..ContourDistance::default() };
        let renderer = TileRenderer { coverage, compositing: Compositing::Blend };
        let mut coverage = vec![0.0_f64; size.pixels()];
        renderer.object_coverage(&drawing, size, &mut Default::default(), &mut coverage).map(|()| coverage)
    };
    let exact = covered(1e-12).unwrap();
    for saturation in [1e-6, 1e-4, 1e-2, 0.5] {
        let found = covered(saturation).unwrap();
        let most = exact.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most <= saturation, "{saturation}: {most}");
        assert!(most > 0.0 && found.iter().zip(&exact).all(|(found, exact)| found >= exact), "{saturation}");
    }
    for refused in [0.0, -1.0, 0.6, f64::NAN] {
        assert!(matches!(covered(refused), Err(RenderError::Setting { what: "saturation", .. })), "{refused}");
    }
}
