//! What `dvp fit` writes beside scenes: measurements, masks and files for other programs; and the outlines of label maps.

use alloc::collections::BTreeSet;
use std::fs;
use std::path::Path;

use dvp::format::read_scene;
use image::{ImageBuffer, Luma, Rgb, RgbImage, Rgba, RgbaImage};
use serde_json::Value;

use crate::runner::{dvp, dvp_done, names, text};

const PAPER: Rgb<u8> = Rgb([240, 240, 235]);
const RED: Rgb<u8> = Rgb([200, 40, 30]);
const BLUE: Rgb<u8> = Rgb([30, 60, 170]);

/// Upright boxes on 64 x 48 pixels of paper: left, top, right, bottom, color.
fn boxes(boxes: &[([u32; 4], Rgb<u8>)]) -> RgbImage {
    RgbImage::from_fn(64, 48, |x, y| {
        let inside = |&&([left, top, right, bottom], _): &&([u32; 4], _)| {
            (left..right).contains(&x) && (top..bottom).contains(&y)
        };
        boxes.iter().rev().find(inside).map_or(PAPER, |&(_, color)| color)
    })
}

/// A red box of 18 x 20 pixels and a blue one of 20 x 12, apart.
fn picture() -> RgbImage {
    boxes(&[([6, 8, 24, 28], RED), ([36, 26, 56, 38], BLUE)])
}

/// The label map of [`picture`]: what is red is 7, what is blue is 300.
fn labels() -> ImageBuffer<Luma<u16>, Vec<u16>> {
    let picture = picture();
    ImageBuffer::from_fn(64, 48, |x, y| match *picture.get_pixel(x, y) {
        RED => Luma([7]),
        BLUE => Luma([300]),
        _ => Luma([0]),
    })
}

/// A table as its rows, each a list of (name of the column, cell). Only the last cell, the error, may hold a comma here; it is cut
/// there.
fn rows(path: &Path) -> Vec<Vec<(String, String)>> {
    let table = fs::read_to_string(path).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').map(str::to_owned));
    let head: Vec<String> = lines.next().unwrap().collect();
    lines.map(|cells| head.iter().cloned().zip(cells).collect()).collect()
}

fn cell<'a>(row: &'a [(String, String)], name: &str) -> &'a str {
    &row.iter().find(|(own, _)| own == name).unwrap().1
}

fn number(row: &[(String, String)], name: &str) -> f64 {
    cell(row, name).parse().unwrap_or_else(|_| panic!("{name}: {:?}", cell(row, name)))
}

