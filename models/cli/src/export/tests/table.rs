use super::*;

#[test]
fn a_row_per_object_and_one_per_failure() {
    let pictures = [picture(vec![frame(), disk([5.0, 5.0], 2.0)]), failed(), picture(Vec::new())];
    let text = String::from_utf8(table_csv(&pictures, None).unwrap()).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 4, "{text}");
    let head = "picture,stem,object,kind,prototype,centroid_x_px,centroid_y_px,area_px2,perimeter_px,circularity,\
        major_axis_px,minor_axis_px,angle_deg,bounds_x_px,bounds_y_px,bounds_width_px,bounds_height_px,red,green,blue,color,\
        confidence,visible,centroid_x_sd_px,centroid_y_sd_px,area_sd_px2,perimeter_sd_px,\
        major_axis_sd_px,minor_axis_sd_px,angle_sd_deg,error";
    assert_eq!(lines[0], head);
    assert!(lines[1].starts_with("a b.png,a b,1,polygon,,"), "{}", lines[1]);
    assert!(lines[1].contains(",255,0,51,#ff0033,1,"), "{}", lines[1]);
    assert!(lines[1].ends_with(",,,,,,,,"), "no fit, no deviations, no error: {}", lines[1]);
    assert!(lines[2].starts_with("a b.png,a b,2,circle,,5,5,"), "{}", lines[2]);
    assert_eq!(lines[3], format!("x.png,x{},\"x.png: no \"\"image\"\"\"", ",".repeat(28)));
    assert_eq!(lines[3].matches(',').count(), head.matches(',').count());
}

#[test]
fn lengths_and_areas_come_in_mm_as_well() {
    let scale = Some(Scale { mm_per_px: 0.5 });
    let text = String::from_utf8(table_csv(&[picture(vec![frame()])], scale).unwrap()).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let head = reader.headers().unwrap().clone();
    let row = reader.records().next().unwrap().unwrap();
    let cell = |name: &str| row[head.iter().position(|own| own == name).unwrap()].parse::<f64>().unwrap();
    assert!(close(cell("area_mm2"), 8.0, 5) && close(cell("perimeter_mm"), 16.0, 5));
    assert!(close(cell("centroid_x_mm"), 2.5, 5) && close(cell("bounds_width_mm"), 3.0, 5));
    assert!(!head.iter().any(|name| name == "circularity_mm" || name == "visible_mm"));
    assert_eq!(head.iter().next_back(), Some("error"));
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_says_the_same() {
    use std::io::Write as _;

    use parquet::file::reader::{FileReader as _, SerializedFileReader};
    use parquet::record::Field;

    let pictures = [picture(vec![frame(), disk([5.0, 5.0], 2.0)]), failed()];
    let scale = Some(Scale { mm_per_px: 0.1 });
    let text = table_csv(&pictures, scale).unwrap();
    let mut csv = csv::Reader::from_reader(&*text);
    let mut file = tempfile::tempfile().unwrap();
    file.write_all(&table_parquet(&pictures, scale).unwrap()).unwrap();
    let file = SerializedFileReader::new(file).unwrap();
    assert_eq!(file.metadata().file_metadata().num_rows(), 3);
    let head = csv.headers().unwrap().clone();
    for (row, record) in file.get_row_iter(None).unwrap().zip(csv.records()) {
        let (row, record) = (row.unwrap(), record.unwrap());
        for (at, (name, value)) in row.get_column_iter().enumerate() {
            assert_eq!(name, &head[at]);
            let text = match value {
                Field::Null => String::new(),
                Field::Str(text) => text.clone(),
                Field::Long(count) => count.to_string(),
                Field::Double(number) => number.to_string(),
                other => panic!("{name}: {other:?}"),
            };
            assert_eq!(text, record[at], "{name}");
        }
    }
}

#[cfg(not(feature = "parquet"))]
#[test]
fn parquet_is_refused_with_what_to_do() {
    let error = table_parquet(&[], None).unwrap_err().to_string();
    assert!(error.contains("--features parquet") && error.contains(".csv"), "{error}");
}
