//! Pixels that touch, and outlines that cover as much as was said.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::contour::{Connectivity, label};
use dvp_core::shape::Circle;
use dvp_core::{Image, ImageSize, Object, Paint, Pose, Scene, Vec2};
use proptest::prelude::*;

use super::level::Level;
use super::{Painted, channels, differing, touching};
use crate::layers::polygon;
use crate::ruler::Ruler;
use crate::tuning;

/// Columns and rows of the windows.
const SIDE: usize = 24;

/// How much of every pixel a pen covers along a line, counted at 16 x 16 places of each.
fn drawn(from: Vec2<f64>, to: Vec2<f64>, width: f64) -> Vec<f64> {
    let line = dvp_core::geometry::LineSegment::new(from, to);
    let is_inside = |x: f64, y: f64| {
        let at = Vec2::new(x, y);
        let foot = from.lerp(to, line.nearest(at).share);
        (at - foot).length() < 0.5 * width
    };
    let share = |x: usize, y: usize| {
        let place = |k: usize| (k as f64 + 0.5) / 16.0;
        let places = (0..256).filter(|k| is_inside(x as f64 + place(k % 16), y as f64 + place(k / 16)));
        places.count() as f64 / 256.0
    };
    (0..SIDE * SIDE).map(|i| share(i % SIDE, i / SIDE)).collect()
}

/// How much of every pixel polygons cover, by the even-odd rule, counted likewise.
fn covered(polygons: &[Vec<[f64; 2]>]) -> Vec<f64> {
    let is_inside =
        |at: [f64; 2]| polygons.iter().filter(|points| dvp_core::contour::contains(points, at)).count() % 2 == 1;
    let share = |x: usize, y: usize| {
        let place = |k: usize| (k as f64 + 0.5) / 8.0;
        let places = (0..64).filter(|k| is_inside([x as f64 + place(k % 8), y as f64 + place(k / 8)]));
        places.count() as f64 / 64.0
    };
    (0..SIDE * SIDE).map(|i| share(i % SIDE, i / SIDE)).collect()
}

proptest! {
    #[test]
    fn pixels_touch_as_components_do(mask in prop::collection::vec(prop::bool::weighted(0.4), 7 * 9)) {
        let size = ImageSize::new(7, 9).unwrap();
        let pixels: Vec<usize> = (0..mask.len()).filter(|&i| mask[i]).collect();
        let parts = touching(&pixels, 7);
        let components = label(&mask, size, Connectivity::Eight).unwrap();
        for (&i, &part) in pixels.iter().zip(&parts) {
            prop_assert_eq!(components.labels[i], part + 1);
        }
    }

    #[test]
    fn differing_pixels_are_found(changes in prop::collection::vec((0_usize..900, 0_usize..3), 0..12), from in 0_usize..900) {
        let size = ImageSize::new(30, 30).unwrap();
        let one = Image::<f32>::zeros(size);
        let mut other = one.clone();
        changes.iter().for_each(|&(i, channel)| other.data_mut()[channel * 900 + i] = -0.5);
        let mut expected: Vec<usize> = changes.iter().map(|&(i, _)| i).filter(|&i| i >= from).collect();
        expected.sort_unstable();
        expected.dedup();
        let off = |step: f32| differing(channels(&one.view(), &(from..900)), channels(&other.view(), &(from..900)), step, from);
        prop_assert_eq!(off(0.4), expected);
        prop_assert!(off(0.6).is_empty());
    }
}

/// Lines of a pen of letters, wherever they lie: in half of them no pixel is off by more than .05, in one of twenty some pixel is by more than .3.
#[test]
fn outlines_cover_what_is_covered() {
    let mut state = 7_u64;
    let mut between = |low: f64, high: f64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let ruler = Ruler { extent: SIDE as f64 };
    let mut worst: Vec<f64> = Vec::new();
    for _ in 0..200 {
        let (middle, turn) = (Vec2::new(between(9.0, 15.0), between(9.0, 15.0)), between(0.0, core::f64::consts::PI));
        let half = Vec2::from_angle(turn) * (0.5 * between(4.0, 10.0));
        let wanted = drawn(middle - half, middle + half, between(0.8, 2.5));
        let level = Level::of(&wanted, ImageSize::new(SIDE, SIDE).unwrap(), Vec2::new(0.0, 0.0)).unwrap();
        let found = level.outlines(&ruler);
        let polygons: Vec<Vec<[f64; 2]>> = found.iter().filter_map(polygon).collect();
        let shown = covered(&polygons);
        worst.push(wanted.iter().zip(&shown).map(|(wanted, shown)| (wanted - shown).abs()).fold(0.0, f64::max));
    }
    worst.sort_unstable_by(f64::total_cmp);
    assert!(worst[100] < 0.05 && worst[190] < 0.3, "{} {}", worst[100], worst[190]);
}

