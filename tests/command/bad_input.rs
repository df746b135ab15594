//! Bad files end in a sentence that names them; the other files are done.

use std::fs;
use std::path::Path;

use crate::runner::{dvp, dvp_done, names, text};

/// A PNG whose header announces 40 000 x 40 000 pixels and which ends soon after.
fn bomb() -> Vec<u8> {
    let mut png = b"\x89PNG\r\n\x1a\n\x00\x00\x00\x0dIHDR".to_vec();
    png.extend(40_000u32.to_be_bytes().repeat(2));
    png.extend([8, 2, 0, 0, 0]);
    let checksum = png[12..].iter().fold(u32::MAX, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    });
    png.extend((!checksum).to_be_bytes());
    png.extend(b"\x00\x00\x00\x01IDAT\x00\x00\x00\x00\x00");
    png
}

fn good_picture(folder: &Path) -> Vec<u8> {
    let data = folder.join("data");
    dvp_done(["generate", "--count", "1", "--width", "48", "--out", text(&data)]);
    fs::read(data.join("00000.png")).unwrap()
}

#[test]
fn bad_pictures_are_reported_and_the_others_fitted() {
    let folder = tempfile::tempdir().unwrap();
    let [pictures, out] = ["pictures", "out"].map(|name| folder.path().join(name));
    fs::create_dir(&pictures).unwrap();
    let good = good_picture(folder.path());
    let write = |name: &str, bytes: &[u8]| fs::write(pictures.join(name), bytes).unwrap();
    write("good.png", &good);
    write("late.png", &good);
    write("bomb.png", &bomb());
    write("empty.png", b"");
    write("truncated.png", &good[..good.len() / 2]);
    write("words.png", b"these are words, not pixels");
    write("zero.ppm", b"P6\n0 0\n255\n");
    write("notes.txt", b"no picture: not even tried");
    let run = dvp(["fit", text(&pictures), "--out", text(&out)]);
    assert_eq!(run.code, 1);
    let complaints: Vec<&str> = run.err.lines().collect();
    assert_eq!(complaints.len(), 5, "{}", run.err);
    for (name, part) in [
        ("bomb.png", "40000 x 40000 pixels"),
        ("empty.png", "not a readable image"),
        ("truncated.png", "not a readable image"),
        ("words.png", "not a readable image"),
        ("zero.ppm", ""),
    ] {
        let found = complaints.iter().any(|line| line.contains(name) && line.contains(part));
        assert!(found, "no line with '{name}' and '{part}': {}", run.err);
    }
    // Each cause once, although errors both tell and hand on what caused them.
    let words = complaints.iter().find(|line| line.contains("words.png")).unwrap();
    assert_eq!(words.matches("signature").count(), 1, "{words}");
    let results = ["good.json", "good.png", "good.svg", "late.json", "late.png", "late.svg"];
    assert_eq!(names(&out), results);
}

#[test]
fn pictures_above_the_limit_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    good_picture(folder.path());
    let picture = folder.path().join("data/00000.png");
    let run = dvp(["fit", text(&picture), "--out", text(&out), "--max-pixels", "1000"]);
    assert!(run.code == 1 && run.err.contains("48 x 48") && run.err.contains("--max-pixels"), "{}", run.err);
    assert!(names(&out).is_empty());
}

#[test]
fn missing_inputs_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let out = text(folder.path());
    for input in ["nowhere.png", "nowhere/*.png", out] {
        let run = dvp(["fit", input, "--out", out]);
        assert!(run.code == 1 && run.err.contains(input), "{input}: {}", run.err);
    }
    for arguments in [["evaluate", "nowhere", out], ["evaluate", out, "nowhere"], ["evaluate", out, out]] {
        let run = dvp(arguments);
        assert!(run.code == 1 && run.err.starts_with("error: "), "{arguments:?}: {}", run.err);
    }
}

#[test]
fn bad_scenes_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let [scene, png] = ["scene.json", "out.png"].map(|name| folder.path().join(name));
    let object = r#"{"translation":[0.5,0.5],"scale":0.2,"rotation":0,"color":[1,1,1],"efd":[[1,0,0,-1]]}"#;
    let with = |from: &str, to: &str| {
        assert!(object.contains(from));
        format!(r#"{{"background":[0,0,0],"objects":[{}]}}"#, object.replace(from, to))
    };
    for (content, part) in [
        ("".to_owned(), "not a scene"),
        ("[1, 2, 3]".to_owned(), "not a scene"),
        (r#"{"type":"FeatureCollection","features":[]}"#.to_owned(), "unknown field `type`"),
        (with("0.2", "NaN"), "not a scene"),
        (with("0.2", "1e400"), "not a scene"),
        (with("0.2", "-0.2"), "objects[0].scale is -0.2"),
        (with("[0.5,0.5]", "[0.5]"), "not a scene"),
        (with("[0.5,0.5]", "[1e30,0.5]"), "objects[0].translation"),
        (with("[1,1,1]", "[1,1,2]"), "objects[0].color is 2"),
        (with("[[1,0,0,-1]]", "[]"), "objects[0].efd has 0 rows"),
        (with("\"efd\"", "\"wings\""), "unknown field `wings`"),
    ] {
        fs::write(&scene, &content).unwrap();
        let run = dvp(["render", text(&scene), "-o", text(&png)]);
        assert_eq!(run.code, 1, "{content}");
        assert!(run.err.contains("scene.json") && run.err.contains(part), "{content}: '{}' lacks '{part}'", run.err);
        assert_eq!(names(folder.path()), ["scene.json"]);
    }
}

#[test]
fn wrong_usage_is_code_2_and_help_opens_with_an_example() {
    assert_eq!(dvp(["fit"]).code, 2);
    assert_eq!(dvp(["fly"]).code, 2);
    for command in ["generate", "render", "fit", "evaluate"] {
        let help = dvp_done([command, "--help"]);
        assert!(help.starts_with(&format!("Example: dvp {command} ")), "{help}");
    }
}
