#![expect(clippy::float_cmp, reason = "numbers of the texts")]

use dvp_core::shape::{AnyShape, Cap, Circle, Ellipse, FillRule, Join, PathRing, Rectangle, Segment, Shape as _};
use dvp_core::{Object, Pose};

use super::{SvgDrawing, SvgError, from_svg};

mod gradient;
mod limits;

fn read(body: &str) -> Result<SvgDrawing, SvgError> {
    from_svg(&format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"100\" height=\"100\">{body}</svg>"))
}

/// The objects of a drawing of 100 x 100 pixels that keeps everything.
fn objects(body: &str) -> Vec<Object<f64>> {
    let drawing = read(body).unwrap();
    assert!(drawing.losses.is_empty(), "{body}: {}", drawing.losses);
    drawing.scene.objects
}

fn one(body: &str) -> Object<f64> {
    let mut objects = objects(body);
    assert_eq!(objects.len(), 1, "{body}: {objects:?}");
    objects.remove(0)
}

fn close(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
}

fn numbers(object: &Object<f64>) -> Vec<f64> {
    let mut numbers = Vec::new();
    object.shape.numbers(&mut numbers);
    let Pose { translation, scale, rotation } = object.pose;
    numbers.extend([translation[0], translation[1], scale, rotation]);
    numbers
}

#[test]
fn basic_shapes_stay_what_they_are() {
    let circle = one("<circle cx='50' cy='25px' r='10' fill='red'/>");
    assert_eq!(circle.shape, AnyShape::Circle(Circle { radius: 0.1 }));
    assert_eq!((circle.pose.translation, circle.color()), ([0.5, 0.25], [1.0, 0.0, 0.0]));
    let ellipse = one("<ellipse cx='50' cy='25' rx='10' ry='20'/>");
    assert_eq!(ellipse.shape, AnyShape::Ellipse(Ellipse { radii: [0.1, 0.2] }));
    let rectangle = one("<rect x='10' y='20' width='30' height='40' ry='50'/>");
    // A missing radius is the other one, and both are held to half the sides: 15 and 20, a path then.
    assert_eq!(rectangle.shape.kind(), "path");
    let rectangle = one("<rect x='10' y='20' width='30' height='40' rx='5'/>");
    assert_eq!(rectangle.shape, AnyShape::Rectangle(Rectangle { size: [0.3, 0.4], corner_radius: 0.05 }));
    assert!(close(&rectangle.pose.translation, &[0.25, 0.4]));
    let AnyShape::Polygon(polygon) = one("<polygon points='0,0 10 0, 0 10'/>").shape else { panic!("no polygon") };
    assert_eq!(polygon.rings, [[[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]]]);
}

#[test]
fn transforms_and_units_are_in_the_numbers() {
    // Turned by 90 degrees about the origin, (10, 0) goes to (0, 10).
    let circle = one("<g transform='translate(20 0) rotate(90) scale(2)'><circle cx='10' cy='0' r='5'/></g>");
    assert!(close(&numbers(&circle), &[0.1, 0.2, 0.2, 1.0, 0.0]), "{circle:?}");
    let squeezed = one("<circle cx='10' cy='10' r='10' transform='scale(2 1)'/>");
    assert_eq!(squeezed.shape.kind(), "ellipse");
    assert!(close(&numbers(&squeezed), &[0.2, 0.1, 0.2, 0.1, 1.0, 0.0]), "{squeezed:?}");
    // x + y, y: singular values (sqrt 5 +- 1) / 2.
    let sheared = one("<circle r='10' transform='matrix(1 0 1 1 50 50)'/>");
    let AnyShape::Ellipse(Ellipse { radii }) = sheared.shape else { panic!("{sheared:?}") };
    assert!(close(&radii, &[0.161_803_4, 0.061_803_4]), "{radii:?}");
    let turned = one("<rect x='-5' y='-10' width='10' height='20' transform='translate(50 50) rotate(30)'/>");
    assert!(close(&numbers(&turned), &[0.1, 0.2, 0.0, 0.5, 0.5, 1.0, core::f64::consts::FRAC_PI_6]), "{turned:?}");
    assert_eq!(one("<rect width='10' height='20' transform='skewX(30)'/>").shape.kind(), "path");
    // 1 in is 96 px, a quarter of the viewport 25 px.
    let inches = one("<circle cx='25%' cy='0.5in' r='25%'/>");
    assert!(close(&numbers(&inches), &[0.25, 0.25, 0.48, 1.0, 0.0]), "{inches:?}");
}

