//! The decision between the two fits, and openings: on pictures whose scenes are known.

#![expect(clippy::float_cmp, reason = "colors exact by construction")]

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{AnyShape, Cap, Circle, Join, PathRing, Rectangle, Stroke};
use dvp_core::{Efd, Image, ImageSize, Object, Pose, Scene};

use proptest::prelude::*;

use super::likelier::likeliest;
use super::*;

const SIDE: usize = 48;

/// A picture of 48 x 48 pixels whose color at (column, row) is said.
fn picture(color: impl Fn(usize, usize) -> [f32; 3]) -> Image<f32> {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let pixels: Vec<f32> = (0..size.pixels()).flat_map(|i| color(i % SIDE, i / SIDE)).collect();
    Image::from_interleaved(size, &pixels).unwrap()
}

fn fit(image: &Image<f32>, known: &Known, options: FitOptions<f32>) -> Fit<f32> {
    let fitter = Fitter::new(options).unwrap();
    fit_picture(&fitter, image.view(), known, &mut PictureScratch::default()).unwrap()
}

fn in_square(least: usize, most: usize) -> impl Fn(usize, usize) -> bool {
    move |column, row| [column, row].iter().all(|at| (least..most).contains(at))
}

#[test]
fn edges_of_the_renderer_do_not_speak_for_more_things_that_are_farther() {
    let square = in_square(12, 36);
    let image = picture(|column, row| if square(column, row) { [0.1, 0.2, 0.6] } else { [1.0; 3] });
    let drawn = Fit { loss: 0.003, ..fit(&image, &Known::default(), FitOptions::default()) };
    let with_edges = FitOptions::default().with_edge(Some(EdgeProfile::reference()));
    let segments = Fitter::new(with_edges).unwrap().fit(image.view(), &mut FitScratch::default()).unwrap();
    let segments = Fit { loss: 0.005, ..segments };
    assert_eq!(segments.scene.edge.law, EdgeLaw::SquaredDistance);
    assert_eq!(likeliest(segments.clone(), drawn.clone(), CLEARLY_WORSE).scene, segments.scene);
    let mut more = segments;
    more.scene.objects.extend(more.scene.objects.clone());
    assert_eq!(likeliest(more.clone(), drawn.clone(), CLEARLY_WORSE).scene, drawn.scene);
    more.loss = 0.002;
    assert_eq!(likeliest(more.clone(), drawn, CLEARLY_WORSE).scene, more.scene);
}

#[test]
fn clear_edges_make_a_drawing_and_what_is_known_beforehand_segments() {
    let square = in_square(12, 36);
    let image = picture(|column, row| if square(column, row) { [0.1, 0.2, 0.6] } else { [1.0; 3] });
    let drawn = fit(&image, &Known::default(), FitOptions::default());
    // A drawing says what an object is: a rectangle of 24 x 24 pixels, not descriptors.
    let [object] = &drawn.scene.objects[..] else { panic!("{:?}", drawn.scene) };
    assert!(object.shape.efd().is_none(), "{object:?}");
    assert!(drawn.loss < 1e-5, "{}", drawn.loss);
    let options = FitOptions::default().with_compositing(Some(Compositing::Over));
    let known = fit(&image, &Known::default(), options.clone());
    let segments = Fitter::new(options).unwrap().fit(image.view(), &mut FitScratch::default()).unwrap();
    assert_eq!(known.scene, segments.scene);
}

#[test]
fn soft_edges_make_segments() {
    // Edges as soft as the reference paints them.
    let pose = Pose { translation: [0.45, 0.5], scale: 0.3, rotation: 0.2 };
    let ellipse = Efd::new(vec![[1.0, 0.0, 0.0, -0.6]]);
    let mut scene = Scene::empty([0.9, 0.9, 0.8]);
    scene.objects.push(Object::of_efd(pose, [0.1, 0.4, 0.2], 1.0, ellipse, None));
    let mut canvas = Canvas::default();
    let image = canvas.paint(&scene, ImageSize::new(SIDE, SIDE).unwrap()).unwrap().0;
    let doubt = dvp_trace::trace(&image.view(), &Known::default()).map(|traced| traced.stained);
    assert!(doubt.is_err() || doubt.is_ok_and(|stained| stained > dvp_trace::tuning::DOUBTFUL_STAINED));
    let soft = fit(image, &Known::default(), FitOptions::default());
    let segments = crate::fit_image(image.view(), &FitOptions::default()).unwrap();
    assert_eq!(soft.scene, segments.scene);
}

