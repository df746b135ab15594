use alloc::vec;
use alloc::vec::Vec;

use super::basis::Basis;
use super::foot::EdgeLanes;
use super::grow::{Freedom, GrowScratch, GrowSettings, Grown, grow};
use super::outline_fit::{FreeOutline, OutlineScratch, OutlineSettings, expand, gather};
use crate::price::Prices;
use crate::segment::EdgeSample;

const VERTICES: usize = 64;
const SETTINGS: OutlineSettings<f64> =
    OutlineSettings { width_px: 0.7, pixel_noise: 0.05, smoothness: 1e-3, max_steps: 0 };

fn outline() -> FreeOutline<f64> {
    FreeOutline {
        center: [31.0, 33.0],
        rows: [[14.0, 1.0, -2.0, -10.0], [0.5, 1.0, -0.7, 0.3], [0.2, -0.4, 0.3, 0.6]].into(),
    }
}

/// Three samples beside each edge, off the outline by -0.9 .. 0.9 px, with distances that do not fit.
fn samples(outline: &FreeOutline<f64>, basis: &Basis<f64>) -> Vec<EdgeSample<f64>> {
    let mut vertices = Vec::new();
    outline.write_vertices(basis, VERTICES, &mut vertices);
    let mut out = Vec::new();
    for (i, pair) in (0_u32..).zip(vertices.windows(2)) {
        let step: [f64; 2] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = step[0].hypot(step[1]);
        for k in 0..3 {
            let (u, off) = (0.25 * f64::from(k + 1), 0.3 * f64::from((i + 2 * k) % 7) - 0.9);
            let point = [0, 1].map(|c| pair[0][c] + u * step[c] + off * [step[1], -step[0]][c] / length);
            out.push(EdgeSample { point, distance: off + 0.2 * f64::from((i * 5 + k) % 5) - 0.4, weight: 0.5 });
        }
    }
    out
}

#[test]
fn no_edge_is_nearer_than_the_closest() {
    let (basis, mut vertices, mut lanes) = (Basis::new(VERTICES, 3), Vec::new(), EdgeLanes::default());
    outline().write_vertices(&basis, VERTICES, &mut vertices);
    // As many edges as fill the lanes, fewer, and more.
    for used in [64, 33, 5] {
        vertices.truncate(used);
        vertices[used - 1] = vertices[0];
        lanes.set(&vertices);
        for i in 0..400 {
            let point = [f64::from(i % 20) * 3.0 + 0.3, f64::from(i / 20) * 3.0 + 0.7];
            let distance = |pair: &[[f64; 2]]| {
                let (step, arm) = ([0, 1].map(|c| pair[1][c] - pair[0][c]), [0, 1].map(|c| point[c] - pair[0][c]));
                let share = (arm[0] * step[0] + arm[1] * step[1]) / (step[0] * step[0] + step[1] * step[1]);
                (arm[0] - share.clamp(0.0, 1.0) * step[0]).hypot(arm[1] - share.clamp(0.0, 1.0) * step[1])
            };
            let distances: Vec<f64> = vertices.windows(2).map(distance).collect();
            let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
            let closest = lanes.closest(point);
            assert!(distances[closest] - least < 1e-9, "edge {closest} of {used} at {point:?}");
        }
    }
}

#[test]
fn the_gradient_is_that_of_half_the_cost() {
    let basis = Basis::new(VERTICES, 3);
    let mut start = outline();
    let samples = samples(&start, &basis);
    let mut scratch = OutlineScratch::default();
    gather(&start, &samples, &basis, VERTICES, &SETTINGS, &mut scratch);
    expand(&mut start, &basis, &SETTINGS, &mut scratch);
    let gradient = scratch.gradient.clone();
    assert_eq!(gradient.len(), 14);
    for (lane, &analytic) in gradient.iter().enumerate() {
        let mut cost = |by: f64| {
            let mut moved = start.clone();
            *moved.coefficient(lane) += by;
            gather(&moved, &samples, &basis, VERTICES, &SETTINGS, &mut scratch)
        };
        let numeric = 0.5 * (cost(1e-6) - cost(-1e-6)) / 2e-6;
        assert!((analytic - numeric).abs() < 1e-5 * (1.0 + numeric.abs()), "lane {lane}: {analytic} {numeric}");
    }
}

