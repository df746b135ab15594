//! What lies behind other objects: how well it is guessed, and that it is said to be a guess.

use dvp_core::contour::contains;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, Image, Real};
use dvp_fit::picture::{Known, PictureScratch, fit_picture};
use dvp_fit::{Ambiguity, Completion, Fit, FitOptions, Fitter, fit_image};
use dvp_tests::draw_svg::draw_svg;

/// Side of the pictures, px.
const SIDE: usize = 192;
/// Color of the object that is partly hidden.
const BEHIND: [f64; 3] = [0.8, 0.2, 0.2];

/// A corner every `turn / corners`, at the radii given in turn, px.
fn corners(corners: u32, radii: [f64; 2], angle: f64) -> Vec<[f64; 2]> {
    let corner = |i: u32| {
        let at = angle + core::f64::consts::TAU * f64::from(i) / f64::from(corners);
        let radius = radii[usize::from(i % 2 == 1)];
        [90.0 + radius * at.cos(), 96.0 + radius * at.sin()]
    };
    (0..corners).map(corner).collect()
}

fn polygon(points: &[[f64; 2]]) -> String {
    let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.3},{y:.3}")).collect();
    format!(r#"<polygon points="{}" fill="rgb(204,51,51)"/>"#, points.join(" "))
}

fn shape(name: &str, angle: f64) -> String {
    match name {
        "disk" => r#"<circle cx="90" cy="96" r="44" fill="rgb(204,51,51)"/>"#.to_owned(),
        "ellipse" => format!(
            r#"<ellipse cx="90" cy="96" rx="52" ry="34" fill="rgb(204,51,51)" transform="rotate({} 90 96)"/>"#,
            angle.to_degrees()
        ),
        "triangle" => polygon(&corners(3, [52.0; 2], angle)),
        "square" => polygon(&corners(4, [52.0; 2], angle)),
        "pentagon" => polygon(&corners(5, [50.0; 2], angle)),
        "hexagon" => polygon(&corners(6, [50.0; 2], angle)),
        "octagon" => polygon(&corners(8, [48.0; 2], angle)),
        "star" => polygon(&corners(10, [56.0, 26.0], angle)),
        "star of 6" => polygon(&corners(12, [56.0, 32.0], angle)),
        "rectangle" => {
            let (sin, cos) = angle.sin_cos();
            let at = |x: f64, y: f64| [90.0 + x * cos - y * sin, 96.0 + x * sin + y * cos];
            polygon(&[at(-56.0, -30.0), at(56.0, -30.0), at(56.0, 30.0), at(-56.0, 30.0)])
        }
        "heart" => format!(
            concat!(
                r#"<path transform="rotate({} 90 96)" fill="rgb(204,51,51)" "#,
                r#"d="M90 140 C40 105 44 60 70 60 C82 60 90 70 90 78 C90 70 98 60 110 60 C136 60 140 105 90 140 Z"/>"#
            ),
            angle.to_degrees()
        ),
        // No symmetry at all.
        _ => polygon(&[[40.0, 80.0], [75.0, 50.0], [128.0, 66.0], [140.0, 120.0], [100.0, 116.0], [66.0, 148.0]]),
    }
}

/// With the least mean IoU of what is hidden, as drawings are completed: a little less than what was
/// measured. Where half of a square or a rectangle is hidden, the half that is seen is a shorter description.
const SHAPES: [(&str, f64); 12] = [
    ("disk", 0.98),
    ("ellipse", 0.98),
    ("triangle", 0.7),
    ("square", 0.5),
    ("rectangle", 0.38),
    ("pentagon", 0.78),
    ("hexagon", 0.98),
    ("octagon", 0.98),
    ("star", 0.94),
    ("star of 6", 0.98),
    ("heart", 0.41),
    ("oblique", 0.51),
];