#[test]
fn what_shows_the_matte_is_an_opening() {
    // A frame, 8 pixels wide, on nothing; the matte is magenta.
    let matte = [1.0, 0.0, 1.0];
    let (outer, inner) = (in_square(8, 40), in_square(16, 32));
    let image = picture(|column, row| if outer(column, row) && !inner(column, row) { [0.0, 0.4, 0.2] } else { matte });
    let known = Known::default().with_matte(Some(matte));
    let frame = fit(&image, &known, FitOptions::default());
    assert!(frame.scene.transparent);
    let is_matte = |object: &Object<f32>| object.color()[0] > 0.5;
    assert!(!frame.scene.objects.iter().any(is_matte), "{:?}", frame.scene);
    let rgba = Canvas::default().paint_rgba(&frame.scene, image.size()).unwrap();
    let alpha = |column: usize, row: usize| rgba.data()[3 * SIDE * SIDE + row * SIDE + column];
    assert!(alpha(24, 24) < 1e-3 && alpha(12, 24) > 0.999 && alpha(2, 2) < 1e-3);
    // The same by hand: a square with a square of the matte on it.
    let scene = {
        let opaque = fit(&image, &Known::default(), FitOptions::default());
        cut_openings(opaque, image.view(), matte, &mut Canvas::default()).unwrap().scene
    };
    assert!(scene.transparent && !scene.objects.iter().any(is_matte), "{scene:?}");
}

#[test]
fn a_picture_of_one_color_over_a_matte_is_a_sheet() {
    let image = picture(|_, _| [0.0, 2.0 / 3.0, 0.0]);
    for coded in [false, true] {
        let known = Known::default().with_matte(Some([1.0; 3])).with_coded(coded);
        let found = fit(&image, &known, FitOptions::default());
        assert_eq!((found.scene.objects.len(), found.scene.transparent), (1, true));
        assert!(found.loss < 1e-3 && found.bits.is_finite(), "{} {}", found.loss, found.bits);
    }
}

#[test]
fn a_picture_with_openings_has_a_description_length() {
    let hole = in_square(18, 30);
    let image = picture(|column, row| if hole(column, row) { [1.0; 3] } else { [0.1, 0.2, 0.6] });
    let cut = fit(&image, &Known::default().with_matte(Some([1.0; 3])), FitOptions::default());
    assert!(cut.scene.transparent && cut.scene.background == [1.0; 3], "{:?}", cut.scene);
    assert!(cut.bits.is_finite(), "{}", cut.bits);
}

#[test]
fn grounds_are_far_from_what_is_seen() {
    let opaque = [[0.2, 0.3, 0.4, 1.0]; 3];
    assert_eq!(Ground::of(opaque.into_iter()), Ground::Opaque);
    assert_eq!(Ground::of([[0.2, 0.3, 0.4, 0.0]; 3].into_iter()), Ground::Invisible);
    // What is no number is not opaque: the color under it is none either, and is refused.
    assert_ne!(Ground::of([[0.2, 0.3, 0.4, 1.0], [0.2, 0.3, 0.4, f64::NAN]].into_iter()), Ground::Opaque);
    // Black and half-seen white: the corner farthest from both is one of those with one or two channels.
    let ground = Ground::of([[0.0, 0.0, 0.0, 1.0], [1.0, 1.0, 1.0, 0.5], [0.0; 4]].into_iter());
    let Ground::Matte(matte) = ground else { panic!("{ground:?}") };
    let squared = |from: f64| matte.iter().map(|c| (c - from) * (c - from)).sum::<f64>();
    assert!(squared(0.0) >= 1.0 && squared(1.0) >= 1.0, "{matte:?}");
    assert_eq!(ground.under([0.5, 0.5, 0.5, 0.5]), matte.map(|c| 0.25 + 0.5 * c));
}

#[test]
fn the_largest_of_a_drawing_stay_if_fewer_are_asked_for() {
    // Three squares of 20, 12 and 6 pixels, the second painted last of all in the scene's order or not: size decides.
    let squares = [(2, 22, [0.8, 0.1, 0.1]), (26, 38, [0.1, 0.6, 0.1]), (40, 46, [0.1, 0.1, 0.8])];
    let image = picture(|column, row| {
        let own = squares.iter().find(|&&(least, most, _)| in_square(least, most)(column, row));
        own.map_or([1.0; 3], |&(.., color)| color)
    });
    let with = |max_objects| fit(&image, &Known::default(), FitOptions::default().with_max_objects(max_objects));
    let colors = |fit: &Fit<f32>| fit.scene.objects.iter().map(|object| object.color()[0] > 0.5).collect::<Vec<_>>();
    let (all, two, one) = (with(256), with(2), with(1));
    assert_eq!([&all, &two, &one].map(|fit| fit.scene.objects.len()), [3, 2, 1]);
    assert_eq!(colors(&one), [true], "the red one is the largest");
    assert!(all.loss < two.loss && two.loss < one.loss, "{} {} {}", all.loss, two.loss, one.loss);
    assert_eq!(one.marginal_gain.len(), 1);
    assert!(one.doubts().unexplained && !all.doubts().unexplained);
}

