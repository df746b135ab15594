use alloc::vec;
use alloc::vec::Vec;

use dvp_core::render::{Compositing, ExactArea, ExactRenderer, Renderer as _};
use dvp_core::scene::{ColorRamp, ColorStop, RampKind};
use dvp_core::shape::{Circle, OutlineBasis, Rectangle};
use dvp_core::{AnyShape, Drawing, Image, ImageSize, Object, Paint, Pose, Scene};
use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::{RngSeed, TestRunner};

use super::smooth::is_rough;
use super::{Light, level};

const SIDE: usize = 80;
const WHITE: [f32; 3] = [1.0; 3];
/// Ramps that are painted, and the share of the pixels of one that may be missed.
const MANY: usize = 400;
const FEW: f64 = 0.02;

/// An object whose numbers are shares of the picture, painted with a ramp between colors at equal distances.
fn object(shape: impl Into<AnyShape<f32>>, center: [f32; 2], kind: RampKind<f32>, colors: &[[f32; 3]]) -> Object<f32> {
    let last = (colors.len() - 1) as f32;
    let stops = colors.iter().enumerate().map(|(i, &color)| ColorStop { offset: i as f32 / last, color });
    let pose = Pose { translation: center, ..Pose::identity() };
    Object {
        shape: shape.into(),
        pose,
        paint: Paint::Ramp(ColorRamp { kind, stops: stops.collect() }),
        confidence: 1.0,
    }
}

/// The picture of objects on white, rounded to 8 bits, and how much of each pixel the first one covers.
fn picture(objects: Vec<Object<f32>>) -> (Image<f32>, Vec<f32>) {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let renderer = ExactRenderer { coverage: ExactArea, compositing: Compositing::Over };
    let paint = |scene: &Scene<f32>| {
        let (mut drawing, mut image) = (Drawing::default(), vec![0.0; 3 * size.pixels()]);
        scene.draw(&OutlineBasis::new(64, 1).unwrap(), &mut drawing).unwrap();
        renderer.render(&drawing, size, &mut Default::default(), &mut image).unwrap();
        image
    };
    let mask = Object { paint: [1.0; 3].into(), ..objects[0].clone() };
    let mask = paint(&Scene { objects: vec![mask], ..Scene::empty([0.0; 3]) });
    let image = paint(&Scene { objects, ..Scene::empty(WHITE) });
    let rounded = image.into_iter().map(|value: f32| (value * 255.0).round() / 255.0).collect();
    (Image::from_planar(size, rounded).unwrap(), mask[..size.pixels()].to_vec())
}

/// Share of the pixels that the object covers of which the ramp found misses more than two steps.
fn missed(image: &Image<f32>, mask: &[f32], ramp: &ColorRamp<f32>) -> f64 {
    let inner = || (0..mask.len()).filter(|&i| mask[i] > 0.999);
    let is_missed = |&i: &usize| {
        let point = [i % SIDE, i / SIDE].map(|at| (at as f32 + 0.5) / SIDE as f32);
        let (found, painted) = (ramp.color_at(ramp.kind.offset(point)), image.view().pixel(i));
        (0..3).any(|c| (found[c] - painted[c]).abs() > 2.0 / 255.0)
    };
    inner().filter(is_missed).count() as f64 / inner().count() as f64
}

fn color() -> impl Strategy<Value = [f32; 3]> {
    prop::array::uniform3(0.0..0.8_f32)
}