/// Covers, from a narrow bar to more than half of the shape.
fn cover(index: usize) -> String {
    let color = r#"fill="rgb(40,80,160)""#;
    match index {
        0 => format!(r#"<rect x="112" y="30" width="60" height="140" {color}/>"#),
        1 => format!(r#"<rect x="80" y="20" width="16" height="150" {color}/>"#),
        2 => format!(r#"<circle cx="126" cy="70" r="36" {color}/>"#),
        3 => format!(r#"<rect x="90" y="24" width="80" height="150" {color}/>"#),
        _ => format!(r#"<rect x="20" y="96" width="150" height="70" rx="8" {color}/>"#),
    }
}
const COVERS: usize = 5;
const ANGLES: [f64; 3] = [0.1, 0.37, 0.8];

fn draw(shape: &str, cover: &str) -> dvp_core::Image<f64> {
    draw_svg(&format!(
        concat!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{0}">"#,
            r#"<rect width="{0}" height="{0}" fill="rgb(236,236,228)"/>{1}{2}</svg>"#
        ),
        SIDE, shape, cover
    ))
    .unwrap()
}

fn is_red(image: &dvp_core::Image<f64>, at: usize) -> bool {
    let view = image.view();
    view.channel(0)[at] > 0.5 && view.channel(1)[at] < 0.55
}

fn is_blue(image: &dvp_core::Image<f64>, at: usize) -> bool {
    image.view().channel(0)[at] < 0.5
}

/// How well what is hidden of the object behind is guessed.
struct Guess {
    /// Pixels behind the cover that shape and guess share, and those that either has.
    both: usize,
    either: usize,
}

impl Guess {
    fn iou(&self) -> f64 {
        f64::of_usize(self.both) / f64::of_usize(self.either.max(1))
    }
}

/// The one object of the color of the one behind; none if there are several.
fn behind<T: Real>(fit: &Fit<T>) -> Option<usize> {
    let is_behind = |color: [T; 3]| (0..3).all(|c| (color[c].as_f64() - BEHIND[c]).abs() < 0.05);
    let mut behind = (0..fit.scene.objects.len()).filter(|&k| is_behind(fit.scene.objects[k].color()));
    behind.next().filter(|_| behind.next().is_none())
}

fn guess(shape: &str, cover: &str) -> Option<Guess> {
    let (whole, image) = (draw(shape, ""), draw(shape, cover));
    let mut single = Image::<f32>::zeros(image.size());
    single.data_mut().iter_mut().zip(image.view().data()).for_each(|(to, &from)| *to = f32::of(from));
    let fitter = Fitter::new(FitOptions::default()).unwrap();
    let fit = fit_picture(&fitter, single.view(), &Known::default(), &mut PictureScratch::default()).unwrap();
    let object = behind(&fit)?;
    let mut drawing = Drawing::default();
    fit.scene.draw(&OutlineBasis::new(REFERENCE_VERTICES, 31).unwrap(), &mut drawing).unwrap();
    let extent = f32::of_usize(SIDE);
    let (mut both, mut either) = (0, 0);
    for at in (0..SIDE * SIDE).filter(|&at| is_blue(&image, at)) {
        let point = [(f32::of_usize(at % SIDE) + 0.5) / extent, (f32::of_usize(at / SIDE) + 0.5) / extent];
        let (truth, found) = (is_red(&whole, at), contains(drawing.outline(object), point));
        both += usize::from(truth && found);
        either += usize::from(truth || found);
    }
    Some(Guess { both, either })
}

/// The edge of the square runs through the center of the disk.
const SQUARE: &str = r#"<rect x="90" y="40" width="90" height="90" fill="rgb(40,80,160)"/>"#;
const DISK: &str = r#"<circle cx="90" cy="85" r="40" fill="rgb(204,51,51)"/>"#;

#[test]
fn half_a_disk_behind_a_square_is_completed() {
    let guess = guess(DISK, SQUARE).unwrap();
    assert!(guess.iou() > 0.97, "{}", guess.iou());
}

#[test]
fn hidden_parts_are_completed() {
    for (name, least) in SHAPES {
        let places = (0..COVERS).flat_map(|index| ANGLES.map(|angle| (index, angle)));
        let guesses: Vec<f64> = places
            .map(|(index, angle)| guess(&shape(name, angle), &cover(index)).map_or(0.0, |guess| guess.iou()))
            .collect();
        let mean = guesses.iter().sum::<f64>() / guesses.len() as f64;
        eprintln!("{name:10} {mean:.3} {guesses:.2?}");
        assert!(mean >= least, "{name}: {mean:.3} {guesses:.2?}");
    }
}

#[test]
fn what_a_segment_hides_is_said_to_be_a_guess() {
    let fit: Fit<f64> = fit_image(draw(DISK, SQUARE).view(), &FitOptions::default()).unwrap();
    let object = behind(&fit).unwrap();
    let stated = fit.ambiguity.iter().find_map(|ambiguity| match *ambiguity {
        Ambiguity::Hidden { object: at, share, completion } if at == object => Some((share, completion)),
        _ => None,
    });
    let (share, completion) = stated.unwrap();
    // An ellipse goes on as it must.
    assert_eq!(completion, Completion::Rotation { order: 0 });
    assert!((share - 0.5).abs() < 0.02, "{share}");
}

/// A large disk, a small one on it of nearly the color of the background, a square beside, a faint dot.
const NESTED: &str = concat!(
    r#"<svg xmlns="http://www.w3.org/2000/svg" width="128" height="128">"#,
    r##"<rect width="128" height="128" fill="#f0f0f0"/><circle cx="50" cy="60" r="36" fill="#202020"/>"##,
    r##"<circle cx="50" cy="60" r="14" fill="#e0e8f0"/><rect x="96" y="20" width="20" height="20" fill="#c04040"/>"##,
    r##"<circle cx="106" cy="100" r="6" fill="#d8d8e8"/></svg>"##
);

#[test]
fn each_object_states_its_marginal_gain() {
    let image = draw_svg(NESTED).unwrap();
    let fit = fit_image(image.view(), &FitOptions::default()).unwrap();
    assert_eq!((fit.scene.objects.len(), fit.marginal_gain.len()), (4, 4));
    // Without an object its pixels show what is behind it: count times squared difference, over the variance.
    let view = image.view();
    let pixels = f64::of_usize(view.size().pixels());
    let variance: f64 = (0..3)
        .map(|c| {
            let mean = view.channel(c).iter().sum::<f64>() / pixels;
            view.channel(c).iter().map(|v| (v - mean) * (v - mean)).sum::<f64>()
        })
        .sum();
    let area = |radius: f64| core::f64::consts::PI * radius * radius;
    let contrast = |a: [u8; 3], b: [u8; 3]| -> f64 {
        (0..3).map(|c| (f64::from(a[c]) - f64::from(b[c])) / 255.0).map(|v| v * v).sum()
    };
    let (ground, dark, light) = ([0xf0; 3], [0x20; 3], [0xe0, 0xe8, 0xf0]);
    // Without the large disk the small one still stands.
    let expected = [
        (dark, (area(36.0) - area(14.0)) * contrast(dark, ground)),
        (light, area(14.0) * contrast(light, dark)),
        ([0xc0, 0x40, 0x40], 400.0 * contrast([0xc0, 0x40, 0x40], ground)),
        ([0xd8, 0xd8, 0xe8], area(6.0) * contrast([0xd8, 0xd8, 0xe8], ground)),
    ];
    let ranking = fit.ranking();
    for (&object, (color, squares)) in ranking.iter().zip(expected) {
        let found = fit.scene.objects[object].color().map(|v| v * 255.0);
        assert!((0..3).all(|c| (found[c] - f64::from(color[c])).abs() < 4.0), "{found:?} in place of {color:?}");
        let (gain, expected) = (fit.marginal_gain[object], squares / variance);
        // Pixels at the rim count in whole or not at all: the smaller the object, the more of it is rim.
        assert!((gain / expected - 1.0).abs() < 0.08, "{gain} in place of {expected}");
    }
}

#[test]
fn too_many_objects_are_cut_to_those_of_the_largest_marginal_gain() {
    let image = draw_svg(NESTED).unwrap();
    let mut left = 1.0;
    for max_objects in 1..=4 {
        let fit = fit_image(image.view(), &FitOptions::default().with_max_objects(max_objects)).unwrap();
        assert_eq!(fit.scene.objects.len(), max_objects);
        // Each one more leaves less; the light disk, which is no contrast to the background, comes second.
        assert!(fit.unexplained < left, "{} of {left}", fit.unexplained);
        left = fit.unexplained;
        let is_light = |color: [f64; 3]| color.iter().all(|&v| v > 0.86);
        assert_eq!(fit.scene.objects.iter().any(|object| is_light(object.color())), max_objects > 1);
    }
    assert!(left < 1e-3, "{left}");
}