#[test]
fn the_view_box_is_scaled_to_the_viewport() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='60' height='40' viewBox='10 10 30 20'>
        <circle cx='25' cy='20' r='5'/></svg>";
    let SvgDrawing { scene, size, .. } = from_svg(text).unwrap();
    assert_eq!((size.width(), size.height()), (60, 40));
    assert!(close(&numbers(&scene.objects[0]), &[0.25, 0.75, 0.5, 1.0, 0.0]), "{scene:?}");
    let bare = from_svg("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 24.2 24'><circle r='9'/></svg>").unwrap();
    assert_eq!((bare.size.width(), bare.size.height()), (25, 24));
    assert_eq!(bare.scene.objects[0].shape, AnyShape::Circle(Circle { radius: 9.0 / 24.0 }));
}

#[test]
fn path_data_keeps_lines_arcs_and_cubics() {
    let object = one("<path d='m10 10h20v10a5 5 0 0 1-10 0c0-5 5-5 5-10q5 0 5 5t5 5l5 5z' fill-rule='evenodd'/>");
    let AnyShape::Path(path) = &object.shape else { panic!("{object:?}") };
    assert_eq!(path.fill, FillRule::EvenOdd);
    let PathRing { points, segments } = &path.rings[0];
    assert_eq!(points.len(), segments.len(), "closed");
    let expected = [
        [10.0, 10.0],
        [30.0, 10.0],
        [30.0, 20.0],
        [20.0, 20.0],
        [25.0, 10.0],
        [30.0, 15.0],
        [35.0, 20.0],
        [40.0, 25.0],
    ];
    assert!(close(points.as_flattened(), &expected.as_flattened().iter().map(|v| v / 100.0).collect::<Vec<_>>()));
    assert_eq!([segments[0], segments[1], segments[7]], [Segment::Line; 3]);
    let Segment::Arc { bulge } = segments[2] else { panic!("{segments:?}") };
    assert!((bulge - 1.0).abs() < 1e-12, "{bulge}");
    let Segment::Cubic { controls } = segments[4] else { panic!("{segments:?}") };
    // Two thirds of the way to the control point (30, 10).
    assert!(close(controls.as_flattened(), &[0.283_333_333, 0.1, 0.3, 0.116_666_667]), "{controls:?}");
    let Segment::Cubic { controls } = segments[5] else { panic!("{segments:?}") };
    // The control point is mirrored at (30, 15): (30, 20).
    assert!(close(controls.as_flattened(), &[0.3, 0.183_333_333, 0.316_666_667, 0.2]), "{controls:?}");
    // Mirrored, an arc turns the other way.
    let mirrored = one("<path d='M0 0a5 5 0 0 1 10 0z' transform='scale(1 -1)'/>");
    let AnyShape::Path(path) = &mirrored.shape else { panic!("{mirrored:?}") };
    assert!(matches!(path.rings[0].segments[0], Segment::Arc { bulge } if (bulge + 1.0).abs() < 1e-9), "{mirrored:?}");
    assert_eq!(path.fill, FillRule::NonZero);
}

#[test]
fn relative_coordinates_come_back_to_their_start() {
    // In binary, .1 + .1 + .1 - .2 is not .1.
    let ring = |data: &str| {
        let AnyShape::Path(path) = one(&format!("<path d='{data}'/>")).shape else { panic!("{data}") };
        path.rings[0].clone()
    };
    let back = ring("m.1 .2l.1 .1l.1 .3l-.2-.4z");
    assert_eq!((back.points.len(), back.segments.len()), (3, 3), "{back:?}");
    let curved = ring("m.1 .2l.1 .1l.1 .3c0 0-.1-.1-.2-.4z");
    assert!(curved.is_closed() && matches!(curved.segments[2], Segment::Cubic { .. }), "{curved:?}");
    // A thousandth short is another corner.
    assert_eq!(ring("m.1 .2l.1 .1l.1 .3l-.199-.4z").points.len(), 4);
}

#[test]
fn broken_path_data_is_read_up_to_the_error_and_said() {
    let drawing = read("<path d='M0 0L10 0L0 10 L'/>").unwrap();
    assert_eq!(drawing.losses.to_string(), "path data: read up to its first error");
    assert_eq!(drawing.scene.objects.len(), 1);
}

