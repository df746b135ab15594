use super::*;
use crate::export::coco::run_lengths;
use crate::export::roi::roi;

/// A triangle with corners on fractions of pixels.
fn triangle() -> Object<f32> {
    polygons(&[&[[1.5, 2.25], [7.5, 2.25], [1.5, 8.25]]], [0.0, 1.0, 0.0])
}

fn json(bytes: &[u8]) -> serde_json::Value {
    serde_json::from_slice(bytes).unwrap()
}

#[test]
fn a_roi_of_one_ring_has_these_bytes() {
    let object = &measured(vec![triangle()])[0];
    let mut region = object.region.clone();
    // Rings may start anywhere; here with the corner that was given first.
    let ring = &mut region.polygons[0].outer;
    let first = ring.iter().position(|&[x, y]| close(x, 1.5, 4) && close(y, 2.25, 4)).unwrap();
    ring.rotate_left(first);
    ring.iter_mut().for_each(|vertex| *vertex = vertex.map(|x| (x * 4.0).round() / 4.0));
    let bytes = roi(&region, &region.bounds().unwrap(), "1");
    let mut expected = b"Iout".to_vec();
    // Version 227, polygon; top 2, left 1, bottom 9, right 8; 3 corners.
    expected.extend([0, 227, 0, 0, 0, 2, 0, 1, 0, 9, 0, 8, 0, 3]);
    // Up to byte 50 nothing; option 128; the second head at 64 + 3 x 2 x (2 + 4) = 100.
    expected.extend([0; 32]);
    expected.extend([0, 128, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 100]);
    assert_eq!(expected.len(), 64);
    // x less 1, rounded: 0.5 to 1, 6.5 to 7, 1; y less 2: 0, 0, 6.
    expected.extend([0, 1, 0, 7, 0, 1, 0, 0, 0, 0, 0, 6]);
    for value in [1.5_f32, 7.5, 1.5, 2.25, 2.25, 8.25] {
        expected.extend(value.to_be_bytes());
    }
    // The second head: the name stands at 100 + 64 and has one letter.
    expected.extend([0; 16]);
    expected.extend([0, 0, 0, 164, 0, 0, 0, 1]);
    expected.extend([0; 40]);
    expected.extend([0, b'1']);
    assert_eq!(bytes, expected);
}

#[test]
fn a_roi_with_a_hole_is_a_composite() {
    let object = &measured(vec![frame()])[0];
    let bytes = roi(&object.region, &object.bounds.unwrap(), "");
    let float = |at: usize| f32::from_be_bytes(bytes[at..at + 4].try_into().unwrap());
    // Kind "rectangle", no corners, 2 x (4 x 3 + 1) numbers.
    assert_eq!((bytes[6], &bytes[16..18], &bytes[36..40]), (1, &[0, 0][..], &[0, 0, 0, 26][..]));
    let kinds: Vec<f32> = [0, 3, 6, 9, 12, 13, 16, 19, 22, 25].map(|k| float(64 + 4 * k)).to_vec();
    assert_eq!(kinds, [0.0, 1.0, 1.0, 1.0, 4.0, 0.0, 1.0, 1.0, 1.0, 4.0]);
}

#[test]
fn an_archive_names_its_entries_and_leaves_out_what_is_empty() {
    let line = polygons(&[&[[1.0, 1.0], [5.0, 1.0], [9.0, 1.0]]], [0.0; 3]);
    let bytes = roi_zip(&measured(vec![triangle(), line, disk([5.0, 5.0], 2.0)])).unwrap();
    let archive = rawzip::ZipArchive::from_slice(&bytes).unwrap();
    let names: Vec<String> = archive
        .entries()
        .map(|entry| String::from_utf8_lossy(entry.unwrap().file_path().as_ref()).into_owned())
        .collect();
    assert_eq!(names, ["0001-polygon.roi", "0003-circle.roi"]);
}

