use alloc::vec::Vec;

use dvp_core::render::{Compositing, ContourRenderer, EdgeLaw, EdgeProfile, HardRenderer, Renderer};
use dvp_core::{Drawing, Image, ImageSize};

use super::{EdgeEvidence, EdgeKind};
use crate::segment::{SegmentOptions, Segmentation};

/// Where a picture's objects stand.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shapes {
    Disks,
    TurnedSquares,
    Upright,
}

fn drawing(shapes: Shapes, seed: u32) -> Drawing<f64> {
    let mut drawing = Drawing { background: [0.1, 0.2, 0.3], ..Drawing::default() };
    let parts = [
        ([0.3, 0.28], 0.15, [0.9, 0.3, 0.2]),
        ([0.7, 0.66], 0.2, [0.2, 0.8, 0.6]),
        ([0.25, 0.75], 0.1, [0.6, 0.1, 0.9]),
    ];
    for (k, (center, radius, color)) in parts.into_iter().enumerate() {
        let k = u32::try_from(k).unwrap();
        let jitter = f64::from((seed * 7 + k * 13) % 17) / 17.0;
        let (count, turn) = match shapes {
            Shapes::Disks => (63, jitter),
            Shapes::TurnedSquares => (4, 0.2 + 1.2 * jitter),
            Shapes::Upright => (4, core::f64::consts::FRAC_PI_4),
        };
        let outline: Vec<[f64; 2]> = (0..count)
            .map(|i| {
                let angle = turn + f64::from(i) * core::f64::consts::TAU / f64::from(count);
                [center[0] + 0.01 * jitter + radius * angle.cos(), center[1] - 0.013 * jitter + radius * angle.sin()]
            })
            .collect();
        drawing.push(&outline, color, 1.0);
    }
    drawing
}

/// How a picture was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Drawn {
    Reference,
    Hard,
    Area,
    /// Area coverage and a Gaussian of that standard deviation, px.
    Blurred(f64),
}

fn picture(shapes: Shapes, drawn: Drawn, side: usize, seed: u32) -> Image<f64> {
    let size = ImageSize::new(side, side).unwrap();
    let mut image = Image::zeros(size);
    let drawing = drawing(shapes, seed);
    let contour = |edge| ContourRenderer::new(edge, Compositing::Blend);
    match drawn {
        Drawn::Reference => {
            contour(EdgeProfile::reference()).render(&drawing, size, &mut Default::default(), image.data_mut())
        }
        Drawn::Hard => HardRenderer::default().render(&drawing, size, &mut Default::default(), image.data_mut()),
        Drawn::Area | Drawn::Blurred(_) => {
            contour(EdgeProfile::area()).render(&drawing, size, &mut Default::default(), image.data_mut())
        }
    }
    .unwrap();
    if let Drawn::Blurred(deviation) = drawn {
        image = blurred(&image, deviation);
    }
    image.data_mut().iter_mut().for_each(|v| *v = (*v * 255.0).round() / 255.0);
    image
}

/// A Gaussian sampled at whole pixels: offsets and weights.
fn kernel(deviation: f64) -> Vec<(i32, f64)> {
    let weights = (-8..=8).map(|i: i32| (i, (-0.5 * (f64::from(i) / deviation).powi(2)).exp()));
    let total: f64 = weights.clone().map(|(_, weight)| weight).sum();
    weights.map(|(i, weight)| (i, weight / total)).collect()
}

/// The square image blurred along rows and columns; beyond the border it goes on as it ends.
fn blurred(image: &Image<f64>, deviation: f64) -> Image<f64> {
    let kernel = kernel(deviation);
    let side = image.size().width();
    let moved = |at: usize, by: i32| at.saturating_add_signed(isize::try_from(by).unwrap()).min(side - 1);
    let mut data = image.data().to_vec();
    for along_rows in [true, false] {
        let before = data;
        let value = |i: usize| {
            let (channel, y, x) = (i / (side * side), i / side % side, i % side);
            let at = |by| if along_rows { y * side + moved(x, by) } else { moved(y, by) * side + x };
            kernel.iter().map(|&(by, weight)| weight * before[channel * side * side + at(by)]).sum()
        };
        data = (0..before.len()).map(value).collect();
    }
    Image::from_planar(image.size(), data).unwrap()
}

fn assert_near(a: f64, b: f64, tolerance: f64) {
    assert!((a - b).abs() <= tolerance, "{a} is not {b}");
}

#[test]
fn distance_inverts_coverage() {
    let (edge, unit) = (EdgeProfile::<f64>::reference(), 128.0);
    let coverage = |d: f64| {
        let doubled = d / (0.5 * unit);
        1.0 / (1.0 + ((doubled * doubled.abs() - edge.offset) / edge.sigma).exp())
    };
    // Coverage 0.985 lies 0.58 px outside the outline, 0.02 lies 1.9 px outside.
    for d in [0.6, 0.9, 1.43, 1.7, 1.85] {
        let (distance, slope) = EdgeKind::Profile(edge).distance(coverage(d), unit).unwrap();
        assert_near(distance, d, 1e-9);
        assert_near(slope, (coverage(d - 1e-5) - coverage(d + 1e-5)) / 2e-5, 1e-8);
    }
    assert!(EdgeKind::Profile(edge).distance(0.999, unit).is_none());
    assert_eq!(EdgeKind::Area.distance(0.75, unit), Some((-0.25, 1.0)));
    assert_eq!(EdgeKind::Hard.distance(0.0, unit), Some((0.5, 0.5)));
}