#[test]
fn a_doubt_about_edges_is_decided_by_the_profile_of_them_all() {
    // A triangle with an opening, as a renderer paints it that asks two by two places of every pixel: its edges are steeper than area coverage
    // one by one, but not all together. Segments make a thing of the opening.
    let is_inside =
        |x: f64, y: f64, size: f64| y < 27.5 + 9.0 * size && (x - 23.5).abs() < 0.93 * (y - 27.5 + 18.0 * size);
    let image = picture(|column, row| {
        let place = |whole: usize, part: usize| whole as f64 + 0.25 + 0.5 * part as f64;
        let is_red = |&k: &usize| {
            let (x, y) = (place(column, k % 2), place(row, k / 2));
            is_inside(x, y, 1.0) && !is_inside(x, y, 0.35)
        };
        let count = (0..4).filter(is_red).count();
        [1.0, 1.0, 0.9].map(|white: f32| ((white - 0.2 * count as f32) * 255.0).round() / 255.0)
    });
    let traced = dvp_trace::trace(&image.view(), &Known::default()).unwrap();
    assert!(traced.stained > dvp_trace::tuning::DOUBTFUL_STAINED, "{}", traced.stained);
    let segments = crate::fit_image(image.view(), &FitOptions::default()).unwrap();
    assert_eq!((segments.scene.edge.law, segments.scene.objects.len()), (EdgeLaw::Area, 2));
    let drawn = fit(&image, &Known::default(), FitOptions::default());
    assert!(segments.loss < CLEARLY_WORSE * drawn.loss, "{} {}", segments.loss, drawn.loss);
    let [object] = &drawn.scene.objects[..] else { panic!("{:?}", drawn.scene) };
    assert!(object.shape.efd().is_none(), "{object:?}");
}

/// A disk of radius 22 and a rectangle of 30 by 40 pixels, in 96 x 96, with edges of some profile.
fn disk_and_rectangle(edge: EdgeProfile<f32>) -> Image<f32> {
    let object = |shape, x: f32, color| {
        let pose = Pose { translation: [x / 96.0, 0.5], scale: 1.0, rotation: 0.0 };
        Object { shape, pose, paint: color, confidence: 1.0 }
    };
    let disk = AnyShape::Circle(Circle { radius: 22.0 / 96.0 });
    let rectangle = AnyShape::Rectangle(Rectangle { size: [30.0 / 96.0, 40.0 / 96.0], corner_radius: 0.0 });
    let objects = vec![object(disk, 25.3, [0.1, 0.4, 0.2].into()), object(rectangle, 72.0, [0.7, 0.2, 0.3].into())];
    let scene = Scene { edge, compositing: Compositing::Over, objects, ..Scene::empty([0.9, 0.9, 0.8]) };
    Canvas::default().paint(&scene, ImageSize::new(96, 96).unwrap()).unwrap().0.clone()
}

fn assert_disk_and_rectangle(fit: &Fit<f32>) {
    let [one, other] = &fit.scene.objects[..] else { panic!("{:?}", fit.scene.objects) };
    let kinds = [one, other].map(|object| match object.shape {
        AnyShape::Circle(_) => 1,
        AnyShape::Rectangle(_) => 2,
        _ => 0,
    });
    assert!(kinds == [1, 2] || kinds == [2, 1], "{:?}", fit.scene.objects);
}

#[test]
fn a_drawing_under_a_blur_is_a_drawing_and_the_blur_is_told() {
    // A logistic curve whose scale is 0.7 px: a blur of 1.27 px.
    let image = disk_and_rectangle(EdgeProfile::distance(1.4 / 96.0));
    assert!(dvp_trace::trace(&image.view(), &Known::default()).is_err());
    let found = fit(&image, &Known::default(), FitOptions::default());
    assert_disk_and_rectangle(&found);
    assert_eq!(found.scene.edge.law, EdgeLaw::Distance);
    assert!((found.scene.edge.sigma * 96.0 / 1.4 - 1.0).abs() < 0.15, "{}", found.scene.edge.sigma * 96.0);
    assert!(found.loss < 2e-3, "{}", found.loss);
}

