use super::*;
use crate::export::efd::normal_form;

/// An egg-like ring: harmonics 1 and 2, moved, turned, scaled.
fn egg(angle: f64, scale: f64, start: usize) -> Region {
    let count = 256;
    let vertex = |i: usize| {
        let t = core::f64::consts::TAU * ((i + start) % count) as f64 / count as f64;
        let (x, y) = (t.cos() + 0.1 * (2.0 * t).cos(), 0.7 * t.sin() + 0.05 * (2.0 * t).sin());
        [40.0 + scale * (x * angle.cos() - y * angle.sin()), 30.0 + scale * (x * angle.sin() + y * angle.cos())]
    };
    Region { polygons: vec![Polygon { outer: (0..count).map(vertex).collect(), holes: Vec::new() }] }
}

#[test]
fn normal_forms_do_not_know_size_angle_and_start() {
    let known = normal_form(&egg(0.0, 10.0, 0), 12).unwrap();
    let [first, ..] = known.rows() else { panic!("12 rows") };
    assert!(close(first[0], 1.0, 9) && close(first[1], 0.0, 9) && close(first[2], 0.0, 9), "{first:?}");
    assert!(first[3] > 0.0 && first[3] < 1.0, "{first:?}");
    for (angle, scale, start) in [(0.3, 4.0, 17), (2.0, 10.0, 128), (-3.0, 55.0, 200)] {
        let other = normal_form(&egg(angle, scale, start), 12).unwrap();
        for (a, b) in known.rows().as_flattened().iter().zip(other.rows().as_flattened()) {
            assert!(close(*a, *b, 6), "{angle} {scale} {start}: {a} {b}");
        }
    }
}

#[test]
fn a_disk_is_one_harmonic() {
    let object = &measured(vec![disk([5.0, 5.0], 4.0)])[0];
    let efd = normal_form(&object.region, 5).unwrap();
    assert!(close(efd.rows()[0][3], 1.0, 4), "{efd:?}");
    assert!(efd.rows()[1..].as_flattened().iter().all(|&value| value.abs() < 1e-3), "{efd:?}");
}

#[test]
fn tables_of_descriptors_have_a_row_per_harmonic() {
    let line = polygons(&[&[[1.0, 1.0], [5.0, 1.0], [9.0, 1.0]]], [0.0; 3]);
    let bar = polygons(&[&corners([1.0, 1.0], [7.0, 3.0])], [0.0; 3]);
    let pictures = [picture(vec![bar, line]), failed()];
    let csv = String::from_utf8(efd_csv(&pictures, 2).unwrap()).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "picture,stem,object,harmonic,a,b,c,d");
    assert!(lines[1].starts_with("a b.png,a b,1,1,1.000000000,"), "{csv}");
    assert!(lines[2].starts_with("a b.png,a b,1,2,"), "{csv}");
    assert_eq!(lines[3..], ["a b.png,a b,2,,,,,"], "nothing enclosed, no picture");
    let nef = String::from_utf8(efd_nef(&pictures, 2)).unwrap();
    let lines: Vec<&str> = nef.lines().collect();
    assert_eq!(lines[..3], ["#CONST 1 1 1 0", "#HARMO 2", "a_b_1"]);
    assert_eq!(lines.len(), 5);
    // The number of harmonics stands from the eighth character on, numbers between blanks.
    assert_eq!(lines[1][7..].parse(), Ok(2));
    let numbers: Vec<f64> = lines[3].split(' ').filter_map(|text| text.parse().ok()).collect();
    assert!(numbers.len() == 4 && close(numbers[0], 1.0, 8), "{nef}");
}