/// Points of ramps around the middle of an object.
fn kind() -> impl Strategy<Value = RampKind<f32>> {
    let line = (0.0..6.3_f32, 0.25..0.5_f32)
        .prop_map(|(angle, half)| RampKind::Linear([-half, half].map(|at| [at * angle.cos(), at * angle.sin()])));
    let circle = (prop::array::uniform2(-0.2..0.2_f32), 0.35..0.7_f32)
        .prop_map(|([x, y], radius)| RampKind::Radial([[x, y], [x + radius, y], [x, y + radius]]));
    let ellipse = (prop::array::uniform2(-0.2..0.2_f32), 0.35..0.7_f32, 0.6..1.4_f32, 0.0..3.0_f32).prop_map(
        |([x, y], radius, ratio, angle)| {
            let ([cos, sin], short) = ([radius * angle.cos(), radius * angle.sin()], ratio);
            RampKind::Radial([[x, y], [x + cos, y + sin], [x - short * sin, y + short * cos]])
        },
    );
    prop_oneof![line, circle, ellipse]
}

/// What is painted with a ramp is found as that ramp, and leveled as if it had been painted with one color: all but a few pixels of it (where colors
/// stop to change just before an edge), and of the pixels that it touches, in nearly all of many.
#[test]
fn ramps_are_found_and_leveled() {
    let config = ProptestConfig { rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() };
    let mut runner = TestRunner::new(config);
    let ramps = (color(), color(), kind(), prop::array::uniform2(0.4..0.6_f32));
    let ramps = ramps.prop_filter("of one color", |(from, to, ..)| (0..3).any(|c| (from[c] - to[c]).abs() > 0.2));
    let (mut found, mut leveled) = (0, 0);
    for _ in 0..MANY {
        let (from, to, kind, center) = ramps.new_tree(&mut runner).unwrap().current();
        let (image, mask) = picture(vec![object(Circle { radius: 0.3 }, center, kind, &[from, to])]);
        let Some(level) = level(&image.view()) else { continue };
        let [ramp] = &level.ramps[..] else { continue };
        found += usize::from(missed(&image, &mask, &ramp.ramp) <= FEW);
        // Rounding tells less of the share the nearer the colors are.
        let is_off = |&i: &usize| {
            let expected = |c: usize| mask[i] * ramp.color[c] + (1.0 - mask[i]) * WHITE[c];
            (0..3).any(|c| (level.image.view().channel(c)[i] - expected(c)).abs() > 0.04)
        };
        let touched = || (0..mask.len()).filter(|&i| mask[i] > 0.0);
        leveled += usize::from(touched().filter(is_off).count() as f64 <= FEW * touched().count() as f64);
    }
    assert!(found >= 99 * MANY / 100 && leveled >= 99 * MANY / 100, "{found} and {leveled} of {MANY}");
}

#[test]
fn flat_pictures_have_no_ramps() {
    let mut disk = object(Circle { radius: 0.3 }, [0.5, 0.5], RampKind::Linear([[0.0; 2], [1.0; 2]]), &[WHITE, WHITE]);
    disk.paint = [0.2, 0.4, 0.7].into();
    assert!(level(&picture(vec![disk]).0.view()).is_none());
}

/// A picture of one ramp that fills it.
fn sheet() -> Image<f32> {
    let shape = Rectangle { size: [1.0, 1.0], corner_radius: 0.0 };
    let kind = RampKind::Linear([[-0.5, -0.2], [0.5, 0.2]]);
    picture(vec![object(shape, [0.5, 0.5], kind, &[[0.1, 0.3, 0.5], [0.3, 0.5, 0.4]])]).0
}

#[test]
fn wide_edges_are_no_ramps() {
    let mut disk = object(Circle { radius: 0.3 }, [0.5, 0.5], RampKind::Linear([[0.0; 2], [1.0; 2]]), &[WHITE, WHITE]);
    disk.paint = [0.8, 0.85, 0.9].into();
    let (mut image, _) = picture(vec![disk]);
    // Means over five by five pixels, three times: nearly a blur of 2.4.
    for _ in 0..3 {
        let before = image.clone();
        let at = |i: usize, by: usize| (i + by).saturating_sub(2).min(SIDE - 1);
        for (i, value) in image.data_mut().iter_mut().enumerate() {
            let (plane, y, x) = (i / (SIDE * SIDE), i / SIDE % SIDE, i % SIDE);
            let row = |y: usize| (0..5).map(|by| before.data()[(plane * SIDE + y) * SIDE + at(x, by)]).sum::<f32>();
            *value = (0..5).map(|by| row(at(y, by))).sum::<f32>() / 25.0;
        }
    }
    assert!(level(&image.view()).is_none());
}

