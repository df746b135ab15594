use super::labels::Room;
use super::*;

fn scatter() -> Scatter {
    let marks = (1..8).map(|k| {
        let x = f64::from(k);
        Mark { at: (x, 1.0 / x), spread: Some((0.9 * x, 1.1 * x)), label: Some(format!("setting {k}")) }
    });
    let series = Series {
        name: "a series".into(),
        color: 0,
        shape: Shape::Triangle,
        hollow: false,
        pale: false,
        joined: true,
        marks: marks.collect(),
    };
    Scatter {
        title: "A title".into(),
        x: "time".into(),
        y: "error".into(),
        floor: 1e-3,
        series: vec![series],
        fronts: vec![("front".into(), vec![(1.0, 1.0), (7.0, 1.0 / 7.0)])],
        shapes: vec![(Shape::Circle, "a circle".into())],
        level: Some(("a level".into(), 0.2)),
        strip: Some(Strip { title: "aside".into(), marks: vec![("other".into(), 0.5), ("none".into(), 0.0)] }),
    }
}

#[test]
fn a_scatter_names_everything_and_is_painted_with_text() {
    let svg = scatter().to_svg().unwrap();
    for text in ["A title", "a series", "setting 1", "setting 7", "front", "a circle", "aside", "other", "a level"] {
        assert!(svg.contains(text), "{text}");
    }
    let png = |scatter: &Scatter| {
        let bytes = scatter.to_png().unwrap();
        image::load_from_memory(&bytes).unwrap().to_rgb8()
    };
    let (named, mut silent) = (png(&scatter()), scatter());
    silent.title = String::new();
    // Text is painted, in the upper part here, on paper that is white elsewhere.
    let dark = |picture: &image::RgbImage| {
        picture.enumerate_pixels().filter(|(_, y, pixel)| *y < 70 && pixel.0.iter().all(|&v| v < 128)).count()
    };
    assert!(dark(&named) > dark(&png(&silent)) + 50);
}

#[test]
fn nothing_is_a_chart_too() {
    let empty = Scatter { series: Vec::new(), fronts: Vec::new(), strip: None, ..scatter() };
    assert!(empty.to_svg().unwrap().contains("A title"));
}

#[test]
fn labels_do_not_overlap() {
    let mut room = Room::new([0.0, 0.0, 200.0, 200.0]);
    let mut placed = Vec::new();
    for _ in 0..12 {
        placed.extend(room.place((100.0, 100.0), (40.0, 10.0), 5.0));
    }
    assert!(placed.len() > 6);
    for (k, a) in placed.iter().enumerate() {
        for b in &placed[..k] {
            let [a, b] = [a.frame, b.frame];
            assert!(a[0] >= b[2] || b[0] >= a[2] || a[1] >= b[3] || b[1] >= a[3], "{a:?} {b:?}");
        }
    }
    assert_eq!(room.place((100.0, 100.0), (300.0, 10.0), 5.0), None);
}