/// A TIFF of one gray channel of 32 bits, which no encoder at hand writes: the head, the pixels, the list of what they are.
fn tiff_of_32_bits([width, height]: [u32; 2], values: &[u32]) -> Vec<u8> {
    let mut bytes = b"II*\0".to_vec();
    let size = 4 * width * height;
    bytes.extend((8 + size).to_le_bytes());
    values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    // Width, height, bits, no compression, black is zero, where the one strip is, channels, its rows, its bytes.
    let tags: [(u16, u32); 9] =
        [(256, width), (257, height), (258, 32), (259, 1), (262, 1), (273, 8), (277, 1), (278, height), (279, size)];
    bytes.extend([9, 0]);
    for (tag, value) in tags {
        // One number of 32 bits each.
        bytes.extend(tag.to_le_bytes().into_iter().chain([4, 0, 1, 0, 0, 0]).chain(value.to_le_bytes()));
    }
    bytes.extend([0; 4]);
    bytes
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn one_run_writes_every_file_and_all_of_them_agree() {
    let folder = tempfile::tempdir().unwrap();
    let [path, out, table, parquet, efd, nef, coco] =
        ["boxes.png", "out", "objects.csv", "objects.parquet", "shapes.csv", "shapes.nef", "coco.json"]
            .map(|name| folder.path().join(name));
    picture().save(&path).unwrap();
    let every = ["--scale", "0.5mm/px", "--harmonics", "8", "--labels", "--whole", "--roi", "--geojson"];
    let files = ["--table", text(&table), "--efd", text(&efd), "--coco", text(&coco)];
    dvp_done(["fit", text(&path), "--out", text(&out), "--compositing", "over"].into_iter().chain(every).chain(files));
    let written = ["geojson", "json", "labels.png", "png", "rois.zip", "svg", "whole.png"];
    assert_eq!(names(&out), written.map(|ending| format!("boxes.{ending}")));

    let rows = rows(&table);
    assert_eq!(rows.len(), 2);
    let labels = image::open(out.join("boxes.labels.png")).unwrap().into_luma8();
    let whole = image::open(out.join("boxes.whole.png")).unwrap().into_luma8();
    assert_eq!((whole.dimensions(), labels.dimensions()), ((128, 48), (64, 48)));
    for (k, row) in (0_u8..).zip(&rows) {
        assert_eq!((cell(row, "picture"), cell(row, "object")), (text(&path), &*(k + 1).to_string()));
        let area = if cell(row, "color") == "#c8281e" { 18.0 * 20.0 } else { 20.0 * 12.0 };
        let close = |found: f64| (found / area - 1.0).abs() < 0.02;
        assert!(close(number(row, "area_px2")) && close(4.0 * number(row, "area_mm2")), "{row:?}");
        let seen = labels.pixels().filter(|pixel| pixel.0 == [k + 1]).count();
        assert!(close(seen as f64), "{seen} pixels of {area}");
        let tile = u32::from(k) * 64..u32::from(k + 1) * 64;
        let covered =
            whole.enumerate_pixels().filter(|(x, ..)| tile.contains(x)).map(|(.., pixel)| f64::from(pixel.0[0]));
        assert!(close(covered.sum::<f64>() / 255.0));
        // Lengths share the deviation of the scale, areas have twice as much.
        let relative =
            |name: &str, unit: &str| number(row, &format!("{name}_sd_{unit}")) / number(row, &format!("{name}_{unit}"));
        let half = 0.5 * relative("area", "px2");
        assert!(half > 0.0, "{row:?}");
        for name in ["perimeter", "major_axis", "minor_axis"] {
            assert!(
                ["px", "mm"].iter().all(|unit| (relative(name, unit) / half - 1.0).abs() < 1e-6),
                "{name}: {row:?}"
            );
        }
    }
    let features = &json(&out.join("boxes.geojson"))["features"];
    assert_eq!(features.as_array().unwrap().len(), 2);
    let coco = json(&coco);
    assert_eq!((&coco["images"][0]["width"], coco["annotations"].as_array().unwrap().len()), (&64.into(), 2));
    // Two objects of 8 harmonics, and the names of the columns.
    assert_eq!(fs::read_to_string(&efd).unwrap().lines().count(), 17);
    assert!(fs::read(out.join("boxes.rois.zip")).unwrap().starts_with(b"PK"));

    // The other formats of the files of a run.
    let files = ["--table", text(&parquet), "--efd", text(&nef), "--no-svg", "--no-png"];
    dvp_done(["fit", text(&path), "--out", text(&out)].into_iter().chain(files));
    assert!(fs::read(&parquet).unwrap().starts_with(b"PAR1"));
    assert!(fs::read_to_string(&nef).unwrap().contains("\nboxes_2\n"));
}

#[test]
fn masks_keep_their_labels_and_take_the_colors_and_the_name_of_their_picture() {
    let folder = tempfile::tempdir().unwrap();
    let [map, path, out, table, coco] =
        ["map.tif", "photo.png", "out", "objects.csv", "coco.json"].map(|name| folder.path().join(name));
    labels().save(&map).unwrap();
    picture().save(&path).unwrap();
    let files = ["--table", text(&table), "--coco", text(&coco), "--labels", "--geojson"];
    dvp_done(["fit", "--masks", text(&map), text(&path), "--out", text(&out)].into_iter().chain(files));
    let rows = rows(&table);
    let told = |name| rows.iter().map(|row| cell(row, name)).collect::<Vec<_>>();
    assert_eq!((told("object"), told("color")), (vec!["7", "300"], vec!["#c8281e", "#1e3caa"]));
    assert_eq!((told("picture"), told("stem")), (vec![text(&path); 2], vec!["map"; 2]));
    assert!(json(&coco)["images"][0]["file_name"].as_str().unwrap().ends_with("photo.png"));
    assert_eq!(read_scene(&out.join("map.json")).unwrap().objects.len(), 2);
    let written = image::open(out.join("map.labels.png")).unwrap().into_luma16();
    let off = written.pixels().zip(labels().pixels()).filter(|(a, b)| a != b).count();
    assert!(off <= 8, "{off} pixels differ: no more than the corners may");
}

#[test]
fn masks_pair_with_the_picture_of_their_name_only() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let at = |name: &str| folder.path().join(name);
    for name in ["cell1_mask.tif", "cell2.tif", "cell10_mask.tif"] {
        labels().save(at(name)).unwrap();
    }
    for name in ["cell1.png", "cell2.png"] {
        picture().save(at(name)).unwrap();
    }
    let [maps, pictures] = ["*.tif", "*.png"].map(at);
    let table = at("objects.csv");
    let run = dvp(["fit", "--masks", text(&maps), text(&pictures), "--out", text(&out), "--table", text(&table)]);
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.err.contains("cell10_mask.tif") && !run.err.contains("cell1_mask.tif"), "{}", run.err);
    let pairs: BTreeSet<(String, String)> =
        rows(&table).iter().map(|row| (cell(row, "stem").to_owned(), cell(row, "picture").to_owned())).collect();
    let expected = [("cell1_mask", "cell1.png"), ("cell2", "cell2.png")];
    assert_eq!(pairs, expected.map(|(stem, name)| (stem.to_owned(), text(&at(name)).to_owned())).into());
}