/// Of lines with round ends a pen tells where they lie, and how wide they are to a tenth, in fewer numbers than any outline: of most of them.
#[test]
fn a_pen_is_told_by_what_it_covers() {
    let ruler = Ruler { extent: SIDE as f64 };
    let mut found = 0;
    for k in 0..24 {
        let (width, turn) = (0.9 + 0.05 * f64::from(k), 0.26 * f64::from(k));
        let middle = Vec2::new(11.0 + 0.13 * f64::from(k), 12.3);
        let half = Vec2::from_angle(turn) * 7.0;
        let wanted = drawn(middle - half, middle + half, width);
        let level = Level::of(&wanted, ImageSize::new(SIDE, SIDE).unwrap(), Vec2::new(0.0, 0.0)).unwrap();
        let outlines: f64 = level.outlines(&ruler).iter().map(|outline| outline.bits + outline.misfit).sum();
        let Some(pen) = level.pen(&ruler).filter(|pen| pen.bits + pen.misfit < outlines) else { continue };
        found += 1;
        let [stroke] = &pen.strokes[..] else { panic!("{k}: {pen:?}") };
        assert!((stroke.width - width).abs() < 0.1 * width, "{k}: {} for {width}", stroke.width);
    }
    assert!(found > 12, "{found} of 24");
}

/// The colors of what is missed where a white drawing should show lines (how much each covers of every pixel, and its gray), whose grays are known.
fn missed_grays(lines: &[(Vec<f64>, f32)]) -> Vec<Paint<f32>> {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let over = |i: usize| lines.iter().fold(1.0_f32, |under, (line, gray)| under + line[i] as f32 * (gray - under));
    let pixels: Vec<f32> = (0..size.pixels()).flat_map(|i| [over(i); 3]).collect();
    let image = Image::from_interleaved(size, &pixels).unwrap();
    let white = Image::from_interleaved(size, &vec![1.0; 3 * size.pixels()]).unwrap();
    let thing = |&(_, gray): &(Vec<f64>, f32)| {
        let pose = Pose { translation: [0.0; 2], scale: 1.0, rotation: 0.0 };
        Object { shape: Circle { radius: 0.01 }.into(), pose, paint: [gray; 3].into(), confidence: 1.0 }
    };
    let scene = Scene { objects: lines.iter().map(thing).collect(), ..Scene::empty([1.0; 3]) };
    let painted = Painted { scene: &scene, image: image.view(), painted: white.view(), step: tuning::LEAST_CONTRAST };
    let missed = painted.missed(&painted.off(&(0..size.pixels())));
    missed.iter().map(|missed| missed.object.paint.clone()).collect()
}

/// A gray line that begins at a black one shows as much as a black hairline would, and stays gray.
#[test]
fn what_lies_across_a_darker_line_keeps_its_color() {
    let bar = drawn(Vec2::new(6.3, 4.0), Vec2::new(6.3, 20.0), 1.4);
    let line = drawn(Vec2::new(6.0, 11.6), Vec2::new(22.0, 13.9), 0.9);
    assert_eq!(missed_grays(&[(line, 0.7), (bar, 0.0)]), [0.0, 0.7].map(|gray| Paint::Flat([gray; 3])));
}

/// Of a line along the border less than half a pixel is seen; it goes on beyond, and is one with what begins there.
#[test]
fn what_lies_along_the_border_is_as_wide_as_what_leads_there() {
    let along = drawn(Vec2::new(-0.1, -4.0), Vec2::new(-0.1, 30.0), 1.1);
    let away = drawn(Vec2::new(0.0, 11.2), Vec2::new(20.0, 13.6), 1.2);
    assert_eq!(missed_grays(&[(along, 0.0), (away, 0.0)]), [Paint::Flat([0.0; 3])]);
}

/// Letters are drawn again and again: the second one is the first, elsewhere, to the last digit.
#[test]
fn what_is_drawn_alike_is_told_alike() {
    let size = ImageSize::new(2 * SIDE, SIDE).unwrap();
    let line = drawn(Vec2::new(7.3, 8.1), Vec2::new(15.6, 14.2), 1.7);
    let over = |i: usize| 1.0 - line[i / (2 * SIDE) * SIDE + i % SIDE] as f32;
    let pixels: Vec<f32> = (0..size.pixels()).flat_map(|i| [over(i); 3]).collect();
    let image = Image::from_interleaved(size, &pixels).unwrap();
    let white = Image::from_interleaved(size, &vec![1.0; 3 * size.pixels()]).unwrap();
    let pair = Painted { scene: &Scene::empty([1.0; 3]), image: image.view(), painted: white.view(), step: 0.01 };
    let found = pair.missed(&pair.off(&(0..size.pixels())));
    let [first, second] = &found[..] else { panic!("{found:?}") };
    assert_eq!((&first.object.shape, first.bits.to_bits()), (&second.object.shape, second.bits.to_bits()));
    let [from, to] = [first, second].map(|missed| missed.object.pose.translation);
    let apart = (to[0] - from[0]) * size.unit_px() as f32;
    assert!((apart - SIDE as f32).abs() < 1e-4 && (to[1] - from[1]).abs() < 1e-6, "{from:?} {to:?}");
}
