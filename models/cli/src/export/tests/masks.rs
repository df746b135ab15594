use super::*;
use crate::paint::Painter;

fn decoded(png: &[u8]) -> image::DynamicImage {
    image::load_from_memory(png).unwrap()
}

#[test]
fn pixels_belong_to_the_last_object_that_covers_half() {
    let size = ImageSize::new(4, 1).unwrap();
    // Scene units are the one pixel of height.
    let bar = |low: f32, high: f32| polygons(&[&corners([10.0 * low, 0.0], [10.0 * high, 10.0])], [0.0; 3]);
    let scene = scene(vec![bar(0.0, 2.4), bar(1.6, 3.4), bar(3.8, 4.0)]);
    // The second covers 0.4 of pixel 1 and 0.4 of pixel 3.
    let labels = label_map(&scene, &[1, 2, 7], size).unwrap();
    assert_eq!(labels, [1, 1, 2, 0]);
    let image = decoded(&label_map_png(&labels, size).unwrap());
    assert_eq!((image.color(), image.to_luma8().into_raw()), (image::ColorType::L8, vec![1, 1, 2, 0]));
}

/// The outline of an object goes straight through jagged edges: pixels that it halves belong to what they show.
#[test]
fn pixels_that_refute_the_scene_belong_to_what_they_show() {
    let size = ImageSize::new(6, 1).unwrap();
    let scene = scene(vec![polygons(&[&corners([0.0, 0.0], [24.5, 10.0])], [0.0; 3])]);
    // White, black up to 2.45 px; no mixture of the two is red.
    let mut image = Painter::default().paint(&scene, size).unwrap();
    let mut labels = |pixel: usize, color: [f32; 3], noise: f32| {
        let pixels = size.pixels();
        let was = [0, 1, 2].map(|c| core::mem::replace(&mut image.data_mut()[c * pixels + pixel], color[c]));
        let labels = label_map_in(&scene, &[7], image.view(), noise).unwrap();
        (0..3).for_each(|c| image.data_mut()[c * pixels + pixel] = was[c]);
        labels
    };
    assert_eq!(labels(2, [0.55; 3], 0.01), [7, 7, 0, 0, 0, 0], "as drawn: 0.45 of it");
    assert_eq!(labels(2, [0.44; 3], 0.01), [7, 7, 7, 0, 0, 0], "the picture has 0.56 of it");
    assert_eq!(labels(2, [0.44; 3], 0.05), [7, 7, 0, 0, 0, 0], "that may be noise");
    assert_eq!(labels(1, [0.7; 3], 0.01), [7, 0, 0, 0, 0, 0]);
    assert_eq!(labels(2, [0.4, 0.0, 0.0], 0.01), [7, 7, 0, 0, 0, 0], "no mixture");
    assert_eq!(labels(5, [0.1; 3], 0.01), [7, 7, 0, 0, 0, 0], "away from every edge");
    let fit_is_unknown = labels(2, [0.44; 3], f32::NAN);
    assert_eq!(fit_is_unknown, [7, 7, 0, 0, 0, 0]);
    let mut thin = scene.clone();
    thin.objects[0].confidence = 0.8;
    assert_eq!(label_map_in(&thin, &[7], image.view(), 0.01).unwrap(), [7, 7, 0, 0, 0, 0], "one can see through it");
}

#[test]
fn many_objects_take_16_bits_and_too_many_are_refused() {
    let size = ImageSize::new(2, 1).unwrap();
    let image = decoded(&label_map_png(&[0, 256], size).unwrap());
    assert_eq!((image.color(), image.to_luma16().into_raw()), (image::ColorType::L16, vec![0, 256]));
    let error = label_map_png(&[0, 70_000], size).unwrap_err().to_string();
    assert!(error.contains("65535") && error.contains("70000"), "{error}");
}

#[test]
fn whole_objects_stand_side_by_side() {
    let low = polygons(&[&corners([0.0, 0.0], [5.0, 10.0])], [0.0; 3]);
    let high = polygons(&[&corners([2.0, 0.0], [10.0, 5.0])], [0.0; 3]);
    let image = decoded(&whole_png(&scene(vec![low, high]), size()).unwrap());
    assert_eq!((image.width(), image.height(), image.color()), (20, 10, image::ColorType::L8));
    let image = image.to_luma8();
    let at = |x, y| image.get_pixel(x, y).0[0];
    assert_eq!([at(0, 9), at(4, 4), at(5, 4)], [255, 255, 0], "the first, hidden or not");
    assert_eq!([at(11, 0), at(12, 0), at(19, 4), at(19, 5)], [0, 255, 255, 0], "the second");
    let empty = decoded(&whole_png(&scene(Vec::new()), size()).unwrap()).to_luma8();
    assert_eq!((empty.width(), empty.iter().copied().max()), (10, Some(0)));
}

#[test]
fn an_image_of_whole_objects_has_a_limit() {
    let size = ImageSize::new(1 << 13, 1 << 13).unwrap();
    let error = whole_png(&scene(vec![frame(); 5]), size).unwrap_err().to_string();
    assert!(error.contains("5") && error.contains("4 of them"), "{error}");
}

#[test]
fn pixels_that_are_missing_are_an_error() {
    let size = ImageSize::new(3, 1).unwrap();
    for labels in [&[0, 1][..], &[0, 256, 1, 2]] {
        let error = label_map_png(labels, size).unwrap_err().to_string();
        assert!(error.contains("PNG"), "{error}");
    }
}

#[test]
fn outlines_of_large_pictures_stray_by_no_more_than_those_of_small_ones() {
    let size = ImageSize::new(4096, 4096).unwrap();
    let drawing = Painter::default().draw(&scene(vec![disk([5.0, 5.0], 4.5)]), size).unwrap();
    let outline = drawing.outline(0);
    let middle = |(a, b): (&[f32; 2], &[f32; 2])| [0, 1].map(|i| (f64::from(a[i]) + f64::from(b[i])) / 2.0 - 0.5);
    let off = outline.iter().zip(&outline[1..]).map(middle).map(|[x, y]| (x.hypot(y) - 0.45).abs() * 4096.0);
    let farthest = off.fold(0.0, f64::max);
    assert!(farthest > 0.0 && farthest < 1.05 / 128.0, "{farthest} px");
}