/// Vertices of an outline, and exact samples around it.
fn exact_samples(outline: &FreeOutline<f64>) -> (Vec<[f64; 2]>, Vec<EdgeSample<f64>>) {
    let basis = Basis::new(VERTICES, outline.rows.len());
    let mut vertices = Vec::new();
    outline.write_vertices(&basis, VERTICES, &mut vertices);
    let mut samples = Vec::new();
    for pair in vertices.windows(2) {
        let step: [f64; 2] = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        let length = step[0].hypot(step[1]);
        let middle = [0, 1].map(|c| 0.5 * (pair[0][c] + pair[1][c]));
        // The outline turns from +x to -y: outside is to the right of its way, (-dy, dx).
        for distance in [-0.6, 0.6] {
            let point = [middle[0] - distance * step[1] / length, middle[1] + distance * step[0] / length];
            samples.push(EdgeSample { point, distance, weight: 0.5 });
        }
    }
    (vertices, samples)
}

/// The outline that is grown from exact samples of another.
fn grown(outline: &FreeOutline<f64>) -> Grown<f64> {
    let (contour, samples) = exact_samples(outline);
    let basis = Basis::new(VERTICES, 31);
    let settings = GrowSettings {
        vertex_count: VERTICES,
        max_harmonics: 31,
        freedom: Freedom::Full,
        noise: 0.003,
        prices: Prices::default(),
    };
    grow(&contour[1..], &samples, &basis, settings, &mut GrowScratch::default()).unwrap()
}

#[test]
fn an_outline_pays_for_no_more_harmonics_than_it_needs() {
    // 2, 0.7 and 0.2 px off a circle, 3, 5 and 9 times around.
    let mut rows = vec![[0.0; 4]; 9];
    rows[0] = [20.0, 0.0, 0.0, -20.0];
    for (harmonic, size) in [(3, 2.0), (5, 0.7), (9, 0.2)] {
        rows[harmonic - 1] = [size, 0.0, 0.0, size];
    }
    let grown = grown(&FreeOutline { center: [40.0, 38.0], rows });
    assert!((5..=14).contains(&grown.outline.rows.len()), "{} harmonics", grown.outline.rows.len());
    // As much again for what is missed.
    assert!(grown.bits < 2.0 * 32.0 * 10.0, "{}", grown.bits);
}

#[test]
fn a_cog_pays_for_the_harmonics_of_its_teeth() {
    // Nothing is gained by any harmonic below the 11th.
    let mut rows = vec![[0.0; 4]; 11];
    rows[0] = [30.0, 0.0, 0.0, -30.0];
    rows[10] = [1.5, 0.0, 0.0, 1.5];
    let grown = grown(&FreeOutline { center: [40.0, 38.0], rows });
    assert!((11..=22).contains(&grown.outline.rows.len()), "{} harmonics", grown.outline.rows.len());
}

#[test]
fn an_ellipse_pays_for_one_harmonic() {
    let grown = grown(&FreeOutline { center: [30.0, 28.0], rows: vec![[14.0, 0.0, 0.0, -9.0]] });
    assert_eq!(grown.outline.rows.len(), 1);
    let [a, b, c, d] = grown.outline.rows[0];
    // The area pi |a d - b c| does not depend on where the outline starts.
    assert!(((a * d - b * c).abs() - 126.0).abs() < 0.5, "{:?}", grown.outline);
    assert!((grown.outline.center[0] - 30.0).abs() < 0.02 && (grown.outline.center[1] - 28.0).abs() < 0.02);
}

#[test]
fn the_basis_holds_cosines_and_sines() {
    // t = 2 pi i / 4: vertex 1 is a quarter turn, vertex 4 is vertex 0 again.
    let basis = Basis::<f64>::new(5, 2);
    let expected = [1.0, 0.0, 1.0, -1.0, 0.0];
    assert!(basis.row(1, 2).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{:?}", basis.row(1, 2));
    assert_eq!(basis.row(0, 2), basis.row(4, 2));
    assert_eq!(basis.row(3, 1).len(), 3);
}
