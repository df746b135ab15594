use alloc::vec;
use alloc::vec::Vec;

use dvp_core::shape::{Cap, Flattening, Join, Outline, OutlineBasis, PathRing, Segment, Shape as _, Stroke};
use dvp_core::Vec2;

use super::*;
use crate::sample::Sample;

const RULER: Ruler = Ruler { extent: 128.0 };
const MITER: Join<f64> = Join::Miter { limit: 4.0 };

/// A generator of noise without state outside: the sum of four uniform numbers, of standard deviation 1.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (0..4).map(|_| self.uniform() - 0.5).sum::<f64>() * 3f64.sqrt()
    }
}

/// Where the outline crosses the middles of columns, if it is flat there, and of rows, if it is steep: as windows read it.
fn samples_of(shapes: &[&dyn dvp_core::Shape<f64>], sigma: f64, seed: u64) -> Vec<RingSamples> {
    let mut noise = Noise(seed);
    let basis = OutlineBasis::new(8, 2).unwrap();
    let mut outline = Outline::default();
    shapes.iter().for_each(|shape| shape.flatten(&Flattening::new(&basis, 1e-4), &mut outline).unwrap());
    let outline = outline.resolved(dvp_core::shape::FillRule::NonZero).unwrap();
    let mut rings = Vec::new();
    for ring in outline.rings().iter() {
        let mut run = Vec::new();
        for (i, &from) in ring.iter().enumerate() {
            let (from, to) = (Vec2::from(from), Vec2::from(ring[(i + 1) % ring.len()]));
            let along = to - from;
            let is_flat = along.x.abs() >= along.y.abs();
            let axis = if is_flat { Vec2::new(0.0, 1.0) } else { Vec2::new(1.0, 0.0) };
            let [start, end] = [from, to].map(|point| if is_flat { point.x } else { point.y } - 0.5);
            let (low, high) = (start.min(end).ceil() as i64, start.max(end).ceil() as i64);
            let mut places: Vec<_> = (low..high).map(|k| (k as f64 - start) / (end - start)).collect();
            places.sort_by(f64::total_cmp);
            run.extend(places.into_iter().map(|share| {
                Sample { point: from.lerp(to, share) + axis * (sigma * noise.normal()), axis, sigma: sigma.max(0.005) }
            }));
        }
        rings.push(RingSamples { runs: vec![run], closed: true });
    }
    rings
}

fn fit(stroke: &Stroke<f64>) -> Option<StrokeFit> {
    fit_strokes(&samples_of(&[stroke], 0.02, 7), &RULER)
}

fn line(points: &[[f64; 2]]) -> PathRing<f64> {
    PathRing::polyline(points.to_vec())
}

fn rounded(rings: Vec<PathRing<f64>>, width: f64) -> Stroke<f64> {
    Stroke { rings, width, cap: Cap::Round, join: Join::Round }
}

/// Most distance between the outlines of two shapes, one way and the other, over points of them.
fn apart(a: &[Stroke<f64>], b: &[Stroke<f64>]) -> f64 {
    let basis = OutlineBasis::new(8, 2).unwrap();
    let outline = |strokes: &[Stroke<f64>]| {
        let mut outline = Outline::default();
        strokes.iter().for_each(|stroke| stroke.flatten(&Flattening::new(&basis, 1e-3), &mut outline).unwrap());
        outline.resolved(dvp_core::shape::FillRule::NonZero).unwrap()
    };
    let [a, b] = [outline(a), outline(b)];
    let one_way = |a: &Outline<f64>, b: &Outline<f64>| {
        let segments: Vec<_> = b.rings().iter().flat_map(dvp_core::geometry::LineSegment::closed).collect();
        let distance = |point: [f64; 2]| {
            segments.iter().map(|segment| segment.nearest(point.into()).distance()).fold(f64::INFINITY, f64::min)
        };
        a.vertices.iter().map(|&vertex| distance(vertex)).fold(0.0, f64::max)
    };
    one_way(&a, &b).max(one_way(&b, &a))
}

#[track_caller]
fn assert_found(stroke: &Stroke<f64>, lines: usize) -> StrokeFit {
    let fit = fit(stroke).expect("a stroke is found");
    std::eprintln!("{:#?}", fit);
    let count: usize = fit.strokes.iter().map(|stroke| stroke.rings.len()).sum();
    let apart = apart(core::slice::from_ref(stroke), &fit.strokes);
    std::eprintln!("apart {apart}, width {} for {}, bits {} + {}", fit.strokes[0].width, stroke.width, fit.bits, fit.misfit);
    assert_eq!(count, lines, "lines");
    assert!((fit.strokes[0].width - stroke.width).abs() < 0.02, "width {}", fit.strokes[0].width);
    assert!(apart < 0.1, "apart {apart}");
    fit
}

#[test]
fn one_line() {
    let stroke = rounded(vec![line(&[[20.3, 30.1], [80.7, 61.9]])], 6.0);
    assert_eq!(assert_found(&stroke, 1).strokes[0].cap, Cap::Round);
    // With straight ends it is a rectangle.
    assert_eq!(fit(&Stroke { cap: Cap::Butt, ..stroke }), None);
}

#[test]
fn a_polyline_with_corners() {
    for (cap, join) in [(Cap::Round, Join::Round), (Cap::Butt, MITER)] {
        let rings = vec![line(&[[20.3, 30.1], [80.7, 41.9], [40.2, 90.3], [100.5, 100.1]])];
        let fit = assert_found(&Stroke { rings, width: 6.0, cap, join }, 1);
        assert_eq!((fit.strokes[0].cap, fit.strokes[0].join), (cap, join));
        assert_eq!(fit.strokes[0].rings[0].points.len(), 4);
    }
}

#[test]
fn crossing_lines_go_on() {
    let rings = vec![line(&[[20.3, 30.1], [80.7, 81.9]]), line(&[[20.2, 75.3], [90.5, 40.1]])];
    assert_found(&rounded(rings, 5.0), 2);
}

#[test]
fn a_line_ends_at_another() {
    let rings = vec![line(&[[20.3, 30.1], [80.7, 30.1]]), line(&[[50.2, 30.1], [50.2, 80.0]])];
    assert_found(&rounded(rings, 5.0), 2);
}

#[test]
fn arcs_and_rings() {
    let arc = PathRing { points: vec![[30.0, 50.0], [90.0, 60.0]], segments: vec![Segment::Arc { bulge: 0.6 }] };
    assert_found(&rounded(vec![arc], 5.0), 1);
    let ring = PathRing { points: vec![[30.0, 50.0], [90.0, 50.0]], segments: vec![Segment::Arc { bulge: 1.0 }; 2] };
    assert_found(&rounded(vec![ring], 5.0), 1);
    let frame = PathRing::polygon(vec![[20.2, 30.3], [100.4, 30.3], [100.4, 80.7], [20.2, 80.7]]);
    let stroke = Stroke { rings: vec![frame], width: 4.0, cap: Cap::Butt, join: MITER };
    assert_found(&stroke, 1);
}
