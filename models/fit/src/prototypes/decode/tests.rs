use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::mdshr_bank;
use dvp_core::{Efd, Image, ImageSize, Object, Pose, Real, Scene};

use super::{Decoded, Decoder, Undecoded};
use crate::paint::Canvas;
use crate::prototypes::Pool;
use crate::{Ambiguity, Bank, Completion};

fn bank() -> Bank<f32> {
    let names = ["heart", "square", "ellipse"].map(ToString::to_string);
    Bank { prototypes: names.into_iter().zip(mdshr_bank(31).prototypes().iter().cloned()).collect() }
}

/// An object of the bank: its shape, place and size in px, angle and color.
type Placed = (usize, [f32; 2], f32, f32, [f32; 3]);

/// A picture of 64 x 64 pixels with hard edges, rounded to 8 bits as files are.
fn picture(bank: &Bank<f32>, objects: &[Placed]) -> Image<f32> {
    let object = |&(k, [x, y], scale, rotation, color): &Placed| {
        let pose = Pose { translation: [x / 64.0, y / 64.0], scale: scale / 64.0, rotation };
        Object::of_efd(pose, color, 1.0, bank.prototypes[k].1.clone(), Some(k))
    };
    let scene = Scene {
        background: [0.1, 0.2, 0.3],
        transparent: false,
        objects: objects.iter().map(object).collect(),
        edge: EdgeProfile { offset: 0.0, sigma: 1e-11, cut: 5.21e-11, ..EdgeProfile::reference() },
        compositing: Compositing::Over,
    };
    let size = ImageSize::new(64, 64).unwrap();
    let mut image = Canvas::default().paint(&scene, size).unwrap().0.clone();
    image.data_mut().iter_mut().for_each(|v| *v = num_traits::Float::round(*v * 255.0) / 255.0);
    image
}

/// Pixels that a scene paints in another color.
fn wrong(scene: &Scene<f32>, image: &Image<f32>) -> usize {
    let mut canvas = Canvas::default();
    let (painted, _) = canvas.paint(scene, image.size()).unwrap();
    let differs = |&i: &usize| (0..3).any(|c| (painted.view().pixel(i)[c] - image.view().pixel(i)[c]).abs() > 0.02);
    (0..image.size().pixels()).filter(differs).count()
}

const RED: [f32; 3] = [0.9, 0.1, 0.1];
const GREEN: [f32; 3] = [0.1, 0.8, 0.2];
const BLUE: [f32; 3] = [0.2, 0.3, 0.9];

#[test]
fn objects_that_hide_one_another_are_found_whole_and_in_order() {
    let placed: [Placed; 3] =
        [(0, [20.0, 22.0], 11.0, 0.4, RED), (1, [29.0, 27.0], 9.0, 1.0, GREEN), (2, [47.0, 46.0], 12.0, 2.0, BLUE)];
    let image = picture(&bank(), &placed);
    let Decoded { scene, ambiguity } = Decoder::new(&bank()).unwrap().decode(&image.view()).unwrap();
    assert!(wrong(&scene, &image) <= 2);
    assert_eq!(scene.objects.len(), 3);
    // A heart has one angle, a square four, an ellipse two; the heart is hidden in part.
    let orders = |k| {
        ambiguity.iter().find_map(|open| match *open {
            Ambiguity::Symmetry { object, order } if scene.objects[object].prototype() == Some(k) => Some(order),
            _ => None,
        })
    };
    assert_eq!([0, 1, 2].map(orders), [None, Some(4), Some(2)]);
    let hidden: Vec<_> = ambiguity
        .iter()
        .filter_map(|open| match *open {
            Ambiguity::Hidden { object, share, completion: Completion::Prototype } => {
                Some((scene.objects[object].prototype(), (0.05..0.5).contains(&share)))
            }
            _ => None,
        })
        .collect();
    assert_eq!(hidden, [(Some(0), true)]);
    let at =
        |color: [f32; 3]| scene.objects.iter().position(|o| (0..3).all(|c| (o.color()[c] - color[c]).abs() < 0.01));
    let (heart, square) = (at(RED).unwrap(), at(GREEN).unwrap());
    assert!(heart < square, "the heart lies behind");
    for (k, [x, y], scale, _, color) in placed {
        let object = &scene.objects[at(color).unwrap()];
        assert_eq!(object.prototype(), Some(k));
        let Pose { translation: [u, v], scale: own, .. } = object.pose;
        let off = [u * 64.0 - x, v * 64.0 - y, own * 64.0 - scale];
        // Pixels tell a place to some tenths of a pixel; what is hidden to more.
        assert!(off.iter().all(|off| off.abs() < 0.6), "{k}: {off:?}");
    }
}