#[test]
fn runs_go_down_the_columns() {
    // . X .
    // X X .
    let mask = [false, true, false, true, true, false];
    let size = ImageSize::new(3, 2).unwrap();
    assert_eq!(run_lengths(&mask, size), [1, 3, 2]);
    assert_eq!(run_lengths(&[true; 6], size), [0, 6]);
    assert_eq!(run_lengths(&[false; 6], size), [6]);
}

#[test]
fn coco_holds_polygons_and_masks() {
    let pictures = [picture(vec![triangle(), frame()]), failed(), picture(vec![disk([5.0, 5.0], 2.0)])];
    let data = json(&coco(&pictures).unwrap());
    assert_eq!(data["images"].as_array().unwrap().len(), 2, "without the one that failed");
    assert_eq!((&data["images"][1]["id"], &data["images"][1]["width"]), (&2.into(), &10.into()));
    let names: Vec<&str> = data["categories"].as_array().unwrap().iter().map(|c| c["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["circle", "polygon"]);
    let annotations = data["annotations"].as_array().unwrap();
    let of: Vec<_> = annotations
        .iter()
        .map(|a| [&a["id"], &a["image_id"], &a["category_id"]].map(|v| v.as_u64().unwrap()))
        .collect();
    assert_eq!(of, [[1, 1, 2], [2, 1, 2], [3, 2, 1]]);
    assert_eq!(annotations[0]["segmentation"][0].as_array().unwrap().len(), 6);
    assert_eq!(annotations[0]["bbox"], serde_json::json!([1.5, 2.25, 6.0, 6.0]));
    assert_eq!(annotations[0]["area"], 18.0);
    // Columns 2 to 7: 2 rows out, 6 in, 2 out; columns 4 and 5 have the hole in rows 4 and 5.
    let counts = [22, 6, 4, 6, 4, 2, 2, 2, 4, 2, 2, 2, 4, 6, 4, 6, 22];
    assert_eq!(annotations[1]["segmentation"], serde_json::json!({ "counts": counts, "size": [10, 10] }));
}

#[test]
fn geojson_holds_holes_parts_and_the_table() {
    let two = polygons(&[&corners([0.0, 0.0], [2.0, 2.0]), &corners([5.0, 5.0], [8.0, 8.0])], [0.0; 3]);
    let line = polygons(&[&[[1.0, 1.0], [5.0, 1.0], [9.0, 1.0]]], [0.0; 3]);
    let scale = Some(Scale { mm_per_px: 0.5 });
    let data = json(&geojson(&picture(vec![frame(), two, line]), scale).unwrap());
    assert_eq!(data["type"], "FeatureCollection");
    let [frame, two, line] = [0, 1, 2].map(|k| &data["features"][k]);
    assert_eq!((&frame["geometry"]["type"], &frame["id"]), (&"Polygon".into(), &1.into()));
    let rings = frame["geometry"]["coordinates"].as_array().unwrap();
    assert_eq!(rings.len(), 2);
    for (ring, area) in rings.iter().zip([36.0, -4.0]) {
        let ring: Vec<[f64; 2]> = serde_json::from_value(ring.clone()).unwrap();
        assert_eq!((ring.len(), ring.first()), (5, ring.last()));
        assert_eq!(dvp_core::contour::signed_area(&ring[..4]), area);
    }
    let number = |name: &str| frame["properties"][name].as_f64().unwrap();
    assert!(close(number("area_px2"), 32.0, 5) && close(number("area_mm2"), 8.0, 5), "{frame}");
    assert_eq!(frame["properties"]["color"], "#ff0033");
    assert!(frame["properties"].get("angle_deg").is_none(), "what is not known is left out");
    assert_eq!(two["geometry"]["type"], "MultiPolygon");
    assert_eq!(two["geometry"]["coordinates"].as_array().unwrap().len(), 2);
    assert!(line["geometry"].is_null());
}
