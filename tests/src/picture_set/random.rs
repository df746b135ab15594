//! Families of random pictures: crowds, MDS-HR, twins, cropped objects. From seeds.

use core::f64::consts::TAU;

use dvp::format::mdshr_bank;
use dvp::generate::{SceneSettings, sample_scene};
use dvp::paint::{Painter, RendererName};
use dvp_core::{Image, ImageSize, Object, Pose, Real, Scene};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Side of MDS-HR images.
const SIDE: usize = 128;

/// Draws before the best of them is taken.
const DRAWS: usize = 10_000;

type Failure = Box<dyn core::error::Error>;

/// A picture of `count` separate disks and squares of up to 12 colors, as SVG.
#[must_use]
pub fn crowd(side: u32, count: usize, seed: u64) -> String {
    const COLORS: [&str; 12] = [
        "#d1495b", "#edae49", "#66a182", "#2e4057", "#8d96a3", "#00798c", "#f4a261", "#7b2cbf", "#386641", "#bc4749",
        "#1d3557", "#e76f51",
    ];
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{side}\" height=\"{side}\">\n\
         <rect width=\"{side}\" height=\"{side}\" fill=\"#f7f4ea\"/>\n"
    );
    // Half of the area at most is taken by circles around the objects, so that free places are found.
    let largest = (f64::from(side).powi(2) / (f64::of_usize(count) * TAU)).sqrt();
    let mut placed: Vec<[f64; 3]> = Vec::new();
    for _ in 0..DRAWS * 10 {
        if placed.len() == count {
            break;
        }
        let radius = largest * rng.random_range(0.5..0.9);
        let [x, y] = [0, 1].map(|_| rng.random_range(radius + 1.0..f64::from(side) - radius - 1.0));
        if placed.iter().any(|[a, b, other]| (x - a).hypot(y - b) < radius + other + 2.5) {
            continue;
        }
        let color = COLORS[rng.random_range(0..COLORS.len())];
        let id = placed.len() + 1;
        text.push_str(&match rng.random_range(0..3) {
            0 => {
                let (half, turn) = (radius / 2.0_f64.sqrt(), rng.random_range(0.0..90.0));
                format!(
                    "<rect id=\"o{id}\" x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{color}\" \
                     transform=\"rotate({turn:.1} {x:.2} {y:.2})\"/>\n",
                    x - half,
                    y - half,
                    2.0 * half,
                    2.0 * half
                )
            }
            _ => format!("<circle id=\"o{id}\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{radius:.2}\" fill=\"{color}\"/>\n"),
        });
        placed.push([x, y, radius]);
    }
    text.push_str("</svg>\n");
    text
}

/// Scene `index` of MDS-HR as it is generated.
#[must_use]
pub fn mds_hr(seed: u64, index: u64) -> Scene<f32> {
    let size = ImageSize::new(SIDE, SIDE).ok();
    let settings = SceneSettings::mds_hr();
    size.map_or_else(|| Scene::empty([0.0; 3]), |size| sample_scene(&settings, &mdshr_bank(), size, seed, index))
}

/// The image of an MDS-HR scene, seams and all.
///
/// # Errors
/// The renderer's.
pub fn paint_mds_hr(scene: &Scene<f32>) -> Result<Image<f32>, Failure> {
    let painter = Painter::from(RendererName::Triangles);
    Ok(painter.paint(scene, ImageSize::new(SIDE, SIDE)?)?)
}

/// A color at least 0.3 away from `other` in some channel.
fn contrasting(rng: &mut ChaCha8Rng, other: [f32; 3]) -> [f32; 3] {
    loop {
        let color: [f32; 3] = rng.random();
        if color.iter().zip(other).any(|(a, b)| (a - b).abs() > 0.3) {
            return color;
        }
    }
}

fn object(rng: &mut ChaCha8Rng, background: [f32; 3], scale: f32) -> Object<f32> {
    let bank = mdshr_bank();
    let prototype = rng.random_range(0..bank.prototypes.len());
    let pose = Pose { translation: [0.5; 2], scale, rotation: rng.random_range(0.0..core::f32::consts::TAU) };
    let color = contrasting(rng, background);
    Object::of_efd(pose, color, 1.0, bank.prototypes[prototype].1.clone(), Some(prototype))
}

/// Two objects of one shape and color, of scale 0.1, their centers `gap` apart: their outlines are one.
#[must_use]
pub fn twins(gap: f32, seed: u64) -> Scene<f32> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let background = rng.random();
    let mut first = object(&mut rng, background, 0.1);
    let mut second = first.clone();
    second.pose.rotation = rng.random_range(0.0..core::f32::consts::TAU);
    let direction = rng.random_range(0.0..core::f32::consts::TAU);
    first.pose.translation = [0, 1].map(|_| rng.random_range(0.3..0.7));
    let [x, y] = first.pose.translation;
    second.pose.translation = [x + gap * direction.cos(), y + gap * direction.sin()];
    Scene { objects: vec![first, second], ..Scene::empty(background) }
}

/// One object of which 30 to 70 % of the area lie outside of the image.
///
/// # Errors
/// The renderer's.
pub fn cropped(seed: u64) -> Result<Scene<f32>, Failure> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let background = rng.random();
    let scale = rng.random_range(0.15..0.3);
    let mut scene = Scene { objects: vec![object(&mut rng, background, scale)], ..Scene::empty(background) };
    let painter = Painter::from(RendererName::Hard);
    let size = ImageSize::new(SIDE, SIDE)?;
    let visible = |scene: &Scene<f32>| -> Result<usize, Failure> {
        let image = painter.paint(scene, size)?;
        let view = image.view();
        let seen = (0..size.pixels())
            .filter(|&i| view.pixel(i).iter().zip(background).any(|(a, b): (&f32, _)| (a - b).abs() > 0.1));
        Ok(seen.count())
    };
    let whole = f64::of_usize(visible(&scene)?);
    for _ in 0..DRAWS {
        scene.objects[0].pose.translation = [0, 1].map(|_| rng.random_range(-0.2..1.2));
        if (0.3..=0.7).contains(&(f64::of_usize(visible(&scene)?) / whole)) {
            return Ok(scene);
        }
    }
    Err("no such place was drawn".into())
}
