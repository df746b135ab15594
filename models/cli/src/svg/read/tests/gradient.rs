use dvp_core::Object;
use dvp_core::scene::RampKind;
use dvp_core::shape::{AnyShape, Shape as _};

use super::{close, one, read};
use crate::paint::{Painter, RendererName};

const STOPS: &str = "<stop offset='0' stop-color='#ff0000'/><stop offset='1' stop-color='#0000ff'/>";

/// A drawing with a linear gradient `g`.
fn linear(attributes: &str, body: &str) -> String {
    format!("<linearGradient id='g' {attributes}>{STOPS}</linearGradient>{body}")
}

/// A drawing with a radial gradient `g`.
fn radial(attributes: &str, body: &str) -> String {
    format!("<radialGradient id='g' {attributes}>{STOPS}</radialGradient>{body}")
}

/// The offsets of places, pixels of 100.
fn offsets(object: &Object<f64>, places: &[[f64; 2]]) -> Vec<f64> {
    let ramp = object.paint.ramp().unwrap_or_else(|| panic!("{object:?}"));
    let kind = ramp.kind.posed(&object.pose);
    places.iter().map(|place| kind.offset(place.map(|v| v / 100.0))).collect()
}

#[track_caller]
fn assert_offsets(body: &str, expected: &[([f64; 2], f64)]) -> Object<f64> {
    let object = one(body);
    let (places, expected): (Vec<_>, Vec<_>) = expected.iter().copied().unzip();
    let found = offsets(&object, &places);
    assert!(close(&found, &expected), "{body}: {found:?} for {expected:?}");
    object
}

#[test]
fn linear_gradients_run_in_user_space() {
    let units = "gradientUnits='userSpaceOnUse' x1='20' x2='80'";
    let body = linear(units, "<circle cx='50' cy='25' r='40' fill='url(#g)'/>");
    let places = [([20.0, 0.0], 0.0), ([50.0, 99.0], 0.5), ([80.0, 5.0], 1.0), ([110.0, 5.0], 1.5)];
    let circle = assert_offsets(&body, &places);
    assert_eq!(circle.color(), [0.5, 0.0, 0.5], "the mean");
    let ramp = circle.paint.ramp().unwrap();
    assert!(close(&ramp.color_at(0.25), &[0.75, 0.0, 0.25]) && close(&ramp.color_at(1.5), &[0.0, 0.0, 1.0]));
    // The whole drawing twice as large: the same lines of the element.
    let body = linear(units, "<g transform='scale(.5)'><circle cx='50' cy='25' r='40' fill='url(#g)'/></g>");
    assert_offsets(&body, &[([10.0, 0.0], 0.0), ([40.0, 0.0], 1.0)]);
}

#[test]
fn linear_gradients_run_across_bounding_boxes() {
    let rect = "<rect x='10' y='30' width='60' height='20' fill='url(#g)'/>";
    // In the square that the box is made of, the other diagonal has one color: so it has in the box.
    let diagonal =
        [([10.0, 30.0], 0.0), ([70.0, 50.0], 1.0), ([70.0, 30.0], 0.5), ([10.0, 50.0], 0.5), ([25.0, 30.0], 0.125)];
    let object = assert_offsets(&linear("x1='0' y1='0' x2='1' y2='1'", rect), &diagonal);
    assert!(matches!(object.shape, AnyShape::Rectangle(_)) && object.pose.translation != [0.0; 2]);
    // Percentages and no numbers at all: from left to right.
    let across = [([10.0, 33.0], 0.0), ([40.0, 33.0], 0.5), ([70.0, 99.0], 1.0)];
    assert_offsets(&linear("", rect), &across);
    assert_offsets(&linear("x1='0%' x2='100%'", rect), &across);
    // Of each of several shapes its own box, of what is used as well.
    let body =
        linear("", "<defs><circle id='c' r='5' fill='url(#g)'/></defs><use href='#c' x='20'/><use href='#c' y='9'/>");
    let objects = read(&body).unwrap().scene.objects;
    assert!(close(&offsets(&objects[0], &[[15.0, 0.0], [25.0, 0.0]]), &[0.0, 1.0]));
    assert!(close(&offsets(&objects[1], &[[-5.0, 9.0], [5.0, 9.0]]), &[0.0, 1.0]));
}