#[test]
fn what_masks_do_not_use_is_refused_with_them() {
    for option in [["--objects", "3"], ["--seed", "7"], ["--max-objects", "3"]] {
        let run = dvp(["fit", "--masks", "map.tif", "--out", "out"].into_iter().chain(option));
        assert!(run.code > 0 && run.err.contains("cannot be used with") && run.err.contains(option[0]), "{}", run.err);
    }
}

#[test]
fn clear_pixels_of_a_picture_give_masks_no_color_and_no_background() {
    let folder = tempfile::tempdir().unwrap();
    let [map, path, out] = ["map.tif", "icon.png", "out"].map(|name| folder.path().join(name));
    labels().save(&map).unwrap();
    // Right halves of the objects are clear, and green where nobody sees it.
    let icon = RgbaImage::from_fn(64, 48, |x, y| match *picture().get_pixel(x, y) {
        Rgb([r, g, b]) if (6..15).contains(&x) || (36..46).contains(&x) => {
            let alpha = if Rgb([r, g, b]) == PAPER { 0 } else { 255 };
            Rgba([r, g, b, alpha])
        }
        _ => Rgba([0, 255, 0, 0]),
    });
    icon.save(&path).unwrap();
    let said = dvp_done(["fit", "--masks", text(&map), text(&path), "--out", text(&out), "--json"]);
    let said: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(said["images"][0]["transparent"], true, "{said}");
    let scene = read_scene(&out.join("map.json")).unwrap();
    assert!(scene.background.is_none(), "the color that the picture was put over is nobody's");
    for (object, color) in scene.objects.iter().zip([RED, BLUE]) {
        let off = object.color.iter().zip(color.0).map(|(found, right)| (found * 255.0 - f64::from(right)).abs());
        assert!(off.fold(0.0, f64::max) < 0.01, "{:?} in place of {color:?}", object.color);
    }
    assert_eq!(scene.objects.len(), 2);
    let drawn = image::open(out.join("map.png")).unwrap().into_rgba8();
    assert_eq!((drawn.get_pixel(0, 0).0[3], drawn.get_pixel(10, 20).0), (0, [200, 40, 30, 255]));
}

#[test]
fn colors_of_label_maps_are_numbered() {
    let folder = tempfile::tempdir().unwrap();
    let [map, out, table] = ["map.png", "out", "objects.csv"].map(|name| folder.path().join(name));
    let mut colors = picture();
    colors.pixels_mut().filter(|pixel| **pixel == PAPER).for_each(|pixel| *pixel = Rgb([0; 3]));
    colors.save(&map).unwrap();
    dvp_done(["fit", "--masks", text(&map), "--out", text(&out), "--labels", "--table", text(&table)]);
    let objects: Vec<String> = rows(&table).iter().map(|row| cell(row, "object").to_owned()).collect();
    assert_eq!(objects, ["1", "2"]);
    let written = image::open(out.join("map.labels.png")).unwrap().into_luma8();
    assert_eq!([[0, 0], [10, 20], [40, 30]].map(|[x, y]| written.get_pixel(x, y).0[0]), [0, 1, 2]);
}

