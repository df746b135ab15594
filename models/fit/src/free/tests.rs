use alloc::vec;
use alloc::vec::Vec;

use dvp_core::contour::resample;
use dvp_core::shape::OutlineBasis;

use super::basis::Basis;
use super::foot::EdgeLanes;
use super::forecast::{DAMPING, Forecast, foretell};
use super::grow::{Freedom, GrowScratch, GrowSettings, Grown, grow};
use super::loops::cut_loops;
use super::outline_fit::{FreeOutline, OutlineScratch, OutlineSettings, Target, damp, expand, gather};
use super::start::shrink;
use crate::cholesky::packed;
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
    let start = outline();
    let samples = samples(&start, &basis);
    let target = Target { samples: &samples, basis: &basis, vertex_count: VERTICES, settings: SETTINGS };
    let mut scratch = OutlineScratch::default();
    gather(&start, &target, &mut scratch);
    expand(&start, &target, &mut scratch);
    let gradient = scratch.gradient.clone();
    assert_eq!(gradient.len(), 14);
    for (lane, &analytic) in gradient.iter().enumerate() {
        let mut cost = |by: f64| {
            let mut moved = start.clone();
            *moved.coefficient_mut(lane) += by;
            gather(&moved, &target, &mut scratch)
        };
        let numeric = 0.5 * (cost(1e-6) - cost(-1e-6)) / 2e-6;
        assert!((analytic - numeric).abs() < 1e-5 * (1.0 + numeric.abs()), "lane {lane}: {analytic} {numeric}");
    }
}

#[test]
fn a_forecast_is_the_least_of_the_quadratic_with_the_high_harmonics_at_0() {
    let basis = Basis::new(VERTICES, 3);
    let start = outline();
    let samples = samples(&start, &basis);
    let (mut scratch, mut forecast) = (OutlineScratch::default(), Forecast::default());
    let target = Target { samples: &samples, basis: &basis, vertex_count: VERTICES, settings: SETTINGS };
    let cost = gather(&start, &target, &mut scratch);
    expand(&start, &target, &mut scratch);
    let (n, gradient) = (scratch.gradient.len(), scratch.gradient.clone());
    damp(&mut scratch.hessian, n, DAMPING);
    let hessian: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| scratch.hessian[packed(i.max(j), i.min(j))]).collect()).collect();
    foretell(&start, &target, &mut scratch, &mut forecast).unwrap();
    for harmonics in 1..=3 {
        let told = forecast.outline(&start, harmonics, &scratch);
        assert_eq!(told.rows.len(), harmonics);
        let mut all = FreeOutline { center: told.center, rows: told.rows.clone() };
        all.rows.resize(3, [0.0; 4]);
        let step: Vec<f64> = (0..n).map(|i| all.coefficient(i) - start.coefficient(i)).collect();
        let slope: Vec<f64> =
            (0..n).map(|i| gradient[i] + (0..n).map(|j| hessian[i][j] * step[j]).sum::<f64>()).collect();
        // What is free has no slope left.
        let free = 2 + 4 * harmonics;
        assert!(slope[..free].iter().all(|s| s.abs() < 1e-7 * gradient[0].abs().max(1.0)), "{harmonics}: {slope:?}");
        let value = cost + (0..n).map(|i| step[i] * (gradient[i] + slope[i])).sum::<f64>();
        let foretold = forecast.costs[harmonics];
        assert!((value - foretold).abs() < 1e-7 * cost, "{harmonics}: {value} {foretold}");
    }
}

#[test]
fn what_is_hidden_of_an_outline_stays_where_it_was() {
    // A disk whose right quarter is hidden; the rest is that of another of 12 harmonics, a tenth of a pixel off here and there.
    let basis = Basis::new(VERTICES, 12);
    let mut shape = FreeOutline { center: [40.0, 38.0], rows: vec![[0.0; 4]; 12] };
    shape.rows[0] = [20.0, 0.0, 0.0, -20.0];
    let (vertices, mut samples) = exact_samples(&shape);
    samples.retain(|sample| sample.point[0] < 54.0);
    for (k, sample) in (0_u32..).zip(&mut samples) {
        sample.distance += 0.1 * f64::from((k / 2 * 7) % 5) - 0.2;
    }
    let target = Target { samples: &samples, basis: &basis, vertex_count: VERTICES, settings: SETTINGS };
    let (mut scratch, mut forecast) = (OutlineScratch::default(), Forecast::default());
    foretell(&shape, &target, &mut scratch, &mut forecast).unwrap();
    let mut moved = Vec::new();
    forecast.outline(&shape, 12, &scratch).write_vertices(&basis, VERTICES, &mut moved);
    let hidden = vertices.iter().zip(&moved).filter(|(v, _)| v[0] > 56.0);
    let farthest = hidden.map(|(v, m)| (v[0] - m[0]).hypot(v[1] - m[1])).fold(0.0, f64::max);
    assert!(farthest < 1.0, "{farthest} px");
}

