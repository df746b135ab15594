#![expect(clippy::float_cmp, reason = "numbers are read as they were written")]

use std::path::Path;

use dvp_core::scene::{ColorRamp, ColorStop, Paint, RampKind};
use dvp_core::{ImageSize, Object, Real, Scene};

use super::super::{FormatError, Place};
use super::*;

fn place() -> Place {
    Place::line(Path::new("scenes.jsonl"), 3)
}

fn read(text: &str) -> Result<Scene<f64>, FormatError> {
    SceneJson::parse(text.as_bytes(), &place())?.to_scene(None, &place())
}

/// A scene of one object with these fields.
fn object(fields: &str) -> String {
    format!(r#"{{"version":3,"background":null,"objects":[{{"color":[1,0,0],{fields}}}]}}"#)
}

fn circle(fields: &str) -> String {
    object(&format!(r#""kind":"circle","radius":0.25{fields}"#))
}

fn path(ring: &str) -> String {
    object(&format!(r#""kind":"path","rings":[{ring}]"#))
}

#[test]
fn what_moves_nothing_is_left_out() {
    let text = r#"{"version":3,"width":8,"height":6,"background":[0.1,0.2,0.3],"objects":[{"kind":"circle","radius":0.25,"color":[1.0,0.0,0.0]}],"edge":{"law":"area"},"compositing":"over"}"#;
    let scene: Scene<f32> = SceneJson::parse(text.as_bytes(), &place()).unwrap().to_scene(None, &place()).unwrap();
    let [object] = &scene.objects[..] else { panic!("one object") };
    assert_eq!((object.pose.translation, object.pose.scale, object.pose.rotation), ([0.0; 2], 1.0, 0.0));
    assert_eq!(object.confidence, 1.0);
    let again = SceneJson::from_scene(&scene, ImageSize::new(8, 6).unwrap()).unwrap();
    assert_eq!(again.to_line(&place()).unwrap(), text);
}

#[test]
fn a_transparent_scene_keeps_its_matte() {
    let scene = read(r#"{"version":3,"background":null,"matte":[0,0.5,1],"objects":[]}"#).unwrap();
    assert!(scene.transparent && scene.background == [0.0, 0.5, 1.0]);
    let text = SceneJson::from_scene(&scene, ImageSize::new(1, 1).unwrap()).unwrap().to_line(&place()).unwrap();
    assert!(text.contains(r#""background":null,"matte":[0.0,0.5,1.0]"#), "{text}");
    assert_eq!(read(&circle("")).unwrap().background, [1.0; 3]);
}

#[test]
fn earlier_versions_become_version_3() {
    let text = r#"{"background":[0,0,0],"objects":[{"translation":[0.5,0.5],"scale":1,"rotation_vec":[1,0],"color":[1,1,1],"shape":2}]}"#;
    let json = SceneJson::parse(text.as_bytes(), &place()).unwrap();
    assert_eq!(json.version, 3);
    assert_eq!(json.objects[0].shape, ShapeJson::Prototype { prototype: 2, efd: None, symmetry: None });
    assert_eq!(json.objects[0].rotation, core::f64::consts::FRAC_PI_2);
}

const LINEAR: &str = r#"{"kind":"linear","points":[[-0.25,0.0],[0.25,0.1]],"stops":[{"offset":-0.5,"color":[0.1,0.2,0.3]},{"offset":0.5,"color":[0.2,0.2,0.3]},{"offset":0.5,"color":[0.6,0.5,0.4]}]}"#;
const RADIAL: &str = r#"{"kind":"radial","points":[[0.1,0.2],[0.35,0.2],[0.1,0.7]],"stops":[{"offset":0.0,"color":[0.1,0.2,0.3]},{"offset":1.0,"color":[0.5,0.2,0.3]}]}"#;

fn assert_ramps_come_back<T: Real>() {
    let of = |value: f64| T::of(value);
    let points = [[-0.25, 0.0], [0.25, 0.1], [0.1, 0.7]].map(|point| point.map(of));
    let stop = |offset: f64, color: [f64; 3]| ColorStop { offset: of(offset), color: color.map(of) };
    let linear = ColorRamp {
        kind: RampKind::Linear([points[0], points[1]]),
        stops: vec![stop(-0.5, [0.1, 0.2, 0.3]), stop(0.5, [0.2, 0.2, 0.3]), stop(0.5, [0.6, 0.5, 0.4])],
    };
    let thirds = [1.0 / 3.0, 0.0, 1.0];
    let radial = ColorRamp { kind: RampKind::Radial(points), stops: vec![stop(thirds[0], thirds)] };
    let text = circle(&format!(r#","ramp":{LINEAR}"#));
    let size = ImageSize::new(8, 6).unwrap();
    let mut scene: Scene<T> = SceneJson::parse(text.as_bytes(), &place()).unwrap().to_scene(None, &place()).unwrap();
    assert_eq!(scene.objects[0].paint, Paint::Ramp(linear));
    let written = SceneJson::from_scene(&scene, size).unwrap().to_line(&place()).unwrap();
    assert!(written.contains(LINEAR), "{written}");
    scene.objects.push(Object { paint: Paint::Ramp(radial), ..scene.objects[0].clone() });
    let json = SceneJson::from_scene(&scene, size).unwrap();
    assert_eq!(json.objects[1].color.map(T::of), scene.objects[1].color());
    let text = json.to_line(&place()).unwrap();
    let again = SceneJson::parse(text.as_bytes(), &place()).unwrap();
    assert_eq!(again, json);
    assert_eq!(again.to_scene::<T>(None, &place()).unwrap(), scene, "{text}");
}

#[test]
fn ramps_come_back_exactly() {
    assert_ramps_come_back::<f32>();
    assert_ramps_come_back::<f64>();
    // Colors are clamped as others are.
    let mut scene = read(&circle(&format!(r#","ramp":{RADIAL}"#))).unwrap();
    scene.objects[0].paint.colors_mut().for_each(|color| color[2] = 1.0 + 1e-12);
    let json = SceneJson::from_scene(&scene, ImageSize::new(1, 1).unwrap()).unwrap();
    assert!(json.objects[0].ramp.as_ref().unwrap().stops.iter().all(|stop| stop.color[2] == 1.0));
}

#[test]
fn broken_ramps_are_refused() {
    let one = r#"{"offset":0,"color":[0,0,0]}"#;
    let stops = |stops: &str| format!(r#"{{"kind":"linear","points":[[0,0],[1,0]],"stops":[{stops}]}}"#);
    let points = |kind: &str, points: &str| format!(r#"{{"kind":"{kind}","points":[{points}],"stops":[{one}]}}"#);
    for (ramp, parts) in [
        (stops(""), ["objects[0].ramp.stops has 0 stops", "must have 1 to 256", "line 3"]),
        (stops(&vec![one; 257].join(",")), ["objects[0].ramp.stops has 257 stops", "must have 1 to 256", "line 3"]),
        (
            stops(r#"{"offset":0.5,"color":[0,0,0]},{"offset":0.25,"color":[0,0,0]}"#),
            ["objects[0].ramp.stops[1].offset is 0.25", "at least 0.5", "the stop before"],
        ),
        (
            stops(r#"{"offset":1e9,"color":[0,0,0]}"#),
            ["objects[0].ramp.stops[0].offset is 1000000000", "from -1000000", "to 1000000"],
        ),
        (stops(r#"{"offset":0,"color":[0,2,0]}"#), ["objects[0].ramp.stops[0].color is 2", "from 0", "to 1"]),
        (stops(r#"{"offset":0,"color":[0,0]}"#), ["invalid length 2", "array of length 3", "not a scene"]),
        (stops(r#"{"color":[0,0,0]}"#), ["missing field `offset`", "not a scene", "line 1"]),
        (stops(r#"{"offset":0,"color":[0,0,0],"opacity":1}"#), ["unknown field `opacity`", "offset", "line 1"]),
        (stops("[0,[0,0,0]]"), ["invalid type: sequence", "a JSON object", "line 1"]),
        (points("linear", "[0,0]"), ["objects[0].ramp.points has 1 points", "must have 2", "linear"]),
        (points("linear", "[0,0],[1,0],[0,1]"), ["objects[0].ramp.points has 3 points", "must have 2", "linear"]),
        (points("radial", "[0,0],[1,0]"), ["objects[0].ramp.points has 2 points", "must have 3", "radial"]),
        (points("linear", "[0,0],[1,1e4]"), ["objects[0].ramp.points[1] is 10000", "from -1000", "to 1000"]),
        (points("conic", "[0,0],[1,0]"), ["unknown variant `conic`", "`linear`", "`radial`"]),
        (LINEAR.replace(r#""stops""#, r#""spread":1,"stops""#), ["unknown field `spread`", "points", "line 1"]),
        ("null".to_owned(), ["invalid type: null", "a JSON object", "line 1"]),
    ] {
        let error = read(&circle(&format!(r#","ramp":{ramp}"#))).unwrap_err().to_string();
        for part in parts {
            assert!(error.contains(part), "{ramp} gives '{error}', which lacks '{part}'");
        }
    }
    let most = stops(&vec![one; 256].join(","));
    assert!(read(&circle(&format!(r#","ramp":{most}"#))).is_ok());
    // The one color must be there, and be one.
    let text = circle(&format!(r#","ramp":{LINEAR}"#)).replace("[1,0,0]", "[2,0,0]");
    assert!(read(&text).unwrap_err().to_string().contains("objects[0].color is 2"));
}

#[test]
fn errors_name_the_field_the_value_and_what_it_must_be() {
    let (ring, line) = (r#"{"points":[[0,0],[1,0],[0,1]],"segments":"#, r#"{"kind":"line"}"#);
    for (text, parts) in [
        (circle(r#","wings":2"#), ["unknown field `wings`", "radius", "line 1 column"]),
        (circle(r#","sides":5"#), ["unknown field `sides`", "radius", "not a scene"]),
        (circle(r#","radius":2"#), ["duplicate field `radius`", "not a scene", "line 1"]),
        (object(r#""radius":2"#), ["missing field `kind`", "not a scene", "line 1"]),
        (object(r#""kind":"blob""#), ["unknown variant `blob`", "`circle`", "`prototype`"]),
        (object(r#""kind":"circle","radius":"wide""#), ["invalid type: string \"wide\"", "f64", "line 1"]),
        (object(r#""kind":"circle","radius":-2"#), ["objects[0].radius is -2", "above 0", "at most 1000"]),
        (object(r#""kind":"ellipse","radii":[1,0]"#), ["objects[0].radii[1] is 0", "above 0", "at most 1000"]),
        (object(r#""kind":"rectangle","size":[1,1],"corner_radius":-1"#), ["objects[0].corner_radius", "-1", "from 0"]),
        (object(r#""kind":"regular_polygon","sides":2,"radius":1"#), ["objects[0].sides is 2", "from 3", "4096"]),
        (object(r#""kind":"star","points":5000,"radius":1,"inner_radius":1"#), ["objects[0].points", "5000", "4096"]),
        (object(r#""kind":"polygon","rings":[[[0,0],[1,1]]]"#), ["objects[0].rings[0]", "has 2 corners", "at least 3"]),
        (object(r#""kind":"polygon","rings":[]"#), ["objects[0].rings", "has 0 rings", "at least 1"]),
        (
            object(r#""kind":"polygon","rings":[[[0,0],[1,1],[0,1e9]]]"#),
            ["objects[0].rings[0][2] is 1000000000", "from -1000", "to 1000"],
        ),
        (
            path(&format!(r#"{ring}[{{"kind":"line"}}]}}"#)),
            ["objects[0].rings[0].segments has 1", "must have 3", "2 in an open"],
        ),
        (
            path(&format!(r#"{ring}[{{"kind":"line"}},{{"kind":"arc","bulge":1e9}}]}}"#)),
            ["objects[0].rings[0].segments[1].bulge is 1000000000", "from", "to"],
        ),
        (
            path(&format!(r#"{ring}[{{"kind":"smooth_arc"}},{{"kind":"line"}}]}}"#)),
            ["objects[0].rings[0] is no ring", "smooth", "direction"],
        ),
        (
            path(&format!(r#"{ring}[{{"kind":"line","bulge":1}}]}}"#)),
            ["unknown field `bulge`", "not a scene", "line 1"],
        ),
        (
            object(&format!(
                r#""kind":"stroke","width":0.1,"cap":"butt","join":"round","miter_limit":2,"rings":[{ring}[{line},{line}]}}]"#
            )),
            ["objects[0].miter_limit is for", "join \"miter\"", "line 3"],
        ),
        (
            object(&format!(
                r#""kind":"stroke","width":0,"cap":"butt","join":"round","rings":[{ring}[{line},{line}]}}]"#
            )),
            ["objects[0].width is 0", "above 0", "line 3"],
        ),
        (
            object(&format!(
                r#""kind":"stroke","width":1,"cap":"flat","join":"round","rings":[{ring}[{line},{line}]}}]"#
            )),
            ["unknown variant `flat`", "`square`", "line 1"],
        ),
        (path("[[[0,0],[1,1]],[]]"), ["invalid type: sequence", "a JSON object", "line 1"]),
        (object(r#""kind":"prototype","prototype":1"#), ["objects[0].efd is missing", "prototype 1", "--bank"]),
        (circle(r#","known":null"#), ["invalid type: null", "a JSON object", "line 1"]),
        (
            circle(r#","known":{"deviations":{"numbers":{"radios":1}}}"#),
            ["objects[0].known.deviations.numbers", "\"radios\"", "no number of this circle"],
        ),
        (
            circle(r#","known":{"deviations":{"scale":-1}}"#),
            ["objects[0].known.deviations.scale is -1", "at least 0", "line 3"],
        ),
        (
            circle(r#","known":{"doubts":[{"kind":"merged","other":1,"visible":0.5}]}"#),
            ["objects[0].known.doubts[0].other is 1", "index", "1 objects"],
        ),
        (
            circle(r#","known":{"doubts":[{"kind":"twin","prototype":1,"ratio":0.5}]}"#),
            ["objects[0].known.doubts[0].ratio is 0.5", "at least 1", "line 3"],
        ),
        (
            r#"{"version":3,"background":[0,0,0],"matte":[0,0,0],"objects":[]}"#.to_owned(),
            ["matte is for transparent", "background is null", "line 3"],
        ),
        (r#"{"version":3,"objects":[]}"#.to_owned(), ["missing field `background`", "not a scene", "line 1"]),
        (
            r#"{"version":3,"background":null,"objects":[],"known":{"stop":"empty","doubts":["why"]}}"#.to_owned(),
            ["known.doubts[0] is \"why\"", "must be one of", "faint"],
        ),
    ] {
        let error = read(&text).unwrap_err().to_string();
        for part in parts {
            assert!(error.contains(part), "{text} gives '{error}', which lacks '{part}'");
        }
    }
}

#[test]
fn scenes_that_would_fill_the_memory_are_refused() {
    let objects = |one: &str, count: usize| {
        let objects = vec![format!("{{\"color\":[0,0,0],{one}}}"); count].join(",");
        format!(r#"{{"version":3,"background":null,"objects":[{objects}]}}"#)
    };
    let star = r#""kind":"star","points":4096,"radius":1,"inner_radius":0.5"#;
    let arcs = vec![r#"{"kind":"arc","bulge":1}"#; 1000].join(",");
    let points = vec!["[0,0]"; 1000].join(",");
    let path = format!(r#""kind":"path","rings":[{{"points":[{points}],"segments":[{arcs}]}}]"#);
    let lines = vec![r#"{"kind":"line"}"#; 999].join(",");
    let stroke = |cap: &str, join: &str| {
        let ring = format!(r#"{{"points":[{points}],"segments":[{lines}]}}"#);
        format!(r#""kind":"stroke","rings":[{ring}],"width":1,"cap":"{cap}","join":"{join}""#)
    };
    for (text, part) in [
        (objects(r#""kind":"circle","radius":1"#, 10_001), "has 10001 objects, at most 10000"),
        // 2 x 4096 corners each.
        (objects(star, 123), "has 1007616 points, at most 1000000"),
        (objects(&path, 101), "has 101000 curves, at most 100000"),
        (objects(&stroke("round", "bevel"), 101), "has 101000 curves, at most 100000"),
        (objects(&stroke("butt", "round"), 101), "has 101000 curves, at most 100000"),
    ] {
        let error = read(&text).unwrap_err().to_string();
        assert!(error.contains(part), "'{error}' lacks '{part}'");
    }
    assert_eq!(read(&objects(star, 122)).unwrap().objects.len(), 122);
    assert_eq!(read(&objects(&stroke("square", "bevel"), 101)).unwrap().objects.len(), 101);
}