#[test]
fn parts_that_something_hides_between_are_one_object() {
    // A square across an ellipse: two tips of one color.
    let image = picture(&bank(), &[(2, [32.0, 30.0], 25.0, 0.0, RED), (1, [32.0, 30.0], 16.0, 0.1, GREEN)]);
    let scene = Decoder::new(&bank()).unwrap().decode(&image.view()).unwrap().scene;
    let prototypes: Vec<_> = scene.objects.iter().map(Object::prototype).collect();
    assert_eq!(prototypes, [Some(2), Some(1)]);
    assert!(wrong(&scene, &image) <= 2);
}

/// A shape of cells, 5 px each, as it stands.
fn cells(cells: &[[f64; 2]]) -> Efd<f32> {
    Efd::from_contour(cells, 31).unwrap().0.cast()
}

/// A bank of three tetrominoes, two of them one shape turned.
fn pieces() -> Bank<f32> {
    let bar = cells(&[[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]]);
    let upright = cells(&[[0.0, 0.0], [1.0, 0.0], [1.0, 4.0], [0.0, 4.0]]);
    let block = cells(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
    Bank { prototypes: vec![("lying".into(), bar), ("standing".into(), upright), ("block".into(), block)] }
}

/// Rectangles of pixels (left, top, right, bottom) in color on black.
fn rectangles(rectangles: &[([usize; 4], [f32; 3])]) -> Image<f32> {
    let size = ImageSize::new(35, 35).unwrap();
    let mut image = Image::zeros(size);
    for &([left, top, right, bottom], color) in rectangles {
        for pixel in (top..bottom).flat_map(|row| (left..right).map(move |column| 35 * row + column)) {
            for (c, value) in color.into_iter().enumerate() {
                image.data_mut()[c * size.pixels() + pixel] = value;
            }
        }
    }
    image
}

#[test]
fn what_has_run_together_is_taken_apart_and_not_turned() {
    let red = [1.0, 0.0, 0.0];
    // A block below a lying bar, one color; a standing bar apart.
    let image = rectangles(&[([3, 4, 23, 9], red), ([6, 9, 16, 19], red), ([29, 10, 34, 30], [0.0, 1.0, 1.0])]);
    let scene = Decoder::new(&pieces()).unwrap().decode(&image.view()).unwrap().scene;
    assert_eq!(wrong(&scene, &image), 0);
    let mut found: Vec<_> = scene.objects.iter().filter_map(Object::prototype).collect();
    found.sort_unstable();
    assert_eq!(found, [0, 1, 2]);
    let turned = |object: &Object<f32>| {
        // A block looks alike after a quarter of a turn.
        let quarter = core::f32::consts::FRAC_PI_2;
        let period = if object.prototype() == Some(2) { quarter } else { 2.0 * quarter };
        (object.pose.rotation - period * num_traits::Float::round(object.pose.rotation / period)).abs()
    };
    assert!(scene.objects.iter().all(|object| turned(object) < 0.1));
}

#[test]
fn what_is_no_such_picture_is_refused() {
    let decoder = Decoder::new(&bank()).unwrap();
    let size = ImageSize::new(32, 32).unwrap();
    let ramp: Vec<f32> = (0..3 * 32 * 32).map(|i| f32::of(f64::of_usize(i % 997) / 997.0)).collect();
    let ramp = Image::from_planar(size, ramp).unwrap();
    assert_eq!(decoder.decode(&ramp.view()), Err(Undecoded::NotFlat));
    assert!(decoder.whole_objects(&ramp.view()).is_empty());
    // A long bar is none of heart, square and ellipse.
    let image = rectangles(&[([2, 15, 33, 18], RED)]);
    assert_eq!(decoder.decode(&image.view()), Err(Undecoded::Unexplained));
    // Nothing but ground.
    assert!(decoder.decode(&Image::zeros(size).view()).unwrap().scene.objects.is_empty());
}

#[test]
fn whole_objects_make_a_shape_better() {
    let truth = bank();
    // Hearts whose notch and tip are rounded.
    let blunt = Efd::new(truth.prototypes[0].1.rows()[..4].to_vec());
    let mut learned = truth.clone();
    learned.prototypes[0].1 = blunt;
    let images: Vec<Image<f32>> = (0..24)
        .map(|i| {
            let t = f32::of(f64::of_usize(i));
            let angle = t * 0.7;
            picture(
                &truth,
                &[(0, [20.0 + 0.37 * t, 30.0], 11.0, angle, RED), (1, [48.0, 50.0 - 0.31 * t], 7.0, angle, BLUE)],
            )
        })
        .collect();
    let share = |bank: &Bank<f32>| {
        let decoder = Decoder::new(bank).unwrap();
        let mut pool = Pool::new(bank).unwrap();
        let (mut wrong, mut pixels) = (0, 0);
        for object in images.iter().flat_map(|image| decoder.whole_objects(&image.view())) {
            if object.prototype == 0 {
                (wrong, pixels) = (wrong + object.wrong, pixels + object.pixels);
            }
            pool.add_whole(&object);
        }
        assert!(pixels > 3000, "{pixels}");
        (f64::of_usize(wrong) / f64::of_usize(pixels), pool.bank().unwrap())
    };
    let (before, better) = share(&learned);
    let (after, _) = share(&better);
    assert!(after < 0.3 * before && after < 0.01, "{before} {after}");
}

#[test]
fn small_objects_with_soft_edges_have_few_colors_too() {
    let mut scene = Scene::empty([0.1, 0.2, 0.3]);
    let pose = Pose { translation: [0.48, 0.53], scale: 0.14, rotation: 0.3 };
    scene.objects.push(Object::of_efd(pose, RED, 1.0, bank().prototypes[2].1.clone(), Some(2)));
    let image = Canvas::default().paint(&scene, ImageSize::new(32, 32).unwrap()).unwrap().0.clone();
    let mut colors: Vec<[f32; 3]> =
        (0..32 * 32).map(|i| image.view().pixel(i).map(|v| num_traits::Float::round(v * 255.0) / 255.0)).collect();
    let image = Image::from_interleaved(image.size(), colors.as_flattened()).unwrap();
    colors.sort_unstable_by(|a, b| a.partial_cmp(b).unwrap());
    colors.dedup();
    assert!((5..=24).contains(&colors.len()), "{}", colors.len());
    assert_eq!(Decoder::new(&bank()).unwrap().decode(&image.view()).map(|_| ()), Err(Undecoded::NotFlat));
}

#[test]
fn soft_edges_of_few_colors_are_soft() {
    // Eleven steps of 8 bits from one color to the other: taken for eleven things, each would be looked for in vain.
    for side in [128, 192, 384] {
        let pose = Pose { translation: [0.45, 0.6], scale: 0.2, rotation: 0.4 };
        let color = [0.464, 0.154, 0.542];
        let scene = Scene {
            background: [0.508, 0.179, 0.541],
            transparent: false,
            objects: vec![Object::of_efd(pose, color, 1.0, bank().prototypes[2].1.clone(), Some(2))],
            edge: EdgeProfile::reference(),
            compositing: Compositing::Over,
        };
        let mut image = Canvas::default().paint(&scene, ImageSize::new(side, side).unwrap()).unwrap().0.clone();
        image.data_mut().iter_mut().for_each(|v| *v = num_traits::Float::round(*v * 255.0) / 255.0);
        assert_eq!(Decoder::new(&bank()).unwrap().decode(&image.view()).unwrap_err(), Undecoded::NotFlat, "{side} px");
    }
}

#[test]
fn pixels_do_not_make_a_right_shape_worse() {
    let truth = bank();
    let images: Vec<Image<f32>> = (0..40)
        .map(|i| {
            let t = f32::of(f64::of_usize(i));
            picture(&truth, &[(1, [21.0 + 0.27 * t, 34.0 - 0.13 * t], 11.0 + 0.1 * t, 0.7 * t, RED)])
        })
        .collect();
    let wrong = |bank: &Bank<f32>| {
        let decoder = Decoder::new(bank).unwrap();
        let mut pool = Pool::new(bank).unwrap();
        let mut wrong = 0;
        for object in images.iter().flat_map(|image| decoder.whole_objects(&image.view())) {
            wrong += object.wrong;
            pool.add_whole(&object);
        }
        (wrong, pool.bank().unwrap())
    };
    let (before, again) = wrong(&truth);
    let (after, _) = wrong(&again);
    // Of 2,000 pixels along outlines; edges half-way between pixels, which cut corners, made it four times as many.
    assert!(before > 0 && after <= 2 * before, "{before} {after}");
}
