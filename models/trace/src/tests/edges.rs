//! Edges that lie close to others, and those that a renderer left uneven.

use super::*;
use crate::partition::Partition;

#[test]
fn what_is_seen_of_a_thing_in_a_sliver_is_no_line() {
    // Of the red frame a pixel and a half is seen below the blue one.
    let behind = object(square_frame(20.0, 9.0), [42.0, 50.0], 0.0, RED);
    let front = object(square_frame(22.0, 10.0), [52.3, 46.6], 0.0, BLUE);
    let picture = paint(&scene(WHITE, vec![behind, front]));
    let found = found(&picture);
    assert_eq!(found.objects.len(), 2, "{:?}", found.objects);
    assert!(error(&picture, &found) < 2e-3, "{}", error(&picture, &found));
}

#[test]
fn a_line_along_the_border_of_two_things_stays_a_line() {
    let block = object(rectangle(50.0, 40.0), [48.0, 28.0], 0.0, RED);
    let line = object(rectangle(60.0, 1.4), [48.0, 48.0], 0.0, [0.0; 3]);
    let dot = object(circle(8.0), [48.0, 74.0], 0.0, [0.0; 3]);
    let found = found(&paint(&scene(WHITE, vec![block, line, dot])));
    assert_eq!(found.objects.len(), 3, "{:?}", found.objects);
}

/// A red triangle with an opening on white, as a renderer paints it that asks `lattice` x `lattice` places of every pixel.
fn counted(lattice: usize) -> Image<f32> {
    let is_inside = |x: f64, y: f64, scale: f64| y < 10.0 * scale && x.abs() < 0.77 * (y + 22.0 * scale);
    let pixels = (0..SIZE * SIZE).flat_map(|i| {
        let inside = (0..lattice * lattice).filter(|k| {
            let at = |whole: usize, part: usize| whole as f64 + (part as f64 + 0.5) / lattice as f64 - 47.3;
            let (x, y) = (at(i % SIZE, k % lattice), at(i / SIZE, k / lattice));
            is_inside(x, y, 1.0) && !is_inside(x, y, 0.4)
        });
        let share = inside.count() as f32 / (lattice * lattice) as f32;
        [0, 1, 2].map(|c| ((WHITE[c] + share * (RED[c] - WHITE[c])) * 255.0).round() / 255.0)
    });
    Image::from_interleaved(size(), &pixels.collect::<Vec<_>>()).unwrap()
}

#[test]
fn edges_are_as_uneven_as_the_renderer_left_them() {
    let sigma = |lattice: usize| {
        let partition = Partition::of(&counted(lattice).view(), false).unwrap();
        let rings = crate::boundary::rings(&partition);
        let mut sigmas: Vec<f64> =
            rings.iter().flatten().flat_map(|ring| &ring.steps).filter_map(|step| Some(step.sample?.sigma)).collect();
        sigmas.sort_by(f64::total_cmp);
        sigmas[sigmas.len() / 2]
    };
    assert!(sigma(16) < 0.01, "{}", sigma(16));
    assert!((0.03..0.25).contains(&sigma(2)), "{}", sigma(2));
    // Straight edges stay straight.
    let found = trace(&counted(2).view(), &Known::default()).unwrap().scene;
    let [object] = &found.objects[..] else { panic!("{} objects", found.objects.len()) };
    let AnyShape::Path(path) = &object.shape else { panic!("{:?}", object.shape) };
    assert_eq!(path.rings.iter().map(|ring| ring.points.len()).collect::<Vec<_>>(), [3, 3], "{path:?}");
}