#[test]
fn fill_and_stroke_are_two_objects_in_their_order() {
    let style = "fill='#ff0000' fill-opacity='.5' stroke='#0000ff' stroke-width='4' stroke-linecap='square' \
                 stroke-linejoin='bevel'";
    let [fill, stroke] = &objects(&format!("<circle cx='50' cy='50' r='20' {style}/>"))[..] else { panic!("not two") };
    assert_eq!((fill.shape.kind(), fill.confidence, fill.color()), ("circle", 0.5, [1.0, 0.0, 0.0]));
    let AnyShape::Stroke(pen) = &stroke.shape else { panic!("{stroke:?}") };
    assert_eq!((pen.cap, pen.join), (Cap::Square, Join::Bevel));
    assert!(close(&[pen.width, stroke.confidence], &[0.04, 1.0]) && stroke.color() == [0.0, 0.0, 1.0]);
    assert_eq!(pen.rings[0].segments, [Segment::Arc { bulge: 1.0 }; 2]);
    assert!(close(pen.rings[0].points.as_flattened(), &[0.7, 0.5, 0.3, 0.5]), "{pen:?}");
    let swapped = objects(&format!("<circle cx='50' cy='50' r='20' paint-order='stroke' {style}/>"));
    assert_eq!(swapped[1].shape.kind(), "circle");
}

#[test]
fn lines_are_strokes_with_the_miter_of_the_file() {
    let line = one("<polyline points='10,10 20,10 10,20' fill='none' stroke='red' stroke-miterlimit='7'/>");
    let AnyShape::Stroke(pen) = &line.shape else { panic!("{line:?}") };
    assert!(!pen.rings[0].is_closed() && pen.rings[0].points.len() == 3);
    assert!(matches!(pen.join, Join::Miter { limit: 7.0 }), "{pen:?}");
    assert_eq!(one("<line x1='1' x2='9' stroke='red'/>").shape.kind(), "stroke");
    let dashes = one("<path d='M10 10H70' stroke='red' stroke-dasharray='10 5'/>");
    let AnyShape::Stroke(pen) = &dashes.shape else { panic!("{dashes:?}") };
    assert_eq!(pen.rings.len(), 4, "{pen:?}");
}

#[test]
fn styles_uses_and_groups_are_resolved() {
    let styled = one("<style>.a{fill:#00ff00} #b{opacity:.5}</style><g id='b'><circle class='a' r='5'/></g>");
    assert_eq!((styled.color(), styled.confidence), ([0.0, 1.0, 0.0], 0.5));
    let copies =
        objects("<defs><rect id='r' width='5' height='5'/></defs><use href='#r' x='10'/><use href='#r' y='20'/>");
    assert_eq!(copies.len(), 2, "{copies:?}");
    assert!(copies.iter().all(|copy| copy.shape.kind() == "rectangle"), "{copies:?}");
    assert!(
        read("<circle r='5' visibility='hidden'/><circle r='5' display='none'/>").unwrap().scene.objects.is_empty()
    );
    assert_eq!(objects("<g opacity='.5'><circle r='5'/><circle cx='50' r='5'/></g>")[1].confidence, 0.5);
    let overlap = read("<g opacity='.5'><circle r='5'/><circle r='5'/></g>").unwrap();
    assert!(overlap.losses.to_string().starts_with("opacity of a group"), "{}", overlap.losses);
}

#[test]
fn what_is_used_keeps_its_kind() {
    let shapes = "<circle cx='5%' r='5.1'/><ellipse rx='5' ry='4'/><rect width='5' height='4' rx='1'/>\
         <polygon points='0,0 7 0 0 7'/><path d='M0 0a5 5 0 0 1 10 0z'/><path d='M0 0l9 0' stroke='red'/>";
    let kinds = |body: &str| objects(body).iter().map(|object| object.shape.kind()).collect::<Vec<_>>();
    let expected = ["circle", "ellipse", "rectangle", "polygon", "path", "stroke"];
    for how in [
        format!("<defs><g id='a'>{shapes}</g></defs><use href='#a' x='20'/>"),
        format!("<symbol id='a' overflow='visible'>{shapes}</symbol><use href='#a'/>"),
        format!("<defs><g id='a'>{shapes}</g><use id='b' href='#a'/></defs><g fill='red'><use href='#b'/></g>"),
        format!(
            "<marker id='a' overflow='visible' markerUnits='userSpaceOnUse' viewBox='0 0 3 3'>{shapes}</marker>\
             <path d='M0 0h1' fill='none' marker-end='url(#a)'/>"
        ),
    ] {
        assert_eq!(kinds(&how), expected, "{how}");
    }
    let used = one("<defs><circle id='a' r='5'/></defs><use href='#a' transform='scale(1 2)' x='5.1'/>");
    assert_eq!(used.shape, AnyShape::Ellipse(Ellipse { radii: [0.05, 0.1] }));
    let object = one("<defs><path id='a' d='M0 0a5 5 0 0 1 10 0z'/></defs><use href='#a'/>");
    let AnyShape::Path(path) = &object.shape else { panic!("{object:?}") };
    assert!(matches!(path.rings[0].segments[0], Segment::Arc { .. }), "{path:?}");
    // An empty id names nothing.
    assert_eq!(
        kinds("<defs><g id='a'><circle r='5'/></g></defs><rect id='' width='5' height='5'/><use href='#a'/>"),
        ["rectangle", "circle"]
    );
}

