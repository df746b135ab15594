use dvp_core::{Image, ImageSize};

use super::{Confusion, ObjectTotals, Parts, connected_components, score_objects};

/// Labels from a drawing of digits.
fn labels(text: &str) -> Vec<u32> {
    text.chars().filter_map(|c| c.to_digit(10)).collect()
}

/// Whole masks from drawings, `#` where the object is.
fn whole(masks: &[&str]) -> Option<Vec<bool>> {
    Some(masks.iter().flat_map(|mask| mask.chars().filter(|c| "#.".contains(*c)).map(|c| c == '#')).collect())
}

fn parts(text: &str, masks: &[&str], classes: &[u32]) -> Parts {
    let classes = classes.iter().copied().map(Some).collect();
    Parts { labels: labels(text), whole: whole(masks), ordered: true, classes }
}

/// Gray by label: 0, 0.5 and 1.
fn image(labels: &[u32]) -> Image<f32> {
    let size = ImageSize::new(4, labels.len() / 4).unwrap();
    let values: Vec<f32> = labels.iter().flat_map(|&label| [label as f32 / 2.0; 3]).collect();
    Image::from_interleaved(size, &values).unwrap()
}

#[test]
fn the_truth_scores_full() {
    let truth = parts("0112 0112 0112", &[".##. .##. .##.", "..## ..## ..##"], &[4, 9]);
    let score = score_objects(image(&truth.labels).view(), &truth, &truth).unwrap();
    let totals = ObjectTotals::of([&score].into_iter()).unwrap();
    let all = [totals.ari_foreground, totals.ari, totals.exact_count, totals.order, totals.iou, totals.f1];
    assert_eq!(all, [Some(1.0); 6]);
    assert_eq!((totals.class_accuracy, totals.n), (Some(1.0), 1));
}

#[test]
fn figures_of_a_worked_example() {
    // Object 2 lies on object 1, which is 2 x 3 with a column hidden. Found: object 1 cropped to what is seen, and on top of the other.
    let truth = parts("0122 0122 0122", &[".##. .##. .##.", "..## ..## ..##"], &[0, 1]);
    let found = parts("0211 0211 0211", &["..## ..## ..##", ".#.. .#.. .#.."], &[0, 1]);
    let score = score_objects(image(&truth.labels).view(), &truth, &found).unwrap();
    assert!((score.ari_foreground - 1.0).abs() < 1e-12 && (score.ari - 1.0).abs() < 1e-12);
    assert_eq!((score.true_objects, score.found_objects), (2, 2));
    // 3 of 6 pixels, and 6 of 6.
    assert!((score.iou.mean().unwrap() - 0.75).abs() < 1e-12);
    // 2 x 3 / 9, and 1.
    assert!((score.f1.mean().unwrap() - (6.0 / 9.0 + 1.0) / 2.0).abs() < 1e-12);
    // Three pixels of both, colors 0.5 apart in three channels; the order is wrong.
    assert!((score.order.weight - 3.0 * 0.75).abs() < 1e-6 && score.order.sum == 0.0);
    // Names of classes mean nothing.
    assert_eq!(score.classes.mean_accuracy().unwrap(), Some(1.0));
}

#[test]
fn what_is_not_found_counts() {
    let truth = parts("0122 0122 0122", &[".##. .##. .##.", "..## ..## ..##"], &[0, 1]);
    let found = parts("0022 0022 0022", &[".... .... ....", "..## ..## ..##"], &[0, 0]);
    let mut only = found.clone();
    only.whole = whole(&["..## ..## ..##"]);
    let score = score_objects(image(&truth.labels).view(), &truth, &only).unwrap();
    assert_eq!((score.true_objects, score.found_objects), (2, 1));
    assert!((score.iou.mean().unwrap() - 0.5).abs() < 1e-12);
    assert!(score.order.weight > 0.0 && score.order.sum == 0.0);
    // Object 1 is given to the background; that is wrong, not left out.
    assert_eq!(score.classes.mean_accuracy().unwrap(), Some(0.5));
    assert!((score.ari_foreground - 1.0).abs() < 1e-12, "the foreground is divided alike");
    assert!(score.ari < 0.9);
}

#[test]
fn without_whole_masks_and_classes_there_are_no_such_figures() {
    let truth = Parts { labels: labels("0122 0122"), ..Parts::default() };
    let score = score_objects(image(&truth.labels).view(), &truth, &truth).unwrap();
    let totals = ObjectTotals::of([&score].into_iter()).unwrap();
    assert_eq!((totals.iou, totals.order, totals.class_accuracy), (None, None, None));
    assert_eq!(ObjectTotals::of([].into_iter()).unwrap().ari, None);
}

#[test]
fn classes_are_matched_one_to_one() {
    let mut confusion = Confusion::default();
    // Of class 5: 8 pixels called 0, 2 called 1; of class 6: 3 called 0, 1 called 1, 6 nothing; class 7: nothing but 0.
    for (truth, found, pixels) in
        [(5, Some(0), 8), (5, Some(1), 2), (6, Some(0), 3), (6, Some(1), 1), (6, None, 6), (7, Some(0), 1)]
    {
        confusion.add(truth, found, pixels);
    }
    // 5 is 0 (8 of 10), 6 is 1 (1 of 10), nothing is left for 7.
    let accuracy = confusion.mean_accuracy().unwrap().unwrap();
    assert!((accuracy - (0.8 + 0.1 + 0.0) / 3.0).abs() < 1e-12, "{accuracy}");
    let mut nothing = Confusion::default();
    nothing.add(1, None, 5);
    assert_eq!(nothing.mean_accuracy().unwrap(), None);
}

#[test]
fn components_of_equal_color() {
    // Two parts of color 1, one of color 2, a single pixel of color 3 that is an edge of the part beside it.
    let text = "00000000 01100110 01100110 00000000 02230000 02200000";
    let pixels: Vec<u8> = labels(text).into_iter().flat_map(|v| [u8::try_from(v).unwrap() * 40; 3]).collect();
    let found = connected_components(&pixels, ImageSize::new(8, 6).unwrap());
    assert_eq!(found.seen(), 3);
    let at = |row: usize, column: usize| found.labels[8 * row + column];
    assert_eq!((at(0, 0), at(1, 1), at(1, 5), at(4, 1)), (0, 1, 2, 3));
    // One step from part 3 and from the background.
    assert!([0, 3].contains(&at(4, 3)));
    assert_eq!(found.whole.as_ref().map(Vec::len), Some(3 * 48));
    assert!(!found.ordered && found.classes.is_empty());
    // Nothing but stripes of one pixel: all is background.
    let stripes: Vec<u8> = (0..16).flat_map(|i| [u8::try_from(i % 2).unwrap() * 255; 3]).collect();
    assert_eq!(connected_components(&stripes, ImageSize::new(4, 4).unwrap()).seen(), 0);
}