#[test]
fn radial_gradients_keep_their_ellipse() {
    let (sin, cos) = (30.0_f64.to_radians().sin(), 30.0_f64.to_radians().cos());
    let units = "gradientUnits='userSpaceOnUse' cx='0' cy='0' r='20' gradientTransform='translate(50 40) rotate(30) scale(2 1)'";
    let places = [
        ([50.0, 40.0], 0.0),
        ([50.0 + 40.0 * cos, 40.0 + 40.0 * sin], 1.0),
        ([50.0 + 10.0 * sin, 40.0 - 10.0 * cos], 0.5),
        ([50.0 - 30.0 * sin, 40.0 + 30.0 * cos], 1.5),
    ];
    let body = radial(
        units,
        "<rect x='-20' y='-5' width='40' height='10' transform='translate(50 40) rotate(-30)' fill='url(#g)'/>",
    );
    // In the frame of the turned rectangle.
    let turned = places.map(|([x, y], offset)| {
        let [x, y] = [x * cos + y * sin, y * cos - x * sin];
        ([50.0 + x, 40.0 + y], offset)
    });
    let object = assert_offsets(&body, &turned);
    assert!(object.pose.rotation != 0.0, "{object:?}");
    assert_offsets(&radial(units, "<circle cx='9' cy='9' r='5' fill='url(#g)'/>"), &places);
    // Half the box, which is 60 x 20.
    let body = radial("", "<rect x='10' y='30' width='60' height='20' rx='3' fill='url(#g)'/>");
    assert_offsets(
        &body,
        &[([40.0, 40.0], 0.0), ([70.0, 40.0], 1.0), ([40.0, 50.0], 1.0), ([25.0, 45.0], 0.5_f64.sqrt())],
    );
}

#[test]
fn gradients_go_with_the_transform_of_the_object() {
    let units = "gradientUnits='userSpaceOnUse' x1='-5' x2='5'";
    let body = linear(units, "<circle r='5' transform='translate(50 50) rotate(90) scale(2)' fill='url(#g)'/>");
    assert_offsets(&body, &[([50.0, 40.0], 0.0), ([0.0, 50.0], 0.5), ([50.0, 60.0], 1.0)]);
    // Turned over, and a rectangle whose own frame is turned.
    let body = linear(
        units,
        "<rect x='-5' width='10' height='3' transform='translate(50 50) rotate(20) scale(-3 3)' fill='url(#g)'/>",
    );
    let (sin, cos) = (20.0_f64.to_radians().sin(), 20.0_f64.to_radians().cos());
    let object = assert_offsets(&body, &[([50.0 + 15.0 * cos, 50.0 + 15.0 * sin], 0.0), ([50.0, 50.0], 0.5)]);
    assert!(object.pose.rotation != 0.0, "{object:?}");
    // x + y, y: lines of one color lean as the shape does.
    let sheared = "<path d='M0 0H10V10H0Z' transform='matrix(1 0 1 1 50 50)' fill='url(#g)'/>";
    assert_offsets(
        &linear("", sheared),
        &[([50.0, 50.0], 0.0), ([60.0, 60.0], 0.0), ([70.0, 60.0], 1.0), ([65.0, 60.0], 0.5)],
    );
    // So do circles in them.
    let sheared = "<rect width='10' height='10' transform='matrix(1 0 1 1 50 50)' fill='url(#g)'/>";
    assert_offsets(&radial("", sheared), &[([60.0, 55.0], 0.0), ([65.0, 55.0], 1.0), ([65.0, 60.0], 1.0)]);
}

#[test]
fn strokes_and_what_is_cut_have_the_gradient_of_the_whole() {
    let style = "fill='none' stroke='url(#g)' stroke-width='20'";
    // The box is that of the line, without the pen.
    let body = linear("", &format!("<path d='M20 50L80 60' {style}/>"));
    let object = assert_offsets(&body, &[([20.0, 50.0], 0.0), ([50.0, 50.0], 0.5), ([80.0, 50.0], 1.0)]);
    assert_eq!(object.shape.kind(), "stroke");
    let clip = "<clipPath id='c'><rect width='50' height='100'/></clipPath>";
    let body = linear("", &format!("{clip}<rect x='20' width='60' height='50' fill='url(#g)' clip-path='url(#c)'/>"));
    let cut = read(&body).unwrap().scene.objects.remove(0);
    assert!(close(&offsets(&cut, &[[20.0, 0.0], [80.0, 0.0]]), &[0.0, 1.0]), "{cut:?}");
}