#[test]
fn used_shapes_that_are_not_known_again_are_named() {
    // Percent of the symbol's own viewport, which the element alone does not have.
    let drawing = read("<symbol id='a' viewBox='0 0 20 20' overflow='visible'><circle r='10%'/></symbol><use href='#a' width='30' height='30'/>").unwrap();
    assert_eq!(drawing.scene.objects[0].shape.kind(), "path");
    assert!(drawing.losses.to_string().contains("use or marker: shape became a path"), "{}", drawing.losses);
}

#[test]
fn the_first_full_rectangle_is_the_background() {
    let covered = read("<rect width='100%' height='100%' fill='#ff0000'/><circle r='5'/>").unwrap().scene;
    assert_eq!((covered.transparent, covered.background, covered.objects.len()), (false, [1.0, 0.0, 0.0], 1));
    for partly in
        ["width='99' height='100'", "width='100' height='100' fill-opacity='.5'", "width='100' height='100' rx='3'"]
    {
        let scene = read(&format!("<rect {partly}/>")).unwrap().scene;
        assert_eq!((scene.transparent, scene.objects.len()), (true, 1), "{partly}");
    }
    assert!(read("<circle r='5'/><rect width='100' height='100'/>").unwrap().scene.transparent, "not the first");
}

#[test]
fn what_cannot_be_kept_is_named() {
    for (body, named) in [
        ("<text>a</text>", "text: not drawn"),
        ("<image href='a.png' width='9' height='9'/>", "image: not drawn"),
        ("<foreignObject/>", "foreignObject: not drawn"),
        (
            "<pattern id='p' width='5' height='5'><circle r='2'/></pattern><rect width='9' height='9' fill='url(#p)'/>",
            "pattern",
        ),
        (
            "<filter id='f'><feGaussianBlur stdDeviation='2'/></filter><rect width='9' height='9' filter='url(#f)'/>",
            "filter",
        ),
        ("<rect width='9' height='9' style='mix-blend-mode:multiply'/>", "mix-blend-mode"),
        ("<path d='M0 0H9' stroke='red' stroke-linejoin='miter-clip'/>", "stroke-linejoin miter-clip"),
        ("<path d='M0 0L9 9' stroke='red' transform='scale(1 2)'/>", "stroke under a transform"),
    ] {
        let losses = read(body).unwrap().losses.to_string();
        assert!(losses.starts_with(named), "{body}: {losses}");
    }
    assert!(objects("<defs><text>a</text></defs>").is_empty());
}

#[test]
fn clips_and_masks_cut() {
    let area = |object: &Object<f64>| object.shape.area().unwrap();
    let clip = "<clipPath id='c'><rect width='50' height='100'/></clipPath>";
    let cut = read(&format!("{clip}<circle cx='50' cy='50' r='20' clip-path='url(#c)'/>")).unwrap();
    // Half a disk.
    assert!((area(&cut.scene.objects[0]) - 0.02 * core::f64::consts::PI).abs() < 1e-5, "{:?}", cut.scene);
    assert_eq!(cut.losses.to_string(), "clip-path or mask: curves of what it cuts became polygons");
    let inside = one(&format!("{clip}<circle cx='25' cy='50' r='20' clip-path='url(#c)'/>"));
    assert_eq!(inside.shape.kind(), "circle", "what is not cut stays");
    assert!(objects(&format!("{clip}<circle cx='80' cy='50' r='20' clip-path='url(#c)'/>")).is_empty());
    let mask = "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='100' height='100'>
        <rect width='60' height='60' fill='#fff'/><rect x='10' y='10' width='20' height='20'/></mask>";
    let cut = read(&format!("{mask}<rect width='100' height='50' mask='url(#m)'/>")).unwrap();
    assert!((area(&cut.scene.objects[0]) - (0.3 - 0.04)).abs() < 1e-9, "{:?}", cut.scene);
    let gray = "<mask id='m'><rect width='60' height='60' fill='#888'/></mask>";
    let whole = read(&format!("{gray}<rect width='50' height='50' mask='url(#m)'/>")).unwrap();
    assert!(whole.losses.to_string().starts_with("mask that is neither"), "{}", whole.losses);
}