#[test]
fn a_drawing_under_noise_is_a_drawing() {
    let mut image = disk_and_rectangle(EdgeProfile::area());
    let mut state = 5_u64;
    for value in image.data_mut() {
        // The sum of four even numbers, of a generator with Knuth's constants: a standard deviation of 0.03.
        let mut even = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1_u64 << 24) as f32 - 0.5
        };
        *value += 0.03 * 3.0_f32.sqrt() * (0..4).map(|_| even()).sum::<f32>();
    }
    assert!(dvp_trace::trace(&image.view(), &Known::default()).is_err());
    let found = fit(&image, &Known::default(), FitOptions::default());
    assert_disk_and_rectangle(&found);
    assert!((found.noise / 0.03 - 1.0).abs() < 0.1, "{}", found.noise);
}

/// Letters of nine pixels' height, of a pen of 1.2 pixels, and a wide bar, black on two grounds: 120 x 48 pixels.
fn letters() -> Image<f32> {
    let size = ImageSize::new(120, 48).unwrap();
    let unit = size.unit_px() as f32;
    let object = |shape: AnyShape<f32>, [x, y]: [f32; 2], paint: [f32; 3]| {
        let pose = Pose { translation: [x / unit, y / unit], scale: 1.0 / unit, rotation: 0.0 };
        Object { shape, pose, paint: paint.into(), confidence: 1.0 }
    };
    let rectangle = |width, height| AnyShape::Rectangle(Rectangle { size: [width, height], corner_radius: 0.0 });
    let letter = |lines: &[&[[f32; 2]]], [x, y]: [f32; 2]| {
        let rings = lines.iter().map(|line| PathRing::polyline(line.to_vec())).collect();
        let stroke = Stroke { rings, width: 1.2, cap: Cap::Butt, join: Join::Miter { limit: 4.0 } };
        object(AnyShape::Stroke(stroke), [x, y], [0.0; 3])
    };
    let e: &[&[[f32; 2]]] = &[&[[4.6, 0.6], [0.6, 0.6], [0.6, 8.4], [4.6, 8.4]], &[[0.6, 4.3], [4.2, 4.3]]];
    let n: &[&[[f32; 2]]] = &[&[[0.6, 9.0], [0.6, 2.8]], &[[0.6, 3.9], [2.2, 3.1], [3.8, 3.4], [4.6, 4.8], [4.6, 9.0]]];
    let k: &[&[[f32; 2]]] = &[&[[0.6, 0.0], [0.6, 9.0]], &[[4.6, 2.7], [1.2, 5.6], [4.9, 9.0]]];
    let mut objects = vec![
        object(rectangle(60.0, 40.0), [86.0, 24.0], [0.8, 0.87, 0.93]),
        object(rectangle(90.0, 3.0), [52.0, 40.0], [0.0; 3]),
    ];
    for (i, form) in [e, n, k, n, e, k, e, n].into_iter().enumerate() {
        let column = i as f32;
        objects.push(letter(form, [9.3 + 13.7 * column, 14.2 + 0.3 * column]));
    }
    let scene = Scene { edge: EdgeProfile::area(), compositing: Compositing::Over, objects, ..Scene::empty([1.0; 3]) };
    Canvas::default().paint(&scene, size).unwrap().0.clone()
}

#[test]
fn letters_of_a_few_pixels_are_painted() {
    let image = letters();
    let found = fit(&image, &Known::default(), FitOptions::default());
    let mut canvas = Canvas::default();
    let mut wrong = |scene: &Scene<f32>| {
        let painted = canvas.paint(scene, image.size()).unwrap().0;
        let pairs = image.data().iter().zip(painted.data()).take(image.size().pixels());
        pairs.filter(|(seen, painted)| (*seen - *painted).abs() > 0.5).count()
    };
    let read = dvp_trace::trace(&image.view(), &Known::default()).unwrap().scene;
    let [of_faces, mended] = [&read, &found.scene].map(&mut wrong);
    // More than three pixels of each are wrong if faces are all there is.
    assert!(of_faces > 30 && mended <= 5, "{of_faces} pixels, {mended} of them still: {:?}", found.scene.objects);
    // As many things as there are letters, on what they lie on.
    assert_eq!(found.scene.objects.len(), 10);
}

/// Every pixel `times` x `times` times.
fn repeated(image: &Image<f32>, times: usize) -> Image<f32> {
    let (width, height) = (image.size().width() * times, image.size().height() * times);
    let of_channel = |c: usize| {
        let channel = image.view().channel(c).to_vec();
        (0..width * height).map(move |i| channel[i / width / times * (width / times) + i % width / times])
    };
    let size = ImageSize::new(width, height).unwrap();
    Image::from_planar(size, (0..3).flat_map(of_channel).collect()).unwrap()
}