#[test]
fn a_forecast_tells_how_far_residuals_spread() {
    let basis = Basis::new(VERTICES, 3);
    let (mut scratch, mut forecast) = (OutlineScratch::default(), Forecast::default());
    // A hundred and twenty-six samples, off by three times what their weights say, in turns of the golden section.
    let shape = outline();
    let mut samples = exact_samples(&shape).1;
    for (k, sample) in (0_u32..).zip(&mut samples) {
        let turn = (f64::from(k) * 0.618_033_988_749_895).fract() * core::f64::consts::TAU;
        sample.distance += 3.0 * core::f64::consts::SQRT_2 * turn.cos() * SETTINGS.pixel_noise / sample.weight;
    }
    // Some that are far off do not count.
    samples.iter_mut().step_by(10).for_each(|sample| sample.distance += 3.0);
    let target = Target { samples: &samples, basis: &basis, vertex_count: VERTICES, settings: SETTINGS };
    foretell(&shape, &target, &mut scratch, &mut forecast).unwrap();
    assert!((9.0..30.0).contains(&forecast.spread), "{}", forecast.spread);
}

#[test]
fn an_outline_in_its_normal_form_has_the_same_vertices() {
    // Started anywhere, turned, and in pixels of which 50 are a unit.
    let mut outline = outline();
    outline.rows.resize(20, [0.02, -0.01, 0.03, 0.01]);
    let basis = Basis::new(VERTICES, 20);
    let mut fitted = Vec::new();
    outline.write_vertices(&basis, VERTICES, &mut fitted);
    let (efd, pose) = outline.normal_form(50.0).unwrap();
    let mut drawn = vec![[0.0; 2]; VERTICES];
    OutlineBasis::new(VERTICES, 20).unwrap().outline(efd.rows(), &mut drawn).unwrap();
    pose.transform(&mut drawn);
    for vertex in &drawn {
        let distance = |v: &[f64; 2]| (v[0] - 50.0 * vertex[0]).hypot(v[1] - 50.0 * vertex[1]);
        let nearest = fitted.iter().map(distance).fold(f64::INFINITY, f64::min);
        assert!(nearest < 1e-9, "{vertex:?} is {nearest} px from the nearest");
    }
    // Within half an edge of the long axis.
    let [a, b, ..] = efd.rows()[0];
    assert!(a > (core::f64::consts::PI / 63.0).cos() - 1e-9 && b.abs() < core::f64::consts::PI / 63.0, "{a} {b}");
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
    grown_from(&contour[1..], &samples)
}

/// The outline that is grown from a traced one.
fn grown_from(contour: &[[f64; 2]], samples: &[EdgeSample<f64>]) -> Grown<f64> {
    let basis = Basis::new(VERTICES, 31);
    let settings = GrowSettings {
        vertex_count: VERTICES,
        max_harmonics: 31,
        freedom: Freedom::Full,
        noise: 0.003,
        prices: Prices::default(),
    };
    grow(contour, samples, &basis, settings, &mut GrowScratch::default()).unwrap()
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
fn a_spur_of_the_traced_outline_is_not_grown() {
    // A square with a loop traced at one of its corners, as noise leaves it.
    let ring = |radius: f64| {
        let corners =
            [[1.0, 1.0], [1.0, -1.0], [-1.0, -1.0], [-1.0, 1.0]].map(|p: [f64; 2]| p.map(|v| 40.0 + radius * v));
        resample(&corners, 96)
    };
    let traced = resample(
        &[
            [60.0, 60.0],
            [60.0, 20.0],
            [20.0, 20.0],
            [20.0, 57.0],
            [21.5, 65.0],
            [24.0, 65.0],
            [22.0, 57.0],
            [18.5, 60.0],
        ],
        96,
    );
    let samples: Vec<_> = [-0.7, 0.7]
        .into_iter()
        .flat_map(|distance| {
            ring(20.0 + distance).into_iter().map(move |point| EdgeSample { point, distance, weight: 0.5 })
        })
        .collect();
    let outline = grown_from(&traced, &samples).outline;
    let mut vertices = Vec::new();
    outline.write_vertices(&Basis::new(VERTICES, 31), VERTICES, &mut vertices);
    let farthest = vertices.iter().flatten().map(|v| (v - 40.0).abs()).fold(0.0, f64::max);
    assert!(farthest < 21.0, "{farthest}: {vertices:?}");
}

#[test]
fn a_traced_outline_moved_inward_does_not_cross_itself() {
    let cog: Vec<[f64; 2]> = (0..90)
        .map(|i| core::f64::consts::TAU * f64::from(i) / 90.0)
        .map(|angle| [angle.cos(), angle.sin()].map(|v| 40.0 + v * (12.0 + 2.0 * (9.0 * angle).sin())))
        .collect();
    let mut moved = shrink(&cog, 4.0);
    assert!(!cut_loops(&mut moved));
    // What is left lies about as far inside.
    let radii = moved.iter().map(|&[x, y]| (x - 40.0).hypot(y - 40.0));
    assert!(radii.clone().fold(0.0, f64::max) < 11.0 && radii.fold(f64::INFINITY, f64::min) > 5.0, "{moved:?}");
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