#[test]
fn noise_hides_ramps() {
    let mut image = sheet();
    assert!(level(&image.view()).is_some());
    crate::noise::tests::add_noise(&mut image, 0.0025);
    assert!(level(&image.view()).is_none());
}

#[test]
fn what_leaps_is_rough() {
    let all = [(0..(SIDE * SIDE) as u32).collect()];
    let is_rough = |leap: f32| {
        let value =
            |x: usize, y: usize| (x as f32 + if (7 * x + 3 * y).is_multiple_of(5) { leap } else { 0.0 }) / 255.0;
        let pixels: Vec<[f32; 3]> = (0..SIDE * SIDE).map(|i| [value(i % SIDE, i / SIDE); 3]).collect();
        is_rough(&pixels, SIDE, all.iter())
    };
    // Rounding leaves half a step of each of three pixels.
    assert!(!is_rough(0.0) && !is_rough(0.9) && is_rough(1.6));
}

/// One color explains nearly all pixels: so does a ramp that hardly changes.
#[test]
fn a_spot_on_one_color_is_no_ramp() {
    let mut image = Image::from_planar(ImageSize::new(SIDE, SIDE).unwrap(), vec![0.5; 3 * SIDE * SIDE]).unwrap();
    for (i, value) in image.data_mut().iter_mut().enumerate() {
        let (x, y) = (i % SIDE, i / SIDE % SIDE);
        *value += if x >= 20 && (30..50).contains(&y) { 26_usize.saturating_sub(x) as f32 / 255.0 } else { 0.0 };
    }
    assert!(level(&image.view()).is_none());
}

#[test]
fn three_stops_are_three_stops() {
    let colors = [[0.9, 0.5, 0.1], [0.8, 0.1, 0.5], [0.2, 0.3, 0.8]];
    let kind = RampKind::Linear([[-0.4, 0.0], [0.4, 0.1]]);
    let bar = Rectangle { size: [0.8, 0.5], corner_radius: 0.1 };
    let (image, mask) = picture(vec![object(bar, [0.5, 0.5], kind, &colors)]);
    let leveled = level(&image.view()).unwrap();
    let [found] = &leveled.ramps[..] else { panic!("{} ramps", leveled.ramps.len()) };
    assert_eq!(found.ramp.stops.len(), 3);
    assert!(found.is_exact);
    assert!(missed(&image, &mask, &found.ramp) <= 0.005);
}

#[test]
fn what_shows_in_two_places_is_one_ramp() {
    let kind = RampKind::Linear([[-0.4, -0.3], [0.4, 0.3]]);
    let colors = [[0.9, 0.5, 0.1], [0.2, 0.3, 0.8]];
    let behind = object(Rectangle { size: [0.9, 0.7], corner_radius: 0.0 }, [0.5, 0.5], kind, &colors);
    let mut bar = object(Rectangle { size: [0.1, 1.0], corner_radius: 0.0 }, [0.5, 0.5], kind, &colors);
    bar.paint = [0.1; 3].into();
    let leveled = level(&picture(vec![behind, bar]).0.view()).unwrap();
    assert_eq!(leveled.ramps.len(), 1);
    let sides = [SIDE / 4, 3 * SIDE / 4].map(|column| leveled.image.view().pixel(SIDE / 2 * SIDE + column));
    assert_eq!(sides[0], sides[1]);
}

/// What is seen of a color at a place.
type Lit<'a> = &'a dyn Fn(f32, [f32; 2]) -> f32;