#[test]
fn a_picture_whose_pixels_are_repeated_is_read_at_the_size_that_it_was_drawn() {
    let image = disk_and_rectangle(EdgeProfile::area());
    let small = fit(&image, &Known::default(), FitOptions::default());
    let large = fit(&repeated(&image, 3), &Known::default(), FitOptions::default());
    assert_disk_and_rectangle(&large);
    assert_eq!(large.scene, small.scene);
}

#[test]
fn pixels_of_a_sprite_are_squares() {
    // A creature, 16 x 16 pixels, whose eyes and feelers are one pixel wide. Read as coverage, half of it is gone.
    const ROWS: [&str; 16] = [
        "................",
        "..#..........#..",
        "...#........#...",
        "....########....",
        "...##########...",
        "..##o######o##..",
        "..############..",
        ".###.######.###.",
        ".#.##########.#.",
        ".#.#.######.#.#.",
        "...#.#....#.#...",
        "....##....##....",
        "................",
        "..o..........o..",
        ".ooo........ooo.",
        "................",
    ];
    let color = |at: u8| match at {
        b'#' => [0.1, 0.5, 0.2],
        b'o' => [0.9, 0.3, 0.1],
        _ => [0.95, 0.95, 1.0],
    };
    let pixels: Vec<f32> = ROWS.iter().flat_map(|row| row.bytes()).flat_map(color).collect();
    let sprite = Image::from_interleaved(ImageSize::new(16, 16).unwrap(), &pixels).unwrap();
    let outlines = super::drawing_or_segments(
        &Fitter::new(FitOptions::default()).unwrap(),
        sprite.view(),
        &Known::default(),
        &mut PictureScratch::default(),
    );
    assert!(outlines.unwrap().unexplained > UNEXPLAINED_SHARE);
    let of_squares = fit(&sprite, &Known::default(), FitOptions::default());
    for times in [1, 4] {
        let shown = repeated(&sprite, times);
        let painted = Canvas::default().paint(&of_squares.scene, shown.size()).unwrap().0.clone();
        let missed = painted.data().iter().zip(shown.data()).filter(|(a, b)| (*a - *b).abs() > 0.1).count();
        assert_eq!(missed, 0, "of {} values, {times} times", shown.data().len());
        assert_eq!(fit(&shown, &Known::default(), FitOptions::default()).scene, of_squares.scene);
    }
    // The body, two eyes, two hands or feet, each of them one thing.
    assert_eq!(of_squares.scene.objects.len(), 5, "{:?}", of_squares.scene.objects);
}

#[test]
fn smooth_edges_that_are_off_by_a_share_are_not_wrong_unless_their_pixels_are_repeated() {
    // A square whose left edge covers a half of its pixels, and a scene that has a third there; another one without the square.
    let edge = |share: f32| {
        move |column, row| {
            if in_square(13, 36)(column, row) {
                [0.0; 3]
            } else if in_square(12, 36)(column, row) {
                [1.0 - share; 3]
            } else {
                [1.0; 3]
            }
        }
    };
    let (image, scene) = (picture(edge(0.5)), picture(edge(0.34)));
    let wrong_bits = |painted: &Image<f32>, are_repeated| {
        Squares::of(&image.view(), &painted.view(), are_repeated).unwrap().wrong_bits
    };
    assert_eq!(wrong_bits(&scene, false), 0.0);
    assert!(wrong_bits(&scene, true) > 24.0 && wrong_bits(&picture(|_, _| [1.0; 3]), false) > 24.0 * 24.0);
    assert!(Squares::of(&image.view(), &image.view(), true).is_none(), "nothing is missed");
}

proptest! {
    #[test]
    fn what_is_repeated_is_found_by_what_differs(
        (width, height, times) in (16_usize..40, 16_usize..40, 1_usize..5),
        marks in proptest::collection::vec((0_usize..1600, 0.0_f32..1.0), 1..40),
    ) {
        let size = ImageSize::new(width, height).unwrap();
        let mut image = Image::zeros(size);
        for (at, value) in marks {
            let count = image.data().len();
            image.data_mut()[at % count] = value;
        }
        let large = repeated(&image, times);
        let small = squares::reduced(&large.view());
        // What was repeated has no more pixels than before, and says the same.
        let small = small.unwrap_or_else(|| large.clone());
        prop_assert!(small.size().pixels() <= image.size().pixels());
        let back = large.size().width() / small.size().width();
        prop_assert_eq!(repeated(&small, back), large);
    }
}