#[test]
fn a_picture_whose_files_cannot_all_be_written_leaves_none() {
    let folder = tempfile::tempdir().unwrap();
    let [map, out, table] = ["map.tif", "out", "objects.csv"].map(|name| folder.path().join(name));
    // Labels of 32 bits: 300000 is more than the 16 bits of a label map hold.
    let values: Vec<u32> = labels().pixels().map(|pixel| u32::from(pixel.0[0]) * 1000).collect();
    fs::write(&map, tiff_of_32_bits([64, 48], &values)).unwrap();
    let run = dvp(["fit", "--masks", text(&map), "--out", text(&out), "--labels", "--table", text(&table)]);
    assert!(run.code > 0 && run.err.contains("300000"), "{}", run.err);
    assert_eq!(names(&out), Vec::<String>::new());
    let rows = rows(&table);
    assert!(rows.len() == 1 && cell(&rows[0], "error").contains("65535"), "{rows:?}");
}

#[test]
fn true_label_maps_beside_pictures_are_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["data", "out"].map(|name| folder.path().join(name));
    fs::create_dir(&data).unwrap();
    let [path, truth] = ["a.png", "a.labels.png"].map(|name| data.join(name));
    picture().save(&path).unwrap();
    labels().save(&truth).unwrap();
    let before = fs::read(&truth).unwrap();
    let run = dvp(["fit", text(&data), "--out", text(&data), "--no-png", "--labels"]);
    assert!(run.code == 1 && run.err.contains("a.labels.png") && run.err.contains("--out"), "{}", run.err);
    assert_eq!(names(&data), ["a.labels.png", "a.png"]);
    // Nor are those of the pictures of masks, nor the pictures, by whatever option.
    let map = folder.path().join("a.tif");
    labels().save(&map).unwrap();
    let masks = ["fit", "--masks", text(&map), text(&path), "--out", text(&data), "--no-png", "--labels"];
    assert!(dvp(masks).err.contains("a.labels.png"));
    let run = dvp(["fit", text(&path), "--out", text(&out), "--coco", text(&path)]);
    assert!(run.code == 1 && run.err.contains("a.png"), "{}", run.err);
    assert!(fs::read(&truth).unwrap() == before && !out.exists());
    dvp_done(["fit", text(&data), "--out", text(&out), "--labels"]);
    dvp_done(["fit", text(&data), "--out", text(&out), "--labels"]);
}

#[test]
fn a_picture_that_failed_has_a_row_that_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let [good, bad, out, table] = ["good.png", "bad.png", "out", "objects.csv"].map(|name| folder.path().join(name));
    picture().save(&good).unwrap();
    fs::write(&bad, b"no picture").unwrap();
    let run = dvp(["fit", text(&bad), text(&good), "--out", text(&out), "--table", text(&table)]);
    assert_eq!(run.code, 1);
    let rows = rows(&table);
    assert_eq!(rows.iter().map(|row| cell(row, "stem")).collect::<Vec<_>>(), ["bad", "good", "good"]);
    assert!(cell(&rows[0], "error").contains("not a readable image"), "{rows:?}");
    let filled = rows[0].iter().filter(|(_, cell)| !cell.is_empty()).count();
    assert!(filled == 3 && rows[1..].iter().all(|row| cell(row, "error").is_empty()), "{rows:?}");
}

#[test]
fn endings_that_no_format_has_are_refused_before_anything_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let [path, out] = ["a.png", "out"].map(|name| folder.path().join(name));
    picture().save(&path).unwrap();
    for [option, file, endings] in [
        ["--table", "a.xlsx", ".csv or .parquet"],
        ["--efd", "a.parquet", ".csv or .nef"],
        ["--efd", "a", ".csv or .nef"],
    ] {
        let run = dvp(["fit", text(&path), "--out", text(&out), option, file]);
        assert!(run.code == 1 && run.err.contains(option) && run.err.contains(endings), "{}", run.err);
        assert!(!out.exists());
    }
}