#[test]
fn distance_inverts_blur() {
    // Sigma 1 px at 128 px per unit: coverage 0.75 lies ln 3 inside and has slope 0.75 x 0.25.
    let kind = EdgeKind::Profile(EdgeProfile::distance(1.0 / 64.0));
    let (distance, slope) = kind.distance(0.75, 128.0).unwrap();
    assert_near(distance, -(3.0_f64.ln()), 1e-12);
    assert_near(slope, 0.1875, 1e-12);
}

fn edges(image: &Image<f64>) -> EdgeEvidence<f64> {
    let mut segmentation = Segmentation::default();
    assert!(segmentation.read(&image.view(), &SegmentOptions::default()));
    segmentation.interpret(Compositing::Blend);
    segmentation.edges(&image.view())
}

#[test]
fn pixels_are_counted_by_coverage() {
    let mut evidence = EdgeEvidence::default();
    [0.0149, 0.05, 0.5, 0.9, 0.95, 0.99].into_iter().for_each(|coverage| evidence.count(coverage));
    assert_eq!([evidence.settled, evidence.low, evidence.middle, evidence.high], [2, 1, 2, 1]);
    assert_eq!(evidence.softness(), None);
    // Nothing to go by.
    assert_eq!(evidence.kinds(128.0), (EdgeKind::Profile(EdgeProfile::reference()), None));
}

#[test]
fn softness_of_a_ramp_by_hand() {
    // Coverage 0, 1/4, 1/2, 3/4, 1 across: p (1 - p) sums to 3/16 + 4/16 + 3/16, and |grad p| to 1 per row.
    let size = ImageSize::new(9, 20).unwrap();
    let ramp = [0.0, 0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0];
    let pixels: Vec<f64> = (0..180).flat_map(|i| [ramp[i % 9], 0.5, 0.2 * ramp[i % 9]]).collect();
    let image = Image::from_interleaved(size, &pixels).unwrap();
    let mut evidence = EdgeEvidence::default();
    let colors = [[0.0, 0.5, 0.0], [1.0, 0.5, 0.2]];
    for y in 0..20 {
        for x in 0..9 {
            evidence.measure(&image.view(), [x, y], colors);
        }
    }
    // The first and the last row tell nothing.
    assert_near(evidence.length, 18.0, 1e-9);
    assert_near(evidence.softness().unwrap(), 0.625, 1e-9);
    // Beside another color there is nothing to measure.
    let before = evidence;
    evidence.measure(&image.view(), [4, 4], [[0.0, 0.5, 0.0], [0.0, 0.5, 1.0]]);
    assert_eq!(evidence, before);
}

/// Pictures of 64 to 512 px; the large ones once.
fn cases() -> impl Iterator<Item = (usize, Shapes, u32)> {
    let shapes = [Shapes::Disks, Shapes::TurnedSquares, Shapes::Upright];
    let small = [64, 96, 128, 256].into_iter().flat_map(|side| (0..4).map(move |seed| (side, seed)));
    small.chain([(512, 0)]).flat_map(move |(side, seed)| shapes.map(|shapes| (side, shapes, seed)))
}

#[test]
fn hard_and_area_pixels_are_told() {
    for (side, shapes, seed) in cases() {
        for (drawn, expected) in [(Drawn::Hard, EdgeKind::Hard), (Drawn::Area, EdgeKind::Area)] {
            let evidence = edges(&picture(shapes, drawn, side, seed));
            let (kind, other) = evidence.kinds(f64::from(u32::try_from(side).unwrap()));
            // Near 128 px the reference is as soft as areas are; where edges run along the grid both are tried.
            let doubt = shapes == Shapes::Upright && (96..=128).contains(&side);
            let found = kind == expected || (doubt && other == Some(expected));
            assert!(found, "{side} {drawn:?} {shapes:?} {seed}: {kind:?}, {other:?} from {evidence:?}");
        }
    }
}

#[test]
fn the_reference_is_told_at_any_size() {
    for (side, shapes, seed) in cases() {
        let evidence = edges(&picture(shapes, Drawn::Reference, side, seed));
        let (kind, _) = evidence.kinds(f64::from(u32::try_from(side).unwrap()));
        let expected = EdgeKind::Profile(EdgeProfile::reference());
        assert!(kind == expected, "{side} {shapes:?} {seed}: {kind:?} from {evidence:?}");
    }
}

#[test]
fn blur_is_measured() {
    for (side, shapes, seed) in cases() {
        for deviation in [0.5, 1.0, 1.5, 2.0] {
            let evidence = edges(&picture(shapes, Drawn::Blurred(deviation), side, seed));
            let unit = f64::from(u32::try_from(side).unwrap());
            let (kind, other) = evidence.kinds(unit);
            let EdgeKind::Profile(edge) = kind else { panic!("{side} {deviation} {shapes:?} {seed}: {kind:?}") };
            // Areas of pixels are a blur of variance 1/12; the nearest logistic has 1/1.702 of the deviation.
            let kernel = kernel(deviation);
            let variance = kernel.iter().map(|(i, weight)| weight * f64::from(i * i)).sum::<f64>();
            let expected = (variance + 1.0 / 12.0).sqrt() / 1.702;
            let off = edge.in_pixels(unit).sharpness.recip() / expected;
            assert!(
                edge.law == EdgeLaw::Distance && other.is_none() && (0.85..1.15).contains(&off),
                "{side} {deviation} {shapes:?} {seed}: {kind:?}, {other:?}, {off} times as soft, from {evidence:?}"
            );
        }
    }
}
