use std::path::Path;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Efd, Image, ImageSize, Object, Pose, Scene};

use super::*;

fn scene() -> Scene<f32> {
    let pose = Pose { translation: [0.25, 0.75], scale: 0.2, rotation: -1.5 };
    let efd = Efd::new(vec![[1.0, 0.0, 0.0, -0.5], [0.01, 0.02, -0.03, 1e-7]]);
    Scene {
        background: [0.1, 0.2, 0.3],
        transparent: false,
        objects: vec![Object::of_efd(pose, [1.0, 0.0, 0.7], 1.0, efd, None)],
        edge: EdgeProfile::reference(),
        compositing: Compositing::Over,
    }
}

fn parse(text: &str) -> Result<Scene<f64>, FormatError> {
    let place = Place::line(Path::new("scenes.jsonl"), 3);
    SceneJson::parse(text.as_bytes(), &place)?.to_scene(Some(&mdshr_bank()), &place)
}

fn object_with(fields: &str) -> String {
    format!(r#"{{"background":[0,0,0],"objects":[{{"translation":[0.5,0.5],"color":[1,1,1],{fields}}}]}}"#)
}

fn with_edge(edge: &str) -> String {
    format!(r#"{{"background":[0,0,0],"objects":[],"edge":{edge}}}"#)
}

#[test]
fn a_scene_comes_back_bit_for_bit() {
    let place = Place::file(Path::new("a.json"));
    let size = ImageSize::new(64, 48).unwrap();
    let text = SceneJson::from_scene(&scene(), size).unwrap().to_line(&place).unwrap();
    assert!(text.contains("\"background\":[0.1,0.2,0.3]"), "short decimals: {text}");
    assert!(!text.contains("cut"), "the default cut is left out: {text}");
    let back = SceneJson::parse(text.as_bytes(), &place).unwrap();
    assert_eq!(back.size(&place).unwrap(), Some(size));
    assert_eq!(back.to_scene::<f32>(None, &place).unwrap(), scene());
}

#[test]
fn every_edge_comes_back() {
    let place = Place::file(Path::new("a.json"));
    let size = ImageSize::new(64, 48).unwrap();
    let thin = EdgeProfile { offset: 0.01, sigma: 0.125, cut: 0.5, ..EdgeProfile::distance(1.0) };
    for (edge, text) in [
        (EdgeProfile::reference(), r#""edge":{"offset":0.0005,"sigma":0.0001}"#),
        (EdgeProfile::area(), r#""edge":{"law":"area"}"#),
        (EdgeProfile::distance(0.125_f32), r#""edge":{"law":"distance","offset":0.0,"sigma":0.125}"#),
        (thin, r#""edge":{"law":"distance","offset":0.01,"sigma":0.125,"cut":0.5}"#),
    ] {
        let written = SceneJson::from_scene(&Scene { edge, ..scene() }, size).unwrap().to_line(&place).unwrap();
        assert!(written.contains(text), "{written}");
        let back: Scene<f32> = SceneJson::parse(written.as_bytes(), &place).unwrap().to_scene(None, &place).unwrap();
        assert_eq!(back.edge, edge);
    }
}

#[test]
fn published_lines_are_read() {
    // sin = 0.6, cos = -0.8; shape 2 of the built-in bank is the ellipse, d_1 = -0.5.
    let scene = parse(&object_with(r#""scale":0.2,"rotation_vec":[0.6,-0.8],"confidence":1.0,"shape":2"#)).unwrap();
    let object = &scene.objects[0];
    assert!((object.pose.rotation - 0.6f64.atan2(-0.8)).abs() < 1e-15);
    assert_eq!(object.prototype(), Some(2));
    assert!((object.efd_rows()[0][3] + 0.5).abs() < 1e-12);
    assert_eq!(scene.edge, EdgeProfile::reference());
}

#[test]
fn errors_name_line_field_and_remedy() {
    let efd = r#""efd":[[1,0,0,-1]]"#;
    for (text, parts) in [
        (object_with(&format!(r#""scale":-1,"rotation":0,{efd}"#)), ["line 3", "objects[0].scale is -1", "above 0"]),
        (object_with(&format!(r#""scale":1,{efd}"#)), ["line 3", "objects[0].rotation", "either"]),
        (object_with(r#""scale":1,"rotation":0,"efd":[]"#), ["line 3", "objects[0].efd has 0 rows", "1 to"]),
        (object_with(r#""scale":1,"rotation":0,"efd":[[1,0,0]]"#), ["line 3", "not a scene", "length 3"]),
        (object_with(r#""scale":1,"rotation":0,"prototype":7"#), ["line 3", "objects[0].efd", "only 3 prototypes"]),
        (object_with(r#""scale":1,"rotation":0,"rotation_vec":[0,1]"#), ["line 3", "rotation", "either"]),
        (object_with(&format!(r#""scale":1,"rotation":0,"wings":2,{efd}"#)), ["line 3", "unknown field", "wings"]),
        (object_with(&format!(r#""scale":NaN,"rotation":0,{efd}"#)), ["line 3", "not a scene", "column"]),
        (object_with(&format!(r#""scale":1e999,"rotation":0,{efd}"#)), ["line 3", "not a scene", "out of range"]),
        (r#"{"version":4,"what":1}"#.to_owned(), ["line 3", "format version 4", "newer dvp"]),
        (with_edge(r#"{"law":"area","sigma":1}"#), ["line 3", "edge.law", "has no offset"]),
        (with_edge(r#"{"law":"distance","sigma":1}"#), ["line 3", "edge needs offset", "area"]),
        (with_edge(r#"{"law":"cubed","offset":0,"sigma":1}"#), ["line 3", "unknown variant", "squared_distance"]),
        (with_edge(r#"{"law":"distance","offset":0,"sigma":-1}"#), ["line 3", "edge.sigma is -1", "above 0"]),
        (r#"{"background":[0,0,2],"objects":[]}"#.to_owned(), ["line 3", "background is 2", "from 0 to 1"]),
        ("{}".to_owned(), ["line 3", "not a scene", "missing field"]),
        ("[1, 2".to_owned(), ["line 3", "not a scene", "column"]),
    ] {
        let error = parse(&text).unwrap_err().to_string();
        for part in parts {
            assert!(error.contains(part), "{text} gives '{error}', which lacks '{part}'");
        }
    }
}

#[test]
fn the_built_in_bank_survives_its_own_text() {
    let bank = mdshr_bank::<f64>();
    let names: Vec<&str> = bank.prototypes.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["heart", "square", "ellipse"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bank.json");
    write_atomic(&path, bank_to_json(&bank).as_bytes()).unwrap();
    assert!(read_bank::<f64>(&path).unwrap() == bank, "a number changed on the way");
}

#[test]
fn both_bank_layouts_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bank.json");
    for text in [
        r#"{"version":1,"prototypes":[{"name":"disk","efd":[[1,0,0,-1]]}]}"#,
        r#"{"order":["disk"],"layout":"rows","disk":[[1,0,0,-1]]}"#,
    ] {
        write_atomic(&path, text.as_bytes()).unwrap();
        let bank = read_bank::<f32>(&path).unwrap();
        assert_eq!(bank.prototypes, [("disk".to_owned(), Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]))]);
    }
}

#[test]
fn png_keeps_eight_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let size = ImageSize::new(16, 16).unwrap();
    let values: Vec<f32> = (0..768).map(|i| f32::from(u8::try_from(i % 256).unwrap()) / 255.0).collect();
    let image = Image::from_planar(size, values).unwrap();
    write_atomic(&path, &encode_png(image.view(), BitDepth::Eight).unwrap()).unwrap();
    let back: Picture<f32> = read_picture(&path, 256).unwrap();
    assert_eq!(back, Picture::from(image).with_bits(BitDepth::Eight));
    let error = read_picture::<f32>(&path, 255).unwrap_err().to_string();
    assert!(error.contains("16 x 16") && error.contains("--max-pixels"), "{error}");
}

fn npy(header: &str, data: &[u8]) -> Vec<u8> {
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(data);
    file
}

#[test]
fn numpy_arrays_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.npy");
    let floats: Vec<u8> = (0_u8..12).flat_map(|i| (f32::from(i) / 16.0).to_le_bytes()).collect();
    let header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1, 2, 3), }\n";
    write_atomic(&path, &npy(header, &floats)).unwrap();
    let images = read_npy::<f64>(&path, 2).unwrap();
    assert_eq!(images.len(), 2);
    // The second image holds 6/16 .. 11/16, pixel by pixel.
    assert_eq!(
        images[1].view().pixel(1).map(|value| value * 16.0).map(f64::to_bits),
        [9.0, 10.0, 11.0].map(f64::to_bits)
    );
    for (header, data, part) in [
        (header, &floats[..40], "truncated"),
        ("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 1, 2, 3), }", &floats[..], "C order"),
        ("{'descr': '<f4', 'fortran_order': False, 'shape': (12,), }", &floats[..], "(12,)"),
        ("{'descr': '>f4', 'fortran_order': False, 'shape': (2, 1, 2, 3), }", &floats[..], "descr is >f4"),
        ("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3, 3), }", &floats[..], "3 x 1 pixels"),
        ("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 3), }", &[0xff; 24][..], "NaN"),
        ("what", &floats[..], "descr"),
    ] {
        write_atomic(&path, &npy(header, data)).unwrap();
        let error = read_npy::<f64>(&path, 2).unwrap_err().to_string();
        assert!(error.contains(part), "{header}: '{error}' lacks '{part}'");
    }
    write_atomic(&path, b"PK\x03\x04 is a zip archive").unwrap();
    assert!(read_npy::<f64>(&path, 2).unwrap_err().to_string().contains("not that of a NumPy array"));
}