#[test]
fn stops_keep_steps_and_opacity() {
    let stops = |stops: &str| {
        let body = "<circle cx='50' cy='50' r='9' fill='url(#g)' fill-opacity='.5'/>";
        one(&format!("<linearGradient id='g'>{stops}</linearGradient>{body}"))
    };
    let step = stops(
        "<stop offset='.25' stop-color='#f00' stop-opacity='.5'/><stop offset='.5' stop-color='#0f0' stop-opacity='.5'/>\
         <stop offset='.5' stop-color='#00f' stop-opacity='.5'/>",
    );
    assert_eq!(step.confidence, 0.25);
    let ramp = step.paint.ramp().unwrap();
    assert_eq!(ramp.stops.iter().map(|stop| stop.offset).collect::<Vec<_>>(), [0.25, 0.5, 0.5]);
    assert_eq!([ramp.color_at(0.0), ramp.color_at(0.5)], [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    let step = stops("<stop stop-color='#f00'/><stop stop-color='#0f0'/><stop offset='1' stop-color='#00f'/>");
    assert_eq!(step.paint.ramp().unwrap().stops[1].offset, 0.0);
    // One color is no ramp, and needs none.
    let even = stops("<stop stop-color='#f00'/><stop offset='1' stop-color='#f00'/>");
    assert!(even.paint.ramp().is_none() && even.color() == [1.0, 0.0, 0.0]);
    // Along no way the last color is everywhere.
    let nothing = one(&linear("x1='.5' x2='.5'", "<circle r='5' fill='url(#g)'/>"));
    assert!(nothing.paint.ramp().is_none() && nothing.color() == [0.0, 0.0, 1.0]);
    let nothing = one(&radial("r='0'", "<circle r='5' fill='url(#g)'/>"));
    assert!(nothing.paint.ramp().is_none() && nothing.color() == [0.0, 0.0, 1.0]);
}

#[test]
fn other_gradients_have_their_mean_color_and_are_named() {
    let circle = "<circle r='5' fill='url(#g)'/>";
    let many: String =
        (0..300).map(|k| format!("<stop offset='{}' stop-color='rgb({},0,0)'/>", k as f64 / 299.0, k % 2)).collect();
    for (body, loss) in [
        (
            linear("spreadMethod='reflect'", circle),
            "spreadMethod reflect or repeat: gradient painted in its mean color",
        ),
        (radial("spreadMethod='repeat'", circle), "spreadMethod reflect or repeat: gradient painted in its mean color"),
        (radial("fx='.4'", circle), "radialGradient with fx, fy or fr off its center: painted in its mean color"),
        (radial("fr='.1'", circle), "radialGradient with fx, fy or fr off its center: painted in its mean color"),
        (
            linear("", circle).replace("'#0000ff'", "'#0000ff' stop-opacity='.99'"),
            "stop-opacity that changes along a gradient: painted in its mean color",
        ),
        (
            linear("gradientUnits='userSpaceOnUse' x2='1' gradientTransform='scale(1e6)'", circle),
            "gradient of points too far away: painted in its mean color",
        ),
        (
            format!("<linearGradient id='g'>{many}</linearGradient>{circle}"),
            "gradient of more than 256 stops: painted in its mean color",
        ),
    ] {
        let drawing = read(&body).unwrap();
        assert_eq!(drawing.losses.to_string(), loss, "{body}");
        let object = &drawing.scene.objects[0];
        assert!(object.paint.ramp().is_none() && (0.0..1.0).contains(&object.color()[0]), "{object:?}");
    }
    let mean = read(&linear("spreadMethod='repeat'", circle)).unwrap().scene.objects.remove(0);
    assert_eq!((mean.color(), mean.confidence), ([0.5, 0.0, 0.5], 1.0));
    let clear = linear("", circle).replace("'#0000ff'", "'#0000ff' stop-opacity='0'");
    let clear = read(&clear).unwrap().scene.objects.remove(0);
    assert_eq!((clear.color(), clear.confidence), ([1.0, 0.0, 0.0], 0.5));
}

#[test]
fn a_background_that_changes_stays_before_its_mean() {
    let units = "gradientUnits='userSpaceOnUse' cx='50' cy='50' r='50'";
    let drawing = read(&radial(units, "<rect width='100' height='100' fill='url(#g)'/>")).unwrap();
    let (scene, size) = (drawing.scene, drawing.size);
    assert_eq!((scene.transparent, scene.background, scene.objects.len()), (false, [0.5, 0.0, 0.5], 1));
    assert!(matches!(scene.objects[0].paint.ramp().unwrap().kind, RampKind::Radial(_)));
    // Painted as it is read: pixel centers are half a pixel in.
    let image = Painter::from(RendererName::Exact).paint(&scene, size).unwrap();
    for [x, y] in [[50_usize, 50], [70, 50], [50, 20], [80, 90], [0, 0]] {
        let offset = (x as f64 + 0.5 - 50.0).hypot(y as f64 + 0.5 - 50.0) / 50.0;
        let share = offset.min(1.0);
        let found = [0, 1, 2].map(|channel| image.data()[channel * 10_000 + y * 100 + x]);
        let wrong = found.iter().zip([1.0 - share, 0.0, share]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(wrong < 1e-3, "{x} {y}: {found:?} for {share}");
    }
}

#[test]
fn gradients_of_many_shapes_do_not_fill_the_memory() {
    let stops: String =
        (0..200).map(|k| format!("<stop offset='{}' stop-color='rgb({k},0,0)'/>", k as f64 / 200.0)).collect();
    let body = |count: usize| {
        let shapes = "<circle r='5'/>".repeat(count);
        format!("<linearGradient id='g'>{stops}</linearGradient><g fill='url(#g)'>{shapes}</g>")
    };
    assert!(read(&body(100)).is_ok());
    let error = read(&body(2000)).unwrap_err().to_string();
    assert!(error.contains("stops of gradients"), "{error}");
}