/// Places of a picture as shares of its side, from -1/2 to 1/2.
fn shares(i: usize) -> [f32; 2] {
    [i % SIDE, i / SIDE].map(|at| (at as f32 + 0.5) / SIDE as f32 - 0.5)
}

/// Two disks in front of a dark ground, in light that `lit` changes by the place; of one color each.
fn in_light(lit: impl Fn(f32, [f32; 2]) -> f32) -> Image<f32> {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let values: Vec<f32> = (0..size.pixels())
        .map(|i| {
            let [x, y] = shares(i);
            let share = |cx: f32, cy: f32| (SIDE as f32 * (0.15 - (x - cx).hypot(y - cy)) + 0.5).clamp(0.0, 1.0);
            let color = 0.3 + 0.4 * share(-0.2, -0.15) + 0.3 * share(0.2, 0.2);
            lit(color, [x, y])
        })
        .collect();
    let rounded = values.iter().flat_map(|value| [(value * 255.0).round() / 255.0; 3]).collect::<Vec<f32>>();
    Image::from_interleaved(size, &rounded).unwrap()
}

#[test]
fn uneven_light_is_taken_out_as_it_came() {
    let even = in_light(|color, _| color);
    let lights: [(&str, Lit); 3] = [
        ("added along a line", &|color, [x, y]| color + 0.1 * x - 0.07 * y),
        ("added about the middle", &|color, [x, y]| color - 0.25 * (x * x + y * y)),
        ("multiplied", &|color, [x, y]| color * (1.0 - 0.6 * (x * x + y * y) + 0.1 * x)),
    ];
    for (name, lit) in lights {
        let image = in_light(lit);
        let light = Light::of(&image.view(), 0.0).expect(name);
        // All of it is brighter or darker by as much, or by as many times.
        let off: Vec<f32> = light.image.data().iter().zip(even.data()).map(|(found, is)| found / is).collect();
        let mean = off.iter().sum::<f32>() / off.len() as f32;
        if name == "multiplied" {
            assert!(off.iter().all(|off| (off / mean - 1.0).abs() < 0.02), "{name}");
        } else {
            let off: Vec<f32> = light.image.data().iter().zip(even.data()).map(|(found, is)| found - is).collect();
            let mean = off.iter().sum::<f32>() / off.len() as f32;
            assert!(off.iter().all(|off| (off - mean).abs() < 2.0 / 255.0), "{name}");
        }
        for i in (0..SIDE * SIDE).step_by(7) {
            let color = light.image.view().pixel(i).map(f64::from);
            let seen = light.seen(color, [(i % SIDE) as f64 + 0.5, (i / SIDE) as f64 + 0.5]);
            assert!((seen[0] - f64::from(image.view().pixel(i)[0])).abs() < 1e-5, "{name}");
            // The ramp is near to what is seen of the ground.
            if (even.view().pixel(i)[0] - 0.3).abs() < 0.01 {
                let [x, y] = shares(i).map(|at| at + 0.5);
                let painted = light.ramp.color_at(light.ramp.kind.offset([x, y]))[0];
                assert!((painted - image.view().pixel(i)[0]).abs() < 3.0 / 255.0, "{name}: {painted}");
            }
        }
    }
}

#[test]
fn things_in_front_of_a_ramp_are_in_no_uneven_light() {
    let ramp = |[x, y]: [f32; 2]| 0.1 * x - 0.07 * y;
    let even = in_light(|color, _| color);
    assert!(Light::of(&even.view(), 0.0).is_none(), "it is even");
    // The ground changes, and they do not.
    let front = in_light(|color, at| if color > 0.35 { color } else { color + ramp(at) });
    assert!(Light::of(&front.view(), 0.0).is_none());
    // Most of the picture shows no surface of second degree.
    let waves = in_light(|color, [x, y]| color + 0.1 * (20.0 * x).sin() * (20.0 * y).cos());
    assert!(Light::of(&waves.view(), 0.0).is_none());
}
