mod pair;

use alloc::vec::Vec;

use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, mdshr_bank};

use super::waist::is_convex;
use super::{Part, PartSet, split};
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::pose::search::Prototype;
use crate::segment::{EdgeSample, Segment};

fn prototypes() -> Vec<Prototype<f64>> {
    let bank = mdshr_bank::<f64>(16);
    let basis = OutlineBasis::new(REFERENCE_VERTICES, 16).unwrap();
    bank.prototypes().iter().map(|efd| Prototype::new(efd, &basis).unwrap().unwrap()).collect()
}

fn pose(x: f64, y: f64, rotation: f64) -> PosePx<f64> {
    PosePx { translation: [x, y], log_scale: 13.0_f64.ln(), rotation }
}

/// Samples within 1.5 px of the outline of the union, and the pixels inside it.
fn union_of(parts: &[Part<f64>], prototypes: &[Prototype<f64>]) -> Segment<f64> {
    let mut segment = Segment::default();
    for index in 0..96 * 96_u32 {
        let point = [index % 96, index / 96].map(|v| f64::from(v) + 0.5);
        let distance = parts.iter().fold(f64::INFINITY, |least, part| {
            let frame = Frame::new(&part.pose);
            least.min(frame.scale * prototypes[part.prototype].field.distance(frame.to_unit(point)).0)
        });
        segment.pixels += usize::from(distance < 0.0);
        if distance.abs() < 1.5 {
            segment.samples.push(EdgeSample { point, distance, weight: 0.5 });
        }
    }
    segment
}

fn assert_found(sets: &[PartSet<f64>], truth: &[Part<f64>]) {
    let found = &sets[0];
    assert_eq!(found.parts.len(), truth.len(), "{sets:?}");
    for part in truth {
        let near = |other: &&Part<f64>| {
            let [x, y] = [0, 1].map(|c| other.pose.translation[c] - part.pose.translation[c]);
            other.prototype == part.prototype && x.hypot(y) < 0.05
        };
        let other = found.parts.iter().find(near).unwrap_or_else(|| panic!("{part:?} is not in {found:?}"));
        assert!((other.pose.log_scale - part.pose.log_scale).abs() < 0.005, "{other:?} is not {part:?}");
    }
}

#[test]
fn twins_of_every_shape() {
    let prototypes = prototypes();
    for prototype in 0..prototypes.len() {
        // Centers 13 px apart, objects about 26 px across: half of each lies in the other.
        let truth = [pose(40.0, 45.0, 0.4), pose(53.0, 46.0, 2.1)].map(|pose| Part { prototype, pose });
        let mut segment = union_of(&truth, &prototypes);
        assert_found(&split(&segment, &prototypes), &truth);
        // Seeds depend on the order of the samples, the answer does not.
        segment.samples.reverse();
        assert_found(&split(&segment, &prototypes), &truth);
    }
}

#[test]
fn three_in_a_row() {
    let prototypes = prototypes();
    let truth: Vec<_> =
        (0..3).map(|i| Part { prototype: i, pose: pose(26.0 + 18.0 * i as f64, 45.0, 0.3 + i as f64) }).collect();
    assert_found(&split(&union_of(&truth, &prototypes), &prototypes), &truth);
}

#[test]
fn one_shape_stays_whole() {
    let prototypes = prototypes();
    for prototype in 0..prototypes.len() {
        let segment = union_of(&[Part { prototype, pose: pose(44.0, 41.0, 1.0) }], &prototypes);
        assert_eq!(split(&segment, &prototypes), []);
    }
}

#[test]
fn what_is_convex_but_for_ripples_is_no_union() {
    let rectangle = |i: usize, ripple: f64| {
        // 30 x 12 px; every other point of the upper side lies `ripple` below it.
        let x = (i % 30) as f64;
        if i < 30 { [x, ripple * (i % 2) as f64] } else { [30.0 - x, 12.0] }
    };
    let contour = |ripple| (0..60).map(|i| rectangle(i, ripple)).collect::<Vec<[f64; 2]>>();
    assert!(is_convex(&contour(0.3)));
    assert!(!is_convex(&contour(1.0)));
    // Either way around.
    let mut reversed = contour(1.0);
    reversed.reverse();
    assert!(!is_convex(&reversed));
    reversed = contour(0.3);
    reversed.reverse();
    assert!(is_convex(&reversed));
}
